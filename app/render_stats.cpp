#include "render_stats.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "limits.h"

namespace dupin::app {
namespace {

using Json = nlohmann::ordered_json;

/// A face of a part that is skipped is so in every instance; the instance's place in the assembly tells them
/// apart.
std::string placed_name(const Instance& instance, const std::string& face) {
  return instance.name.empty() ? face : instance.name + ": " + face;
}

std::string face_name(const Part& part, std::size_t face) {
  if (!part.faces[face].name.empty()) return part.faces[face].name;
  return "face " + std::to_string(face + 1) + (part.name.empty() ? "" : " of " + part.name);
}

Json to_json(const std::optional<CertifiedError>& error) {
  if (!error) return {{"bound", nullptr}, {"bound_px", nullptr}, {"normal_bound_degrees", nullptr}};
  return {{"bound", error->bound},
          {"bound_px", error->bound_px},
          {"normal_bound_degrees", error->normal_bound_degrees},
          {"estimated_primitives", error->estimated},
          {"specks", error->specks}};
}

Json to_json(const StageTimes& t) {
  return {{"import", t.import},
          {"prepare", t.prepare},
          {"context", t.context},
          {"upload", t.upload},
          {"first_frame", t.first_frame},
          {"frame_median", t.frame_median},
          {"write", t.write},
          {"total", t.total}};
}

}  // namespace

CertifiedError certified_error(const DpScene& scene) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  CertifiedError error{scene.bound, scene.bound_px, scene.normal_bound * kDegrees};
  for (const PartDps& part : scene.parts) {
    for (const QuadricDp& dp : part.dps) {
      error.estimated += dp.sampled_bound;
      error.specks += dp.speck;
    }
  }
  return error;
}

FaceReport report_faces(const Model& model, const std::vector<std::vector<SkippedFace>>& left_out) {
  FaceReport faces;
  for (const SkippedFace& face : model.skipped)
    for (std::uint32_t i = 0; i < face.count; ++i) faces.skipped.push_back({face.name, face.reason, 1});
  std::size_t instances = face_instance_count(model);
  for (const Instance& instance : model.instances) {
    for (const SkippedFace& face : left_out[instance.part]) {
      faces.skipped.push_back({placed_name(instance, face.name), face.reason, 1});
      --instances;
    }
  }
  faces.drawn = instances;
  return faces;
}

nlohmann::ordered_json to_json(const FaceReport& faces) {
  Json skipped = Json::array();
  for (const SkippedFace& face : faces.skipped)
    skipped.push_back({{"name", face.name}, {"reason", face.reason}});
  return {{"total", faces.total()}, {"drawn", faces.drawn}, {"skipped", std::move(skipped)}};
}

FaceReport report_faces(const Model& model, const DpScene& scene) {
  std::vector<std::vector<SkippedFace>> left_out(model.parts.size());
  for (std::size_t i = 0; i < model.parts.size(); ++i) left_out[i] = scene.parts[i].skipped;
  return report_faces(model, left_out);
}

FaceReport report_faces_of_triangles(const Model& model) {
  std::vector<std::vector<SkippedFace>> left_out(model.parts.size());
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    const Part& part = model.parts[i];
    std::vector<bool> meshed(part.faces.size(), false);
    for (std::uint32_t face : part.mesh.faces) meshed[face] = true;
    for (std::size_t face = 0; face < meshed.size(); ++face)
      if (!meshed[face])
        left_out[i].push_back({face_name(part, face), "the kernel's mesher made no triangles of it", 1});
  }
  return report_faces(model, left_out);
}

nlohmann::ordered_json to_json(const RenderStats& stats) {
  Json json;
  json["file"] = stats.files.size() == 1 ? Json(stats.files.front()) : Json(stats.files);
  json["faces"] = to_json(stats.faces);
  json["primitives"] = {
      {"kind", stats.primitive}, {"count", stats.primitives}, {"bytes", stats.bytes}, {"clips", stats.clips}};
  if (stats.points)
    json["point_trees"] = {{"points", stats.points->points},         {"triangles", stats.points->triangles},
                           {"visited_nodes", stats.points->visited}, {"cut_ms", stats.points->cut_ms},
                           {"gather_ms", stats.points->gather_ms},   {"raster_ms", stats.points->raster_ms}};
  if (stats.domains)
    json["domains"] = {{"points", stats.domains->points},
                       {"texels", stats.domains->texels},
                       {"level", stats.domains->level},
                       {"levels", stats.domains->levels},
                       {"deviation_99", stats.domains->deviation_99},
                       {"decomposition_s", stats.domains->decomposition},
                       {"construction_s", stats.domains->construction}};
  json["error"] = to_json(stats.error);
  json["time_s"] = to_json(stats.times);
  json["peak_rss_bytes"] = peak_resident_bytes();
  json["reader_peak_rss_bytes"] = peak_child_resident_bytes();
  json["image"] = {
      {"width", stats.width}, {"height", stats.height}, {"covered_pixels", stats.covered_pixels}};
  json["device"] = stats.device;
  json["gl_renderer"] = stats.gl_renderer;
  return json;
}

std::string describe(const StageTimes& t) {
  char text[256];
  std::snprintf(text, sizeof text,
                "import %.3f s, prepare %.3f s, context %.3f s, upload %.3f s, first frame %.4f s, write "
                "%.3f s, total %.3f s",
                t.import, t.prepare, t.context, t.upload, t.first_frame, t.write, t.total);
  return text;
}

}  // namespace dupin::app
