// STL, as text and binary. Facet normals are what the corners say already and are not read.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "mesh_file.h"
#include "text_cursor.h"
#include "vertex_welder.h"

namespace dupin::mesh_files {
namespace {

constexpr std::size_t kMostCorners = 0xfffffff0u;

bool same_word(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

/// solid NAME / facet normal x y z / outer loop / vertex x y z … / endloop / endfacet / endsolid: the words
/// that carry something are solid, loop, vertex and their ends.
class TextReader {
 public:
  explicit TextReader(std::string_view bytes) : text_(bytes), welder_(mesh().positions) {}

  Result<MeshFile> run() {
    mesh().starts = {0};
    for (; !text_.at_end(); text_.next_line())
      for (std::string_view word = text_.word(); !word.empty(); word = text_.word())
        if (!statement(word)) return status_;
    if (in_loop_) return text_.failure("the file ends within a facet");
    finish();
    return std::move(file_);
  }

 private:
  PolygonMesh& mesh() { return file_.mesh; }
  bool fail(std::string_view what) {
    status_ = text_.failure(what);
    return false;
  }

  bool statement(std::string_view word) {
    if (same_word(word, "vertex")) return vertex();
    if (same_word(word, "loop")) return begin_loop();
    if (same_word(word, "endloop")) return end_loop();
    if (same_word(word, "solid")) return begin_solid();
    if (same_word(word, "endsolid")) return text_.rest(), true;
    if (same_word(word, "facet")) return text_.rest(), true;
    if (same_word(word, "outer") || same_word(word, "endfacet")) return true;
    return fail(quoted(word) + " does not belong in an STL file");
  }

  bool begin_solid() {
    const auto [found, is_new] =
        solids_.try_emplace(std::string(text_.rest()), static_cast<std::uint32_t>(mesh().groups.size()));
    if (is_new) mesh().groups.push_back({found->first, std::nullopt});
    solid_ = found->second;
    return true;
  }

  bool begin_loop() {
    if (in_loop_) return fail("a loop begins within another");
    if (mesh().groups.empty()) mesh().groups.emplace_back();
    in_loop_ = true;
    return true;
  }

  bool vertex() {
    if (!in_loop_) return fail("a vertex stands outside of a loop");
    Vec3 p;
    for (int i = 0; i < 3; ++i) {
      const auto value = to_number(text_.word());
      if (!value) return fail("a vertex has too few numbers");
      if (!std::isfinite(*value)) return fail("a vertex is not finite");
      p[i] = *value;
    }
    if (mesh().corners.size() >= kMostCorners) return fail("the file has more than 4 billion corners");
    mesh().corners.push_back(welder_.add(p));
    return true;
  }

  bool end_loop() {
    if (!in_loop_) return fail("a loop ends that did not begin");
    in_loop_ = false;
    if (mesh().corners.size() - mesh().starts.back() < 3)
      return fail("a facet has fewer than three vertices");
    mesh().starts.push_back(static_cast<std::uint32_t>(mesh().corners.size()));
    mesh().polygon_groups.push_back(solid_);
    return true;
  }

  void finish() {
    file_.format = "STL";
    if (mesh().groups.size() <= 1) mesh().polygon_groups.clear();
    if (mesh().groups.size() == 1 && mesh().groups[0].name.empty()) mesh().groups.clear();
    simplify_layout(mesh());
  }

  TextCursor text_;
  Status status_;
  MeshFile file_;
  VertexWelder welder_;
  std::map<std::string, std::uint32_t> solids_;
  std::uint32_t solid_ = 0;
  bool in_loop_ = false;
};

/// Fifteen bits of colour in the two bytes that the format leaves over: VisCAM's are b, g, r from the top and
/// bit 15 says that they are there; Magics' are the other way round, and bit 15 says that the whole part's
/// colour holds.
class FacetColors {
 public:
  explicit FacetColors(std::string_view header) {
    const std::size_t at = header.find("COLOR=");
    magics_ = at != header.npos && at + 10 <= header.size();
    if (magics_) std::memcpy(whole_.data(), header.data() + at + 6, 4);
  }
  void add(std::uint16_t word, std::size_t facet) {
    const bool own = ((word & 0x8000) != 0) != magics_;
    if (own && colors_.empty()) colors_.assign(facet, missing());
    if (own || !colors_.empty()) colors_.push_back(own ? color(word) : missing());
  }
  std::vector<Rgba8> take(std::size_t facets) {
    if (magics_ && colors_.empty()) colors_.assign(facets, whole_);
    return std::move(colors_);
  }

 private:
  Rgba8 missing() const { return magics_ ? whole_ : Rgba8{160, 160, 160, 255}; }
  Rgba8 color(std::uint16_t word) const {
    const auto part = [word](int shift) {
      return static_cast<std::uint8_t>((word >> shift & 31) * 255 / 31);
    };
    return magics_ ? Rgba8{part(0), part(5), part(10), 255} : Rgba8{part(10), part(5), part(0), 255};
  }
  bool magics_ = false;
  Rgba8 whole_{};
  std::vector<Rgba8> colors_;
};

}  // namespace

Result<MeshFile> read_stl_text(std::string_view bytes) {
  return TextReader(bytes).run();
}

Result<MeshFile> read_stl_binary(std::string_view bytes) {
  if (bytes.size() < stl_bytes(0))
    return {StatusCode::unreadable, "the STL file is cut off within its header"};
  std::uint32_t count;
  std::memcpy(&count, bytes.data() + 80, 4);
  if (bytes.size() < stl_bytes(count))
    return {StatusCode::unreadable, "the STL file is cut off: it promises " + std::to_string(count) +
                                        " triangles, but ends at byte " + std::to_string(bytes.size())};
  if (count > kMostCorners / 3) return {StatusCode::limit, "the file has more than 4 billion corners"};
  MeshFile file;
  file.format = "STL";
  PolygonMesh& mesh = file.mesh;
  mesh.corners.reserve(std::size_t{3} * count);
  VertexWelder welder(mesh.positions);
  FacetColors colors(bytes.substr(0, 80));
  for (std::size_t i = 0; i < count; ++i) {
    const char* const facet = bytes.data() + stl_bytes(i);
    float numbers[9];
    std::uint16_t word;
    std::memcpy(numbers, facet + 12, sizeof numbers);
    std::memcpy(&word, facet + 48, 2);
    for (std::size_t k = 0; k < 9; k += 3) {
      const Vec3 p{numbers[k], numbers[k + 1], numbers[k + 2]};
      if (!is_finite(p))
        return {StatusCode::unreadable,
                "byte " + std::to_string(stl_bytes(i) + 12 + 4 * k) + ": a vertex is not finite"};
      mesh.corners.push_back(welder.add(p));
    }
    colors.add(word, i);
  }
  mesh.polygon_colors = colors.take(count);
  if (bytes.size() > stl_bytes(count))
    file.notes.push_back(std::to_string(bytes.size() - stl_bytes(count)) +
                         " bytes behind the triangles are not used");
  return file;
}

}  // namespace dupin::mesh_files
