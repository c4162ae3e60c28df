// Domains that no height field over one plane can show, in pieces that one can.
#ifndef DUPIN_SIMPLIFY_AMG_FOLDS_H
#define DUPIN_SIMPLIFY_AMG_FOLDS_H

#include "tile.h"

namespace dupin::amg {

/// A piece grows over triangles from a point to all whose normals are within 60° of that point's.
inline constexpr double kPieceCosine = 0.5;
/// A domain is whole if normals are so near to its plane's, but for this part of its points (weighted with
/// Ψ); pieces that are smaller go to those beside them.
inline constexpr double kFlatEnoughCosine = 0.25, kSmallestPiece = 0.01;

/// The domain itself where it does not fold. Pieces overlap by the triangles between them, with the domain's
/// Ψ.
std::vector<TileDomain> unfolded(const TileSource& source, const TileDomain& domain);

}  // namespace dupin::amg

#endif
