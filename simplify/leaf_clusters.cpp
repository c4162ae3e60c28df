#include "leaf_clusters.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "../core/parallel.h"

namespace dupin {
namespace {

constexpr std::size_t kChunk = 4096;  ///< triangles whose neighbours are looked for among each other
constexpr std::uint32_t kNone = 0xffffffffu;
constexpr int kMortonBits = 14;  ///< an axis

std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

/// Stable, by digits of 14 bits.
void radix_sort(std::vector<Keyed>& items) {
  constexpr int kDigit = kMortonBits;
  std::vector<Keyed> other(items.size());
  std::vector<std::uint32_t> starts(std::size_t{1} << kDigit);
  for (int shift = 0; shift < 3 * kMortonBits; shift += kDigit) {
    std::fill(starts.begin(), starts.end(), 0);
    for (const Keyed& item : items) ++starts[item.key >> shift & ((1U << kDigit) - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& s : starts) sum += std::exchange(s, sum);
    for (const Keyed& item : items) other[starts[item.key >> shift & ((1U << kDigit) - 1)]++] = item;
    items.swap(other);
  }
}

struct FloatBox {
  std::array<float, 3> lo{}, hi{};
  void add(const FloatBox& b) {
    for (std::size_t i = 0; i < 3; ++i) lo[i] = std::min(lo[i], b.lo[i]), hi[i] = std::max(hi[i], b.hi[i]);
  }
  float diagonal2() const {
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += (hi[i] - lo[i]) * (hi[i] - lo[i]);
    return sum;
  }
};

/// One chunk's triangles, merged step by step into clusters. Triangles are numbered within the chunk.
class ChunkClusters {
 public:
  ChunkClusters(const TreeMesh& mesh, const std::uint32_t* triangles, std::size_t count, const Vec3& origin)
      : mesh_(mesh), triangles_(triangles), count_(count), neighbours_(3 * count, kNone), cluster_(count) {
    find_neighbours();
    for (std::uint32_t i = 0; i < count; ++i) {
      clusters_.push_back({{i}, 1, box_of(triangles[i], origin)});
      cluster_[i] = i;
    }
  }

  void run(std::vector<LeafCluster>& out) {
    merge_all(1, 1);
    merge_all(2, 2);
    merge_all(1, 3);
    for (const Cluster& c : clusters_) {
      if (c.size == 0) continue;
      LeafCluster& leaf = out.emplace_back();
      leaf.size = c.size;
      for (std::uint32_t k = 0; k < c.size; ++k) leaf.triangles[k] = triangles_[c.members[k]];
    }
  }

 private:
  struct Cluster {
    std::array<std::uint32_t, kMostLeafTriangles> members{};
    std::uint32_t size = 0;
    FloatBox box;
  };

  FloatBox box_of(std::uint32_t triangle, const Vec3& origin) const {
    FloatBox box;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh_.position(triangle, k) - origin;
      const std::array<float, 3> f{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      if (k == 0) box = {f, f};
      box.add({f, f});
    }
    return box;
  }

  bool may_join(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t s = triangles_[a], t = triangles_[b];
    return mesh_.closed[s] == mesh_.closed[t] && mesh_.group(s) == mesh_.group(t);
  }

  /// Across each edge the first other triangle that has it and is not taken by another.
  void find_neighbours() {
    struct Slot {
      std::uint64_t key;
      std::uint32_t side;
    };
    constexpr std::uint64_t kFree = ~std::uint64_t{0};
    static_assert((kChunk & (kChunk - 1)) == 0);
    constexpr std::size_t kSlots = 8 * kChunk;
    std::vector<Slot> table(kSlots, {kFree, 0});
    for (std::uint32_t side = 0; side < 3 * count_; ++side) {
      const std::size_t triangle = triangles_[side / 3];
      const int k = static_cast<int>(side % 3);
      const std::uint32_t a = mesh_.place[mesh_.vertex(triangle, k)],
                          b = mesh_.place[mesh_.vertex(triangle, (k + 1) % 3)];
      if (a == b) continue;
      const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
      std::size_t at = (key * 0x9e3779b97f4a7c15u) >> 40 & (kSlots - 1);
      for (; table[at].key != kFree; at = (at + 1) & (kSlots - 1))
        if (table[at].key == key && neighbours_[table[at].side] == kNone) break;
      if (table[at].key == kFree) {
        table[at] = {key, side};
      } else if (table[at].side / 3 != side / 3 && may_join(table[at].side / 3, side / 3)) {
        neighbours_[table[at].side] = side / 3;
        neighbours_[side] = table[at].side / 3;
      }
    }
  }

  template <class F>
  void each_neighbour(const Cluster& c, F&& use) const {
    for (std::uint32_t m = 0; m < c.size; ++m)
      for (std::uint32_t k = 0; k < 3; ++k)
        if (const std::uint32_t n = neighbours_[3 * c.members[m] + k]; n != kNone) use(cluster_[n]);
  }

  std::uint32_t free_neighbours(std::uint32_t of, std::uint32_t most) const {
    std::uint32_t count = 0;
    each_neighbour(clusters_[of], [&](std::uint32_t n) { count += n != of && clusters_[n].size <= most; });
    return count;
  }

  /// Merges clusters of `least` to `most` triangles with such a neighbour: of those that have the fewest
  /// others to go to, the one with which it stays smallest.
  void merge_all(std::uint32_t least, std::uint32_t most) {
    for (std::uint32_t i = 0; i < clusters_.size(); ++i) {
      const Cluster& c = clusters_[i];
      if (c.size < least || c.size > most) continue;
      std::uint32_t best = kNone, best_choices = kNone;
      float best_size = std::numeric_limits<float>::infinity();
      each_neighbour(c, [&](std::uint32_t n) {
        const std::uint32_t size = clusters_[n].size;
        if (n == i || size < least || size > most || size + c.size > kMostLeafTriangles) return;
        FloatBox box = c.box;
        box.add(clusters_[n].box);
        const std::uint32_t choices = free_neighbours(n, most);
        const float diagonal2 = box.diagonal2();
        if (choices > best_choices || (choices == best_choices && !(diagonal2 < best_size))) return;
        best = n, best_choices = choices, best_size = diagonal2;
      });
      if (best != kNone) merge(i, best);
    }
  }

  void merge(std::uint32_t to, std::uint32_t from) {
    Cluster &a = clusters_[to], &b = clusters_[from];
    for (std::uint32_t k = 0; k < b.size; ++k) {
      a.members[a.size++] = b.members[k];
      cluster_[b.members[k]] = to;
    }
    a.box.add(b.box);
    b.size = 0;
  }

  const TreeMesh& mesh_;
  const std::uint32_t* triangles_;
  std::size_t count_;
  std::vector<std::uint32_t> neighbours_;  ///< three a triangle
  std::vector<std::uint32_t> cluster_;     ///< of each triangle
  std::vector<Cluster> clusters_;
};

}  // namespace

std::vector<std::uint32_t> spatial_order(const std::vector<std::array<float, 3>>& points) {
  FloatBox box;
  if (!points.empty()) box = {points[0], points[0]};
  for (const auto& p : points) box.add({p, p});
  float extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, box.hi[k] - box.lo[k]);
  const float scale = extent > 0 ? static_cast<float>((1 << kMortonBits) - 1) / extent : 0;
  std::vector<Keyed> items(points.size());
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        std::uint64_t key = 0;
        for (std::size_t k = 0; k < 3; ++k)
          key |= spread_bits(static_cast<std::uint64_t>((points[i][k] - box.lo[k]) * scale)) << k;
        items[i] = {key, static_cast<std::uint32_t>(i)};
      },
      8192);
  radix_sort(items);
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].index;
  return order;
}

std::vector<LeafCluster> cluster_triangles(const TreeMesh& mesh) {
  const Vec3 origin = mesh.source.positions.empty() ? Vec3{} : mesh.source.positions[0];
  std::vector<std::array<float, 3>> centers(mesh.size());
  parallel_for(
      mesh.size(),
      [&](std::size_t t) {
        const Vec3 c = (mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3 - origin;
        centers[t] = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
      },
      8192);
  const std::vector<std::uint32_t> order = spatial_order(centers);
  const std::size_t chunks = (mesh.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<LeafCluster>> parts(chunks);
  parallel_for(chunks, [&](std::size_t i) {
    const std::size_t first = i * kChunk, count = std::min(kChunk, mesh.size() - first);
    ChunkClusters(mesh, order.data() + first, count, origin).run(parts[i]);
  });
  std::vector<LeafCluster> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace dupin
