// The reader of `.dps` under mutated files, with their checksums made good again, so that what lies behind
// them is reached: each is refused as unreadable or read into valid points. Runs for DUPIN_FUZZ_SECONDS (2
// unless told otherwise) from the files in corpus/ and from freshly written ones; a file that breaks it is
// named in the failure and belongs into corpus/.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "../../simplify/crc32c.h"
#include "../../simplify/dps_file.h"
#include "points.h"

namespace dupin::testing {
namespace {

using Bytes = std::vector<unsigned char>;

std::uint32_t word_at(const Bytes& b, std::size_t at) {
  std::uint32_t v = 0;
  std::memcpy(&v, b.data() + at, 4);
  return v;
}
void set_word(Bytes& b, std::size_t at, std::uint32_t v) {
  std::memcpy(b.data() + at, &v, 4);
}

/// Puts in the checksums that the bytes as they are ask for, as far as their structure can be followed.
void make_checksums_good(Bytes& b) {
  if (b.size() < 36) return;
  set_word(b, 32, crc32c(b.data(), 32));
  std::uint32_t crcs = 0;
  std::size_t at = 36;
  while (at + 104 <= b.size() && std::memcmp(b.data() + at, "CHNK", 4) == 0) {
    const std::size_t end = at + 100 + word_at(b, at + 8);
    if (end + 4 > b.size() || end < at) return;
    set_word(b, end, crc32c(b.data() + at, end - at));
    crcs = crc32c(b.data() + end, 4, crcs);
    at = end + 4;
  }
  if (at + 20 <= b.size()) set_word(b, at + 16, crc32c(b.data() + at, 16, crcs));
}

void mutate(Bytes& b, std::mt19937& random) {
  const auto any = [&](std::size_t n) {
    return static_cast<std::ptrdiff_t>(random() % std::max<std::size_t>(n, 1));
  };
  for (auto times = 1 + random() % 4; times > 0 && !b.empty(); --times) {
    const std::ptrdiff_t at = any(b.size());
    static const double kNumbers[] = {0, -1, 1e308, -1e308, 1e-320, std::nan(""), INFINITY, 1, 65537};
    switch (random() % 6) {
      case 0:
        b[static_cast<std::size_t>(at)] ^= static_cast<unsigned char>(1U << random() % 8);
        break;
      case 1:
        b[static_cast<std::size_t>(at)] = static_cast<unsigned char>(random());
        break;
      case 2:
        b.resize(static_cast<std::size_t>(at));
        break;
      case 3:
        b.insert(b.begin() + at, static_cast<unsigned char>(random()));
        break;
      case 4:
        b.erase(
            b.begin() + at,
            b.begin() + at + std::min<std::ptrdiff_t>(any(20), static_cast<std::ptrdiff_t>(b.size()) - at));
        break;
      default:
        if (b.size() >= 8)
          std::memcpy(b.data() + any(b.size() - 7), &kNumbers[any(std::size(kNumbers))],
                      random() % 2 ? 8 : 4);
    }
  }
}

bool holds(const DpsContent& content) {
  for (const DpsChunk& group : content.groups)
    for (const DifferentialPoint& p : group.points)
      if (!is_finite(p.position) || !is_finite(p.n()) || !(p.half_u > 0) || !(p.half_v > 0) ||
          !std::isfinite(p.lambda_u))
        return false;
  return true;
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  for (const auto& entry : std::filesystem::directory_iterator(DUPIN_DPS_CORPUS))
    if (entry.path().extension() == ".dps") all.push_back(bytes_of(entry.path().string()));
  for (const DpsEncoding encoding : {DpsEncoding::raw, DpsEncoding::packed})
    for (const bool sizes : {false, true}) {
      const std::string path = scratch_file("seed.dps");
      auto writer = DpsWriter::create(path, {encoding, kEpsilon, kDelta});
      const auto points = random_points(5, 9, sizes);
      EXPECT_TRUE(writer->add({}, points).ok() && writer->add({{1, 2, 3}, {}}, points).ok() &&
                  writer->finish().ok());
      all.push_back(bytes_of(path));
    }
  return all;
}

TEST(DpsFuzz, NoMutatedFileBreaksTheReader) {
  const char* text = std::getenv("DUPIN_FUZZ_SECONDS");
  const double seconds = text ? std::atof(text) : 2;
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Bytes> from = seeds();
  const std::string path = scratch_file("fuzzed.dps");
  std::mt19937 random(text ? static_cast<unsigned>(start.time_since_epoch().count()) : 1);
  std::size_t read_well = 0, refused = 0;
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds) {
    for (int i = 0; i < 100; ++i) {
      Bytes bytes = from[random() % from.size()];
      mutate(bytes, random);
      if (random() % 8 != 0) make_checksums_good(bytes);
      write_bytes(path, bytes);
      const auto content = read_dps(path);
      if (content.ok()) ++read_well;
      if (content.ok() && holds(*content)) continue;
      if (content.ok()) {
        std::filesystem::copy_file(path, "dps-fuzz-failure.dps",
                                   std::filesystem::copy_options::overwrite_existing);
        FAIL() << "read what is not valid; kept as dps-fuzz-failure.dps";
      }
      ++refused;
      ASSERT_EQ(content.status().code, StatusCode::unreadable);
    }
  }
  EXPECT_GT(read_well, 0U) << "mutations never get past the checks";
  EXPECT_GT(refused, 0U);
}

}  // namespace
}  // namespace dupin::testing
