// The options of a row are those of `dupin render`, read by its own parser.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "../render_primitive.h"
#include "../tree_files.h"
#include "study.h"

namespace dupin::app {
namespace {

constexpr std::array kGivenElsewhere{"output",    "stats", "view",        "eye",        "target",
                                     "up-vector", "fov",   "height",      "resolution", "repeat",
                                     "device",    "aov",   "orthographic"};
constexpr std::array kLooks{"shading", "samples", "edges", "light", "color", "background"};
/// What the exact ray caster does not know.
constexpr std::array kNotExact{"shading", "samples", "edges", "light"};

struct Applies {
  const char* key;
  std::vector<std::string_view> primitives;
};
/// Options that `dupin render` takes with any primitive but that mean something for these alone.
const std::vector<Applies>& restricted() {
  static const std::vector<Applies> table{
      {"tolerance", {"auto", "quadric", "amg"}},
      {"normal-tolerance", {"auto", "quadric", "amg"}},
      {"deflection", {"triangles", "pop", "qsplat"}},
      {"splat-size", {"auto", "quadric", "pop", "qsplat"}},
      {"splatting", {"auto", "quadric", "pop", "qsplat"}},
      {"silhouette", {"auto", "quadric", "pop", "qsplat"}},
      {"point-shading", {"dp"}},
  };
  return table;
}

template <class List>
bool holds(const List& list, const std::string& key) {
  return std::find(std::begin(list), std::end(list), key) != std::end(list);
}

/// A flag that is not set, where that has to be said.
std::string unset(const std::string& key) {
  return key == "edges" ? "--no-edges" : "";
}

/// As words of a command line.
std::vector<std::string> words(const StudyRow& row) {
  std::vector<std::string> list{row.model.path, "--output=study.exr"};
  if (row.value_of("edges").empty()) list.emplace_back("--no-edges");
  for (const auto& [key, value] : row.options) {
    if (value == "true")
      list.push_back("--" + key);
    else if (value != "false")
      list.push_back("--" + key + "=" + value);
    else if (const std::string word = unset(key); !word.empty())
      list.push_back(word);
  }
  return list;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row.back();
}

std::string nearest_name(const CLI::App& app, const std::string& key) {
  std::string nearest;
  std::size_t least = 3;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      if (const std::size_t d = edit_distance(name, key); d < least) least = d, nearest = name;
  return nearest;
}

Status misfit(const StudyRow& row) {
  const std::string& primitive = row.render.primitive;
  for (const Applies& rule : restricted())
    if (!row.value_of(rule.key).empty() && !holds(rule.primitives, primitive))
      return {StatusCode::invalid_argument,
              std::string(rule.key) + " means nothing to primitive " + primitive};
  return {};
}

/// Points and trees are what they are, and say nothing of the surfaces that they were made of.
Status misfit_of_file(const Study& study, const StudyRow& row) {
  const auto bad = [&](const std::string& why) {
    return Status{StatusCode::invalid_argument, "'" + row.model.name + "' " + why};
  };
  const ModelKind kind = row.model.kind();
  if (kind == ModelKind::cad) return {};
  if (kind == ModelKind::tree && !row.is_prepared() && row.render.primitive != "triangles")
    return bad("is a point tree: it is drawn as pop, qsplat or triangles, not as " + row.render.primitive);
  if (!row.value_of("deflection").empty()) return bad("is drawn as it is: deflection means nothing to it");
  if (kind == ModelKind::points && study.draw && study.reference != ReferenceKind::none &&
      row.model.of.empty())
    return bad(
        "holds points: say of what they are, { file = \"…\", of = \"part.step\" }, or reference = \"none\"");
  return {};
}

}  // namespace

ModelKind StudyModel::kind() const {
  if (path.size() > 4 && path.compare(path.size() - 4, 4, ".dps") == 0) return ModelKind::points;
  return is_tree_file(path) ? ModelKind::tree : ModelKind::cad;
}

bool StudyRow::is_prepared() const {
  const bool tree = render.primitive == "pop" || render.primitive == "qsplat";
  return model.kind() == ModelKind::points || (model.kind() == ModelKind::tree && tree);
}

std::string StudyRow::arguments() const {
  std::string text;
  for (const auto& [key, value] : options) {
    const std::string word = value == "true"    ? "--" + key
                             : value == "false" ? unset(key)
                                                : "--" + key + " " + value;
    if (!text.empty() && !word.empty()) text += ' ';
    text += word;
  }
  return text;
}

std::string StudyRow::value_of(const std::string& key) const {
  for (const auto& [name, value] : options)
    if (name == key) return value;
  return {};
}

std::string check_key(const std::string& key) {
  RenderOptions options;
  CLI::App app;
  add_render_options(app, options);
  if (holds(kGivenElsewhere, key)) return "'" + key + "' is no option of a sweep (views and sizes say it)";
  const CLI::Option* option = app.get_option_no_throw("--" + key);
  if (option && option->get_group() != "Common options") return {};
  const std::string nearest = nearest_name(app, key);
  return "unknown key '" + key + "'" + (nearest.empty() ? "" : "; is '" + nearest + "' meant?");
}

Status resolve_row(const Study& study, StudyRow& row) {
  row.render = RenderOptions();
  CLI::App app;
  add_render_options(app, row.render);
  std::vector<std::string> list = words(row);
  std::reverse(list.begin(), list.end());  // as CLI11 wants them
  try {
    app.parse(list);
  } catch (const CLI::ParseError& error) {
    return {StatusCode::invalid_argument, error.what()};
  }
  row.render.view = row.view.camera;
  row.render.view.resolution = {row.width, row.height};
  if (const Status status = row.render.check(); !status.ok()) return status;
  if (const Status status = misfit(row); !status.ok()) return status;
  if (const Status status = misfit_of_file(study, row); !status.ok()) return status;
  row.looks.clear();
  for (const StudyOption& option : row.options) {
    if (holds(kLooks, option.first)) row.looks.push_back(option);
    if (study.draw && study.reference == ReferenceKind::exact && holds(kNotExact, option.first))
      return {StatusCode::invalid_argument,
              option.first +
                  " needs reference = \"triangles\": the exact reference has the usual light, one "
                  "sample a pixel and no edges"};
  }
  return {};
}

std::pair<std::size_t, std::size_t> shard_range(std::size_t rows, int number, int count) {
  const auto n = static_cast<std::size_t>(number), of = static_cast<std::size_t>(count);
  return {rows * (n - 1) / of, rows * n / of};
}

}  // namespace dupin::app
