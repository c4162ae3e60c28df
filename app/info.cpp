// dupin info: what a file holds.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "colors.h"
#include "commands.h"
#include "exit_code.h"
#include "load.h"
#include "session.h"

namespace dupin::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  CommonOptions common;
  std::string file;
  bool json = false;
};

/// Face instances by what they lie on and by colour, and what there is of polygons.
struct Counts {
  std::map<std::string, std::size_t> surfaces, colors;
  std::size_t vertices = 0, polygons = 0, triangles = 0, loose_points = 0, groups = 0, creases = 0;
  bool vertex_colors = false, polygon_colors = false, normals = false;
};

void count_mesh(const PolygonMesh& mesh, const Instance& instance, const Part& part, Counts& counts) {
  if (mesh.empty()) return;
  counts.vertices += mesh.positions.size();
  counts.polygons += mesh.polygon_count();
  counts.triangles += triangle_count(mesh);
  counts.loose_points += loose_point_count(mesh);
  counts.groups += mesh.groups.size();
  counts.creases += mesh.tags.creases.size();
  counts.vertex_colors = counts.vertex_colors || !mesh.colors.empty();
  counts.polygon_colors = counts.polygon_colors || !mesh.polygon_colors.empty();
  counts.normals = counts.normals || !mesh.normals.empty();
  for (std::size_t i = 0; i < face_count(mesh); ++i) {
    ++counts.surfaces[mesh.polygon_count() > 0 ? "mesh" : "points"];
    std::optional<Color> color = i < mesh.groups.size() ? mesh.groups[i].color : std::nullopt;
    if (!color) color = instance.color ? instance.color : part.color;
    const bool own = !mesh.colors.empty() || !mesh.polygon_colors.empty();
    ++counts.colors[own ? "its own" : color ? hex_color(*color) : "none"];
  }
}

Counts count(const Model& model) {
  Counts counts;
  for (const Instance& instance : model.instances) {
    const Part& part = model.parts[instance.part];
    count_mesh(part.polygons, instance, part, counts);
    for (const Face& face : part.faces) {
      ++counts.surfaces[std::string(kind_name(part.surfaces[face.surface]))];
      const auto color = file_color(face, instance, part);
      ++counts.colors[color ? hex_color(*color) : "none"];
    }
  }
  return counts;
}

Json to_json(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Json tree_json(const PointTree& tree) {
  const PointTreeInfo& info = tree.info();
  return {{"kind", info.kind == PointTreeKind::pop ? "pop" : "qsplat"},
          {"nodes", info.nodes},
          {"leaves", info.leaves},
          {"triangles", info.triangles},
          {"bytes", tree.byte_count()},
          {"position_error", info.position_error}};
}

std::string tree_text(const PointTree& tree) {
  const PointTreeInfo& info = tree.info();
  std::string text = std::to_string(info.nodes) + " nodes over ";
  text += info.kind == PointTreeKind::pop ? std::to_string(info.triangles) + " triangles"
                                          : std::to_string(info.leaves) + " points";
  return text + ", " + std::to_string(tree.byte_count() / 1024) + " KiB";
}

Json to_json(const Loaded& loaded, const std::string& file) {
  const Model& model = loaded.model;
  const Counts counts = count(model);
  const std::size_t faces = face_instance_count(model), skipped = skipped_count(model.skipped);
  Json json;
  json["file"] = file;
  json["format"] = model.format;
  json["units"] = model.unit_note;
  json["parts"] = model.parts.size();
  json["instances"] = model.instances.size();
  json["faces"] = {{"total", faces + skipped}, {"readable", faces}, {"by_surface", counts.surfaces}};
  if (counts.vertices)
    json["mesh"] = {{"vertices", counts.vertices},
                    {"polygons", counts.polygons},
                    {"triangles", counts.triangles},
                    {"loose_points", counts.loose_points},
                    {"groups", counts.groups},
                    {"creases", counts.creases},
                    {"vertex_colors", counts.vertex_colors},
                    {"polygon_colors", counts.polygon_colors},
                    {"normals", counts.normals}};
  if (!loaded.trees.empty() && loaded.trees[0]) json["point_tree"] = tree_json(*loaded.trees[0]);
  const Box3 box = bounding_box(model);
  json["bounding_box"] =
      box.empty() ? Json(nullptr) : Json{{"min", to_json(box.lo)}, {"max", to_json(box.hi)}};
  json["colors"] = counts.colors;
  json["skipped"] = Json::array();
  for (const SkippedFace& face : model.skipped)
    json["skipped"].push_back({{"name", face.name}, {"reason", face.reason}, {"count", face.count}});
  json["notes"] = model.notes;
  return json;
}

void row(const char* name, const std::string& text) {
  std::printf("%-13s %s\n", name, text.c_str());
}

std::string list(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [name, n] : counts) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + name;
  return text;
}

std::string numbers(const char* format, const Vec3& v) {
  char text[128];
  std::snprintf(text, sizeof text, format, v.x, v.y, v.z);
  return text;
}

std::string mesh_text(const Counts& counts) {
  std::string text =
      std::to_string(counts.vertices) + " vertices, " + std::to_string(counts.polygons) + " polygons";
  if (counts.triangles != counts.polygons) text += " (" + std::to_string(counts.triangles) + " triangles)";
  if (counts.groups)
    text += ", " + std::to_string(counts.groups) + (counts.groups == 1 ? " group" : " groups");
  if (counts.loose_points) text += ", " + std::to_string(counts.loose_points) + " vertices without polygons";
  if (counts.creases) text += ", " + std::to_string(counts.creases) + " creases";
  if (counts.normals) text += ", normals";
  return text + (counts.vertex_colors ? ", vertex colours" : "") +
         (counts.polygon_colors ? ", polygon colours" : "");
}

void print_table(const Loaded& loaded, const std::string& file) {
  const Model& model = loaded.model;
  const Counts counts = count(model);
  const std::size_t faces = face_instance_count(model), skipped = skipped_count(model.skipped);
  row("file", file);
  row("format", model.format);
  row("units", model.unit_note);
  row("parts",
      std::to_string(model.parts.size()) + " in " + std::to_string(model.instances.size()) + " instances");
  row("faces",
      std::to_string(faces + skipped) + (counts.surfaces.empty() ? "" : ": " + list(counts.surfaces)));
  if (counts.vertices) row("mesh", mesh_text(counts));
  if (!loaded.trees.empty() && loaded.trees[0]) row("tree", tree_text(*loaded.trees[0]));
  row("colours", counts.colors.empty() ? "none" : list(counts.colors));
  if (const Box3 box = bounding_box(model); !box.empty()) {
    row("box", numbers("%.6g %.6g %.6g", box.lo) + " … " + numbers("%.6g %.6g %.6g", box.hi));
    row("size", numbers("%.6g × %.6g × %.6g", box.size()));
  }
  for (const std::string& note : model.notes) row("note", note);
  if (skipped) row("not readable", std::to_string(skipped) + (skipped == 1 ? " face" : " faces"));
  for (const SkippedFace& face : model.skipped)
    row("", face.name + (face.count > 1 ? " (" + std::to_string(face.count) + " times)" : "") + ": " +
                face.reason);
}

int run(const InfoOptions& options) {
  Session session(options.common);
  LoadOptions how;
  how.trees = true;
  const Result<Loaded> loaded = load(session, {options.file}, how);
  if (!loaded.ok()) return session.fail(loaded.status());
  session.done();
  if (options.json)
    std::printf("%s\n",
                to_json(*loaded, options.file).dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  else
    print_table(*loaded, options.file);
  if (std::fflush(stdout) != 0)
    return session.fail({StatusCode::cannot_write, "standard output: cannot write"});
  return options.common.strict && !loaded->model.skipped.empty() ? kPartial : kDone;
}

}  // namespace

void add_info_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Say what a CAD or mesh file holds");
  command->add_option("FILE", options->file, "STEP, IGES, BREP, FCStd, OBJ, PLY, STL, OFF or .dpt")
      ->required();
  command->add_flag("--json", options->json, "As JSON, for programs");
  add_common_options(*command, options->common);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
