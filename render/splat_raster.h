// Points and triangles into a picture of numbers and depths, on the CPU's threads: for OpenGL that has no
// other processor to draw with either, where a point of one pixel would cost a quarter of a microsecond and
// here costs a twentieth of that.
//
// Every pixel holds the nearest depth's bits and the number's complement in one word, and keeps the larger of
// any two: so the picture does not depend on the order in which threads come by.
#ifndef DUPIN_RENDER_SPLAT_RASTER_H
#define DUPIN_RENDER_SPLAT_RASTER_H

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "../simplify/point_node.h"

namespace dupin {

/// From a tree's grid to the picture, for one placement. A plane's value at a point is n·p + d.
struct SplatProjection {
  std::array<double, 4> x{}, y{}, depth{};  ///< clip X, Y; depth in model units
  bool perspective = true;
  /// The depth buffer's value is a + b·depth + c/depth.
  std::array<double, 3> depth_terms{};
  double nearest_depth = 0;    ///< triangles are cut here; perspective only
  double pixels_per_step = 1;  ///< of a length of one step; in perspective at the depth 1
  double depth_per_step = 1;   ///< the most that a step changes the depth
  Vec3 eye;                    ///< in the tree's grid; in parallel the direction towards the viewer
  /// Discs are as narrow, where they are seen at a slant, as the cone of their normals allows; else circles.
  bool foreshortened = false;
  bool flat = false;  ///< discs face the viewer, as QSplat's do; else they lie in their tangent planes
  /// What has a negative value of any of them, of clip X, Y, the depth and 1, is cut away.
  std::span<const std::array<double, 4>> sections;
};

enum class Splatting {
  /// A disc of the sphere's size; where discs overlap, the one whose middle is nearest is seen, if they are
  /// of one surface
  simple,
  visibility,  ///< the disc, marked as a hole and behind what it stands for; and its middle pixel
};

/// A vertex of triangles, on the grid as in EncodedNode.
struct SplatVertex {
  std::uint32_t words[2];  ///< EncodedNode's first two
  std::uint32_t normal, color;
};
static_assert(sizeof(SplatVertex) == 16);
/// Three indices into the vertices, and one word more.
using SplatTriangle = std::array<std::uint32_t, 4>;

/// Nodes or leaves, in the order of their numbers.
struct SplatList {
  std::span<const std::uint32_t> items;
  std::uint32_t first = 0;  ///< the number of the first
};

class SplatRaster {
 public:
  static constexpr std::uint32_t kHole = 1U << 25, kTriangle = 1U << 26;

  /// An empty picture; what the last one left is cleared.
  void begin(int width, int height);

  // Several threads may add at once.

  /// Writes the nodes of some items of a list.
  using CopyNodes = std::function<void(std::span<const std::uint32_t> items, EncodedNode* nodes)>;
  /// Points with the numbers list.first, list.first + 1, …; below kHole.
  void add_points(const SplatProjection& projection, std::span<const SplatList> lists,
                  const CopyNodes& copy_nodes, Splatting splatting);
  /// The triangles [first, last) of a leaf in a list, four at most.
  using TrianglesOf = std::function<std::array<std::uint32_t, 2>(std::uint32_t)>;
  /// Leaves' triangles, both sides of them, with the numbers kTriangle | list.first + 4 i + k.
  /// Pixels whose centres they cover, those on a common edge once.
  void add_triangles(const SplatProjection& projection, std::span<const SplatVertex> vertices,
                     std::span<const SplatTriangle> triangles, std::span<const SplatList> lists,
                     const TrianglesOf& triangles_of);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Row 0 on top: the number's complement in the low half, the depth buffer's value in the high one; 0 where
  /// there is nothing.
  const std::vector<std::uint64_t>& pixels() const { return pixels_; }
  std::span<std::uint64_t> row(int y) {
    return std::span(pixels_).subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_),
                                      static_cast<std::size_t>(width_));
  }
  /// Rows [first, last) hold everything.
  std::array<int, 2> rows() const { return rows_; }

 private:
  class Points;
  class Triangles;
  void add_rows(int first, int last);
  int width_ = 0, height_ = 0;
  std::mutex rows_lock_;
  std::array<int, 2> rows_{0, 0};
  std::vector<std::uint64_t> pixels_;
};

}  // namespace dupin

#endif
