// What the 13 bytes of a packed record lose.
#ifndef DUPIN_BENCH_PAPERS_ENCODING_H
#define DUPIN_BENCH_PAPERS_ENCODING_H

#include "../../sampling/differential_point.h"

namespace dupin::bench {

/// The largest over all points; see dp_codec.h for what they may be.
struct EncodingErrors {
  double position = 0;  ///< in a coordinate, as a part of the box of the point's chunk
  double normal_degrees = 0, direction_degrees = 0;
  /// Of λu, relative, and of ρ; where |λu| is above kLeastCurvature of the chunk's largest.
  double curvature = 0, rho = 0;
};

/// Every point packed and unpacked, in chunks as a .dps file has them; the scene becomes what was decoded.
EncodingErrors pack_and_unpack(PointScene& scene);

}  // namespace dupin::bench

#endif
