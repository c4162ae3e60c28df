// Trees' cache files under mutations, with checksums made good again so that what lies behind them is
// reached: each is refused as unreadable or safe to walk and to unpack. Runs for half of DUPIN_FUZZ_SECONDS
// (4 unless told otherwise, always the same mutations) from the files in corpus/ and from trees made here; a
// file that breaks it is kept as tree-fuzz-failure.dpt and belongs into corpus/.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "../../simplify/point_tree.h"
#include "../../simplify/point_tree_bytes.h"
#include "../../simplify/point_tree_layout.h"
#include "../mutations.h"
#include "meshes.h"

namespace dupin {
namespace {

using Tree = std::shared_ptr<const PointTree>;

std::string bytes_of(const PolygonMesh& mesh, PointTreeKind kind) {
  PointTreeOptions options;
  options.kind = kind;
  options.source = {"a part", "mm", 25.4};
  const auto tree = build_point_tree(mesh, options);
  EXPECT_TRUE(tree.ok());
  return {(*tree)->bytes().begin(), (*tree)->bytes().end()};
}

std::vector<std::string> seeds() {
  PolygonMesh colored = test::terrain(5);
  for (std::size_t i = 0; i < colored.positions.size(); ++i)
    colored.colors.push_back({static_cast<std::uint8_t>(i), 100, 7, 255});
  PolygonMesh grouped = test::terrain(4), points;
  grouped.groups = {{"a", Color{}}, {"b", std::nullopt}};
  grouped.polygon_groups.assign(grouped.polygon_count(), 1);
  points.positions = colored.positions;
  std::vector<std::string> all{bytes_of(colored, PointTreeKind::pop), bytes_of(grouped, PointTreeKind::pop),
                               bytes_of(test::ball(9), PointTreeKind::pop),
                               bytes_of(colored, PointTreeKind::qsplat),
                               bytes_of(points, PointTreeKind::qsplat)};
  for (const auto& entry : std::filesystem::directory_iterator(DUPIN_DPS_CORPUS)) {
    if (entry.path().extension() != ".dpt") continue;
    std::ifstream in(entry.path(), std::ios::binary);
    all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return all;
}

/// As far as the structure can be followed.
void make_checksums_good(std::string& bytes) {
  PointTreeHeader h;
  if (bytes.size() < sizeof h) return;
  std::memcpy(&h, bytes.data(), sizeof h);
  const ByteRange pages = h.sections[kPages];
  if (pages.offset >= sizeof h && pages.offset <= bytes.size() && pages.size <= bytes.size() - pages.offset) {
    const auto paged = std::span(bytes).subspan(sizeof h, pages.offset - sizeof h);
    for (std::size_t i = 0; i < pages.size / 8 && i * kPointTreePage < paged.size(); ++i) {
      const std::size_t first = i * kPointTreePage;
      const std::uint64_t sum =
          page_checksum(paged.subspan(first, std::min<std::size_t>(kPointTreePage, paged.size() - first)));
      std::memcpy(bytes.data() + pages.offset + 8 * i, &sum, 8);
    }
  }
  h.checksum = page_checksum(std::span(bytes).first(sizeof h - sizeof h.checksum));
  std::memcpy(bytes.data() + offsetof(PointTreeHeader, checksum), &h.checksum, 8);
}

/// "" if everything can be looked at.
std::string fault_of(const PointTree& tree) {
  MeshBlock block;
  for (std::uint64_t i = 0; i < tree.info().nodes; ++i) {
    const auto node = tree.nodes(i, 1);
    if (!node.empty() && !is_finite(decode(node[0]).normal)) return "a normal that is none";
    (void)tree.curvature(i);
  }
  for (std::uint64_t i = 0; i < tree.info().leaves; ++i)
    if (tree.leaf_group(i) > 0 && tree.leaf_group(i) >= tree.groups().size()) return "a group out of range";
  for (std::size_t i = 0; i < tree.block_count(); ++i)
    if (tree.block(i, block))
      for (const auto& t : block.triangles)
        for (const std::uint16_t v : t)
          if (v >= block.vertices.size()) return "a vertex out of range";
  const auto mesh = unpack_mesh(tree);
  return mesh.ok() ? check(*mesh).message : "";
}

TEST(PointTreeFuzz, NoMutatedFileBreaksWhoWalksIt) {
  const char* text = std::getenv("DUPIN_FUZZ_SECONDS");
  const double seconds = (text ? std::atof(text) : 4) / 2;
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::string> from = seeds();
  std::mt19937 random(text ? static_cast<unsigned>(start.time_since_epoch().count()) : 1);
  std::size_t opened = 0, refused = 0;
  const auto try_out = [&](const std::string& bytes) -> std::string {
    const auto tree = PointTree::from_bytes(std::make_shared<OwnedBytes>(bytes, false));
    ++(tree.ok() ? opened : refused);
    const std::string fault = tree.ok()                       ? fault_of(**tree)
                              : tree.status().message.empty() ? "refused without a word"
                                                              : "";
    if (!fault.empty()) std::ofstream("tree-fuzz-failure.dpt", std::ios::binary) << bytes;
    return fault;
  };
  for (const std::string& seed : from) ASSERT_EQ(try_out(seed), "");
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds)
    for (int i = 0; i < 20; ++i) {
      std::string bytes = from[random() % from.size()];
      // Half of them in the header, where everything else is referred to.
      std::string head = bytes.substr(0, std::min(bytes.size(), sizeof(PointTreeHeader)));
      if (random() % 2) {
        const std::size_t size = head.size();
        test::mutate(head, random);
        head.resize(size);
        bytes.replace(0, size, head);
      } else {
        test::mutate(bytes, random);
      }
      if (random() % 8 != 0) make_checksums_good(bytes);
      ASSERT_EQ(try_out(bytes), "") << "kept as tree-fuzz-failure.dpt";
    }
  EXPECT_GT(opened, 50u) << "mutations never get past the checks";
  EXPECT_GT(refused, 50u);
}

}  // namespace
}  // namespace dupin
