#include "mesh.h"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopoDS_Compound.hxx>

#include <chrono>

#include "../../core/parallel.h"
#include "geometry.h"

namespace dupin::reader {
namespace {

Vec3 normal_at(const Part& part, const Face& face, Vec2 q) {
  const Surface& surface = part.surfaces[face.surface];
  const SurfaceJet s = evaluate(surface, q.x, q.y, 1);
  Vec3 n = cross(s.pu, s.pv);
  if (!(length(n) > 1e-9 * length(s.pu) * length(s.pv))) {
    const Curvature limit = principal_curvature(surface, q.x, q.y, face.uv_box.center());
    n = limit.kind == Curvature::Kind::undefined ? Vec3{} : limit.n;
  }
  return normalized(face.reversed ? -n : n);
}

struct FaceMesh {
  std::vector<Vec3> positions, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

FaceMesh face_mesh(const TopoDS_Face& shape, const Part& part, const Face& face) {
  FaceMesh mesh;
  TopLoc_Location location;
  const Handle(Poly_Triangulation) t = BRep_Tool::Triangulation(shape, location);
  if (t.IsNull()) return mesh;
  const gp_Trsf placement = location.Transformation();
  for (int i = 1; i <= t->NbNodes(); ++i) {
    mesh.positions.push_back(to_vec(t->Node(i).Transformed(placement).XYZ()));
    mesh.normals.push_back(t->HasUVNodes() ? normal_at(part, face, to_vec(t->UVNode(i).XY())) : Vec3{});
  }
  for (int i = 1; i <= t->NbTriangles(); ++i) {
    int a, b, c;
    t->Triangle(i).Get(a, b, c);
    if (face.reversed) std::swap(b, c);
    mesh.triangles.push_back({static_cast<std::uint32_t>(a - 1), static_cast<std::uint32_t>(b - 1),
                              static_cast<std::uint32_t>(c - 1)});
  }
  // Where the surface has no normal, the triangles around do.
  std::vector<Vec3> around(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 n = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    around[a] += n, around[b] += n, around[c] += n;
  }
  for (std::size_t i = 0; i < around.size(); ++i)
    if (!(length(mesh.normals[i]) > 0.5)) mesh.normals[i] = normalized(around[i]);
  return mesh;
}

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

double mesh_faces(const std::vector<TopoDS_Face>& faces, double deflection, double angle_radians) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Face& face : faces) builder.Add(all, face);
  const auto start = std::chrono::steady_clock::now();
  const BRepMesh_IncrementalMesh mesher(all, deflection, false, angle_radians, true);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void take_mesh(const std::vector<TopoDS_Face>& faces, Part& part) {
  std::vector<FaceMesh> meshes(faces.size());
  parallel_for(
      faces.size(), [&](std::size_t i) { meshes[i] = face_mesh(faces[i], part, part.faces[i]); }, 16);
  TriangleMesh& out = part.mesh;
  out.origin = part.box.center();
  for (std::size_t f = 0; f < meshes.size(); ++f) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (const Vec3& p : meshes[f].positions) out.positions.push_back(to_float(p - out.origin));
    for (const Vec3& n : meshes[f].normals) out.normals.push_back(to_float(n));
    for (const auto& triangle : meshes[f].triangles) {
      for (const std::uint32_t corner : triangle) out.triangles.push_back(first + corner);
      out.faces.push_back(static_cast<std::uint32_t>(f));
    }
  }
}

}  // namespace dupin::reader
