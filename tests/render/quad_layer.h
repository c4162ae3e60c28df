// A layer for tests: flat squares, each in a face of its own.
#ifndef DUPIN_TESTS_RENDER_QUAD_LAYER_H
#define DUPIN_TESTS_RENDER_QUAD_LAYER_H

#include "../../render/layer.h"

namespace dupin::testing {

struct Quad {
  std::uint32_t part = 0, face = 0;
  Vec3 center, u, v;     ///< half sides; the normal is u × v
  float k1 = 0, k2 = 0;  ///< what its curvatures are said to be; u is the first one's direction
};

/// The quads are to be sorted by part.
std::shared_ptr<Layer> make_quad_layer(std::vector<Quad> quads);

}  // namespace dupin::testing

#endif
