// Reading the files that a command names.
#ifndef DUPIN_APP_LOAD_H
#define DUPIN_APP_LOAD_H

#include <memory>
#include <string>
#include <vector>

#include "../cad_import/cad_import.h"
#include "../nurbs/model.h"
#include "../simplify/point_tree.h"
#include "session.h"

namespace dupin::app {

struct Loaded {
  Model model;
  double import_seconds = 0;  ///< without the tessellation, which is Model::mesh_seconds
  /// Of LoadOptions::trees, one a part: the tree that stands for it, or the file that its tree is to be kept
  /// in; or neither.
  std::vector<std::shared_ptr<const PointTree>> trees;
  std::vector<std::string> tree_files;
};

struct LoadOptions {
  double mesh_deflection = 0;  ///< as in ImportOptions
  /// Trees from .dpt files stay what they are; else their parts get the trees' triangles.
  bool trees = false;
  PointTreeKind kind = PointTreeKind::pop;  ///< of the trees that are wanted
  std::string tree_folder;                  ///< where trees of mesh files are kept; empty: nowhere
};

/// Reads the files and puts their models, each where it stands in its own space, into one.
Result<Loaded> load(Session& session, const std::vector<std::string>& files, const LoadOptions& options = {});

/// Turns every mesh into the limit surface of the cage that it is: exact faces; for a `mesh_deflection` above
/// 0 with triangles of their own. `scheme`: "auto", "catmull-clark" or "loop". A model without meshes is
/// unreadable.
Status subdivide(Session& session, Model& model, const std::string& scheme, double mesh_deflection);

/// Adds what `other` holds to `model`.
void merge(Model& model, Model other);

/// How many face instances could not be read.
std::size_t skipped_count(const std::vector<SkippedFace>& skipped);

}  // namespace dupin::app

#endif
