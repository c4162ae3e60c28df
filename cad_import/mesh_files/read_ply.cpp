// PLY: vertices, faces and triangle strips, as text or as binary numbers of either byte order.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "color_scale.h"
#include "mesh_file.h"
#include "ply_header.h"
#include "text_cursor.h"

namespace dupin::mesh_files {
namespace {

template <class T>
T swapped(T value) {
  auto bytes = std::bit_cast<std::array<unsigned char, sizeof(T)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// The body's numbers one after the other, from a text or from binary data. After a failure every number is
/// 0.
class Numbers {
 public:
  Numbers(std::string_view body, const PlyHeader& header)
      : format_(header.format),
        text_(body, header.lines + 1),
        begin_(body.data()),
        at_(body.data()),
        end_(body.data() + body.size()),
        header_bytes_(header.bytes) {}

  bool is_text() const { return format_ == PlyHeader::Format::text; }
  std::size_t bytes_left() const {
    return is_text() ? text_.bytes_left() : static_cast<std::size_t>(end_ - at_);
  }
  const Status& status() const { return status_; }
  bool ok() const { return status_.ok(); }

  bool fail(std::string_view what) {
    if (!status_.ok()) return false;
    const std::size_t byte = header_bytes_ + static_cast<std::size_t>(at_ - begin_);
    status_ = is_text()
                  ? text_.failure(what)
                  : Status{StatusCode::unreadable, "byte " + std::to_string(byte) + ": " + std::string(what)};
    return false;
  }

  double next(PlyType type) {
    if (!ok()) return 0;
    return is_text() ? from_text(type) : from_binary(type);
  }
  /// Of binary data.
  void skip(std::size_t bytes) { at_ += bytes; }

 private:
  double from_text(PlyType type) {
    const std::string_view word = text_.word_on_any_line('\0');
    if (word.empty()) return fail("the file ends too early"), 0;
    const auto value = to_number(word);
    if (!value) return fail(quoted(word) + " stands where a number should"), 0;
    if (!is_float(type) && *value != std::floor(*value))
      return fail(quoted(word) + " stands where a whole number should"), 0;
    return *value;
  }

  template <class T>
  double read() {
    T value;
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
    return static_cast<double>(format_ == PlyHeader::Format::big_endian ? swapped(value) : value);
  }

  double from_binary(PlyType type) {
    if (bytes_left() < byte_size(type)) return fail("the file ends too early"), 0;
    switch (type) {
      case PlyType::int8:
        return read<std::int8_t>();
      case PlyType::uint8:
        return read<std::uint8_t>();
      case PlyType::int16:
        return read<std::int16_t>();
      case PlyType::uint16:
        return read<std::uint16_t>();
      case PlyType::int32:
        return read<std::int32_t>();
      case PlyType::uint32:
        return read<std::uint32_t>();
      case PlyType::float32:
        return read<float>();
      case PlyType::float64:
        break;
    }
    return read<double>();
  }

  static_assert(std::endian::native == std::endian::little);
  PlyHeader::Format format_;
  TextCursor text_;
  const char *begin_, *at_, *end_;
  std::size_t header_bytes_;
  Status status_;
};

/// What a scalar property is for.
enum Use : int {
  kX,
  kY,
  kZ,
  kNormalX,
  kNormalY,
  kNormalZ,
  kRed,
  kGreen,
  kBlue,
  kAlpha,
  kUses,
  kUnused = kUses
};

Use use_of(const std::string& name) {
  static constexpr std::pair<const char*, Use> kNames[] = {{"x", kX},
                                                           {"y", kY},
                                                           {"z", kZ},
                                                           {"nx", kNormalX},
                                                           {"ny", kNormalY},
                                                           {"nz", kNormalZ},
                                                           {"red", kRed},
                                                           {"green", kGreen},
                                                           {"blue", kBlue},
                                                           {"alpha", kAlpha},
                                                           {"diffuse_red", kRed},
                                                           {"diffuse_green", kGreen},
                                                           {"diffuse_blue", kBlue},
                                                           {"r", kRed},
                                                           {"g", kGreen},
                                                           {"b", kBlue}};
  for (const auto& [known, use] : kNames)
    if (name == known) return use;
  return kUnused;
}

/// From a property's range to 0 … 255.
double color_scale(PlyType type) {
  return is_float(type) ? 255 : byte_size(type) == 1 ? 1 : byte_size(type) == 2 ? 1 / 257.0 : 1 / 16843009.0;
}

/// The scalars of one vertex or face that mean something, whichever of them it has.
struct Scalars {
  double value[kUses + 1] = {};
  Rgba8 color() const {
    return {to_byte(value[kRed]), to_byte(value[kGreen]), to_byte(value[kBlue]), to_byte(value[kAlpha])};
  }
};

/// How an element's properties are read.
struct Plan {
  std::vector<Use> uses;
  std::vector<double> scales;
  bool has[kUses + 1] = {};
  int indices = -1;  ///< the property that lists vertices

  explicit Plan(const PlyElement& element) {
    for (const PlyProperty& p : element.properties) {
      const bool lists_vertices = p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
      if (lists_vertices && indices < 0) indices = static_cast<int>(uses.size());
      uses.push_back(p.list ? kUnused : use_of(p.name));
      scales.push_back(uses.back() >= kRed && uses.back() <= kAlpha ? color_scale(p.type) : 1);
      has[uses.back()] = true;
    }
  }
  bool has_position() const { return has[kX] && has[kY] && has[kZ]; }
  bool has_normal() const { return has[kNormalX] && has[kNormalY] && has[kNormalZ]; }
  bool has_color() const { return has[kRed] && has[kGreen] && has[kBlue]; }
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const PlyHeader& header)
      : header_(header), numbers_(bytes.substr(header.bytes), header) {}

  Result<MeshFile> run() {
    mesh().starts = {0};
    file_.format = "PLY";
    for (const PlyElement& element : header_.elements)
      if (!read_element(element)) return numbers_.status();
    if (!seen_vertices_) return {StatusCode::unreadable, "the PLY file has no vertices with x, y and z"};
    if (const Status valid = check_indices(); !valid.ok()) return valid;
    finish();
    return std::move(file_);
  }

 private:
  PolygonMesh& mesh() { return file_.mesh; }

  bool read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face",
               is_strip = element.name == "tristrips";
    const Plan plan(element);
    const std::size_t least = element.least_bytes(numbers_.is_text());
    // The last number of a text may have no blank behind it.
    if (element.count > 0 && (least == 0 || element.count > (numbers_.bytes_left() + 1) / least))
      return numbers_.fail("the header promises " + std::to_string(element.count) + " of " +
                           quoted(element.name) + ", more than the file can hold");
    if (element.count > std::numeric_limits<std::uint32_t>::max() - 1)
      return numbers_.fail("more than 4 billion of " + quoted(element.name));
    if (is_vertex && !plan.has_position()) return numbers_.fail("the vertices lack x, y or z");
    if (is_vertex) return read_vertices(element, plan);
    if ((is_face || is_strip) && plan.indices >= 0) return read_faces(element, plan, is_strip);
    if (element.count > 0 && element.name != "camera" && element.name != "material")
      file_.notes.push_back(std::to_string(element.count) + " of " + quoted(element.name) + " are not used");
    for (std::uint64_t i = 0; i < element.count && numbers_.ok(); ++i) read_one(element, plan);
    return numbers_.ok();
  }

  Scalars read_one(const PlyElement& element, const Plan& plan) {
    Scalars s;
    s.value[kAlpha] = 255;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.list)
        read_list(property, static_cast<int>(i) == plan.indices);
      else
        s.value[plan.uses[i]] = plan.scales[i] * numbers_.next(property.type);
    }
    return s;
  }

  void read_list(const PlyProperty& property, bool keep) {
    const double count = numbers_.next(property.count_type);
    if (keep) list_.clear();
    const std::size_t each = numbers_.is_text() ? 2 : byte_size(property.type);
    if (!(count >= 0 && count <= static_cast<double>((numbers_.bytes_left() + 1) / each))) {
      numbers_.fail("a list is longer than the file");
      return;
    }
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < n && numbers_.ok(); ++i) {
      const double value = numbers_.next(property.type);
      if (keep) list_.push_back(value);
    }
  }

  bool read_vertices(const PlyElement& element, const Plan& plan) {
    if (seen_vertices_) return numbers_.fail("the file has two lists of vertices");
    seen_vertices_ = true;
    const auto n = static_cast<std::size_t>(element.count);
    mesh().positions.reserve(n);
    if (plan.has_normal()) mesh().normals.reserve(n);
    if (plan.has_color()) mesh().colors.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Scalars s = read_one(element, plan);
      const Vec3 p{s.value[kX], s.value[kY], s.value[kZ]};
      Vec3 normal{s.value[kNormalX], s.value[kNormalY], s.value[kNormalZ]};
      if (!numbers_.ok()) return false;
      if (!is_finite(p)) return numbers_.fail("vertex " + std::to_string(i) + " is not finite");
      if (!is_finite(normal))
        return numbers_.fail("the normal of vertex " + std::to_string(i) + " is not finite");
      mesh().positions.push_back(p);
      normal = normalized(normal);
      if (plan.has_normal())
        mesh().normals.push_back(
            {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)});
      if (plan.has_color()) mesh().colors.push_back(s.color());
    }
    note_unused(element, plan);
    return true;
  }

  void note_unused(const PlyElement& element, const Plan& plan) {
    std::string names;
    for (std::size_t i = 0; i < plan.uses.size(); ++i)
      if (plan.uses[i] == kUnused && static_cast<int>(i) != plan.indices && names.size() < 200)
        names += (names.empty() ? "" : ", ") + quoted(element.properties[i].name);
    if (!names.empty()) file_.notes.push_back("not used of each " + element.name + ": " + names);
  }

  bool read_faces(const PlyElement& element, const Plan& plan, bool strips) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const Scalars s = read_one(element, plan);
      if (!numbers_.ok() || !(strips ? add_strip() : add_polygon(i))) return false;
      // Strips and faces that are left out have no colour of their own.
      if (plan.has_color() && !strips && mesh().polygon_colors.size() + 2 == mesh().starts.size())
        mesh().polygon_colors.push_back(s.color());
    }
    note_unused(element, plan);
    return true;
  }

  bool add_corner(double index) {
    if (!(index >= 0 && index < std::numeric_limits<std::uint32_t>::max()))
      return numbers_.fail("a face refers to a vertex below the first or above 4 billion");
    mesh().corners.push_back(static_cast<std::uint32_t>(index));
    if (mesh().corners.size() >= std::numeric_limits<std::uint32_t>::max())
      return numbers_.fail("the file has more than 4 billion corners");
    return true;
  }

  /// Vertices may come after faces: what a face refers to is checked at the end, but for those that come
  /// before.
  bool add_polygon(std::uint64_t number) {
    if (list_.size() < 3) {
      ++small_;
      return true;
    }
    for (const double index : list_) {
      if (seen_vertices_ && !(index < static_cast<double>(mesh().positions.size())))
        return numbers_.fail("face " + std::to_string(number) + " refers to vertex " +
                             std::to_string(static_cast<long long>(index)) + " of " +
                             std::to_string(mesh().positions.size()));
      if (!add_corner(index)) return false;
    }
    mesh().starts.push_back(static_cast<std::uint32_t>(mesh().corners.size()));
    return true;
  }

  /// A strip turns every other triangle; -1 begins a new one.
  bool add_strip() {
    std::size_t first = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1) {
        first = i + 1;
        continue;
      }
      if (i < first + 2) continue;
      const bool turned = (i - first) % 2 == 1;
      const double a = list_[i - 2], b = list_[i - 1];
      if (a == b || b == list_[i] || a == list_[i]) continue;  // joins strips, covers nothing
      if (!add_corner(turned ? b : a) || !add_corner(turned ? a : b) || !add_corner(list_[i])) return false;
      mesh().starts.push_back(static_cast<std::uint32_t>(mesh().corners.size()));
    }
    return true;
  }

  Status check_indices() {
    for (const std::uint32_t v : mesh().corners)
      if (v >= mesh().positions.size())
        return {StatusCode::unreadable, "a face refers to vertex " + std::to_string(v) + " of " +
                                            std::to_string(mesh().positions.size())};
    return {};
  }

  void finish() {
    if (small_ > 0)
      file_.notes.push_back(std::to_string(small_) + " faces of fewer than three corners are left out");
    if (mesh().polygon_colors.size() != mesh().polygon_count()) mesh().polygon_colors.clear();
    simplify_layout(mesh());
  }

  const PlyHeader& header_;
  Numbers numbers_;
  MeshFile file_;
  std::vector<double> list_;
  bool seen_vertices_ = false;
  std::size_t small_ = 0;
};

}  // namespace

Result<MeshFile> read_ply(std::string_view bytes) {
  const Result<PlyHeader> header = read_ply_header(bytes);
  if (!header.ok()) return header.status();
  return PlyReader(bytes, *header).run();
}

}  // namespace dupin::mesh_files
