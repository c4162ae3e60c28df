#include "sanitize.h"

#include <numeric>

namespace dupin::reader {
namespace {

// The face alone with what it refers to, as a model for check().
Model alone(const Part& part, const Face& face) {
  Model model;
  Part& own = model.parts.emplace_back();
  own.surfaces.push_back(part.surfaces[face.surface]);
  own.faces.push_back(face);
  own.faces[0].surface = 0;
  for (Loop& loop : own.faces[0].loops)
    for (Trim& trim : loop) {
      own.edges.push_back(part.edges[trim.edge]);
      trim.edge = static_cast<std::uint32_t>(own.edges.size() - 1);
    }
  return model;
}

std::string after_colon(const std::string& message) {
  const std::size_t colon = message.rfind(": ");
  return colon == message.npos ? message : message.substr(colon + 2);
}

}  // namespace

std::vector<SkippedFace> remove_invalid_faces(Part& part, std::vector<std::size_t>& index) {
  index.resize(part.faces.size());
  std::iota(index.begin(), index.end(), std::size_t{0});
  std::vector<SkippedFace> removed;
  Model whole;
  whole.parts.push_back(std::move(part));
  const bool valid = check(whole).ok();
  part = std::move(whole.parts[0]);
  if (valid) return removed;
  std::vector<Face> kept;
  index.clear();
  for (std::size_t i = 0; i < part.faces.size(); ++i) {
    const Status status = check(alone(part, part.faces[i]));
    if (status.ok()) {
      index.push_back(i);
      kept.push_back(std::move(part.faces[i]));
    } else {
      const std::string& name = part.faces[i].name;
      removed.push_back(
          {name.empty() ? "face " + std::to_string(i + 1) : name, after_colon(status.message), 1});
    }
  }
  part.faces = std::move(kept);
  return removed;
}

}  // namespace dupin::reader
