// Point trees as files: read as models, and kept for the next time.
#ifndef DUPIN_APP_TREE_FILES_H
#define DUPIN_APP_TREE_FILES_H

#include <memory>
#include <string>

#include "../nurbs/model.h"
#include "../simplify/point_tree.h"

namespace dupin::app {

/// Whether a file begins as a .dpt file does.
bool is_tree_file(const std::string& path);

/// A model of one part that stands for the tree: its groups, its box, its place. With `unpack` it has the
/// tree's triangles too.
Result<Model> model_of_tree(const PointTree& tree, const std::string& path, bool unpack);

/// Where the tree of a file is kept in a folder: under a name that changes with the file's path, size and
/// time, the unit it is read in, the kind of tree and this version's layout. Empty for a file that cannot be
/// looked at.
std::string kept_tree(const std::string& folder, const std::string& file, const std::string& units,
                      PointTreeKind kind);

}  // namespace dupin::app

#endif
