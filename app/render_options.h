// What `dupin render` can be asked for.
#ifndef DUPIN_APP_RENDER_OPTIONS_H
#define DUPIN_APP_RENDER_OPTIONS_H

#include <optional>
#include <string>
#include <vector>

#include "../nurbs/model.h"
#include "../render/tree_layer.h"
#include "amg_options.h"
#include "point_options.h"
#include "session.h"
#include "view.h"

namespace dupin::app {

struct RenderOptions {
  CommonOptions common;
  std::vector<std::string> files;
  std::string output, stats;
  ViewOptions view;
  std::string primitive = "auto";
  double tolerance_px = 0.5, normal_tolerance_degrees = 0.25;
  double deflection = 1e-3;
  int samples = 0;  ///< 0: 4, or 1 for an EXR
  bool edges = true;
  std::string background = "white", color;
  std::vector<std::string> aovs;  ///< empty: color, normal, depth
  std::string shading = "lit", device = "auto";
  int repeat = 1;
  std::vector<double> lights;    ///< x, y, z of each
  std::vector<double> sections;  ///< normal and offset of each
  PointOptions points;
  AmgOptions amg;
  std::string point_shading = "published";
  TreeLayerOptions trees;
  std::string tree_folder;  ///< where meshes' trees are kept; empty: nowhere
  std::string subdivision;  ///< empty: meshes are meshes; else the scheme of cages

  bool exr() const;
  /// The files are .dps.
  bool points_files() const;
  /// Drawn as points: dp or a splat.
  bool draws_points() const;
  std::vector<Vec3> light_positions() const;
  int sample_count() const { return samples > 0 ? samples : exr() ? 1 : 4; }
  /// What is wrong with options that are fine each by itself.
  Status check() const;
  Status check_points() const;
  std::optional<Color> uniform_color() const;
  /// Alpha 0 for none.
  Color background_color() const;
};

void add_render_options(CLI::App& command, RenderOptions& options);

}  // namespace dupin::app

#endif
