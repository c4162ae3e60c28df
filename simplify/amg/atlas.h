// Putting rectangles of texels into one.
#ifndef DUPIN_SIMPLIFY_AMG_ATLAS_H
#define DUPIN_SIMPLIFY_AMG_ATLAS_H

#include "../domain_primitives.h"

namespace dupin::amg {

/// Sets x and y of every primitive so that none overlap, in rows ordered by height, and the atlas' width and
/// height. False where they do not fit into `most` × `most`.
bool pack(std::vector<DomainPrimitive>& primitives, std::uint32_t most, DomainAtlas& atlas);

}  // namespace dupin::amg

#endif
