// How surfaces become domains: options of `dupin render --primitive amg`.
#ifndef DUPIN_APP_AMG_OPTIONS_H
#define DUPIN_APP_AMG_OPTIONS_H

#include <string>

namespace CLI {
class App;
}

namespace dupin::app {

struct AmgOptions {
  int level = -1;  ///< 0 is the coarsest; -1: by --tolerance
  int neighbors = 50;
  double spacing = 0;      ///< of points on exact faces, model units; 0: chosen from the picture
  double texel = 0;        ///< model units; 0: the points' spacing
  std::string save, load;  ///< .dom files
  std::string blend = "surface";
  bool normal_maps = true, heights = true;

  /// Of what says how domains are made.
  bool made_given() const { return level >= 0 || neighbors != 50 || spacing > 0 || texel > 0; }
  bool given() const {
    return made_given() || !save.empty() || !load.empty() || blend != "surface" || !normal_maps || !heights;
  }
};

void add_amg_options(CLI::App& command, AmgOptions& options);

}  // namespace dupin::app

#endif
