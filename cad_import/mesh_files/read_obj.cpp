// Wavefront OBJ: vertices with colours, normals, polygons of any size, groups with their materials, and the
// subdivision tags that OpenSubdiv's shapes have ("t crease", "t corner", …).
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "color_scale.h"
#include "materials.h"
#include "mesh_file.h"
#include "obj_tags.h"
#include "text_cursor.h"

namespace dupin::mesh_files {
namespace {

constexpr std::size_t kMostCorners = std::numeric_limits<std::uint32_t>::max() - 1;

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const FindFile& find_file)
      : text_(bytes, 1, true), find_file_(find_file) {}

  Result<MeshFile> run() {
    mesh().starts = {0};
    for (; !text_.at_end(); text_.next_line())
      if (!statement(text_.word())) return status_;
    if (!is_there(vertices_ahead_, mesh().positions.size(), "vertex") ||
        !is_there(normals_ahead_, mesh().normals.size(), "normal"))
      return status_;
    finish();
    return std::move(file_);
  }

 private:
  PolygonMesh& mesh() { return file_.mesh; }
  bool fail(std::string_view what) {
    status_ = text_.failure(what);
    return false;
  }

  bool statement(std::string_view key) {
    if (key.empty() || key.front() == '#') return true;
    if (key == "v") return vertex();
    if (key == "f" || key == "fo") return polygon();
    if (key == "vn") return normal();
    if (key == "g" || key == "o" || key == "usemtl") return group(key);
    if (key == "t") return tag();
    if (key == "mtllib") return materials();
    ++others_[std::string(key.substr(0, 16))];
    if (others_.size() > kMostOthers) return fail("not an OBJ file: too many unknown statements");
    return true;
  }

  bool number(double& value, const char* what) {
    const std::string_view word = text_.word();
    if (word.empty()) return fail(std::string(what) + " has too few numbers");
    const auto parsed = to_number(word);
    if (!parsed) return fail(std::string(what) + " has " + quoted(word) + " for a number");
    value = *parsed;
    return std::isfinite(value) || fail(std::string(what) + " is not finite");
  }

  bool vertex() {
    Vec3& p = mesh().positions.emplace_back();
    for (int i = 0; i < 3; ++i)
      if (!number(p[i], "a vertex")) return false;
    double more[4];
    int count = 0;
    for (std::string_view word = text_.word(); !word.empty() && word.front() != '#'; word = text_.word()) {
      const auto value = to_number(word);
      if (count == 4 || !value) return fail("a vertex has " + quoted(word) + " after its numbers");
      if (!std::isfinite(*value)) return fail("a vertex is not finite");
      more[count++] = *value;
    }
    if (count >= 3)
      colors_.set(mesh().positions.size() - 1, {more[0], more[1], more[2], count == 4 ? more[3] : -1});
    return true;  // a single fourth number is the weight of free-form curves
  }

  bool normal() {
    Vec3 n;
    for (int i = 0; i < 3; ++i)
      if (!number(n[i], "a normal")) return false;
    n = normalized(n);
    mesh().normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    return true;
  }

  /// The largest index yet that refers to something further down in the file, and where it stands.
  struct Ahead {
    std::int64_t index = -1;
    std::size_t line = 0;
  };

  /// From 1 on, or backwards from -1. What lies ahead is checked at the end.
  bool index(std::string_view word, std::size_t count, const char* what, Ahead& ahead, std::uint32_t& out) {
    const auto value = to_integer(word);
    if (!value) return fail("a polygon's corner is " + quoted(word));
    const auto signed_count = static_cast<std::int64_t>(count);
    const std::int64_t i = *value < 0 ? signed_count + *value : *value - 1;
    if (i < 0 || i >= static_cast<std::int64_t>(kMostCorners)) return fail(refers_to(what, *value, count));
    if (i >= signed_count && i > ahead.index) ahead = {i, text_.line()};
    out = static_cast<std::uint32_t>(i);
    return true;
  }
  static std::string refers_to(const char* what, std::int64_t index, std::size_t count) {
    return "a polygon refers to " + std::string(what) + " " + std::to_string(index) + " of " +
           std::to_string(count);
  }
  bool is_there(const Ahead& ahead, std::size_t count, const char* what) {
    if (ahead.index < static_cast<std::int64_t>(count)) return true;
    status_ = {StatusCode::unreadable,
               "line " + std::to_string(ahead.line) + ": " + refers_to(what, ahead.index + 1, count)};
    return false;
  }

  /// "v", "v/t", "v//n" or "v/t/n".
  bool corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    if (!index(word.substr(0, slash), mesh().positions.size(), "vertex", vertices_ahead_,
               mesh().corners.emplace_back()))
      return false;
    const std::size_t second = slash == word.npos ? word.npos : word.find('/', slash + 1);
    std::uint32_t n = PolygonMesh::kNoNormal;
    if (second != word.npos && second + 1 < word.size())
      if (!index(word.substr(second + 1), mesh().normals.size(), "normal", normals_ahead_, n)) return false;
    mesh().corner_normals.push_back(n);
    return true;
  }

  bool polygon() {
    const std::size_t first = mesh().corners.size();
    for (std::string_view word = text_.word(); !word.empty() && word.front() != '#'; word = text_.word())
      if (!corner(word)) return false;
    const std::size_t size = mesh().corners.size() - first;
    if (mesh().corners.size() > kMostCorners) {
      status_ = {StatusCode::limit, "the file has more than 4 billion corners"};
      return false;
    }
    polygon_numbers_.push_back(size < 3 ? kNoPolygon : static_cast<std::uint32_t>(mesh().starts.size() - 1));
    if (size < 3) {
      mesh().corners.resize(first);
      mesh().corner_normals.resize(first);
      ++small_;
      return true;
    }
    mesh().starts.push_back(static_cast<std::uint32_t>(mesh().corners.size()));
    mesh().polygon_groups.push_back(current_group());
    return true;
  }

  bool group(std::string_view key) {
    std::string& name = key == "g" ? group_ : key == "o" ? object_ : material_;
    name = std::string(text_.rest());
    known_group_ = false;
    return true;
  }

  /// A group is what has the same object, group and material.
  std::uint32_t current_group() {
    if (known_group_) return group_number_;
    const auto [found, is_new] = group_numbers_.try_emplace({object_, group_, material_},
                                                            static_cast<std::uint32_t>(mesh().groups.size()));
    if (is_new) {
      const bool both = !object_.empty() && !group_.empty();
      mesh().groups.push_back({both ? object_ + "/" + group_ : object_ + group_, std::nullopt});
      group_materials_.push_back(material_);
    }
    known_group_ = true;
    return group_number_ = found->second;
  }

  bool materials() {
    const std::string name(text_.rest());
    if (libraries_.size() == kMostLibraries || !libraries_.insert(name).second) return true;
    const std::optional<std::string> content = find_file_ ? find_file_(name) : std::nullopt;
    if (content)
      add_materials(*content, materials_);
    else
      file_.notes.push_back("the materials in " + quoted(name) + " are not there");
    return true;
  }

  bool tag() {
    const Status status = tags_.read(text_);
    if (!status.ok()) status_ = status;
    return status.ok();
  }

  void finish() {
    file_.format = "OBJ";
    mesh().colors = colors_.take(mesh().positions.size());
    const auto& used = mesh().corner_normals;
    if (std::all_of(used.begin(), used.end(), [](std::uint32_t n) { return n == PolygonMesh::kNoNormal; }))
      mesh().corner_normals.clear(), mesh().normals.clear();
    for (std::size_t i = 0; i < mesh().groups.size(); ++i)
      if (const auto found = materials_.find(group_materials_[i]); found != materials_.end())
        mesh().groups[i].color = found->second;
    const bool one = mesh().groups.size() == 1 && mesh().groups[0].name.empty() && !mesh().groups[0].color;
    if (one) mesh().groups.clear(), mesh().polygon_groups.clear();
    tags_.finish(polygon_numbers_, mesh(), file_.notes);
    simplify_layout(mesh());
    if (small_ > 0)
      file_.notes.push_back(std::to_string(small_) + " polygons of fewer than three corners are left out");
    note_others();
  }

  void note_others() {
    static const std::map<std::string, std::string> kMeanings{
        {"l", "lines"}, {"p", "marked points"}, {"vt", "texture coordinates"}};
    static constexpr std::string_view kFreeForm =
        " cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con vp ";
    std::size_t free_form = 0;
    for (const auto& [key, count] : others_) {
      if (kFreeForm.find(" " + key + " ") != kFreeForm.npos) free_form += count;
      if (const auto known = kMeanings.find(key); known != kMeanings.end())
        file_.notes.push_back(std::to_string(count) + " " + known->second + " are not used");
    }
    if (free_form > 0) file_.notes.push_back("free-form curves and surfaces of an OBJ file are not read");
  }

  static constexpr std::size_t kMostOthers = 1000, kMostLibraries = 100;
  static constexpr std::uint32_t kNoPolygon = ObjTags::kNoPolygon;

  TextCursor text_;
  const FindFile& find_file_;
  Status status_;
  MeshFile file_;
  VertexColors colors_;
  ObjTags tags_;
  bool known_group_ = false;
  std::string object_, group_, material_;
  std::uint32_t group_number_ = 0;
  std::map<std::tuple<std::string, std::string, std::string>, std::uint32_t> group_numbers_;
  std::vector<std::string> group_materials_;
  std::map<std::string, Color, std::less<>> materials_;
  std::set<std::string> libraries_;
  std::vector<std::uint32_t> polygon_numbers_;  ///< by the file's order, where some are left out
  Ahead vertices_ahead_, normals_ahead_;
  std::size_t small_ = 0;
  std::map<std::string, std::size_t> others_;
};

}  // namespace

Result<MeshFile> read_obj(std::string_view bytes, const FindFile& find_file) {
  return ObjReader(bytes, find_file).run();
}

}  // namespace dupin::mesh_files
