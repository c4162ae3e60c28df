// `.dps` files: what is written is read, and what is damaged is refused.
#include "../../simplify/dps_file.h"

#include <gtest/gtest.h>

#include "points.h"

namespace dupin::testing {
namespace {

constexpr DpsColors kRed{{255, 0, 0}, {10, 20, 30}}, kBlue{{0, 0, 255}, {1, 2, 3}};

std::string written(const std::string& name, DpsEncoding encoding, const std::vector<DifferentialPoint>& red,
                    const std::vector<DifferentialPoint>& blue) {
  const std::string path = scratch_file(name);
  auto writer = DpsWriter::create(path, {encoding, kEpsilon, kDelta});
  EXPECT_TRUE(writer.ok());
  EXPECT_TRUE(writer->add(kRed, red).ok());
  EXPECT_TRUE(writer->add(kBlue, blue).ok());
  EXPECT_TRUE(writer->finish().ok());
  EXPECT_EQ(writer->bytes(), bytes_of(path).size());
  return path;
}

class BothEncodings : public ::testing::TestWithParam<DpsEncoding> {};

TEST_P(BothEncodings, AreReadAsTheyWereWritten) {
  const auto red = random_points(40000, 1, true), blue = random_points(17, 2, false);
  const auto content = read_dps(written("both.dps", GetParam(), red, blue));
  ASSERT_TRUE(content.ok()) << content.status().message;
  EXPECT_EQ(content->header.epsilon, kEpsilon);
  EXPECT_EQ(content->header.delta, kDelta);
  ASSERT_EQ(content->groups.size(), 2U);
  EXPECT_EQ(content->groups[0].colors, kRed);
  EXPECT_EQ(content->groups[1].colors, kBlue);
  ASSERT_EQ(content->groups[0].points.size(), red.size());
  const bool raw = GetParam() == DpsEncoding::raw;
  for (std::size_t i = 0; i < red.size(); ++i) {
    const DifferentialPoint &p = red[i], &q = content->groups[0].points[i];
    ASSERT_LT(distance(p.position, q.position), raw ? 1e-5 : 1e-3);
    ASSERT_LT(distance(p.n(), q.n()), raw ? 1e-6 : 5e-3);
    ASSERT_NEAR(q.lambda_u, p.lambda_u, (raw ? 1e-6 : 1e-3) * std::abs(p.lambda_u) + 1e-4);
    ASSERT_EQ(q.own_size, p.own_size);
  }
}

TEST_P(BothEncodings, HaveTheBytesThatThePapersCount) {
  const auto points = random_points(10000, 3, false);
  const std::size_t record = GetParam() == DpsEncoding::raw ? 62 : 13;
  EXPECT_EQ(bytes_of(written("sized.dps", GetParam(), points, {})).size(),
            36 + 100 + 4 + 20 + record * points.size());
}

TEST_P(BothEncodings, AreTheSameBytesEveryTime) {
  const auto points = random_points(3000, 4, true);
  EXPECT_EQ(bytes_of(written("one.dps", GetParam(), points, points)),
            bytes_of(written("two.dps", GetParam(), points, points)));
}

TEST_P(BothEncodings, WithAnyByteChangedOrCutAreRefused) {
  const auto whole =
      bytes_of(written("whole.dps", GetParam(), random_points(9, 5, true), random_points(4, 6, false)));
  const std::string path = scratch_file("damaged.dps");
  std::mt19937 random(1);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    auto damaged = whole;
    damaged[i] ^= static_cast<unsigned char>(1 + random() % 255);
    write_bytes(path, damaged);
    const auto read = read_dps(path);
    ASSERT_FALSE(read.ok()) << "byte " << i;
    ASSERT_EQ(read.status().code, StatusCode::unreadable);
    damaged.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i));
    write_bytes(path, damaged);
    ASSERT_EQ(read_dps(path).status().code, StatusCode::unreadable) << "cut at " << i;
  }
  auto longer = whole;
  longer.push_back(0);
  write_bytes(path, longer);
  EXPECT_EQ(read_dps(path).status().code, StatusCode::unreadable);
}

TEST_P(BothEncodings, MissingOrExchangedChunksAreNoticed) {
  const auto points = random_points(20, 7, false);
  const auto whole = bytes_of(written("chunks.dps", GetParam(), points, random_points(20, 8, false)));
  const std::size_t chunk = (whole.size() - 36 - 20) / 2;
  const auto begin = whole.begin() + 36;
  const auto at = [&](std::size_t n) { return begin + static_cast<std::ptrdiff_t>(n); };
  std::vector<unsigned char> missing(whole.begin(), begin), exchanged(whole.begin(), begin);
  missing.insert(missing.end(), at(chunk), whole.end());
  exchanged.insert(exchanged.end(), at(chunk), at(2 * chunk));
  exchanged.insert(exchanged.end(), at(0), at(chunk));
  exchanged.insert(exchanged.end(), at(2 * chunk), whole.end());
  for (const auto& bytes : {missing, exchanged}) {
    write_bytes(scratch_file("missing.dps"), bytes);
    EXPECT_EQ(read_dps(scratch_file("missing.dps")).status().code, StatusCode::unreadable);
  }
}

INSTANTIATE_TEST_SUITE_P(Dps, BothEncodings, ::testing::Values(DpsEncoding::raw, DpsEncoding::packed),
                         [](const auto& info) { return info.param == DpsEncoding::raw ? "raw" : "packed"; });

TEST(DpsFile, NoFileAndAnEmptyOneAreRefused) {
  EXPECT_EQ(read_dps(scratch_file("none.dps")).status().code, StatusCode::unreadable);
  write_bytes(scratch_file("empty.dps"), {});
  EXPECT_EQ(read_dps(scratch_file("empty.dps")).status().code, StatusCode::unreadable);
  EXPECT_EQ(DpsWriter::create("/no/such/folder/x.dps", {}).status().code, StatusCode::cannot_write);
}

TEST(DpsFile, WithoutAPointIsAFile) {
  const auto content = read_dps(written("nothing.dps", DpsEncoding::packed, {}, {}));
  ASSERT_TRUE(content.ok());
  EXPECT_TRUE(content->groups.empty());
}

}  // namespace
}  // namespace dupin::testing
