// Pictures of the shipped samples as they were when somebody last looked at them (tests/app/golden/). Where
// one differs, the picture drawn and one of the differences are left in the folder that the failure names.
// DUPIN_UPDATE_GOLDEN=1 writes the pictures anew: look at them before they are committed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "../../render/image.h"
#include "../../render/metrics.h"
#include "command.h"

namespace dupin::test {
namespace {

namespace fs = std::filesystem;

/// Another driver may round otherwise, and decide otherwise about a pixel here and there along an outline.
constexpr double kMeanFlip = 0.003, kDifferentPixels = 0.002;
constexpr int kDifferentLevels = 24;

struct Picture {
  std::string name, file;
  std::vector<std::string> options;
  double slack = 1;  ///< stripes move by more than normals do
};

const std::vector<Picture>& pictures() {
  static const std::vector<Picture> kPictures{
      {"bracket", "bracket.step", {}},
      {"bracket_bore",
       "bracket.step",
       {"--eye=-40,-160,110", "--target=0,0,55", "--fov", "25", "--samples", "1"}},
      {"bracket_transparent", "bracket.step", {"--view", "front", "--orthographic", "--background", "none"}},
      {"assembly", "assembly.step", {"--view", "iso"}},
      {"freeform", "freeform.step", {"--view", "iso", "--no-edges"}},
      {"freeform_zebra", "freeform.step", {"--view", "iso", "--shading", "zebra"}, 8},
      {"freeform_gaussian", "freeform.step", {"--view", "top", "--shading", "gaussian"}, 3},
      {"bracket_normals", "bracket.step", {"--view", "iso", "--shading", "normal"}},
      {"bracket_triangles", "bracket.step", {"--primitive", "triangles", "--deflection", "1e-3"}}};
  return kPictures;
}

int different_pixels(const Image8& a, const Image8& b) {
  int count = 0;
  const auto channels = static_cast<std::size_t>(a.channels);
  for (std::size_t i = 0; i < a.values.size(); i += channels) {
    int largest = 0;
    for (std::size_t k = 0; k < channels; ++k)
      largest = std::max(largest, std::abs(a.values[i + k] - b.values[i + k]));
    count += largest > kDifferentLevels;
  }
  return count;
}

/// Leaves the two pictures and their difference where they are found.
std::string keep(const std::string& name, const std::string& golden, const std::string& drawn, const Image& a,
                 const Image& b) {
  const fs::path kept = fs::path(DUPIN_GOLDEN_OUTPUT) / name;
  fs::create_directories(kept);
  fs::copy_file(golden, kept / "golden.png", fs::copy_options::overwrite_existing);
  fs::copy_file(drawn, kept / "drawn.png", fs::copy_options::overwrite_existing);
  const auto difference = difference_picture(a, b, {});
  if (difference.ok()) (void)write_png((kept / "difference.png").string(), *difference);
  return kept.string();
}

void expect_golden(const std::string& name, const std::string& drawn, double slack = 1) {
  const std::string golden = std::string(DUPIN_GOLDEN) + "/" + name + ".png";
  if (std::getenv("DUPIN_UPDATE_GOLDEN")) {
    fs::copy_file(drawn, golden, fs::copy_options::overwrite_existing);
    GTEST_SKIP() << golden << " was written";
  }
  const auto expected = read_png(golden), actual = read_png(drawn);
  ASSERT_TRUE(expected.ok()) << golden << ": " << expected.status().message;
  ASSERT_TRUE(actual.ok()) << actual.status().message;
  ASSERT_EQ(actual->width, expected->width);
  ASSERT_EQ(actual->height, expected->height);
  ASSERT_EQ(actual->channels, expected->channels);
  const Image a = to_image(*expected), b = to_image(*actual);
  const auto difference = compare(a, b, {});
  ASSERT_TRUE(difference.ok() && difference->color) << difference.status().message;
  const int different = different_pixels(*expected, *actual);
  if (difference->color->flip <= slack * kMeanFlip &&
      different <= slack * kDifferentPixels * expected->width * expected->height)
    return;
  ADD_FAILURE() << different << " pixels differ by more than " << kDifferentLevels << " levels, mean FLIP "
                << difference->color->flip << "; see " << keep(name, golden, drawn, a, b);
}

class Golden : public testing::TestWithParam<Picture> {};

TEST_P(Golden, PictureIsAsItWas) {
  const Picture& picture = GetParam();
  const Folder folder;
  const std::string drawn = folder.path("drawn.png");
  std::vector<std::string> arguments{"render", sample(picture.file), "-o", drawn, "--resolution", "320,240"};
  arguments.insert(arguments.end(), picture.options.begin(), picture.options.end());
  const Outcome outcome = run_dupin(arguments);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_golden(picture.name, drawn, picture.slack);
}

INSTANTIATE_TEST_SUITE_P(Render, Golden, testing::ValuesIn(pictures()),
                         [](const auto& info) { return info.param.name; });

// examples/host.cpp: the ring passes in front of the model and behind it, the ground is seen through the
// bore.
TEST(GoldenHost, ModelInAHostsPicture) {
  if (!fs::exists(DUPIN_HOST)) GTEST_SKIP() << "the examples are not built";
  const Folder folder;
  const std::string drawn = folder.path("drawn.png");
  const std::string command = std::string(DUPIN_HOST) + " '" + sample("bracket.step") + "' '" + drawn + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  expect_golden("host", drawn);
}

}  // namespace
}  // namespace dupin::test
