// The other side of the comparison: Open CASCADE reads and tessellates the same file.
#ifndef DUPIN_BENCH_OCCT_SIDE_H
#define DUPIN_BENCH_OCCT_SIDE_H

#include <cstddef>
#include <memory>
#include <string>

namespace dupin::bench {

/// A file's shape, read once and meshed as often as asked.
class OcctShape {
 public:
  /// STEP, IGES and BREP by the name's ending; null where Open CASCADE cannot read it.
  static std::unique_ptr<OcctShape> read(const std::string& path);
  ~OcctShape();

  /// Seconds of one BRepMesh_IncrementalMesh (parallel) at an absolute linear deflection, from no triangles.
  double mesh(double deflection, double angle_radians);

  /// Of the last mesh. Faces that occur several times in an assembly share their triangles and count once.
  struct Triangles {
    std::size_t triangles = 0;
    std::size_t on_curved = 0;  ///< triangles of faces that are no plane, cylinder, cone or sphere
    /// The angle between the interpolated vertex normals and the surface's own normal over those faces: what
    /// 99 % of their area stays below, in degrees. 0 where there are none.
    double normal_p99_degrees = 0;
  };
  Triangles triangles() const;

 private:
  struct Data;
  explicit OcctShape(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace dupin::bench

#endif
