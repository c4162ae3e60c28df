#include "render_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "../render/renderer.h"
#include "colors.h"
#include "render_primitive.h"

namespace dupin::app {
namespace {

std::string extension(const std::string& path) {
  const auto dot = path.rfind('.');
  if (dot == std::string::npos || path.find('/', dot) != std::string::npos) return {};
  std::string text = path.substr(dot);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_points_file(const std::string& file) {
  return extension(file) == ".dps";
}

std::string joined(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + name;
  return text;
}

/// The primitives that the command's contract names; those of later versions are known so that they can be
/// refused by name.
std::string check_primitive(const std::string& name) {
  static const std::vector<std::string> contract{"auto",    "quadric", "dp",     "square", "rectangle",
                                                 "ellipse", "pop",     "qsplat", "amg",    "triangles"};
  std::vector<std::string> now;
  for (const PrimitiveKind& kind : primitive_kinds())
    now.insert(now.end(), kind.names.begin(), kind.names.end());
  if (std::count(now.begin(), now.end(), name)) return {};
  if (std::count(contract.begin(), contract.end(), name))
    return "--primitive " + name + " is not in this version (" + joined(now, ", ") + " are)";
  return name + " not in {" + joined(now, ",") + "}";
}

std::string check_color(const std::string& text) {
  return parse_color(text) ? std::string{} : "'" + text + "' is no colour: #rrggbb, R,G,B or a CSS name";
}

std::string check_background(const std::string& text) {
  return text == "none" ? std::string{} : check_color(text);
}

void add_quality_options(CLI::App& command, RenderOptions& options) {
  const char* group = "What is drawn";
  command
      .add_option("--primitive", options.primitive,
                  "auto, quadric; dp: the papers' flat differential points; square, rectangle, ellipse: "
                  "splats; amg: textured domains; pop, qsplat: points and triangles of meshes; triangles: "
                  "the tessellated reference")
      ->check(CLI::Validator(check_primitive, ""))
      ->type_name("NAME")
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--tolerance", options.tolerance_px,
                  "Largest geometric error on the screen, in pixels (certified)")
      ->check(CLI::Range(1e-4, 1e3))
      ->type_name("PX")
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--normal-tolerance", options.normal_tolerance_degrees,
                  "Largest angle between a drawn and the true normal, in degrees (certified)")
      ->check(CLI::Range(1e-4, 90.0))
      ->type_name("DEG")
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--deflection", options.deflection,
                  "For triangles: Open CASCADE's linear deflection, as a part of the model's diagonal")
      ->check(CLI::Range(1e-9, 1.0))
      ->type_name("D")
      ->capture_default_str()
      ->group(group);
  command
      .add_flag("--subdivision{auto}", options.subdivision,
                "Meshes are cages of subdivision surfaces, with their files' creases, corners and holes; "
                "=catmull-clark or =loop instead of by their polygons")
      ->check(CLI::IsMember({"auto", "catmull-clark", "loop"}))
      ->group(group);
  add_point_options(command, options.points, false);
  add_amg_options(command, options.amg);
  command
      .add_option(
          "--point-shading", options.point_shading,
          "Of dp: published, by normal maps and light vectors linear over each rectangle, or analytic, "
          "computed for each pixel")
      ->check(CLI::IsMember({"published", "analytic"}))
      ->capture_default_str()
      ->group("Differential points");
  command.add_option("--samples", options.samples, "Samples a pixel (default: 4, for EXR 1)")
      ->check(CLI::Range(1, 64))
      ->type_name("N")
      ->group(group);
}

void add_tree_options(CLI::App& command, RenderOptions& options) {
  const char* group = "Meshes";
  command
      .add_option(
          "--splat-size", options.trees.threshold_px,
          "Largest diameter of what is drawn as a point, in pixels; what is larger is drawn by its triangles")
      ->check(CLI::Range(0.05, 100.0))
      ->type_name("PX")
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<std::string>(
          "--splatting",
          [&options](const std::string& how) { options.trees.reconstruct = how == "visibility"; },
          "simple: discs; visibility: points of one pixel, and the holes between them filled from around")
      ->check(CLI::IsMember({"simple", "visibility"}))
      ->type_name("NAME")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--splat-shape",
          [&options](const std::string& shape) { options.trees.foreshortened = shape == "ellipse"; },
          "ellipse: discs lie in the surface, narrow where it is seen at a slant; circle: as published")
      ->check(CLI::IsMember({"ellipse", "circle"}))
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--tree-cache", options.tree_folder,
                  "A folder in which the trees of mesh files are kept, to be drawn at once the next time")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER")
      ->group(group);
  command
      .add_flag("--silhouette", options.trees.silhouette,
                "Draw triangles, however small, near the silhouette")
      ->group(group);
}

void add_look_options(CLI::App& command, RenderOptions& options) {
  const char* group = "Looks";
  command
      .add_flag("--edges,!--no-edges", options.edges,
                "Draw the edges in which faces meet at an angle (default)")
      ->group(group);
  command.add_option("--background", options.background, "A colour, or none")
      ->check(CLI::Validator(check_background, ""))
      ->type_name("COLOR")
      ->capture_default_str()
      ->group(group);
  command.add_option("--color", options.color, "Draw everything in this colour (default: the file's)")
      ->check(CLI::Validator(check_color, ""))
      ->type_name("COLOR")
      ->group(group);
  command
      .add_option("--light", options.lights,
                  "A point light in model space, in place of those around the camera; up to 8 times")
      ->delimiter(',')
      ->type_name("X,Y,Z")
      ->group(group);
  command
      .add_option("--section", options.sections,
                  "Cut the model open: only X·x + Y·y + Z·z + D >= 0 is drawn; up to 6 times")
      ->delimiter(',')
      ->type_name("X,Y,Z,D")
      ->group(group);
  command
      .add_option(
          "--shading", options.shading,
          "What the colour shows; of --primitive amg also its domains, mixed with their weights, and the "
          "classifier, black at edges")
      ->check(CLI::IsMember({"lit", "normal", "k1", "k2", "mean", "gaussian", "zebra", "face", "primitive",
                             "domains", "classifier"}))
      ->capture_default_str()
      ->group(group);
}

}  // namespace

bool RenderOptions::points_files() const {
  return !files.empty() && std::all_of(files.begin(), files.end(), is_points_file);
}

bool RenderOptions::draws_points() const {
  if (primitive == "auto") return points_files();
  return primitive == "dp" || primitive == "square" || primitive == "rectangle" || primitive == "ellipse";
}

std::vector<Vec3> RenderOptions::light_positions() const {
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i + 2 < lights.size(); i += 3)
    positions.push_back({lights[i], lights[i + 1], lights[i + 2]});
  return positions;
}

bool RenderOptions::exr() const {
  return extension(output) == ".exr";
}

Status RenderOptions::check() const {
  const auto bad = [](std::string why) { return Status{StatusCode::invalid_argument, std::move(why)}; };
  if (!exr() && extension(output) != ".png") return bad(output + ": a picture's name ends in .png or .exr");
  if (!exr() && !aovs.empty()) return bad("--aov goes with an EXR; a PNG shows --shading");
  if (lights.size() % 3 != 0 || lights.size() / 3 > kMostLights)
    return bad("--light takes X,Y,Z, up to " + std::to_string(kMostLights) + " times");
  if (sections.size() % 4 != 0 || sections.size() / 4 > kMostSections)
    return bad("--section takes X,Y,Z,D, up to " + std::to_string(kMostSections) + " times");
  if (primitive != "amg" && (amg.given() || shading == "domains" || shading == "classifier"))
    return bad("options of domains go with --primitive amg");
  if (!amg.load.empty() &&
      (amg.made_given() || !amg.save.empty() || shading == "domains" || shading == "classifier"))
    return bad("the domains of --amg-load are drawn as they are");
  return check_points();
}

Status RenderOptions::check_points() const {
  const auto bad = [](std::string why) { return Status{StatusCode::invalid_argument, std::move(why)}; };
  const bool any = std::any_of(files.begin(), files.end(), is_points_file);
  if (any && !points_files()) return bad(".dps files are drawn with other .dps files only");
  if (any && !draws_points()) return bad("a .dps file is drawn as dp, square, rectangle or ellipse");
  if (any && points.given()) return bad("the points of a .dps file are drawn as they are");
  if (!draws_points() && (points.given() || point_shading != "published"))
    return bad("options of differential points go with --primitive dp, square, rectangle or ellipse");
  if (const Status status = points.check(); !status.ok()) return status;
  return {};
}

std::optional<Color> RenderOptions::uniform_color() const {
  return color.empty() ? std::nullopt : parse_color(color);
}

Color RenderOptions::background_color() const {
  return parse_color(background).value_or(Color{0, 0, 0, 0});
}

void add_render_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("FILE", options.files,
                  "STEP, IGES, BREP, FCStd, OBJ, PLY, STL, OFF or .dpt; several become one picture")
      ->required();
  command.add_option("-o,--output", options.output, "The picture: .png or .exr")
      ->required()
      ->type_name("FILE");
  command.add_option("--stats", options.stats, "Write what was done, as JSON")->type_name("FILE.json");
  add_view_options(command, options.view);
  add_quality_options(command, options);
  add_tree_options(command, options);
  add_look_options(command, options);
  command
      .add_option("--aov", options.aovs,
                  "Channels of an EXR: color, normal, depth, position, curvature, direction, face, "
                  "primitive, uv (default: color,normal,depth)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(
          {"color", "normal", "depth", "position", "curvature", "direction", "face", "primitive", "uv"}))
      ->type_name("NAME,...")
      ->group("Looks");
  command.add_option("--device", options.device, "Where to draw: auto (EGL, then OSMesa), egl, osmesa")
      ->check(CLI::IsMember({"auto", "egl", "osmesa"}))
      ->capture_default_str()
      ->group("Looks");
  command.add_option("--repeat", options.repeat, "Draw N frames, for timing")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->capture_default_str()
      ->group("Looks");
  add_common_options(command, options.common);
}

}  // namespace dupin::app
