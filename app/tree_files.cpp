#include "tree_files.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace dupin::app {
namespace {

/// Of what decides a tree besides its mesh: the builder's.
constexpr int kBuilderVersion = 1;

std::uint64_t hash(const std::string& text) {
  std::uint64_t h = 14695981039346656037u;  // FNV-1a
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return h;
}

}  // namespace

bool is_tree_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  char head[8] = {};
  std::ifstream(path, std::ios::binary).read(head, sizeof head);
  return is_point_tree(head);
}

Result<Model> model_of_tree(const PointTree& tree, const std::string& path, bool unpack) {
  const PointTreeInfo& info = tree.info();
  Model model;
  model.source = std::filesystem::path(path).filename().string();
  model.format = info.kind == PointTreeKind::pop ? "point tree" : "point tree of points";
  model.unit_note = info.source.unit_note;
  Part& part = model.parts.emplace_back();
  part.name = info.source.name;
  part.box = info.box;
  if (unpack) {
    Result<PolygonMesh> mesh = unpack_mesh(tree);
    if (!mesh.ok()) return {mesh.status().code, path + ": " + mesh.status().message};
    part.polygons = std::move(*mesh);
  } else {
    part.polygons.groups = tree.groups();
    if (part.polygons.groups.empty()) part.polygons.groups.emplace_back();
  }
  const double s = info.source.scale;
  model.instances.emplace_back().to_world.linear = {{s, 0, 0}, {0, s, 0}, {0, 0, s}};
  return model;
}

std::string kept_tree(const std::string& folder, const std::string& file, const std::string& units,
                      PointTreeKind kind) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::canonical(file, error);
  if (error) return {};
  const auto size = std::filesystem::file_size(path, error);
  const auto time = std::filesystem::last_write_time(path, error).time_since_epoch().count();
  if (error) return {};
  const std::string key = path.string() + '\n' + std::to_string(size) + '\n' + std::to_string(time) + '\n' +
                          units + '\n' + std::to_string(static_cast<int>(kind)) + '\n' +
                          std::to_string(kBuilderVersion);
  char name[32];
  std::snprintf(name, sizeof name, "%016llx.dpt", static_cast<unsigned long long>(hash(key)));
  return (std::filesystem::path(folder) / name).string();
}

}  // namespace dupin::app
