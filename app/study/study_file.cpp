// Study files: TOML, read with the line of whatever is wrong.
#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "../../render/view.h"
#include "study.h"

namespace dupin::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRows = 100000;
constexpr int kLargestPicture = 16384;

int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}
int line_of(const toml::key& key) {
  return static_cast<int>(key.source().begin.line);
}

/// The shortest text that reads back as the same number.
std::string text_of(double x) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  return {text, end};
}

/// One failure stops the reading; the first one is what is told.
class Reader {
 public:
  Reader(std::string name, std::string folder) : name_(std::move(name)), folder_(std::move(folder)) {}

  Result<Study> read(const std::string& text) {
    const toml::parse_result parsed = toml::parse(text, name_);
    if (!parsed) {
      const toml::parse_error& error = parsed.error();
      return fail_at(static_cast<int>(error.source().begin.line), std::string(error.description()));
    }
    read_top(parsed.table());
    if (ok()) read_sweeps(parsed.table());
    if (ok() && study_.rows.empty()) fail(1, "no rows: a study has models and at least one [[sweep]]");
    if (!ok()) return failure_;
    return std::move(study_);
  }

 private:
  struct Axis {
    std::string key;
    int line = 0;
    std::vector<std::string> values;
  };
  /// What the rows of a sweep are made from.
  struct Sweep {
    int line = 0;
    std::vector<StudyModel> models;
    std::vector<StudyView> views;
    std::vector<std::pair<int, int>> sizes;
    std::vector<Axis> axes;
  };

  bool ok() const { return failure_.ok(); }
  Status fail_at(int line, const std::string& why) const {
    return {StatusCode::invalid_argument, name_ + ":" + std::to_string(line) + ": " + why};
  }
  void fail(int line, const std::string& why) {
    if (ok()) failure_ = fail_at(line, why);
  }

  // --- values
  std::string string_at(const toml::node& node, const std::string& what) {
    if (const auto* value = node.as_string()) return value->get();
    fail(line_of(node), what + " must be a string");
    return {};
  }
  double number_at(const toml::node& node, const std::string& what, double least, double most) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) {
      fail(line_of(node), what + " must be a number");
    } else if (!(*value >= least && *value <= most)) {
      fail(line_of(node),
           what + " = " + text_of(*value) + " is not between " + text_of(least) + " and " + text_of(most));
    } else {
      return *value;
    }
    return least;
  }
  int integer_at(const toml::node& node, const std::string& what, int least, int most) {
    if (!node.is_integer()) {
      fail(line_of(node), what + " must be a whole number");
      return least;
    }
    return static_cast<int>(number_at(node, what, least, most));
  }
  bool flag_at(const toml::node& node, const std::string& what) {
    if (const auto* value = node.as_boolean()) return value->get();
    fail(line_of(node), what + " must be true or false");
    return false;
  }
  std::vector<double> triple_at(const toml::node& node, const std::string& what) {
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) {
      fail(line_of(node), what + " must be three numbers");
      return {};
    }
    std::vector<double> numbers;
    for (const toml::node& n : *array) numbers.push_back(number_at(n, what, -1e300, 1e300));
    return numbers;
  }
  /// The elements of an array, or a single value as if it were one.
  static std::vector<const toml::node*> elements(const toml::node& node) {
    std::vector<const toml::node*> list;
    if (const toml::array* array = node.as_array())
      for (const toml::node& n : *array) list.push_back(&n);
    else
      list.push_back(&node);
    return list;
  }
  /// Entries of a table as the file has them.
  static std::vector<std::pair<const toml::key*, const toml::node*>> entries(const toml::table& table) {
    std::vector<std::pair<const toml::key*, const toml::node*>> list;
    for (auto&& [key, node] : table) list.emplace_back(&key, &node);
    const auto place = [](const toml::key* key) {
      const toml::source_position at = key->source().begin;
      return std::pair(at.line, at.column);
    };
    std::stable_sort(list.begin(), list.end(),
                     [&](const auto& a, const auto& b) { return place(a.first) < place(b.first); });
    return list;
  }

  // --- the top of the file
  void read_top(const toml::table& top) {
    for (const auto& [key, node] : entries(top)) {
      const std::string name(key->str());
      if (name == "title")
        study_.title = string_at(*node, name);
      else if (name == "models")
        common_.models = models_at(*node);
      else if (name == "views")
        common_.views = views_at(*node);
      else if (name == "sizes")
        common_.sizes = sizes_at(*node);
      else if (name == "reference")
        read_reference(*node);
      else if (name == "frames")
        study_.frames = integer_at(*node, name, 0, 100000);
      else if (name == "prepares")
        study_.prepares = integer_at(*node, name, 1, 1000);
      else if (name == "row-seconds")
        study_.row_seconds = number_at(*node, name, 0.1, 1e7);
      else if (name == "draw")
        study_.draw = flag_at(*node, name);
      else if (name == "pictures")
        study_.pictures = flag_at(*node, name);
      else if (name != "sweep")
        fail(line_of(*key),
             "unknown key '" + name +
                 "' (title, models, views, sizes, reference, frames, prepares, row-seconds, draw, "
                 "pictures and [[sweep]] are known)");
    }
    if (common_.views.empty()) common_.views = {StudyView{"iso", {}, 1}};
    if (common_.sizes.empty()) common_.sizes = {{512, 512}};
  }

  void read_reference(const toml::node& node) {
    const std::string value = string_at(node, "reference");
    const std::string fine = "triangles:";
    if (value == "exact") {
      study_.reference = ReferenceKind::exact;
    } else if (value == "none") {
      study_.reference = ReferenceKind::none;
    } else if (value == "triangles") {
      study_.reference = ReferenceKind::triangles;
    } else if (value.rfind(fine, 0) == 0) {
      study_.reference = ReferenceKind::triangles;
      const char *first = value.data() + fine.size(), *last = value.data() + value.size();
      const auto [end, error] = std::from_chars(first, last, study_.reference_deflection);
      if (error != std::errc() || end != last ||
          !(study_.reference_deflection >= 1e-9 && study_.reference_deflection <= 1))
        fail(line_of(node), "the reference's deflection must be a number between 1e-09 and 1");
    } else {
      fail(line_of(node), "reference must be \"exact\", \"triangles\", \"triangles:DEFLECTION\" or \"none\"");
    }
  }

  /// ${NAME} from the environment.
  std::string expanded(std::string path, int line) {
    for (std::size_t at; ok() && (at = path.find("${")) != std::string::npos;) {
      const std::size_t end = path.find('}', at);
      if (end == std::string::npos) {
        fail(line, "'" + path + "': ${ without }");
        break;
      }
      const std::string variable = path.substr(at + 2, end - at - 2);
      const char* value = std::getenv(variable.c_str());
      if (!value) fail(line, "the environment has no " + variable);
      path.replace(at, end - at + 1, value ? value : "");
    }
    return path;
  }

  std::vector<StudyModel> models_at(const toml::node& node) {
    std::vector<StudyModel> models;
    for (const toml::node* n : elements(node)) {
      if (const toml::table* table = n->as_table())
        models.push_back(model_table(*table));
      else
        add_models(*n, models);
      if (!ok()) return {};
    }
    return models;
  }
  fs::path path_at(const toml::node& node, const std::string& name) {
    const std::string written = expanded(name, line_of(node));
    const fs::path path = fs::path(written).is_absolute() ? fs::path(written) : fs::path(folder_) / written;
    std::error_code error;
    if (ok() && !fs::exists(path, error)) fail(line_of(node), "model '" + name + "' is not there");
    return path;
  }
  /// A file, or all that are in a folder.
  void add_models(const toml::node& node, std::vector<StudyModel>& models) {
    const std::string name = string_at(node, "a model");
    const fs::path path = ok() ? path_at(node, name) : fs::path();
    if (!ok()) return;
    std::error_code error;
    if (!fs::is_directory(path, error)) return models.push_back({name, path.string(), line_of(node), ""});
    const std::vector<std::string> files = model_files(path.string());
    if (files.empty()) fail(line_of(node), "'" + name + "' holds no models");
    for (const std::string& file : files)
      models.push_back({name + "/" + fs::relative(file, path, error).string(), file, line_of(node), ""});
  }
  /// { file = "part.dps", of = "part.step" }
  StudyModel model_table(const toml::table& table) {
    StudyModel model;
    model.line = line_of(table);
    for (const auto& [key, node] : entries(table)) {
      const std::string name(key->str());
      if (name != "file" && name != "of") {
        fail(line_of(*key), "unknown key '" + name + "' of a model (file, of)");
        break;
      }
      const std::string written = string_at(*node, name);
      const fs::path path = ok() ? path_at(*node, written) : fs::path();
      std::error_code error;
      if (ok() && fs::is_directory(path, error)) fail(line_of(*node), "'" + written + "' is a folder");
      (name == "file" ? model.path : model.of) = path.string();
      if (name == "file") model.name = written;
    }
    if (ok() && model.path.empty()) fail(model.line, "a model's table needs its file");
    if (ok() && !model.of.empty() && model.kind() == ModelKind::cad)
      fail(model.line, "'" + model.name + "' is neither points (.dps) nor a tree (.dpt): 'of' is theirs");
    return model;
  }

  std::vector<StudyView> views_at(const toml::node& node) {
    std::vector<StudyView> views;
    std::set<std::string> names;
    for (const toml::node* n : elements(node)) {
      StudyView view = n->is_table() ? view_table(*n->as_table()) : named_view(string_at(*n, "a view"), *n);
      if (!names.insert(view.name).second) fail(line_of(*n), "two views are called '" + view.name + "'");
      views.push_back(std::move(view));
    }
    return views;
  }
  StudyView named_view(const std::string& name, const toml::node& node) {
    if (ok() && std::find(std::begin(kViewNames), std::end(kViewNames), name) == std::end(kViewNames))
      fail(line_of(node), "no view is called '" + name + "' (iso, front, back, left, right, top, bottom)");
    StudyView view;
    view.name = view.camera.view = name;
    return view;
  }
  StudyView view_table(const toml::table& table) {
    StudyView view;
    for (const auto& [key, node] : entries(table)) {
      const std::string name(key->str());
      if (name == "name")
        view.name = string_at(*node, name);
      else if (name == "view")
        view.camera.view = named_view(string_at(*node, name), *node).name;
      else if (name == "zoom")
        view.zoom = number_at(*node, name, 1e-3, 1e6);
      else if (name == "fov")
        view.camera.fov_degrees = number_at(*node, name, 1e-6, 179);
      else if (name == "orthographic")
        view.camera.orthographic = flag_at(*node, name);
      else if (name == "eye")
        view.camera.eye = triple_at(*node, name);
      else if (name == "target")
        view.camera.target = triple_at(*node, name);
      else if (name == "up-vector")
        view.camera.up = triple_at(*node, name);
      else
        fail(line_of(*key), "unknown key '" + name +
                                "' of a view (name, view, zoom, fov, orthographic, eye, target, up-vector)");
    }
    if (view.name.empty() && !view.camera.eye.empty())
      fail(line_of(table), "a view with an eye needs a name");
    if (view.name.empty()) view.name = view.camera.view;
    if (view.name == view.camera.view && view.zoom != 1) view.name += "*" + text_of(view.zoom);
    return view;
  }

  std::vector<std::pair<int, int>> sizes_at(const toml::node& node) {
    std::vector<std::pair<int, int>> sizes;
    for (const toml::node* n : elements(node)) {
      if (const toml::array* pair = n->as_array()) {
        if (pair->size() != 2) {
          fail(line_of(*n), "a size is a number or [width, height]");
          return {};
        }
        sizes.emplace_back(integer_at(*pair->get(0), "a width", 1, kLargestPicture),
                           integer_at(*pair->get(1), "a height", 1, kLargestPicture));
      } else {
        const int size = integer_at(*n, "a size", 1, kLargestPicture);
        sizes.emplace_back(size, size);
      }
    }
    return sizes;
  }

  // --- sweeps
  void read_sweeps(const toml::table& top) {
    const toml::node* node = top.get("sweep");
    if (!node) return fail(1, "no [[sweep]]: a study has at least one");
    const toml::array* sweeps = node->as_array();
    if (!sweeps) return fail(line_of(*node), "sweeps are written [[sweep]], with two brackets");
    for (const toml::node& n : *sweeps) {
      if (!ok()) return;
      if (const toml::table* table = n.as_table())
        add_rows(sweep_at(*table));
      else
        fail(line_of(n), "a sweep is a table");
    }
  }

  Sweep sweep_at(const toml::table& table) {
    Sweep sweep{line_of(table), common_.models, common_.views, common_.sizes, {}};
    for (const auto& [key, node] : entries(table)) {
      const std::string name(key->str());
      if (name == "models") {
        sweep.models = models_at(*node);
      } else if (name == "views") {
        sweep.views = views_at(*node);
      } else if (name == "sizes") {
        sweep.sizes = sizes_at(*node);
      } else if (const std::string why = check_key(name); !why.empty()) {
        fail(line_of(*key), why);
      } else {
        sweep.axes.push_back({name, line_of(*key), values_at(*node, name)});
        if (std::find(study_.keys.begin(), study_.keys.end(), name) == study_.keys.end())
          study_.keys.push_back(name);
      }
    }
    if (ok() && sweep.models.empty()) fail(sweep.line, "no models: neither here nor at the top of the study");
    return sweep;
  }

  std::vector<std::string> values_at(const toml::node& node, const std::string& key) {
    std::vector<std::string> values;
    for (const toml::node* n : elements(node)) values.push_back(value_at(*n, key));
    if (values.empty()) fail(line_of(node), key + " has no values");
    return values;
  }
  /// A list inside of the list of values is one value: light = [[1, 2, 3]].
  std::string value_at(const toml::node& node, const std::string& key) {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    if (node.is_integer()) return std::to_string(*node.value<std::int64_t>());
    if (node.is_floating_point() && std::isnan(*node.value<double>())) fail(line_of(node), key + " is no number");
    if (node.is_floating_point()) return text_of(*node.value<double>());
    if (const toml::array* array = node.as_array()) {
      std::string text;
      for (const toml::node& n : *array) text += (text.empty() ? "" : ",") + value_at(n, key);
      return text;
    }
    fail(line_of(node), key + " must be a number, a string, true or false, or a list of them");
    return {};
  }

  void add_rows(const Sweep& sweep) {
    if (!ok()) return;
    std::size_t combinations = 1;
    for (const Axis& axis : sweep.axes) combinations *= std::min(axis.values.size(), kMostRows);
    const std::size_t rows = combinations * sweep.models.size() *
                             std::max<std::size_t>(1, sweep.views.size() * sweep.sizes.size());
    if (rows > kMostRows || study_.rows.size() + rows > kMostRows)
      return fail(sweep.line, "more than " + std::to_string(kMostRows) + " rows");
    for (const StudyModel& model : sweep.models)
      for (const StudyView& view : sweep.views)
        for (const auto& [width, height] : sweep.sizes)
          for (std::size_t i = 0; ok() && i < combinations; ++i) {
            StudyRow row;
            row.index = study_.rows.size();
            row.model = model;
            row.view = view;
            row.width = width;
            row.height = height;
            set_options(sweep, i, row);
            add(sweep, std::move(row));
          }
  }

  /// The last key of the sweep varies fastest.
  static void set_options(const Sweep& sweep, std::size_t combination, StudyRow& row) {
    row.options.resize(sweep.axes.size());
    for (std::size_t k = sweep.axes.size(); k-- > 0;) {
      const Axis& axis = sweep.axes[k];
      row.options[k] = {axis.key, axis.values[combination % axis.values.size()]};
      combination /= axis.values.size();
    }
  }

  void add(const Sweep& sweep, StudyRow row) {
    if (const Status status = resolve_row(study_, row); !status.ok()) {
      int line = sweep.line;
      for (const Axis& axis : sweep.axes)
        if (status.message.find(axis.key) != std::string::npos) line = axis.line;
      return fail(line, status.message);
    }
    study_.rows.push_back(std::move(row));
  }

  std::string name_, folder_;
  Study study_;
  Sweep common_;
  Status failure_;
};

}  // namespace

std::vector<std::string> model_files(const std::string& folder) {
  static const std::set<std::string> kEndings{".step",  ".stp", ".iges", ".igs", ".brep", ".brp",
                                              ".fcstd", ".obj", ".ply",  ".stl", ".off"};
  const auto lower = [](const fs::path& path) {
    std::string text = path.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  };
  std::vector<std::string> files;
  std::error_code error;
  for (auto at = fs::recursive_directory_iterator(folder, error); !error && at != fs::end(at);
       at.increment(error)) {
    const fs::path& path = at->path();
    const std::string ending = lower(path) == ".gz" ? lower(path.stem()) : lower(path);
    if (kEndings.count(ending) && at->is_regular_file(error)) files.push_back(path.string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<Study> parse_study(const std::string& text, const std::string& name, const std::string& folder) {
  return Reader(name, folder).read(text);
}

Result<Study> read_study(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code error;
  if (!in || fs::is_directory(path, error)) return {StatusCode::invalid_argument, path + ": cannot be read"};
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  return parse_study(text, path, fs::absolute(path, error).parent_path().string());
}

}  // namespace dupin::app
