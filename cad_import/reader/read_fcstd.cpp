#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>

#include <set>
#include <unordered_map>

#include "brep_content.h"
#include "fcstd_document.h"
#include "read_files.h"
#include "zip_archive.h"

namespace dupin::reader {
namespace {

// What FreeCAD shows of a document: visible objects, in visible containers, a body rather than its features.
class Reading {
 public:
  Reading(ZipArchive& archive, const FcDocument& document, const Stage& stage)
      : archive_(archive), document_(document), stage_(stage) {
    for (std::size_t i = 0; i < document_.objects.size(); ++i) index_.emplace(document_.objects[i].name, i);
    for (std::size_t i = 0; i < document_.objects.size(); ++i)
      if (places_its_group(document_.objects[i]))
        for (const std::string& child : document_.objects[i].group)
          if (const auto at = index_.find(child); at != index_.end()) parent_.emplace(at->second, i);
    for (const FcObject& object : document_.objects)
      for (const std::string& input : object.inputs)
        if (!object.shape_file.empty()) used_.insert(input);
  }

  SourceDocument run() {
    out_.format = "FCStd";
    out_.unit_note = "mm";
    int hidden = 0;
    for (std::size_t i = 0; i < document_.objects.size(); ++i) {
      stage_("reading", static_cast<double>(i) / static_cast<double>(document_.objects.size()));
      const FcObject& object = document_.objects[i];
      const bool shape = !object.shape_file.empty(), link = !object.linked.empty();
      if ((!shape && !link) || is_construction(object) || is_feature_of_body(i)) continue;
      if (!shown(i)) {
        ++hidden;
        continue;
      }
      if (link)
        add_link(i);
      else
        add_shape(object, container_placement(i), object, true);
    }
    if (hidden > 0)
      out_.notes.push_back(std::to_string(hidden) + " hidden objects of the document are left out");
    if (!document_.has_view)
      out_.notes.push_back(
          "the document says nothing about colours and what is shown; shown is what nothing else uses");
    return std::move(out_);
  }

 private:
  static constexpr int kMaxDepth = 100;

  static bool is_body(const FcObject& o) { return o.type == "PartDesign::Body"; }
  // App::Part and its kin; a plain group only lists its members.
  static bool places_its_group(const FcObject& o) {
    return o.has_placement && !o.group.empty() && o.linked.empty();
  }
  static bool is_construction(const FcObject& o) {
    static const std::set<std::string> kTypes{
        "PartDesign::Plane", "PartDesign::Line", "PartDesign::Point",       "PartDesign::CoordinateSystem",
        "App::Plane",        "App::Line",        "PartDesign::ShapeBinder", "PartDesign::SubShapeBinder"};
    return kTypes.contains(o.type) || o.type.starts_with("Sketcher::");
  }

  bool is_feature_of_body(std::size_t i) const {
    const auto parent = parent_.find(i);
    return parent != parent_.end() && is_body(document_.objects[parent->second]);
  }

  bool shown(std::size_t i) const {
    const FcObject& object = document_.objects[i];
    if (!document_.has_view && !object.visible) return !used_.contains(object.name);
    int depth = 0;
    for (auto at = std::optional(i); at && depth < kMaxDepth; ++depth) {
      if (!document_.objects[*at].visible.value_or(true)) return false;
      const auto parent = parent_.find(*at);
      at = parent == parent_.end() ? std::nullopt : std::optional(parent->second);
    }
    return true;
  }

  Affine3 container_placement(std::size_t i) const {
    Affine3 placement;
    int depth = 0;
    for (auto parent = parent_.find(i); parent != parent_.end() && depth < kMaxDepth;
         parent = parent_.find(parent->second), ++depth)
      placement = document_.objects[parent->second].placement * placement;
    return placement;
  }

  void add_link(std::size_t i) {
    const FcObject& link = document_.objects[i];
    const auto target = index_.find(link.linked);
    if (link.link_to_other_file || link.link_elements > 0 || target == index_.end() ||
        document_.objects[target->second].shape_file.empty()) {
      out_.skipped.push_back(
          {name_of(link), "a link to another file, an array of links or a link to a container", 1});
      return;
    }
    const Vec3 s = link.link_scale;
    Affine3 placement = link.placement;
    placement.linear = {placement.linear.x * s.x, placement.linear.y * s.y, placement.linear.z * s.z};
    add_shape(document_.objects[target->second], container_placement(i) * placement, link,
              link.link_keeps_placement);
  }

  // The object's own placement is where its shape is; the file may or may not hold it in the shape too.
  void add_shape(const FcObject& object, Affine3 placement, const FcObject& shown_as, bool own_placement) {
    std::optional<TopoDS_Shape> shape = load(object);
    if (!shape) {
      out_.skipped.push_back({name_of(shown_as), "its shape in the file is damaged or missing", 1});
      return;
    }
    if (shape->IsNull() || !TopExp_Explorer(*shape, TopAbs_FACE).More()) return;
    if (object.has_placement) shape->Location(TopLoc_Location());
    if (object.has_placement && own_placement) placement = placement * object.placement;
    SourceItem item;
    item.shape = *shape;
    item.placement = placement;
    item.part_name = item.path = name_of(shown_as);
    set_colors(object, item);
    out_.items.push_back(std::move(item));
  }

  void set_colors(const FcObject& object, SourceItem& item) {
    const float alpha = static_cast<float>(1 - object.transparency);
    item.part_color = object.color;
    if (item.part_color) item.part_color->a = alpha;
    if (object.face_colors_file.empty()) return;
    const std::optional<std::string> bytes = archive_.read(object.face_colors_file);
    if (!bytes) return;
    std::vector<Color> colors = parse_colors(*bytes);
    for (Color& color : colors) color.a = alpha;
    TopTools_IndexedMapOfShape faces;  // FreeCAD's Face1, Face2, …
    TopExp::MapShapes(item.shape, TopAbs_FACE, faces);
    if (colors.size() == 1) item.part_color = colors[0];
    if (static_cast<int>(colors.size()) != faces.Extent() || colors.size() < 2) return;
    auto styles = std::make_shared<ShapeStyles>();
    for (int i = 1; i <= faces.Extent(); ++i) styles->colors.Bind(faces(i), colors[i - 1]);
    item.styles = styles;
  }

  // A null shape where the object's is empty, none where it cannot be had.
  std::optional<TopoDS_Shape> load(const FcObject& object) {
    if (const auto known = shapes_.find(object.shape_file); known != shapes_.end()) return known->second;
    const std::optional<std::string> bytes = archive_.read(object.shape_file);
    if (!bytes) return std::nullopt;
    TopoDS_Shape shape;
    if (!bytes->empty()) {
      shape = read_brep_content(*bytes);
      if (shape.IsNull()) return std::nullopt;
    }
    shapes_.emplace(object.shape_file, shape);
    return shape;
  }

  static std::string name_of(const FcObject& object) {
    return object.label.empty() ? object.name : object.label;
  }

  ZipArchive& archive_;
  const FcDocument& document_;
  const Stage& stage_;
  std::unordered_map<std::string, std::size_t> index_;
  std::unordered_map<std::size_t, std::size_t> parent_;
  std::set<std::string> used_;
  std::unordered_map<std::string, TopoDS_Shape> shapes_;
  SourceDocument out_;
};

}  // namespace

Result<SourceDocument> read_fcstd(const std::string& path, const Stage& stage) {
  stage("reading", 0);
  const std::unique_ptr<ZipArchive> archive = ZipArchive::open(path);
  if (!archive) return {StatusCode::unreadable, "the file is a damaged zip archive"};
  const std::optional<std::string> document = archive->read("Document.xml");
  if (!document)
    return {StatusCode::unreadable, "a zip archive, but no FCStd file: it has no readable Document.xml"};
  const Result<FcDocument> parsed = parse_fcstd(*document, archive->read("GuiDocument.xml").value_or(""));
  if (!parsed.ok()) return parsed.status();
  return Reading(*archive, *parsed, stage).run();
}

}  // namespace dupin::reader
