#include "amg_options.h"

#include <CLI/CLI.hpp>

namespace dupin::app {

void add_amg_options(CLI::App& command, AmgOptions& options) {
  const char* group = "Domains (--primitive amg)";
  command
      .add_option("--amg-level", options.level,
                  "Level of domains; 0 is the coarsest (default: by --tolerance)")
      ->check(CLI::Range(0, 100))
      ->type_name("L")
      ->group(group);
  command.add_option("--amg-neighbors", options.neighbors, "Points that the classifier looks at around each")
      ->check(CLI::Range(3, 1000))
      ->type_name("K")
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--amg-spacing", options.spacing,
                  "Distance of points on exact faces, in model units (default: a pixel)")
      ->check(CLI::Range(1e-12, 1e12))
      ->type_name("LENGTH")
      ->group(group);
  command
      .add_option("--amg-texel", options.texel,
                  "Edge of a texel, in model units (default: the points' distance)")
      ->check(CLI::Range(1e-12, 1e12))
      ->type_name("LENGTH")
      ->group(group);
  command.add_option("--amg-save", options.save, "Keep the domains in a file, for --amg-load")
      ->type_name("FILE.dom")
      ->group(group);
  command.add_option("--amg-load", options.load, "Draw the domains that --amg-save kept of the same model")
      ->type_name("FILE.dom")
      ->group(group);
  command
      .add_option("--amg-blend", options.blend,
                  "How domains become one surface: surface (blended at each pixel's place), published (flat, "
                  "front to "
                  "back, blended with neighbours, then locked), opaque (the nearest)")
      ->check(CLI::IsMember({"surface", "published", "opaque"}))
      ->capture_default_str()
      ->group(group);
  command
      .add_flag("--amg-normal-maps,!--no-amg-normal-maps", options.normal_maps,
                "Light by normal maps (default)")
      ->group(group);
  command
      .add_flag("--amg-heights,!--no-amg-heights", options.heights,
                "Draw heights above domains' planes (default)")
      ->group(group);
}

}  // namespace dupin::app
