// Pictures in files: what is written is read back, and failures leave nothing.
#include "../../render/image.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

namespace dupin::testing {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    char name[] = "/tmp/dupin-image-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), fs::directory_iterator{}));
  }

 private:
  std::string path_;
};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Image8 gradient(int channels) {
  Image8 image{37, 23, channels, {}};
  for (int i = 0; i < 37 * 23 * channels; ++i)
    image.values.push_back(static_cast<std::uint8_t>(i * 7 + i / 11));
  return image;
}

TEST(Png, ReturnsWhatWasWritten) {
  const Folder folder;
  for (const int channels : {1, 3, 4}) {
    const Image8 image = gradient(channels);
    ASSERT_TRUE(write_png(folder / "a.png", image).ok());
    const auto back = read_png(folder / "a.png");
    ASSERT_TRUE(back.ok()) << back.status().message;
    EXPECT_EQ(back->channels, channels);
    EXPECT_EQ(back->values, image.values);
  }
}

TEST(Png, EncodesEveryLevelToItsNearest) {
  Image image{256, 1, {}};
  for (const char* name : {"R", "G", "B"})
    for (int i = 0; i < 256; ++i) {
      const double s = i / 255.0;
      image.channel(name).values[static_cast<std::size_t>(i)] =
          static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
  const Image8 bytes = to_image8(image);
  ASSERT_EQ(bytes.channels, 3);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(bytes.values[3 * i], i);
}

TEST(Png, AlphaIsStraightInFilesAndPremultipliedInMemory) {
  Image image{1, 1, {}};
  image.channel("R").values[0] = 0.25F;
  image.channel("A").values[0] = 0.5F;
  const Image8 bytes = to_image8(image);
  ASSERT_EQ(bytes.channels, 4);
  EXPECT_EQ(bytes.values[0], 188);  // linear ½
  EXPECT_EQ(bytes.values[3], 128);
  EXPECT_NEAR(to_image(bytes).find("R")->values[0], 0.25, 0.003);
}

TEST(Exr, ReturnsWhatWasWritten) {
  const Folder folder;
  Image image{31, 17, {}};
  image.pixel_per_depth = 1.25e-3;
  for (const char* name : {"R", "Z", "N.X", "id"}) {
    std::vector<float>& v = image.channel(name).values;
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i] = name[0] == 'i' ? static_cast<float>(i * 1000) : static_cast<float>(i) * 0.37F - 3;
  }
  image.channel("Z").values[5] = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(write_exr(folder / "a.exr", image).ok());
  const auto back = read_image(folder / "a.exr");
  ASSERT_TRUE(back.ok()) << back.status().message;
  EXPECT_EQ(back->pixel_per_depth, image.pixel_per_depth);
  for (const Image::Channel& channel : image.channels) {
    ASSERT_TRUE(back->find(channel.name)) << channel.name;
    EXPECT_EQ(back->find(channel.name)->values, channel.values) << channel.name;
  }
}

TEST(Files, TheSamePictureGivesTheSameBytes) {
  const Folder folder;
  Image image{64, 64, {}};
  for (std::size_t i = 0; i < image.pixels(); ++i) image.channel("R").values[i] = static_cast<float>(i);
  ASSERT_TRUE(write_exr(folder / "a.exr", image).ok());
  ASSERT_TRUE(write_exr(folder / "b.exr", image).ok());
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
  ASSERT_TRUE(write_png(folder / "a.png", gradient(3)).ok());
  ASSERT_TRUE(write_png(folder / "b.png", gradient(3)).ok());
  EXPECT_EQ(bytes_of(folder / "a.png"), bytes_of(folder / "b.png"));
}

TEST(Files, AFailureLeavesNothingBehind) {
  const Folder folder;
  EXPECT_EQ(write_png(folder / "missing/a.png", gradient(3)).code, StatusCode::cannot_write);
  fs::create_directory(folder / "here.png");
  EXPECT_EQ(write_png(folder / "here.png", gradient(3)).code, StatusCode::cannot_write);
  EXPECT_EQ(write_exr(folder / "here.png", Image{1, 1, {{"R", {0}}}}).code, StatusCode::cannot_write);
  EXPECT_EQ(folder.files(), 1U);
  EXPECT_TRUE(write_png("/dev/null", gradient(3)).ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Files, NewFilesHaveTheUsualRightsAndOldOnesKeepTheirs) {
  const Folder folder;
  const mode_t mask = umask(022);
  ASSERT_TRUE(write_png(folder / "a.png", gradient(3)).ok());
  struct stat info {};
  stat((folder / "a.png").c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0644U);
  chmod((folder / "a.png").c_str(), 0660);
  ASSERT_TRUE(write_png(folder / "a.png", gradient(3)).ok());
  stat((folder / "a.png").c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0660U);
  umask(mask);
}

TEST(Files, DamagedOnesAreUnreadable) {
  const Folder folder;
  ASSERT_TRUE(write_png(folder / "a.png", gradient(3)).ok());
  ASSERT_TRUE(write_exr(folder / "a.exr", Image{64, 64, {{"R", std::vector<float>(4096, 1.5F)}}}).ok());
  for (const char* name : {"a.png", "a.exr"}) {
    const std::string whole = bytes_of(folder / name);
    for (const std::size_t keep : {std::size_t{0}, std::size_t{3}, std::size_t{20}, whole.size() / 2}) {
      std::ofstream(folder / "cut", std::ios::binary).write(whole.data(), static_cast<std::streamsize>(keep));
      EXPECT_EQ(read_image(folder / "cut").status().code, StatusCode::unreadable) << name << " " << keep;
    }
  }
  EXPECT_EQ(read_image(folder / "none").status().code, StatusCode::unreadable);
}

}  // namespace
}  // namespace dupin::testing
