// OFF, the text form: [ST][C][N]OFF with three coordinates. Vertices may have normals and colours, faces
// colours.
#include <cmath>
#include <limits>

#include "color_scale.h"
#include "mesh_file.h"
#include "text_cursor.h"

namespace dupin::mesh_files {
namespace {

class OffReader {
 public:
  explicit OffReader(std::string_view bytes) : text_(bytes) {}

  Result<MeshFile> run() {
    mesh().starts = {0};
    if (!header() || !counts() || !vertices() || !faces()) return status_;
    file_.format = "OFF";
    mesh().colors = vertex_colors_.take(vertex_colors_seen_ ? mesh().positions.size() : 0);
    if (face_colors_seen_) mesh().polygon_colors = face_colors_.take(mesh().polygon_count());
    if (small_ > 0)
      file_.notes.push_back(std::to_string(small_) + " faces of fewer than three corners are left out");
    simplify_layout(mesh());
    return std::move(file_);
  }

 private:
  PolygonMesh& mesh() { return file_.mesh; }
  bool fail(std::string_view what) {
    status_ = text_.failure(what);
    return false;
  }

  bool header() {
    std::string_view word = text_.word_on_any_line('#');
    const std::string_view whole = word;
    const auto has = [&word](std::string_view prefix) {
      const bool found = word.starts_with(prefix);
      if (found) word.remove_prefix(prefix.size());
      return found;
    };
    texture_ = has("ST");
    has("C");
    normals_ = has("N");
    if (word == "4OFF" || word == "nOFF" || word == "4nOFF")
      return fail("an OFF file that is not three-dimensional");
    if (word != "OFF") return fail(quoted(whole) + " stands where OFF should");
    if (TextCursor(text_).rest().starts_with("BINARY"))
      return fail("a binary OFF file, which is not supported");
    return true;
  }

  bool count(std::size_t& out, std::size_t least_bytes, const char* what) {
    const auto value = to_integer(text_.word_on_any_line('#'));
    if (!value || *value < 0) return fail(std::string("the number of ") + what + " is missing");
    out = static_cast<std::size_t>(*value);
    if (out > (text_.bytes_left() + 1) / least_bytes || out >= std::numeric_limits<std::uint32_t>::max())
      return fail("the header promises " + std::to_string(out) + " " + what +
                  ", more than the file can hold");
    return true;
  }

  bool counts() {
    if (!count(vertices_, 6, "vertices") || !count(faces_, 2, "faces")) return false;
    if (6 * vertices_ + 2 * faces_ > text_.bytes_left() + 1)
      return fail("the header promises more vertices and faces than the file can hold");
    text_.rest();  // the number of edges, which nobody needs
    return true;
  }

  /// The next line that has something on it; its words.
  bool next_row() {
    for (; !text_.at_end(); text_.next_line()) {
      const std::string_view word = text_.word();
      if (word.empty() || word.front() == '#') continue;
      first_ = word;
      return true;
    }
    return fail("the file ends too early");
  }
  std::string_view next_word() {
    const std::string_view word = first_.empty() ? text_.word() : first_;
    first_ = {};
    return word.empty() || word.front() == '#' ? std::string_view{} : word;
  }
  void end_row() { text_.rest(), text_.next_line(); }

  bool number(double& out) {
    const std::string_view word = next_word();
    const auto value = to_number(word);
    if (!value)
      return fail(word.empty() ? "a vertex has too few numbers"
                               : quoted(word) + " stands where a number should");
    out = *value;
    return std::isfinite(out) || fail("a vertex is not finite");
  }

  /// Three or four numbers at the end of a line, 0 … 1 or 0 … 255; a lone one is an index into a table of
  /// colours that is not there.
  bool color(std::size_t index, std::size_t unused, VertexColors& colors, bool& seen) {
    double c[16] = {0, 0, 0, -1};
    std::size_t n = 0;
    for (std::string_view word = next_word(); !word.empty(); word = next_word(), ++n) {
      const auto value = to_number(word);
      if (n == 16 || !value || !std::isfinite(*value))
        return fail(quoted(word) + " stands where a colour should");
      c[n] = *value;
    }
    n -= std::min(n, unused);
    if (n < 3) return true;
    colors.set(index, {c[0], c[1], c[2], n == 4 ? c[3] : -1});
    seen = true;
    return true;
  }

  bool vertices() {
    for (std::size_t i = 0; i < vertices_; ++i) {
      Vec3 p, n;
      if (!next_row() || !number(p.x) || !number(p.y) || !number(p.z)) return false;
      mesh().positions.push_back(p);
      if (normals_) {
        if (!number(n.x) || !number(n.y) || !number(n.z)) return false;
        n = normalized(n);
        mesh().normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
      }
      if (!color(i, texture_ ? 2 : 0, vertex_colors_, vertex_colors_seen_)) return false;
      end_row();
    }
    return true;
  }

  bool face() {
    const auto size = to_integer(next_word());
    if (!size || *size < 0) return fail("a face does not say how many corners it has");
    const std::size_t first = mesh().corners.size();
    for (std::int64_t k = 0; k < *size; ++k) {
      const std::string_view word = next_word();
      const auto v = to_integer(word);
      if (!v) return fail(word.empty() ? "a face has too few corners" : "a face's corner is " + quoted(word));
      if (*v < 0 || static_cast<std::size_t>(*v) >= vertices_)
        return fail("a face refers to vertex " + std::to_string(*v) + " of " + std::to_string(vertices_));
      mesh().corners.push_back(static_cast<std::uint32_t>(*v));
    }
    if (mesh().corners.size() >= std::numeric_limits<std::uint32_t>::max())
      return fail("the file has more than 4 billion corners");
    if (*size >= 3) {
      const std::size_t index = mesh().starts.size() - 1;
      mesh().starts.push_back(static_cast<std::uint32_t>(mesh().corners.size()));
      return color(index, 0, face_colors_, face_colors_seen_);
    }
    mesh().corners.resize(first);
    ++small_;
    return true;
  }

  bool faces() {
    for (std::size_t i = 0; i < faces_; ++i) {
      if (!next_row() || !face()) return false;
      end_row();
    }
    return true;
  }

  TextCursor text_;
  Status status_;
  MeshFile file_;
  bool texture_ = false, normals_ = false, vertex_colors_seen_ = false, face_colors_seen_ = false;
  std::size_t vertices_ = 0, faces_ = 0, small_ = 0;
  std::string_view first_;
  VertexColors vertex_colors_, face_colors_;
};

}  // namespace

Result<MeshFile> read_off(std::string_view bytes) {
  return OffReader(bytes).run();
}

}  // namespace dupin::mesh_files
