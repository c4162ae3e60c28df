#include "xde_document.h"

#include <Quantity_ColorRGBA.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GraphNode.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <map>
#include <set>

#include "geometry.h"

namespace dupin::reader {
namespace {

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  std::string text(name->Get().LengthOfCString() + 1, '\0');
  Standard_PCharacter to = text.data();
  name->Get().ToUTF8CString(to);
  text.resize(name->Get().LengthOfCString());
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == '/') c = c == '/' ? '|' : ' ';
  return text;
}

// Names that a file's writer or OCCT made up say nothing.
bool says_nothing(const std::string& name) {
  static const std::set<std::string> kKinds{"",     "SOLID",     "SHELL",    "COMPOUND",
                                            "FACE", "COMPSOLID", "ASSEMBLY", "SHAPE"};
  const bool number = name.find_first_not_of("0123456789") == std::string::npos;
  return kKinds.contains(name) || number || name.starts_with("NAUO") || name.starts_with("=>[") ||
         name.starts_with("Open CASCADE STEP translator");
}

class Walk {
 public:
  Walk(const Handle(TDocStd_Document) & document, SourceDocument& out)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        out_(out) {}

  void run() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (int i = 1; i <= roots.Length(); ++i) {
      const TDF_Label& root = roots.Value(i);
      Place place;
      place.path = name_of(root);
      visit(root, place, 0);
    }
  }

 private:
  struct Place {
    Affine3 to_world;
    std::string path, component_name;
    std::optional<Color> override_color, inherited_color;
    std::vector<TDF_Label> components;  ///< from the root down to here
  };
  static constexpr int kMaxDepth = 200;  // an assembly that contains itself

  void visit(const TDF_Label& label, const Place& place, int depth) {
    if (depth > kMaxDepth) return;
    if (XCAFDoc_ShapeTool::IsAssembly(label)) return visit_components(label, place, depth);
    SourceItem item;
    item.shape = XCAFDoc_ShapeTool::GetShape(label);
    if (item.shape.IsNull()) return;
    item.placement = place.to_world;
    item.path = place.path;
    item.part_name = name_of(label);
    if (says_nothing(item.part_name))
      item.part_name = says_nothing(place.component_name) ? "" : place.component_name;
    item.part_color = color_of(label);
    item.instance_color = place.override_color;
    if (const auto color = color_in_context(place.components)) item.instance_color = color;
    if (!item.instance_color && !item.part_color) item.instance_color = place.inherited_color;
    item.styles = styles_of(label);
    out_.items.push_back(std::move(item));
  }

  void visit_components(const TDF_Label& label, const Place& place, int depth) {
    const std::optional<Color> own = color_of(label);
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(label, components);
    for (int i = 1; i <= components.Length(); ++i) {
      const TDF_Label& component = components.Value(i);
      TDF_Label referred;
      if (!XCAFDoc_ShapeTool::GetReferredShape(component, referred)) continue;
      Place below = place;
      below.to_world = place.to_world * to_affine(XCAFDoc_ShapeTool::GetLocation(component).Transformation());
      const std::string instance = name_of(component), product = name_of(referred);
      below.component_name = instance;
      below.components.push_back(component);
      const std::string& name = says_nothing(instance) ? product : instance;
      if (!name.empty()) below.path = place.path.empty() ? name : place.path + "/" + name;
      if (own) below.inherited_color = own;
      if (const auto color = color_of(component)) below.override_color = color;
      visit(referred, below, depth + 1);
    }
  }

  // A colour that holds for a part only where it is used along this path, or along a lower part of it.
  std::optional<Color> color_in_context(const std::vector<TDF_Label>& components) const {
    for (std::size_t first = 0; first + 1 < components.size(); ++first) {
      TDF_LabelSequence path;
      for (std::size_t i = first; i < components.size(); ++i) path.Append(components[i]);
      Handle(XCAFDoc_GraphNode) usage;
      if (XCAFDoc_ShapeTool::FindSHUO(path, usage) && !usage.IsNull())
        if (const auto color = color_of(usage->Label())) return color;
    }
    return std::nullopt;
  }

  std::shared_ptr<const ShapeStyles> styles_of(const TDF_Label& label) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(label, entry);
    auto& known = styles_[entry.ToCString()];
    if (known) return known;
    auto styles = std::make_shared<ShapeStyles>();
    TDF_LabelSequence subshapes;
    XCAFDoc_ShapeTool::GetSubShapes(label, subshapes);
    for (int i = 1; i <= subshapes.Length(); ++i) {
      const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(subshapes.Value(i));
      if (shape.IsNull()) continue;
      if (const auto color = color_of(subshapes.Value(i))) styles->colors.Bind(shape, *color);
      if (const std::string name = name_of(subshapes.Value(i)); !says_nothing(name))
        styles->names.Bind(shape, name);
    }
    return known = styles;
  }

  std::optional<Color> color_of(const TDF_Label& label) const {
    // The surface's colour before the general one.
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
      Quantity_ColorRGBA color;
      if (!colors_->GetColor(label, type, color)) continue;
      const Quantity_Color& rgb = color.GetRGB();  // linear
      return Color{static_cast<float>(rgb.Red()), static_cast<float>(rgb.Green()),
                   static_cast<float>(rgb.Blue()), color.Alpha()};
    }
    return std::nullopt;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  SourceDocument& out_;
  std::map<std::string, std::shared_ptr<const ShapeStyles>> styles_;
};

}  // namespace

Handle(TDocStd_Document) new_xde_document() {
  // Without an application: nothing here is stored or undone.
  Handle(TDocStd_Document) document = new TDocStd_Document("XmlXCAF");
  XCAFDoc_DocumentTool::Set(document->Main(), false);
  return document;
}

void add_items(const Handle(TDocStd_Document) & document, SourceDocument& out) {
  Walk(document, out).run();
}

}  // namespace dupin::reader
