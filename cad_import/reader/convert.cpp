#include "convert.h"

#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>

#include <algorithm>
#include <map>

#include "geometry.h"
#include "part_builder.h"

namespace dupin::reader {
namespace {

/// A piece and where it stands in its item.
struct Piece {
  TopoDS_Shape shape;  ///< without location
  TopLoc_Location location;
  bool loose = false;  ///< no solid: the faces outside of solids
};

// Solids anywhere below, each on its own; shells and faces outside of solids together.
std::vector<Piece> pieces_of(const TopoDS_Shape& shape) {
  std::vector<Piece> pieces;
  for (TopExp_Explorer e(shape, TopAbs_SOLID); e.More(); e.Next())
    pieces.push_back({e.Current().Located(TopLoc_Location()), e.Current().Location(), false});
  const TopExp_Explorer loose(shape, TopAbs_FACE, TopAbs_SOLID);
  if (loose.More()) pieces.push_back({shape.Located(TopLoc_Location()), shape.Location(), true});
  return pieces;
}

bool same_look(const PartSource& a, const PartSource& b) {
  if (a.name != b.name || a.color != b.color || a.faces.size() != b.faces.size()) return false;
  for (std::size_t i = 0; i < a.faces.size(); ++i)
    if (a.faces[i].color != b.faces[i].color || a.faces[i].name != b.faces[i].name) return false;
  return true;
}

class Conversion {
 public:
  Conversion(const SourceDocument& document, const MeshOptions& mesh, const Stage& stage)
      : document_(document), mesh_(mesh), stage_(stage) {}

  Model run() {
    model_.format = document_.format;
    model_.unit_note = document_.unit_note;
    model_.notes = document_.notes;
    model_.skipped = document_.skipped;
    find_lone_faces();
    for (std::size_t i = 0; i < document_.items.size(); ++i) {
      stage_("converting", static_cast<double>(i) / static_cast<double>(document_.items.size()));
      if (!lone_[i]) add_item(document_.items[i]);
    }
    add_lone_faces();
    finish_skipped();
    if (free_curves_ > 0)
      model_.notes.push_back(std::to_string(free_curves_) + " curves that bound no face are not drawn");
    if (mesh_.deflection > 0) add_meshes();
    return std::move(model_);
  }

 private:
  struct Known {
    PartSource source;
    std::size_t built = 0;
  };
  struct Built {
    std::optional<std::uint32_t> part;  ///< none if none of its faces could be had
    std::vector<TopoDS_Face> faces;
    std::vector<SkippedFace> skipped;
    std::uint32_t instances = 0;
  };

  void add_item(const SourceItem& item) {
    for (TopExp_Explorer e(item.shape, TopAbs_EDGE, TopAbs_FACE); e.More(); e.Next()) ++free_curves_;
    for (const Piece& piece : pieces_of(item.shape))
      add_instance(built_of(item, piece), item.placement * to_affine(piece.location.Transformation()), item);
  }

  void add_instance(std::size_t built, const Affine3& to_world, const SourceItem& item) {
    ++built_[built].instances;
    if (!built_[built].part) return;
    Instance instance;
    instance.part = *built_[built].part;
    instance.to_world = to_world;
    instance.color = item.instance_color;
    instance.name = item.path;
    model_.instances.push_back(std::move(instance));
  }

  std::size_t built_of(const SourceItem& item, const Piece& piece) {
    PartSource source = describe(item, piece);
    auto& known =
        known_[{piece.shape.TShape().get(), static_cast<int>(piece.shape.Orientation()), piece.loose}];
    for (const Known& k : known)
      if (same_look(k.source, source)) return k.built;
    const std::size_t index = build(source);
    known.push_back({std::move(source), index});
    return index;
  }

  std::size_t build(const PartSource& source) {
    BuiltPart made = build_part(source);
    Built built;
    if (!made.part.faces.empty()) built.part = static_cast<std::uint32_t>(model_.parts.size());
    const std::string name =
        source.name.empty() ? "part " + std::to_string(model_.parts.size() + 1) : source.name;
    for (const std::string& n : made.notes) model_.notes.push_back(name + ": " + n);
    if (built.part) model_.parts.push_back(std::move(made.part));
    built.faces = std::move(made.shapes);
    built.skipped = std::move(made.skipped);
    built_.push_back(std::move(built));
    return built_.size() - 1;
  }

  // Files without topology, IGES above all, list each face as a shape of its own: thousands of parts of one
  // face, which are one part to everything that comes after.
  void find_lone_faces() {
    std::map<const void*, int> uses;
    for (const SourceItem& item : document_.items) ++uses[item.shape.TShape().get()];
    std::size_t count = 0;
    for (const SourceItem& item : document_.items) {
      TopExp_Explorer face(item.shape, TopAbs_FACE);
      bool lone = face.More() && uses[item.shape.TShape().get()] == 1 &&
                  item.placement == document_.items[0].placement;
      if (lone) face.Next(), lone = !face.More() && !TopExp_Explorer(item.shape, TopAbs_SOLID).More();
      lone_.push_back(lone);
      count += lone;
    }
    if (count < 2) std::fill(lone_.begin(), lone_.end(), false);
  }

  void add_lone_faces() {
    PartSource source;
    source.name = "faces";
    SourceItem all;
    for (std::size_t i = 0; i < lone_.size(); ++i) {
      if (!lone_[i]) continue;
      const SourceItem& item = document_.items[i];
      FaceSource face = describe(item, {item.shape, TopLoc_Location(), true}).faces.at(0);
      if (!face.color) face.color = style(item, item.shape);
      if (item.instance_color) face.color = item.instance_color;
      if (!face.color) face.color = item.part_color;
      if (face.name.empty()) face.name = item.part_name;
      source.faces.push_back(std::move(face));
      all.placement = item.placement;
    }
    if (!source.faces.empty()) add_instance(build(source), all.placement, all);
  }

  static PartSource describe(const SourceItem& item, const Piece& piece) {
    PartSource source;
    source.name = item.part_name;
    source.color = item.part_color;
    if (const auto color = style(item, piece.shape.Located(piece.location))) source.color = color;
    TopExp_Explorer faces = piece.loose ? TopExp_Explorer(piece.shape, TopAbs_FACE, TopAbs_SOLID)
                                        : TopExp_Explorer(piece.shape, TopAbs_FACE);
    for (; faces.More(); faces.Next()) {
      FaceSource face;
      face.face = TopoDS::Face(faces.Current());
      const TopoDS_Shape in_item = face.face.Moved(piece.location);
      face.color = style(item, in_item);
      if (item.styles)
        if (const std::string* name = item.styles->names.Seek(in_item)) face.name = *name;
      source.faces.push_back(std::move(face));
    }
    return source;
  }

  static std::optional<Color> style(const SourceItem& item, const TopoDS_Shape& shape) {
    if (!item.styles) return std::nullopt;
    const Color* color = item.styles->colors.Seek(shape);
    return color ? std::optional(*color) : std::nullopt;
  }

  // A part's skipped faces are missing from each of its instances.
  void finish_skipped() {
    for (const Built& built : built_)
      for (SkippedFace skipped : built.skipped) {
        skipped.count = built.instances;
        model_.skipped.push_back(std::move(skipped));
      }
  }

  void add_meshes() {
    stage_("tessellating", 0);
    std::vector<TopoDS_Face> faces;
    for (const Built& built : built_) faces.insert(faces.end(), built.faces.begin(), built.faces.end());
    const double deflection = mesh_.deflection * bounding_box(model_).diagonal();
    if (!(deflection > 0)) return;
    model_.mesh_seconds = mesh_faces(faces, deflection, mesh_.angle_radians);
    for (const Built& built : built_)
      if (built.part) take_mesh(built.faces, model_.parts[*built.part]);
  }

  const SourceDocument& document_;
  const MeshOptions& mesh_;
  const Stage& stage_;
  Model model_;
  int free_curves_ = 0;
  std::vector<Built> built_;
  std::vector<bool> lone_;
  std::map<std::tuple<const void*, int, bool>, std::vector<Known>> known_;
};

}  // namespace

Model convert(const SourceDocument& document, const MeshOptions& mesh, const Stage& stage) {
  return Conversion(document, mesh, stage).run();
}

}  // namespace dupin::reader
