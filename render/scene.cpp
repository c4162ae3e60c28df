#include "scene.h"

#include <limits>

#include "../core/parallel.h"
#include "../nurbs/mesh_triangles.h"
#include "layer.h"
#include "renderer_impl.h"

namespace dupin {
namespace {

constexpr Color kDefaultColor{0.55F, 0.57F, 0.60F, 1};

std::size_t piece_count(const QuadricDp& dp) {
  return std::size_t{dp.planes} + dp.lines + dp.arcs + dp.ellipses;
}

/// Numbers the faces that are drawn, in the part's order; the others get none.
void number_faces(const std::vector<bool>& drawn, ScenePart& part) {
  part.face_numbers.assign(drawn.size(), 0);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (drawn[i]) part.face_numbers[i] = part.drawn_faces++;
}

Status pack_dps(const PartDps& dps, ScenePart& part, SceneInfo& info, ScenePackage& package) {
  part.dps.resize(dps.dps.size());
  parallel_for(
      dps.dps.size(), [&](std::size_t i) { part.dps[i] = dp_bounds(dps, dps.dps[i], part.anchor); }, 16);
  for (DpBounds& bounds : part.dps) {
    const QuadricDp& dp = bounds.dp;
    bounds.record = static_cast<std::uint32_t>(package.heap.size());
    const Status status = encode_dp(dps, dp, part.anchor, part.face_numbers[dp.face], package.heap);
    if (!status.ok()) return status;
    info.clips += piece_count(dp);
    for (const Vec3& c : prism_corners(dp)) part.box.add(dp.origin + dp.u * c.x + dp.v * c.y + dp.n() * c.z);
  }
  part.primitives += static_cast<std::uint32_t>(dps.dps.size());
  return {};
}

/// `first_face`: the index in the part of the mesh's first face.
void pack_mesh(const TriangleMesh& mesh, std::size_t first_face, ScenePart& part, ScenePackage& package) {
  if (part.triangles == 0) part.first_triangle = static_cast<std::uint32_t>(package.indices.size() / 3);
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size() / 3);
  const auto first_vertex = static_cast<std::uint32_t>(package.vertices.size() / 6);
  const Vec3 shift = mesh.origin - part.anchor;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto& p = mesh.positions[i];
    const auto& n = mesh.normals[i];
    const Vec3 q = shift + Vec3{p[0], p[1], p[2]};
    package.vertices.insert(package.vertices.end(), {static_cast<float>(q.x), static_cast<float>(q.y),
                                                     static_cast<float>(q.z), n[0], n[1], n[2]});
    part.box.add(mesh.origin + Vec3{p[0], p[1], p[2]});
  }
  for (const std::uint32_t i : mesh.triangles) package.indices.push_back(first_vertex + i);
  for (const std::uint32_t f : mesh.faces)
    package.triangle_faces.push_back(part.face_numbers[first_face + f]);
  part.triangles += triangles;
  part.primitives += triangles;
}

/// What there is of one part.
struct PartContent {
  const PartDps* dps = nullptr;       ///< not empty
  std::vector<std::uint32_t> unseen;  ///< faces that are drawn with nothing to see
  const TriangleMesh* mesh = nullptr;
  const PolygonMesh* polygons = nullptr;  ///< drawn as triangles
  std::vector<LayerPart> layers;
};

PartContent content_of(const Model& model, std::size_t index, const DpScene* dps, const Scene::Impl& scene) {
  const Part& source = model.parts[index];
  PartContent content;
  bool by_layers = false;
  for (const auto& layer : scene.layers) {
    content.layers.push_back(layer->part(index));
    by_layers |= !content.layers.back().box.empty();
  }
  const bool by_dps = dps && !source.faces.empty();
  if (by_dps && !dps->parts[index].dps.empty()) content.dps = &dps->parts[index];
  if (by_dps) content.unseen = dps->parts[index].out_of_picture;
  if (!by_dps && !by_layers && !source.mesh.triangles.empty()) content.mesh = &source.mesh;
  if (!by_layers && source.polygons.polygon_count() > 0) content.polygons = &source.polygons;
  return content;
}

/// Which faces of the part are drawn, with something to see of them or not, so that their numbers do not
/// depend on the camera; the groups of its polygons come after its exact ones. What is drawn of a part
/// without faces is one face.
Status mark_faces(const Part& source, const PartContent& content, std::vector<bool>& drawn) {
  bool valid = true;
  const auto mark = [&](std::uint32_t face) {
    valid &= face < drawn.size();
    if (face < drawn.size()) drawn[face] = true;
  };
  drawn.assign(std::max<std::size_t>(1, face_count(source)), false);
  for (const std::uint32_t face : content.unseen) mark(face);
  if (content.dps)
    for (const QuadricDp& dp : content.dps->dps) mark(dp.face);
  if (content.mesh)
    for (const std::uint32_t face : content.mesh->faces) mark(face);
  for (std::size_t i = 0; content.polygons && i < content.polygons->polygon_count(); ++i)
    mark(static_cast<std::uint32_t>(source.faces.size() + content.polygons->group_of(i)));
  for (const LayerPart& layer : content.layers)
    for (const std::uint32_t face : layer.faces) mark(face);
  if (!valid) return {StatusCode::invalid_argument, "a primitive names a face that its part lacks"};
  return {};
}

/// The layers' own wish counts where nothing else is drawn (pack_layers).
Vec3 anchor_of(const Part& source, const PartContent& content) {
  if (!source.box.empty()) return source.box.center();
  return content.dps ? content.dps->dps.front().origin : content.mesh ? content.mesh->origin : Vec3{};
}

void pack_layers(const PartContent& content, ScenePart& part) {
  for (const LayerPart& layer : content.layers) {
    part.first_in_layer.push_back(part.primitives);
    if (layer.box.empty()) continue;
    if (part.primitives == 0) part.anchor = layer.anchor;
    part.primitives += layer.primitives;
    part.layer_box.add(layer.box);
  }
  part.box.add(part.layer_box);
}

/// What the file says of the face itself.
std::optional<Color> own_color(const Part& part, std::size_t face) {
  if (face < part.faces.size()) return part.faces[face].color;
  const std::vector<MeshGroup>& groups = part.polygons.groups;
  const std::size_t group = face - part.faces.size();
  return group < groups.size() ? groups[group].color : std::nullopt;
}

void place(const Model& model, const Instance& instance, const std::vector<std::vector<bool>>& drawn,
           Scene::Impl& scene) {
  const Part& source = model.parts[instance.part];
  const ScenePart& part = scene.parts[instance.part];
  SceneInstance placed;
  placed.part = instance.part;
  place(instance.to_world, placed);
  placed.first_face = static_cast<std::uint32_t>(scene.faces.size());
  placed.first_primitive = static_cast<std::uint32_t>(scene.info.placed_primitives);
  const Color own = instance.color ? *instance.color : source.color ? *source.color : kDefaultColor;
  FaceColors& colors = placed.file_colors;
  colors.whole = srgb_word(own);
  const auto index = static_cast<std::uint32_t>(scene.instances.size());
  const std::vector<bool>& faces = drawn[instance.part];
  bool own_colors = false;
  for (std::size_t f = 0; f < faces.size(); ++f) own_colors = own_colors || own_color(source, f);
  for (std::size_t f = 0; own_colors && f < faces.size(); ++f) {
    const std::optional<Color> color = own_color(source, f);
    colors.faces.push_back(color ? srgb_word(*color) : colors.whole);
  }
  placed.colors = colors;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f]) scene.faces.push_back({index, static_cast<std::uint32_t>(f)});
  scene.info.placed_primitives += part.primitives;
  scene.box.add(transform_box(instance.to_world, part.box));
  scene.instances.push_back(std::move(placed));
}

}  // namespace

Status pack_scene(const Model& model, const DpScene* dps, Scene::Impl& scene, ScenePackage& package) {
  if (dps && dps->parts.size() != model.parts.size())
    return {StatusCode::invalid_argument,
            "the primitives are not those of this model: the numbers of parts differ"};
  std::vector<std::vector<bool>> drawn(model.parts.size());
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    const Part& source = model.parts[i];
    const PartContent content = content_of(model, i, dps, scene);
    Status status = mark_faces(source, content, drawn[i]);
    if (!status.ok()) return status;
    ScenePart part;
    part.closed = source.closed;
    part.anchor = anchor_of(source, content);
    number_faces(drawn[i], part);
    if (content.dps) status = pack_dps(*content.dps, part, scene.info, package);
    if (!status.ok()) return status;
    if (content.mesh) pack_mesh(*content.mesh, 0, part, package);
    if (content.polygons)
      pack_mesh(to_triangle_mesh(*content.polygons, part.anchor), source.faces.size(), part, package);
    pack_layers(content, part);
    scene.info.primitives += part.primitives;
    scene.parts.push_back(std::move(part));
  }
  for (const Instance& instance : model.instances) place(model, instance, drawn, scene);
  scene.info.drawn_faces = scene.faces.size();
  scene.info.bytes = package.heap.size() * sizeof(Texel) + package.vertices.size() * 4 +
                     package.indices.size() * 4 + package.triangle_faces.size() * 4;
  for (const auto& layer : scene.layers) scene.info.bytes += layer->bytes();
  return {};
}

}  // namespace dupin
