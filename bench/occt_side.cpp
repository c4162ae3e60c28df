#include "occt_side.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace dupin::bench {

struct OcctShape::Data {
  TopoDS_Shape shape;
  TopTools_IndexedMapOfShape
      faces;  // by TShape and location: placed copies are found by their first location
};

namespace {

bool ends_with(std::string name, const std::string& ending) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name.size() >= ending.size() &&
         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

template <class Reader>
TopoDS_Shape transfer(const std::string& path) {
  Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return {};
  reader.TransferRoots();
  return reader.OneShape();
}

TopoDS_Shape read_shape(const std::string& path) {
  if (ends_with(path, ".step") || ends_with(path, ".stp")) return transfer<STEPControl_Reader>(path);
  if (ends_with(path, ".igs") || ends_with(path, ".iges")) return transfer<IGESControl_Reader>(path);
  TopoDS_Shape shape;
  BRep_Builder builder;
  if (ends_with(path, ".brep") || ends_with(path, ".brp")) BRepTools::Read(shape, path.c_str(), builder);
  return shape;
}

/// Not where the partial derivatives are parallel.
bool unit_normal(const BRepAdaptor_Surface& surface, const gp_Pnt2d& uv, gp_Vec& normal) {
  gp_Pnt p;
  gp_Vec du, dv;
  surface.D1(uv.X(), uv.Y(), p, du, dv);
  normal = du.Crossed(dv);
  const double length = normal.Magnitude();
  if (!(length > 1e-9 * du.Magnitude() * dv.Magnitude()) || length == 0) return false;
  normal.Divide(length);
  return true;
}

struct Weighted {
  double angle, area;
};

/// The interpolated against the true normal at a triangle's middle and half way from it to the corners.
void add_normal_errors(const BRepAdaptor_Surface& surface, const Poly_Triangulation& mesh,
                       std::vector<Weighted>& errors) {
  static constexpr double kPoints[4][3] = {
      {1 / 3., 1 / 3., 1 / 3.}, {2 / 3., 1 / 6., 1 / 6.}, {1 / 6., 2 / 3., 1 / 6.}, {1 / 6., 1 / 6., 2 / 3.}};
  for (int i = 1; i <= mesh.NbTriangles(); ++i) {
    int corner[3];
    mesh.Triangle(i).Get(corner[0], corner[1], corner[2]);
    gp_Vec normals[3];
    gp_XY uv[3];
    bool regular = true;
    for (int k = 0; k < 3; ++k) {
      uv[k] = mesh.UVNode(corner[k]).XY();
      regular = regular && unit_normal(surface, uv[k], normals[k]);
    }
    if (!regular) continue;
    const gp_Vec side(mesh.Node(corner[0]), mesh.Node(corner[1]));
    const double area = side.Crossed(gp_Vec(mesh.Node(corner[0]), mesh.Node(corner[2]))).Magnitude() / 8;
    for (const auto& w : kPoints) {
      gp_Vec truth, interpolated = normals[0] * w[0] + normals[1] * w[1] + normals[2] * w[2];
      if (interpolated.Magnitude() == 0 ||
          !unit_normal(surface, uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2], truth))
        continue;
      errors.push_back({truth.Angle(interpolated) * 180 / M_PI, area});
    }
  }
}

double weighted_percentile(std::vector<Weighted>& errors, double part) {
  std::sort(errors.begin(), errors.end(),
            [](const Weighted& a, const Weighted& b) { return a.angle < b.angle; });
  double total = 0, sum = 0;
  for (const Weighted& e : errors) total += e.area;
  for (const Weighted& e : errors)
    if ((sum += e.area) >= part * total) return e.angle;
  return 0;
}

}  // namespace

OcctShape::OcctShape(std::unique_ptr<Data> data) : data_(std::move(data)) {}
OcctShape::~OcctShape() = default;

std::unique_ptr<OcctShape> OcctShape::read(const std::string& path) {
  Message::DefaultMessenger()->ChangePrinters().Clear();  // the kernel's messages would run into the table
  auto data = std::make_unique<Data>();
  data->shape = read_shape(path);
  if (data->shape.IsNull()) return nullptr;
  TopTools_IndexedMapOfShape placed;
  TopExp::MapShapes(data->shape, TopAbs_FACE, placed);
  TopTools_IndexedMapOfShape seen;
  for (int i = 1; i <= placed.Extent(); ++i) {
    const int before = seen.Extent();
    seen.Add(placed(i).Located(TopLoc_Location()).Oriented(TopAbs_FORWARD));
    if (seen.Extent() > before) data->faces.Add(placed(i));
  }
  return std::unique_ptr<OcctShape>(new OcctShape(std::move(data)));
}

double OcctShape::mesh(double deflection, double angle_radians) {
  BRepTools::Clean(data_->shape);
  const auto start = std::chrono::steady_clock::now();
  BRepMesh_IncrementalMesh mesher(data_->shape, deflection, false, angle_radians, true);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

OcctShape::Triangles OcctShape::triangles() const {
  Triangles counts;
  std::vector<Weighted> errors;
  for (int i = 1; i <= data_->faces.Extent(); ++i) {
    const TopoDS_Face& face = TopoDS::Face(data_->faces(i));
    TopLoc_Location location;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull()) continue;
    counts.triangles += mesh->NbTriangles();
    const BRepAdaptor_Surface surface(TopoDS::Face(face.Located(TopLoc_Location())), false);
    if (surface.GetType() <= GeomAbs_Sphere) continue;  // plane, cylinder, cone, sphere come first
    counts.on_curved += mesh->NbTriangles();
    try {
      if (mesh->HasUVNodes()) add_normal_errors(surface, *mesh, errors);
    } catch (const Standard_Failure&) {
      // Where the kernel cannot evaluate its own surface the face has no say in what normals are to be like.
    }
  }
  counts.normal_p99_degrees = weighted_percentile(errors, 0.99);
  return counts;
}

}  // namespace dupin::bench
