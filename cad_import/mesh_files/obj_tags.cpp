#include "obj_tags.h"

#include <algorithm>
#include <cmath>

namespace dupin::mesh_files {
namespace {

/// "2/1/0": how many numbers of each sort follow. Counts beyond what a line can hold are refused by what is
/// missing.
bool parse_counts(std::string_view word, std::array<std::int64_t, 3>& counts) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t slash = word.find('/');
    const auto value = to_integer(word.substr(0, slash));
    if (!value || *value < 0 || (slash == word.npos) != (i == 2)) return false;
    counts[i] = *value;
    word.remove_prefix(slash == word.npos ? word.size() : slash + 1);
  }
  return true;
}

/// Kept as a number that no vertex has where it is no index at all.
std::uint32_t to_index(std::int64_t i) {
  return i >= 0 && i < 0xffffffff ? static_cast<std::uint32_t>(i) : 0xffffffffu;
}

}  // namespace

Status ObjTags::read(TextCursor& text) {
  Tag tag;
  tag.name = std::string(text.word());
  std::array<std::int64_t, 3> counts;
  if (tag.name.empty() || !parse_counts(text.word(), counts))
    return text.failure("a tag has no counts such as 2/1/0");
  for (std::int64_t i = 0; i < counts[0]; ++i) {
    const auto value = to_integer(text.word());
    if (!value) return text.failure("a tag has too few whole numbers");
    tag.ints.push_back(*value);
  }
  for (std::int64_t i = 0; i < counts[1]; ++i) {
    const auto value = to_number(text.word());
    if (!value || !std::isfinite(*value)) return text.failure("a tag has too few numbers");
    tag.floats.push_back(*value);
  }
  for (std::int64_t i = 0; i < counts[2]; ++i) {
    const std::string_view word = text.word();
    if (word.empty()) return text.failure("a tag has too few words");
    tag.words.emplace_back(word);
  }
  use(tag);
  return {};
}

void ObjTags::use(const Tag& tag) {
  if (tag.name == "crease")
    use_crease(tag);
  else if (tag.name == "corner")
    use_corner(tag);
  else if (tag.name == "hole")
    holes_.insert(holes_.end(), tag.ints.begin(), tag.ints.end());
  else if (tag.name == "interpolateboundary")
    use_boundary(tag);
  else if (tag.name == "creasemethod")
    tags_.chaikin = !tag.words.empty() && tag.words[0] == "chaikin";
  else if (tag.name == "smoothtriangles")
    tags_.smooth_triangles = !tag.words.empty() && tag.words[0] == "smooth";
  else
    ++unknown_;
}

/// A chain of vertices, with one sharpness for all of it or one for each of its edges.
void ObjTags::use_crease(const Tag& tag) {
  if (tag.floats.empty()) return;
  for (std::size_t i = 0; i + 1 < tag.ints.size(); ++i) {
    const double sharpness = tag.floats[std::min(i, tag.floats.size() - 1)];
    tags_.creases.push_back(
        {to_index(tag.ints[i]), to_index(tag.ints[i + 1]), static_cast<float>(sharpness)});
  }
}

void ObjTags::use_corner(const Tag& tag) {
  if (tag.floats.empty()) return;
  for (std::size_t i = 0; i < tag.ints.size(); ++i)
    tags_.corners.push_back(
        {to_index(tag.ints[i]), static_cast<float>(tag.floats[std::min(i, tag.floats.size() - 1)])});
}

void ObjTags::use_boundary(const Tag& tag) {
  if (tag.ints.empty()) return;
  switch (tag.ints[0]) {
    case 0:
      tags_.boundary = SubdivisionTags::Boundary::none;
      break;
    case 1:
      tags_.boundary = SubdivisionTags::Boundary::edges_and_corners;
      break;
    case 2:
      tags_.boundary = SubdivisionTags::Boundary::edges;
      break;
    default:
      ++unknown_;
  }
}

void ObjTags::finish(const std::vector<std::uint32_t>& polygon_numbers, PolygonMesh& mesh,
                     std::vector<std::string>& notes) {
  const std::size_t vertices = mesh.positions.size();
  std::size_t dangling = std::erase_if(tags_.creases, [&](const SubdivisionTags::Crease& c) {
    return c.a >= vertices || c.b >= vertices || !std::isfinite(c.sharpness);
  });
  dangling += std::erase_if(tags_.corners, [&](const SubdivisionTags::Corner& c) {
    return c.vertex >= vertices || !std::isfinite(c.sharpness);
  });
  for (const std::int64_t hole : holes_) {
    const auto at = static_cast<std::size_t>(hole);
    if (hole >= 0 && at < polygon_numbers.size() && polygon_numbers[at] != kNoPolygon)
      tags_.holes.push_back(polygon_numbers[at]);
    else
      ++dangling;
  }
  mesh.tags = std::move(tags_);
  if (dangling > 0)
    notes.push_back(std::to_string(dangling) + " subdivision tags refer to nothing and are left out");
  if (unknown_ > 0)
    notes.push_back(std::to_string(unknown_) + " subdivision tags are of a kind that is not used");
}

}  // namespace dupin::mesh_files
