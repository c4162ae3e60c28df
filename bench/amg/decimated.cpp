#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "pictures.h"

namespace dupin::bench {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Mesh to_openmesh(const PolygonMesh& source) {
  Mesh mesh;
  std::vector<Mesh::VertexHandle> vertices;
  for (const Vec3& p : source.positions) vertices.push_back(mesh.add_vertex({p.x, p.y, p.z}));
  for (std::size_t i = 0; i < source.polygon_count(); ++i) {
    std::vector<Mesh::VertexHandle> corners;
    for (std::size_t k = 0; k < source.corner_count(i); ++k)
      corners.push_back(vertices[source.corners[source.first_corner(i) + k]]);
    mesh.add_face(corners);  // what is not manifold is left out
  }
  return mesh;
}

PolygonMesh from_openmesh(const Mesh& mesh) {
  PolygonMesh result;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    result.positions.push_back({p[0], p[1], p[2]});
  }
  for (const auto f : mesh.faces())
    for (const auto v : mesh.fv_range(f)) result.corners.push_back(static_cast<std::uint32_t>(v.idx()));
  return result;
}

}  // namespace

Model decimated(const Model& model, std::size_t triangles) {
  Model result = model;
  for (Part& part : result.parts) {
    Mesh mesh = to_openmesh(part.polygons);
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    decimater.add(quadric);
    decimater.initialize();
    decimater.decimate_to_faces(0, triangles);
    mesh.garbage_collection();
    part.polygons = from_openmesh(mesh);
  }
  return result;
}

}  // namespace dupin::bench
