// Whether two pictures of the same surfaces are shaded alike, whatever their surfaces' errors.
#ifndef DUPIN_APP_STUDY_AGREEMENT_H
#define DUPIN_APP_STUDY_AGREEMENT_H

#include <cstdint>

#include "../../render/image.h"

namespace dupin::app {

/// Pixels where both see the same place: both cover them, with depths closer than kAgreeingDepthPx pixels and
/// normals within kAgreeingDegrees. There the same camera, colors and lights give the same color.
struct Agreement {
  std::uint64_t pixels = 0;
  /// The largest channel's difference of those pixels, of 255 (sRGB); 0 without pixels.
  double color_p99 = 0, color_max = 0;
};
inline constexpr double kAgreeingDepthPx = 0.5, kAgreeingDegrees = 0.1;

/// Both with R, G, B, Z and N.X, N.Y, N.Z, else nothing agrees.
Agreement agreement(const Image& reference, const Image& picture);

}  // namespace dupin::app

#endif
