#include "folds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace dupin::amg {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class Unfolder {
 public:
  Unfolder(const TileSource& source, const TileDomain& domain) : source_(source), domain_(domain) {
    total_ = std::accumulate(domain.values.begin(), domain.values.end(), 0.0);
    link();
  }

  std::vector<TileDomain> run() {
    const DomainPrimitive plane = support(source_, domain_, std::numeric_limits<double>::max());
    if (is_height_field(plane.n())) return {domain_};
    grow_all();
    merge_small();
    return pieces();
  }

 private:
  std::uint32_t corner(std::size_t triangle, std::size_t k) const {
    return domain_.corners[3 * triangle + k];
  }

  void link() {
    const std::size_t count = domain_.points.size();
    starts_.assign(count + 1, 0);
    for (const std::uint32_t c : domain_.corners) ++starts_[c + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    around_.resize(domain_.corners.size());
    std::vector<std::uint32_t> at(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t k = 0; k < domain_.corners.size(); ++k) around_[at[domain_.corners[k]]++] = k / 3;
    piece_.assign(count, kNone);
  }

  double alike(std::uint32_t point, const Vec3& normal) const {
    const double cosine = dot(source_.normals[domain_.points[point]], normal);
    return source_.oriented ? cosine : std::abs(cosine);
  }

  /// Over triangles from a point to whatever is free and alike; returns the sum of Ψ.
  double grow(std::uint32_t seed, const Vec3& normal, double cosine, std::uint32_t piece) {
    std::vector<std::uint32_t> front{seed};
    piece_[seed] = piece;
    double sum = 0;
    while (!front.empty()) {
      const std::uint32_t p = front.back();
      front.pop_back();
      sum += domain_.values[p];
      for (std::uint32_t k = starts_[p]; k < starts_[p + 1]; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t q = corner(around_[k], c);
          if (piece_[q] != kNone || !(alike(q, normal) > cosine)) continue;
          piece_[q] = piece;
          front.push_back(q);
        }
    }
    return sum;
  }

  /// What hangs together and faces the plane is nearly everything. Points without triangles cannot fold.
  bool is_height_field(const Vec3& n) {
    double largest = 0, alone = 0;
    for (std::uint32_t p = 0; p < piece_.size(); ++p) {
      if (starts_[p] == starts_[p + 1])
        alone += domain_.values[p];
      else if (piece_[p] == kNone && alike(p, n) > kFlatEnoughCosine)
        largest = std::max(largest, grow(p, n, kFlatEnoughCosine, 0));
    }
    std::fill(piece_.begin(), piece_.end(), kNone);
    return largest + alone >= (1 - kSmallestPiece) * total_;
  }

  void grow_all() {
    std::vector<std::uint32_t> seeds(piece_.size());
    std::iota(seeds.begin(), seeds.end(), 0U);
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return domain_.values[a] > domain_.values[b]; });
    for (const std::uint32_t seed : seeds)
      if (piece_[seed] == kNone && starts_[seed] != starts_[seed + 1])
        sums_.push_back(grow(seed, source_.normals[domain_.points[seed]], kPieceCosine,
                             static_cast<std::uint32_t>(sums_.size())));
  }

  bool is_small(std::uint32_t piece) const { return !(sums_[piece] >= kSmallestPiece * total_); }

  /// Points of small pieces join the piece beside them, from its border inwards.
  void merge_small() {
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<std::uint32_t> next = piece_;
      for (std::uint32_t p = 0; p < piece_.size(); ++p) {
        if (piece_[p] == kNone || !is_small(piece_[p])) continue;
        for (std::uint32_t k = starts_[p]; k < starts_[p + 1]; ++k)
          for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t other = piece_[corner(around_[k], c)];
            if (other != kNone && !is_small(other) && (is_small(next[p]) || other < next[p]))
              next[p] = other, changed = true;
          }
      }
      piece_ = std::move(next);
    }
  }

  /// What has no triangles goes with the first.
  std::vector<TileDomain> pieces() const {
    std::vector<std::uint32_t> used = piece_;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    if (used.size() > 1 && used.back() == kNone) used.pop_back();
    std::vector<TileDomain> result;
    for (const std::uint32_t piece : used) result.push_back(one(piece, piece == used.front()));
    return result;
  }

  TileDomain one(std::uint32_t piece, bool first) const {
    std::vector<bool> in(piece_.size());
    for (std::uint32_t p = 0; p < piece_.size(); ++p)
      in[p] = piece_[p] == piece || (first && piece_[p] == kNone);
    std::vector<bool> kept = in;
    TileDomain tile;
    for (std::size_t t = 0; t < domain_.triangles.size(); ++t) {
      if (!in[corner(t, 0)] && !in[corner(t, 1)] && !in[corner(t, 2)]) continue;
      tile.triangles.push_back(domain_.triangles[t]);
      for (std::size_t k = 0; k < 3; ++k) kept[corner(t, k)] = true;
    }
    for (std::uint32_t p = 0; p < piece_.size(); ++p)
      if (kept[p]) tile.points.push_back(domain_.points[p]), tile.values.push_back(domain_.values[p]);
    find_corners(source_.triangles, tile);
    return tile;
  }

  const TileSource& source_;
  const TileDomain& domain_;
  double total_ = 0;
  std::vector<std::uint32_t> starts_, around_;  // triangles around each point
  std::vector<std::uint32_t> piece_;
  std::vector<double> sums_;
};

}  // namespace

std::vector<TileDomain> unfolded(const TileSource& source, const TileDomain& domain) {
  return Unfolder(source, domain).run();
}

}  // namespace dupin::amg
