// Domain primitives (simplify/domain_primitives.h) as a layer.
#ifndef DUPIN_RENDER_DOMAIN_LAYER_H
#define DUPIN_RENDER_DOMAIN_LAYER_H

#include "layer.h"

namespace dupin {

/// `content.scene` is not needed after the layer's upload.
std::shared_ptr<Layer> make_domain_layer(const DomainContent& content);

}  // namespace dupin

#endif
