// Dense sampling of a scene against the exact faces, in double precision and by other means than the
// sampler's: is every point of every face drawn, is anything drawn that is not the face, and does every bound
// hold?
#ifndef DUPIN_TESTS_SAMPLING_MODEL_CHECK_H
#define DUPIN_TESTS_SAMPLING_MODEL_CHECK_H

#include <string>
#include <vector>

#include "../../sampling/quadric_dp.h"

namespace dupin::test {

struct FaceReport {
  std::uint32_t part = 0, face = 0;
  std::string kind;
  int points = 0;             ///< of the face's interior, away from its trims
  int uncovered = 0;          ///< of those, in no DP's region
  int drawn = 0;              ///< points drawn by the face's DPs
  int outside = 0;            ///< of those, farther outside the trims than the margin
  int unresolved = 0;         ///< of those, whose nearest surface point was not found
  double worst_position = 0;  ///< largest distance over its certified bound (plus rounding)
  double worst_normal = 0;
  int dps = 0;
};

struct CheckOptions {
  int points_per_face = 200;
  int points_per_dp = 9;  ///< a side of the grid over each footprint
  int most_dps_per_face = 200;
  double margin = 0;     ///< model units: points nearer to a trim than this are left out
  double tolerance = 0;  ///< what the scene was made with
};

std::vector<FaceReport> check_scene(const Model& model, const DpScene& scene, const CheckOptions& options);

}  // namespace dupin::test

#endif
