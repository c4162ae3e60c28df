// Up to four adjacent triangles a leaf (Chen & Nguyen 2001, section 3.5).
#ifndef DUPIN_SIMPLIFY_LEAF_CLUSTERS_H
#define DUPIN_SIMPLIFY_LEAF_CLUSTERS_H

#include <array>
#include <cstdint>
#include <vector>

#include "point_node.h"
#include "tree_mesh.h"

namespace dupin {

struct LeafCluster {
  std::array<std::uint32_t, kMostLeafTriangles> triangles{};
  std::uint32_t size = 0;
};

/// Every triangle is in one cluster. Triangles of a cluster are joined by edges, are of one group and either
/// all or none of them of a closed surface. Does not depend on the number of threads.
std::vector<LeafCluster> cluster_triangles(const TreeMesh& mesh);

/// The order of the points along a space-filling curve.
std::vector<std::uint32_t> spatial_order(const std::vector<std::array<float, 3>>& points);

}  // namespace dupin

#endif
