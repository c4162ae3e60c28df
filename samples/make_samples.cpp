// Makes the STEP files in this folder: make_samples FOLDER. See README.md there.
#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepTools.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax2.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace {

constexpr double kPi = 3.14159265358979323846;

Quantity_Color srgb(int rgb) {
  return {(rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0, Quantity_TOC_sRGB};
}
const Quantity_Color kPaint = srgb(0x2f6f8f), kBrass = srgb(0xd6a84b), kSteel = srgb(0xb4b9c0),
                     kDark = srgb(0x4a4f57), kRed = srgb(0xc8452f), kIvory = srgb(0xe9e4d4),
                     kGreen = srgb(0x5f9e6e);

// ---- writing
// -------------------------------------------------------------------------------------------------

class Document {
 public:
  Document() : document_(new TDocStd_Document("XmlXCAF")) {
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
    shapes_->SetAutoNaming(false);
  }

  TDF_Label part(const char* name, const TopoDS_Shape& shape, const Quantity_Color& color) {
    const TDF_Label label = shapes_->AddShape(shape, false);
    TDataStd_Name::Set(label, name);
    colors_->SetColor(label, color, XCAFDoc_ColorSurf);
    return label;
  }
  TDF_Label assembly(const char* name) {
    const TDF_Label label = shapes_->NewShape();
    TDataStd_Name::Set(label, name);
    return label;
  }
  TDF_Label place(const TDF_Label& assembly, const TDF_Label& part, const gp_Trsf& where, const char* name) {
    const TDF_Label label = shapes_->AddComponent(assembly, part, TopLoc_Location(where));
    TDataStd_Name::Set(label, name);
    return label;
  }
  void color(const TDF_Label& label, const Quantity_Color& color) {
    colors_->SetColor(label, color, XCAFDoc_ColorSurf);
  }
  void color_faces(const TDF_Label& part, const Quantity_Color& color,
                   const std::function<bool(const BRepAdaptor_Surface&)>& chosen) {
    for (TopExp_Explorer e(XCAFDoc_ShapeTool::GetShape(part), TopAbs_FACE); e.More(); e.Next())
      if (chosen(BRepAdaptor_Surface(TopoDS::Face(e.Current()))))
        colors_->SetColor(shapes_->AddSubShape(part, e.Current()), color, XCAFDoc_ColorSurf);
  }

  bool write(const std::string& path) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    Interface_Static::SetCVal("write.step.schema", "AP214IS");
    Interface_Static::SetIVal("write.surfacecurve.mode", 0);  // curves in space only: half the size
    Interface_Static::SetCVal("write.step.product.name", "dupin sample");
    if (!writer.Transfer(document_, STEPControl_AsIs)) return false;
    APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
    header.SetTimeStamp(new TCollection_HAsciiString("2026-01-01T00:00:00"));  // the same bytes every time
    const std::size_t slash = path.find_last_of('/');
    header.SetName(new TCollection_HAsciiString(path.substr(slash == path.npos ? 0 : slash + 1).c_str()));
    header.SetAuthorValue(1, new TCollection_HAsciiString("The Dupin authors"));
    header.SetOrganizationValue(1, new TCollection_HAsciiString("Dupin"));
    return writer.Write(path.c_str()) == IFSelect_RetDone;
  }

 private:
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
};

// ---- modelling
// -----------------------------------------------------------------------------------------------

TopoDS_Shape cylinder(const gp_Pnt& foot, const gp_Dir& axis, double radius, double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(foot, axis), radius, height).Shape();
}
TopoDS_Shape cone(const gp_Pnt& foot, const gp_Dir& axis, double r0, double r1, double height) {
  return BRepPrimAPI_MakeCone(gp_Ax2(foot, axis), r0, r1, height).Shape();
}
TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Cut(a, b).Shape();
}
TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Fuse(a, b).Shape();
}

TopoDS_Shape merged(const TopoDS_Shape& shape) {
  ShapeUpgrade_UnifySameDomain unify(shape, true, true, false);
  unify.Build();
  return unify.Shape();
}

TopoDS_Shape extruded(const std::vector<gp_Pnt>& polygon, const gp_Vec& by) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& p : polygon) wire.Add(p);
  wire.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), by).Shape();
}

// The edges whose middle point is chosen, each once.
std::vector<TopoDS_Edge> edges_where(
    const TopoDS_Shape& shape, const std::function<bool(const gp_Pnt&, const BRepAdaptor_Curve&)>& chosen) {
  std::vector<TopoDS_Edge> edges;
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, TopAbs_EDGE, all);
  for (int i = 1; i <= all.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(all(i));
    const BRepAdaptor_Curve curve(edge);
    if (chosen(curve.Value((curve.FirstParameter() + curve.LastParameter()) / 2), curve))
      edges.push_back(edge);
  }
  return edges;
}

TopoDS_Shape filleted(const TopoDS_Shape& shape, double radius,
                      const std::function<bool(const gp_Pnt&, const BRepAdaptor_Curve&)>& chosen) {
  BRepFilletAPI_MakeFillet fillet(shape);
  fillet.SetParams(1e-2, 1e-3, 1e-3, 5e-3, 5e-3, 1e-2);  // fewer poles than by default
  fillet.SetContinuity(GeomAbs_C1, 1e-2);
  for (const TopoDS_Edge& edge : edges_where(shape, chosen)) fillet.Add(radius, edge);
  return fillet.NbContours() > 0 ? fillet.Shape() : shape;
}

TopoDS_Shape chamfered(const TopoDS_Shape& shape, double size,
                       const std::function<bool(const gp_Pnt&, const BRepAdaptor_Curve&)>& chosen) {
  BRepFilletAPI_MakeChamfer chamfer(shape);
  for (const TopoDS_Edge& edge : edges_where(shape, chosen)) chamfer.Add(size, edge);
  return chamfer.NbContours() > 0 ? chamfer.Shape() : shape;
}

bool near(double a, double b) {
  return std::abs(a - b) < 1e-6;
}
bool is_circle(const BRepAdaptor_Curve& c, double radius) {
  return c.GetType() == GeomAbs_Circle && near(c.Circle().Radius(), radius);
}
bool is_bore(const BRepAdaptor_Surface& s, double radius) {
  return s.GetType() == GeomAbs_Cylinder && near(s.Cylinder().Radius(), radius);
}

gp_Trsf moved(double x, double y, double z) {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(x, y, z));
  return t;
}
gp_Trsf turned(const gp_Ax1& axis, double degrees) {
  gp_Trsf t;
  t.SetRotation(axis, degrees * kPi / 180);
  return t;
}

// ---- bracket.step: a machined bearing bracket
// ------------------------------------------------------------------

TopoDS_Shape bracket_blank() {
  constexpr double kWidth = 110, kDepth = 70, kBase = 14, kWall = 14, kAxis = 62, kBoss = 27;
  TopoDS_Shape base = BRepPrimAPI_MakeBox(gp_Pnt(-kWidth / 2, 0, 0), kWidth, kDepth, kBase).Shape();
  base = filleted(base, 12,
                  [&](const gp_Pnt& p, auto&) { return near(p.Z(), kBase / 2) && near(p.Y(), kDepth); });
  // The wall narrows tangentially from the base to the boss.
  const double half = kWidth / 2 - 14, angle = std::atan2(kAxis - kBase, half);
  const double reach = std::hypot(half, kAxis - kBase), lean = angle + std::asin(kBoss / reach);
  const double touch = std::sqrt(reach * reach - kBoss * kBoss);
  const double x = -half + touch * std::cos(lean), z = kBase + touch * std::sin(lean);
  TopoDS_Shape wall =
      extruded({gp_Pnt(-half, 0, kBase), gp_Pnt(half, 0, kBase), gp_Pnt(-x, 0, z), gp_Pnt(x, 0, z)},
               gp_Vec(0, kWall, 0));
  wall = fuse(wall, cylinder(gp_Pnt(0, 0, kAxis), gp_Dir(0, 1, 0), kBoss, kWall));
  TopoDS_Shape body = merged(fuse(base, wall));
  body = filleted(body, 7, [&](const gp_Pnt& p, auto&) { return near(p.Z(), kBase) && near(p.Y(), kWall); });
  const TopoDS_Shape boss = cylinder(gp_Pnt(0, 0, kAxis), gp_Dir(0, 1, 0), 22.5, 30);
  const TopoDS_Shape rib =
      extruded({gp_Pnt(-5, kWall - 1, kBase - 1), gp_Pnt(-5, 58, kBase - 1), gp_Pnt(-5, 58, kBase + 2),
                gp_Pnt(-5, 24, kAxis - 19), gp_Pnt(-5, kWall - 1, kAxis - 12)},
               gp_Vec(10, 0, 0));
  return merged(fuse(fuse(body, rib), boss));
}

TopoDS_Shape bracket() {
  constexpr double kBase = 14, kAxis = 62;
  const gp_Dir up(0, 0, 1), out(0, 1, 0);
  TopoDS_Shape part = bracket_blank();
  part = cut(part, cylinder(gp_Pnt(0, -1, kAxis), out, 12.5, 40));
  part = cut(part, cylinder(gp_Pnt(0, 21, kAxis), out, 16, 10));  // the bearing's seat
  for (const double x : {-38.0, 38.0}) {
    part = cut(part, cylinder(gp_Pnt(x, 54, -1), up, 4.5, 20));  // counterbored in front
    part = cut(part, cylinder(gp_Pnt(x, 54, kBase - 5), up, 8, 10));
    part = cut(part, cylinder(gp_Pnt(x, 27, -1), up, 3.3, 20));  // countersunk behind
    part = cut(part, cone(gp_Pnt(x, 27, kBase - 3.7), up, 3.3, 7.2, 3.9));
  }
  for (int i = 0; i < 4; ++i) {  // tapped holes around the seat
    const double a = kPi / 4 + i * kPi / 2;
    part = cut(part, cylinder(gp_Pnt(19.2 * std::cos(a), 20, kAxis + 19.2 * std::sin(a)), out, 1.25, 12));
  }
  part = chamfered(part, 1, [&](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return (is_circle(c, 12.5) && near(p.Y(), 0)) || (is_circle(c, 16) && near(p.Y(), 30));
  });
  part = filleted(part, 1.5, [&](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return (is_circle(c, 22.5) && near(p.Y(), 30)) ||
           (near(p.Z(), kBase) && p.Y() > 50 && !is_circle(c, 8) && std::abs(p.X()) > 6);
  });
  return BRepBuilderAPI_Transform(part, turned(gp_Ax1(gp_Pnt(0, 0, 0), up), 180), true)
      .Shape();  // its front to the front
}

bool write_bracket(const std::string& folder) {
  Document document;
  const TDF_Label part = document.part("bearing bracket", bracket(), kPaint);
  document.color_faces(part, kBrass,
                       [](const BRepAdaptor_Surface& s) { return is_bore(s, 12.5) || is_bore(s, 16); });
  document.color_faces(part, kSteel, [](const BRepAdaptor_Surface& s) {
    const bool machined_plane = s.GetType() == GeomAbs_Plane &&
                                (near(s.Plane().Location().Y(), -30) || near(s.Plane().Location().Y(), -21) ||
                                 near(s.Plane().Location().Z(), 9));
    return machined_plane || is_bore(s, 4.5) || is_bore(s, 8) || is_bore(s, 3.3) || is_bore(s, 1.25) ||
           s.GetType() == GeomAbs_Cone;
  });
  return document.write(folder + "/bracket.step");
}

// ---- assembly.step: a shaft coupling
// --------------------------------------------------------------------------

// A prism of six sides of width `across`, its corners turned off at 30° at the chosen ends.
TopoDS_Shape hexagon(double across, double height, bool chamfer_bottom, bool chamfer_top) {
  const double corner = across / std::sqrt(3.0);
  std::vector<gp_Pnt> points;
  for (int i = 0; i < 6; ++i)
    points.emplace_back(corner * std::cos(i * kPi / 3), corner * std::sin(i * kPi / 3), 0);
  TopoDS_Shape shape = extruded(points, gp_Vec(0, 0, height));
  const double rise = height + corner, flat = 0.475 * across, slope = std::tan(kPi / 6);
  const auto turning = [&](const gp_Pnt& end, const gp_Dir& away) {
    return cone(end, away, flat, flat + rise / slope, rise);
  };
  if (chamfer_top) shape = BRepAlgoAPI_Common(shape, turning(gp_Pnt(0, 0, height), gp_Dir(0, 0, -1))).Shape();
  if (chamfer_bottom) shape = BRepAlgoAPI_Common(shape, turning(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
  return shape;
}

TopoDS_Shape bolt(double length) {  // along -z from the head's seat at 0
  TopoDS_Shape shank = cylinder(gp_Pnt(0, 0, 0.5), gp_Dir(0, 0, -1), 4, length + 0.5);
  shank = chamfered(shank, 0.8, [&](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return c.GetType() == GeomAbs_Circle && near(p.Z(), -length);
  });
  return merged(fuse(hexagon(13, 5.3, false, true), shank));
}

TopoDS_Shape nut() {
  TopoDS_Shape shape =
      cut(hexagon(13, 6.5, true, true), cylinder(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1), 3.4, 10));
  return chamfered(shape, 0.6, [](const gp_Pnt&, const BRepAdaptor_Curve& c) { return is_circle(c, 3.4); });
}

TopoDS_Shape washer() {
  return cut(cylinder(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 8, 1.6),
             cylinder(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1), 4.2, 4));
}

TopoDS_Shape flange() {  // its mating face at z = 0, the hub upward
  const gp_Dir up(0, 0, 1);
  TopoDS_Shape disc = cylinder(gp_Pnt(0, 0, 0), up, 45, 12), hub = cylinder(gp_Pnt(0, 0, 11), up, 22, 25);
  TopoDS_Shape part = merged(fuse(disc, hub));
  part = filleted(part, 4, [](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return is_circle(c, 22) && near(p.Z(), 12);
  });
  part = cut(part, cylinder(gp_Pnt(0, 0, -1), up, 14, 40));
  part = cut(part, BRepPrimAPI_MakeBox(gp_Pnt(-4, 0, -1), 8, 17.3, 40).Shape());
  for (int i = 0; i < 6; ++i)
    part =
        cut(part, cylinder(gp_Pnt(34 * std::cos(i * kPi / 3), 34 * std::sin(i * kPi / 3), -1), up, 4.5, 20));
  return chamfered(part, 1.5, [](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return is_circle(c, 45) || (is_circle(c, 22) && p.Z() > 30);
  });
}

TopoDS_Shape shaft(double length) {  // from z = 0
  const gp_Dir up(0, 0, 1);
  TopoDS_Shape part =
      chamfered(cylinder(gp_Pnt(0, 0, 0), up, 14, length), 1.5,
                [](const gp_Pnt&, const BRepAdaptor_Curve& c) { return c.GetType() == GeomAbs_Circle; });
  const TopoDS_Shape ends = fuse(cylinder(gp_Pnt(0, 14, 6), gp_Dir(0, -1, 0), 4, 4),
                                 cylinder(gp_Pnt(0, 14, 32), gp_Dir(0, -1, 0), 4, 4));
  const TopoDS_Shape slot = BRepPrimAPI_MakeBox(gp_Pnt(-4, 10, 6), 8, 4, 26).Shape();
  return cut(part, merged(fuse(slot, ends)));
}

TopoDS_Shape key() {
  TopoDS_Shape part = BRepPrimAPI_MakeBox(gp_Pnt(-4, 10, 6), 8, 7, 26).Shape();
  part = fuse(part, fuse(cylinder(gp_Pnt(0, 10, 6), gp_Dir(0, 1, 0), 4, 7),
                         cylinder(gp_Pnt(0, 10, 32), gp_Dir(0, 1, 0), 4, 7)));
  return merged(part);
}

bool write_assembly(const std::string& folder) {
  Document d;
  const TDF_Label flange_part = d.part("flange", flange(), kPaint),
                  shaft_part = d.part("shaft", shaft(60), kSteel), key_part = d.part("key", key(), kBrass),
                  bolt_part = d.part("bolt M8", bolt(40), kDark), nut_part = d.part("nut M8", nut(), kDark),
                  washer_part = d.part("washer 8", washer(), kSteel);
  d.color_faces(flange_part, kSteel, [](const BRepAdaptor_Surface& s) {
    return is_bore(s, 14) || is_bore(s, 4.5) ||
           (s.GetType() == GeomAbs_Plane && near(s.Plane().Location().Z(), 0));
  });

  // A fastener clamps 24 mm of flanges, its middle at z = 0.
  const TDF_Label fastener = d.assembly("fastener");
  d.place(fastener, washer_part, moved(0, 0, 12), "washer below head");
  d.place(fastener, bolt_part, moved(0, 0, 13.6), "bolt");
  d.place(fastener, washer_part, moved(0, 0, -13.6), "washer below nut");
  d.place(fastener, nut_part, moved(0, 0, -20.1), "nut");

  const TDF_Label half = d.assembly("half coupling");  // above z = 0
  d.place(half, flange_part, gp_Trsf(), "flange");
  d.place(half, shaft_part, moved(0, 0, 1), "shaft");

  const TDF_Label coupling = d.assembly("shaft coupling");
  const gp_Trsf lying = turned(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)), 90);
  d.place(coupling, half, lying, "right half");
  const gp_Trsf other = lying * turned(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)), 180);
  d.place(coupling, half, other, "left half");
  d.place(coupling, key_part, lying * moved(0, 0, 1), "right key");
  d.color(d.place(coupling, key_part, other * moved(0, 0, 1), "left key"), kRed);
  for (int i = 0; i < 6; ++i) {
    const gp_Trsf around = turned(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 60.0 * i);
    d.place(coupling, fastener, lying * around * moved(34, 0, 0),
            ("fastener " + std::to_string(i + 1)).c_str());
  }
  return d.write(folder + "/assembly.step");
}

// ---- freeform.step: a sculpted cover
// ---------------------------------------------------------------------------

Handle(Geom_BSplineCurve) outline() {
  constexpr int kPoints = 8;
  Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double a = 2 * kPi * i / kPoints, wide = 1 + 0.16 * std::cos(a);
    points->SetValue(i + 1,
                     gp_Pnt(70 * std::cos(a) * (1 - 0.05 * std::cos(2 * a)), 46 * wide * std::sin(a), 0));
  }
  GeomAPI_Interpolate interpolation(points, true, 1e-6);
  interpolation.Perform();
  return interpolation.Curve();
}

// A bicubic height field over [-90,90] x [-75,75], curved both ways, with a saddle behind and a bulge in
// front.
Handle(Geom_BSplineSurface) skin() {
  constexpr int kU = 5, kV = 5;
  TColgp_Array2OfPnt poles(1, kU, 1, kV);
  for (int i = 0; i < kU; ++i)
    for (int j = 0; j < kV; ++j) {
      const double x = -90 + 180.0 * i / (kU - 1), y = -75 + 150.0 * j / (kV - 1), s = x / 90, t = y / 75;
      const double z =
          26 + 26 * std::exp(-4 * ((s - 0.3) * (s - 0.3) + t * t)) - 12 * s * s + 18 * s * t * t - 6 * t * t;
      poles.SetValue(i + 1, j + 1, gp_Pnt(x, y, z));
    }
  const auto knots = [](int poles_count, TColStd_Array1OfReal& k, TColStd_Array1OfInteger& m) {
    for (int i = 1; i <= poles_count - 2; ++i) k.SetValue(i, i - 1), m.SetValue(i, 1);
    m.SetValue(1, 4), m.SetValue(poles_count - 2, 4);
  };
  TColStd_Array1OfReal ku(1, kU - 2), kv(1, kV - 2);
  TColStd_Array1OfInteger mu(1, kU - 2), mv(1, kV - 2);
  knots(kU, ku, mu), knots(kV, kv, mv);
  return new Geom_BSplineSurface(poles, ku, kv, mu, mv, 3, 3);
}

TopoDS_Shape cover() {
  const gp_Dir up(0, 0, 1);
  const TopoDS_Face foot =
      BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 0), up),
                              BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(outline()).Edge()).Wire())
          .Face();
  TopoDS_Shape body = BRepPrimAPI_MakePrism(foot, gp_Vec(0, 0, 70)).Shape();
  const TopoDS_Shape above =
      BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(skin(), 1e-6).Face(), gp_Vec(0, 0, 90)).Shape();
  body = cut(body, above);
  body = filleted(body, 7, [](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return c.GetType() == GeomAbs_BSplineCurve && p.Z() > 5;
  });
  const TopoDS_Edge eye = BRepBuilderAPI_MakeEdge(gp_Elips(gp_Ax2(gp_Pnt(26, 0, -1), up), 20, 13)).Edge();
  body = cut(body, BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(eye).Wire()).Face(),
                                         gp_Vec(0, 0, 90))
                       .Shape());
  for (int i = 0; i < 3; ++i) {
    const gp_Dir lean(-0.15 - 0.1 * i, 0.25 * (i - 1), 1);
    body = cut(body, cylinder(gp_Pnt(-24 - 6.0 * (i % 2), 17.0 * (i - 1), -10), lean, 5, 90));
  }
  return filleted(body, 1.2, [](const gp_Pnt& p, const BRepAdaptor_Curve& c) {
    return c.GetType() == GeomAbs_BSplineCurve && p.Z() > 20 && std::abs(p.X()) < 47 && std::abs(p.Y()) < 29;
  });
}

bool write_freeform(const std::string& folder) {
  Document document;
  const TDF_Label part = document.part("sculpted cover", cover(), kIvory);
  document.color_faces(part, kGreen, [](const BRepAdaptor_Surface& s) {
    return is_bore(s, 5) || s.GetType() == GeomAbs_SurfaceOfExtrusion;
  });
  return document.write(folder + "/freeform.step");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: make_samples FOLDER\n"), 2;
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const std::string folder = argv[1];
  const bool written = write_bracket(folder) && write_assembly(folder) && write_freeform(folder);
  if (!written) std::fprintf(stderr, "make_samples: a sample could not be made\n");
  return written ? 0 : 1;
}
