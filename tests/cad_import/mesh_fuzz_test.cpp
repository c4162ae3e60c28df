// The readers of mesh files under mutated files: each is refused with a line that says why, or read into a
// mesh that is sound, and nothing asks for memory out of proportion. Runs for half of DUPIN_FUZZ_SECONDS (4
// unless told otherwise, always the same mutations) from the files in corpus/; a file that breaks a reader
// is kept as mesh-fuzz-failure.* and belongs into corpus/.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "../../cad_import/mesh_files/mesh_file.h"
#include "../mutations.h"
#include "allocation_watch.h"

namespace dupin::mesh_files {
namespace {

namespace fs = std::filesystem;

struct Seed {
  std::string kind, bytes;
};

std::vector<Seed> seeds() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(DUPIN_MESH_CORPUS)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Seed> all;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    all.push_back({file.extension().string(), {std::istreambuf_iterator<char>(in), {}}});
  }
  return all;
}

Result<MeshFile> read(const Seed& file) {
  if (file.kind == ".obj")
    return read_obj(file.bytes,
                    [](std::string_view) { return std::optional<std::string>("newmtl red\nKd 1 0 0\n"); });
  if (file.kind == ".ply") return read_ply(file.bytes);
  if (file.kind == ".off") return read_off(file.bytes);
  if (file.kind == ".stl") return read_stl_text(file.bytes);
  return read_stl_binary(file.bytes);  // .stlb
}

/// "" if all is well.
std::string fault_of(const Seed& file, std::map<bool, std::size_t>& outcomes) {
  // A line of a text may make a few hundred bytes of vectors and names; counts alone must make nothing.
  const std::size_t most = 64 * file.bytes.size() + (1U << 20);
  test::watch_allocations();
  const Result<MeshFile> result = read(file);
  if (test::largest_allocation() > most)
    return "asked for " + std::to_string(test::largest_allocation()) + " bytes";
  ++outcomes[result.ok()];
  if (result.ok()) return check(result->mesh).ok() ? "" : check(result->mesh).message;
  if (result.status().code == StatusCode::ok || result.status().message.empty())
    return "refused without a word";
  if (result.status().message.find('\n') != std::string::npos) return "refused with several lines";
  return "";
}

TEST(MeshFuzz, NoMutatedFileBreaksAReader) {
  const char* text = std::getenv("DUPIN_FUZZ_SECONDS");
  const double seconds = (text ? std::atof(text) : 4) / 2;
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Seed> from = seeds();
  ASSERT_GE(from.size(), 8u);
  std::mt19937 random(text ? static_cast<unsigned>(start.time_since_epoch().count()) : 1);
  std::map<bool, std::size_t> outcomes;
  const auto try_out = [&](const Seed& file) {
    const std::string fault = fault_of(file, outcomes);
    if (!fault.empty()) std::ofstream("mesh-fuzz-failure" + file.kind, std::ios::binary) << file.bytes;
    return fault;
  };
  for (const Seed& seed : from) ASSERT_EQ(try_out(seed), "");
  EXPECT_GT(outcomes[true], 5u) << "seeds are sound";
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds)
    for (int i = 0; i < 100; ++i) {
      Seed file = from[random() % from.size()];
      test::mutate(file.bytes, random);
      if (random() % 16 == 0) file.kind = from[random() % from.size()].kind;
      ASSERT_EQ(try_out(file), "") << "kept as mesh-fuzz-failure" << file.kind;
    }
  EXPECT_GT(outcomes[true], 100u) << "mutations never get past the checks";
  EXPECT_GT(outcomes[false], 100u);
}

}  // namespace
}  // namespace dupin::mesh_files
