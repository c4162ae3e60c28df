// Differential points and splats as a layer.
#ifndef DUPIN_RENDER_POINT_LAYER_H
#define DUPIN_RENDER_POINT_LAYER_H

#include "layer.h"

namespace dupin {

std::shared_ptr<Layer> make_point_layer(const PointContent& content);

}  // namespace dupin

#endif
