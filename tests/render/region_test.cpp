// The shaders' region test against its twin on the CPU (sampling/region.cpp): random footprints, lines, arcs,
// ellipses and planes on planes and on curved quadrics, drawn small and large, every pixel of a picture a
// test point.
#include "../../render/view.h"
#include "device.h"
#include "oracle.h"
#include "random_regions.h"

namespace dupin::testing {
namespace {

/// Pixels whose centres the boundary passes within rounding; a picture has a few hundred pixels of boundary.
constexpr int kAtBoundary = 2;

struct RegionCase {
  const char* name;
  bool planar;
  int most_corners;
  double nearest, farthest;  ///< the DP is 2 wide
};

class Regions : public ::testing::TestWithParam<RegionCase> {};

TEST_P(Regions, OfShadersAreThoseOfTheCpu) {
  const RegionCase& c = GetParam();
  TestDevice gl;
  int covered = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    RandomRegions random{std::mt19937(seed)};
    HandMade made;
    made.add(random.dp(made.pieces(), c.planar, c.most_corners));
    made.place({});
    const Camera camera = random.camera(made.pieces().dps[0], random.real(c.nearest, c.farthest));
    const auto scene = gl.upload(made);
    DrawOptions options;
    options.outputs = kEverything;
    for (const bool edges : {true, false}) {
      options.edges = edges;
      const Differences d = differences(made, camera, gl.draw(*scene, camera, options));
      EXPECT_LE(d.coverage, kAtBoundary) << c.name << ", seed " << seed << (edges ? ", edges" : "");
      EXPECT_LE(d.depth_px, 0.02) << c.name << ", seed " << seed;
      covered += d.covered;
    }
    options.outputs = kScreen;
    options.edges = false;
    const std::uint64_t by_ids = gl.draw(*scene, camera, options).stats.covered_pixels;
    options.outputs = kFace;
    EXPECT_EQ(by_ids, gl.draw(*scene, camera, options).stats.covered_pixels) << c.name << ", seed " << seed;
  }
  EXPECT_GT(covered, 1000);
}

INSTANTIATE_TEST_SUITE_P(Drawing, Regions,
                         ::testing::Values(RegionCase{"PlanesLarge", true, 8, 3, 6},
                                           RegionCase{"PlanesOfManyPieces", true, 40, 3, 8},
                                           RegionCase{"PlanesSmall", true, 8, 15, 60},
                                           RegionCase{"CurvedLarge", false, 6, 3, 6},
                                           RegionCase{"CurvedOfManyPieces", false, 30, 3, 8},
                                           RegionCase{"CurvedSmall", false, 6, 15, 60}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace dupin::testing
