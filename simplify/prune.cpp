#include "prune.h"

#include <algorithm>
#include <atomic>
#include <memory>

#include "../core/parallel.h"
#include "neighbors.h"

namespace dupin {
namespace {

/// A neighbour, and the pair's term of eq. 6.
struct Neighbor {
  std::uint32_t point;
  float similarity;
};

/// Memory for neighbour lists: in lumps, never given back before the end, lists of outgrown size used again.
class Arena {
 public:
  Neighbor* take(std::uint32_t capacity) {
    for (std::size_t k = 0; k < free_.size(); ++k)
      if ((kLeast << k) == capacity && !free_[k].empty()) {
        Neighbor* list = free_[k].back();
        free_[k].pop_back();
        return list;
      }
    if (left_ < capacity) {
      left_ = std::max<std::size_t>(kLump, capacity);
      lumps_.push_back(std::make_unique<Neighbor[]>(left_));
      next_ = lumps_.back().get();
    }
    Neighbor* list = next_;
    next_ += capacity;
    left_ -= capacity;
    return list;
  }
  void give_back(Neighbor* list, std::uint32_t capacity) {
    std::size_t k = 0;
    while ((kLeast << k) < capacity) ++k;
    if (k < free_.size()) free_[k].push_back(list);
  }
  static constexpr std::uint32_t kLeast = 8;

 private:
  static constexpr std::size_t kLump = 1 << 14;
  std::vector<std::unique_ptr<Neighbor[]>> lumps_;
  std::array<std::vector<Neighbor*>, 12> free_;
  Neighbor* next_ = nullptr;
  std::size_t left_ = 0;
};

struct List {
  Neighbor* at = nullptr;
  std::uint32_t size = 0, capacity = 0;
  Neighbor* begin() const { return at; }
  Neighbor* end() const { return at + size; }
};

/// A binary heap of points, the most redundant on top; of equal ones the first.
class Heap {
 public:
  Heap(const std::vector<double>& keys, std::vector<std::uint32_t>& places) : keys_(keys), places_(places) {}
  void build(std::vector<std::uint32_t> points) {
    heap_ = std::move(points);
    for (std::uint32_t i = 0; i < heap_.size(); ++i) places_[heap_[i]] = i;
    for (std::size_t i = heap_.size() / 2; i-- > 0;) sink(static_cast<std::uint32_t>(i));
  }
  bool empty() const { return heap_.empty(); }
  std::uint32_t pop() {
    const std::uint32_t top = heap_.front();
    places_[top] = kNoPoint;
    const std::uint32_t last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) {
      heap_[0] = last;
      places_[last] = 0;
      sink(0);
    }
    return top;
  }
  /// After the key has changed; nothing for a point that is not in the heap.
  void update(std::uint32_t point) {
    const std::uint32_t i = places_[point];
    if (i == kNoPoint) return;
    rise(i);
    sink(places_[point]);
  }

 private:
  bool before(std::uint32_t a, std::uint32_t b) const {
    return keys_[a] != keys_[b] ? keys_[a] > keys_[b] : a < b;
  }
  void put(std::uint32_t i, std::uint32_t point) {
    heap_[i] = point;
    places_[point] = i;
  }
  void rise(std::uint32_t i) {
    const std::uint32_t point = heap_[i];
    for (; i > 0 && before(point, heap_[(i - 1) / 2]); i = (i - 1) / 2) put(i, heap_[(i - 1) / 2]);
    put(i, point);
  }
  void sink(std::uint32_t i) {
    const std::uint32_t point = heap_[i];
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t child = 2 * i + 1; child < size; child = 2 * i + 1) {
      if (child + 1 < size && before(heap_[child + 1], heap_[child])) ++child;
      if (!before(heap_[child], point)) break;
      put(i, heap_[child]);
      i = child;
    }
    put(i, point);
  }

  const std::vector<double>& keys_;
  std::vector<std::uint32_t>& places_;  // of each point in heap_, or kNoPoint
  std::vector<std::uint32_t> heap_;
};

/// A part's pruning, in steps so that several parts' can be shared out among threads.
class Pruner {
 public:
  Pruner(const PartPoints& part, const PruneOptions& options)
      : options_(options),
        rectangles_(part.points.size()),
        lists_(part.points.size()),
        sums_(part.points.size(), 0),
        redundancy_(part.points.size(), 0),
        places_(part.points.size(), kNoPoint),
        marks_(part.points.size(), kNoPoint),
        keep_(part.points.size(), true),
        at_border_(part.points.size(), false),
        blocks_(make_blocks(part)),
        arenas_(blocks_.points.size() + 1) {
    parallel_for(
        rectangles_.size(), [&](std::size_t i) { rectangles_[i] = rectangle_of(part.points[i], options); },
        1024);
    fill_lists(neighbor_pairs(part, rectangles_, options));
  }

  std::size_t block_count() const { return blocks_.points.size(); }

  /// Points that have all their neighbours in a block. Blocks may be worked on at once.
  void prune_block(std::size_t block) {
    std::vector<std::uint32_t> inner;
    for (const std::uint32_t p : blocks_.points[block])
      if (!at_border_[p]) inner.push_back(p);
    prune_some(std::move(inner), static_cast<std::uint32_t>(block), arenas_[block]);
  }

  /// When all blocks are done: the points between them, or all that are left.
  void prune_rest() {
    std::vector<std::uint32_t> rest;
    for (std::uint32_t p = 0; p < keep_.size(); ++p)
      if (keep_[p] && (at_border_[p] || options_.second_chance)) rest.push_back(p);
    prune_some(std::move(rest), kAllBlocks, arenas_.back());
  }

  std::vector<bool> result() const { return {keep_.begin(), keep_.end()}; }

 private:
  static constexpr std::uint32_t kAllBlocks = kNoPoint;
  /// What one thread works with.
  struct Scratch {
    std::vector<Shadow> shadows;
    std::vector<Neighbor> neighbors;
    std::vector<std::pair<double, std::uint32_t>> nearest;
    ExactEnclosure enclosure;
    std::uint32_t block = kAllBlocks;  ///< only its points are touched
  };

  void fill_lists(const NeighborPairs& pairs) {
    const auto add_pair = [&](const Pair& pair) {
      const auto [a, b] = pair;
      const auto s = static_cast<float>(similarity(rectangles_[a], rectangles_[b]));
      add(a, {b, s}, arenas_[blocks_.block[a]]);
      add(b, {a, s}, arenas_[blocks_.block[b]]);
      if (blocks_.block[a] != blocks_.block[b]) at_border_[a] = at_border_[b] = true;
    };
    // Grids have no block in common.
    parallel_for(pairs.in_grids.size(), [&](std::size_t g) {
      for (const Pair& pair : pairs.in_grids[g]) add_pair(pair);
    });
    for (const Pair& pair : pairs.others) add_pair(pair);
    for (std::uint32_t p = 0; p < lists_.size(); ++p) refresh(p);
  }

  void add(std::uint32_t point, Neighbor neighbor, Arena& arena) {
    List& list = lists_[point];
    if (list.size == list.capacity) {
      const std::uint32_t capacity = std::max(Arena::kLeast, 2 * list.capacity);
      Neighbor* larger = arena.take(capacity);
      std::copy(list.begin(), list.end(), larger);
      if (list.capacity) arena.give_back(list.at, list.capacity);
      list.at = larger;
      list.capacity = capacity;
    }
    list.at[list.size++] = neighbor;
    sums_[point] += neighbor.similarity;
  }

  void remove(std::uint32_t point, std::uint32_t neighbor) {
    List& list = lists_[point];
    for (Neighbor& n : list)
      if (n.point == neighbor) {
        sums_[point] -= n.similarity;
        n = list.at[--list.size];
        return;
      }
  }

  void refresh(std::uint32_t point) {
    const List& list = lists_[point];
    redundancy_[point] = list.size ? sums_[point] / list.size : 0;
  }

  bool enclosed(std::uint32_t p, Scratch& scratch) const {
    const Rectangle& own = rectangles_[p];
    scratch.shadows.clear();
    for (const Neighbor& n : lists_[p]) scratch.shadows.push_back(project(rectangles_[n.point], own));
    const Vec2 half{own.half_u, own.half_v};
    if (options_.enclosure == EnclosureTest::segments) return segments_enclosed(half, scratch.shadows);
    return scratch.enclosure(half, scratch.shadows);
  }

  /// The neighbours of p that may become each other's, the nearest first.
  void find_nearest(std::uint32_t p, Scratch& scratch) const {
    scratch.nearest.clear();
    for (const Neighbor& n : scratch.neighbors) {
      const Vec3 d = rectangles_[n.point].position - rectangles_[p].position;
      scratch.nearest.push_back({dot(d, d), n.point});
    }
    const std::size_t most = std::min(options_.reconnected, scratch.nearest.size());
    std::partial_sort(scratch.nearest.begin(), scratch.nearest.begin() + static_cast<std::ptrdiff_t>(most),
                      scratch.nearest.end());
    scratch.nearest.resize(most);
  }

  /// Eq. 5: p's neighbours lose it, and those of them that overlap become each other's.
  void take_out(std::uint32_t p, Heap& heap, Arena& arena, Scratch& scratch) {
    keep_[p] = false;
    scratch.neighbors.assign(lists_[p].begin(), lists_[p].end());
    for (const Neighbor& n : scratch.neighbors) remove(n.point, p);
    find_nearest(p, scratch);
    for (std::size_t i = 0; i < scratch.nearest.size(); ++i) {
      const std::uint32_t a = scratch.nearest[i].second;
      for (const Neighbor& n : lists_[a])
        if (scratch.block == kAllBlocks || blocks_.block[n.point] == scratch.block) marks_[n.point] = a;
      for (std::size_t k = i + 1; k < scratch.nearest.size(); ++k) {
        const std::uint32_t b = scratch.nearest[k].second;
        if (marks_[b] == a || !related(rectangles_[a], rectangles_[b], options_)) continue;
        const auto s = static_cast<float>(similarity(rectangles_[a], rectangles_[b]));
        add(a, {b, s}, arena);
        add(b, {a, s}, arena);
      }
    }
    for (const Neighbor& n : scratch.neighbors) {
      refresh(n.point);
      heap.update(n.point);
    }
    arena.give_back(lists_[p].at, lists_[p].capacity);
    lists_[p] = {};
  }

  void prune_some(std::vector<std::uint32_t> points, std::uint32_t block, Arena& arena) {
    Scratch scratch;
    scratch.block = block;
    Heap heap(redundancy_, places_);
    heap.build(std::move(points));
    while (!heap.empty()) {
      const std::uint32_t p = heap.pop();
      if (lists_[p].size > 0 && enclosed(p, scratch)) take_out(p, heap, arena, scratch);
    }
  }

  const PruneOptions& options_;
  std::vector<Rectangle> rectangles_;
  std::vector<List> lists_;
  std::vector<double> sums_, redundancy_;
  std::vector<std::uint32_t> places_, marks_;
  std::vector<char> keep_, at_border_;  // bytes: threads write to neighbouring ones
  Blocks blocks_;
  std::vector<Arena> arenas_;
};

/// Puts the kept points in place of all.
void keep_only(PartPoints& part, const std::vector<bool>& keep) {
  std::vector<std::uint32_t> place(part.points.size(), kNoPoint);
  std::vector<DifferentialPoint> points;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) {
      place[i] = static_cast<std::uint32_t>(points.size());
      points.push_back(part.points[i]);
    }
  part.pruned = part.pruned || points.size() < part.points.size();
  part.points = std::move(points);
  for (std::uint32_t& p : part.grid_points)
    if (p != kNoPoint) p = place[p];
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& [a, b] : part.edges)
    if (keep[a] && keep[b]) edges.push_back({place[a], place[b]});
  part.edges = std::move(edges);
}

}  // namespace

PruneOptions papers_prune_options() {
  PruneOptions options;
  options.enclosure = EnclosureTest::segments;
  options.scale_down = 0.15;
  options.slant = 0;
  options.across_patches = false;
  options.grid_neighbors = 8;
  options.reconnected = static_cast<std::size_t>(-1);
  options.second_chance = false;
  return options;
}

namespace {

Status check(const PruneOptions& options) {
  if (!(options.scale_down >= 0 && options.scale_down < 1))
    return {StatusCode::invalid_argument, "rectangles can be made smaller by 0 to 1, less than all of them"};
  if (!(options.slant >= 0)) return {StatusCode::invalid_argument, "a slant's tangent is at least 0"};
  if (options.grid_neighbors != 8 && options.grid_neighbors != 24)
    return {StatusCode::invalid_argument, "a sample has 8 or 24 first neighbours"};
  return {};
}

}  // namespace

Result<std::vector<std::vector<bool>>> points_to_keep(const std::vector<PartPoints>& parts,
                                                      const PruneOptions& options) {
  if (const Status status = check(options); !status.ok()) return status;
  std::vector<std::unique_ptr<Pruner>> pruners(parts.size());
  parallel_for(parts.size(),
               [&](std::size_t i) { pruners[i] = std::make_unique<Pruner>(parts[i], options); });
  std::vector<std::array<std::size_t, 2>> blocks;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t b = 0; b < pruners[i]->block_count(); ++b) blocks.push_back({i, b});
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stop{false};
  const auto step = [&](double steps) {
    if (!report(options.progress, "simplify", static_cast<double>(++done) / steps)) stop = true;
  };
  const double steps = static_cast<double>(blocks.size() + parts.size());
  parallel_for(blocks.size(), [&](std::size_t i) {
    if (stop) return;
    pruners[blocks[i][0]]->prune_block(blocks[i][1]);
    step(steps);
  });
  parallel_for(parts.size(), [&](std::size_t i) {
    if (stop) return;
    pruners[i]->prune_rest();
    step(steps);
  });
  if (stop) return {StatusCode::cancelled, ""};
  std::vector<std::vector<bool>> keep;
  for (const auto& pruner : pruners) keep.push_back(pruner->result());
  return keep;
}

Status prune(PointScene& scene, const PruneOptions& options) {
  const auto keep = points_to_keep(scene.parts, options);
  if (!keep) return keep.status();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) keep_only(scene.parts[i], (*keep)[i]);
  return {};
}

}  // namespace dupin
