#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "../../core/parallel.h"
#include "atlas.h"
#include "folds.h"
#include "incidence.h"
#include "tile.h"

namespace dupin {
namespace {

using amg::Tile;
using amg::TileDomain;
using amg::TileSource;

constexpr double kTexelGrowth = 1.1;

/// Normals to be seen: those given, or of the triangles around each point, weighted by area, on the side of
/// the bases' own.
std::vector<Vec3> shown_normals(const SurfacePoints& points, const DomainBases& bases) {
  std::vector<Vec3> normals(points.size());
  const std::vector<std::uint32_t>& t = bases.triangles();
  if (points.normals.empty())
    for (std::size_t k = 0; k < t.size(); k += 3) {
      const Vec3 &a = points.positions[t[k]],
                 n = cross(points.positions[t[k + 1]] - a, points.positions[t[k + 2]] - a);
      for (std::size_t c = 0; c < 3; ++c) {
        const bool turn = !points.is_mesh() && dot(n, bases.normals()[t[k + c]]) < 0;
        normals[t[k + c]] += turn ? -n : n;
      }
    }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 n = points.normals.empty() ? normals[i] : points.normals[i];
    normals[i] = length(n) > 0 ? normalized(n) : bases.normals()[i];
    if (!(length(normals[i]) > 0.5)) normals[i] = {0, 0, 1};
  }
  return normals;
}

/// Ψ of one domain at a point; 0 where it has none.
double value_at(const DomainBasis& basis, std::uint32_t point, std::uint32_t domain) {
  for (std::uint64_t k = basis.starts[point]; k < basis.starts[point + 1]; ++k)
    if (basis.domain[k] == domain) return basis.value[k];
  return 0;
}

/// Every domain with the triangles that touch it and all of their points.
std::vector<TileDomain> tile_domains(const DomainBasis& basis, const std::vector<Domain>& domains,
                                     const std::vector<std::uint32_t>& triangles) {
  std::vector<TileDomain> tiles(domains.size());
  const amg::Incidence of_point(
      basis.starts.size() - 1,
      domains.size(), [&](std::size_t d) -> const auto& { return domains[d].points; });
  for (std::uint32_t t = 0; t < triangles.size() / 3; ++t)
    for (std::size_t c = 0; c < 3; ++c)
      for (const std::uint32_t d : of_point.lists_with(triangles[3 * t + c]))
        if (tiles[d].triangles.empty() || tiles[d].triangles.back() != t) tiles[d].triangles.push_back(t);
  parallel_for(
      tiles.size(),
      [&](std::size_t d) {
        TileDomain& tile = tiles[d];
        // Only the few corners that are not the domain's own have to be sorted.
        std::vector<std::uint32_t> others;
        for (const std::uint32_t t : tile.triangles)
          for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t p = triangles[3 * std::size_t(t) + c];
            const auto own = of_point.lists_with(p);
            if (std::find(own.begin(), own.end(), static_cast<std::uint32_t>(d)) == own.end())
              others.push_back(p);
          }
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        std::merge(others.begin(), others.end(), domains[d].points.begin(), domains[d].points.end(),
                   std::back_inserter(tile.points));
        amg::find_corners(triangles, tile);
        for (const std::uint32_t p : tile.points)
          tile.values.push_back(static_cast<float>(value_at(basis, p, static_cast<std::uint32_t>(d))));
      },
      4);
  return tiles;
}

/// The lower quartile, which islands far away do not change.
double default_texel(const SurfacePoints& points, const DomainBases& bases) {
  std::vector<double> spacings = bases.spacings();
  const auto quarter = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 4);
  std::nth_element(spacings.begin(), quarter, spacings.end());
  if (*quarter > 0) return *quarter;
  Box3 box;
  for (const Vec3& p : points.positions) box.add(p);
  return box.diagonal() > 0 ? box.diagonal() : 1;
}

std::uint32_t main_face(const SurfacePoints& points, const TileDomain& domain) {
  if (points.faces.empty()) return 0;
  std::map<std::uint32_t, double> weights;
  for (std::size_t k = 0; k < domain.points.size(); ++k)
    weights[points.faces[domain.points[k]]] += domain.values[k];
  return std::max_element(weights.begin(), weights.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

class SetMaker {
 public:
  SetMaker(const SurfacePoints& points, const DomainBases& bases, const DomainPrimitiveOptions& options)
      : points_(points),
        options_(options),
        normals_(shown_normals(points, bases)),
        source_{points,      normals_,        points.is_mesh() || !points.normals.empty(), bases.triangles(),
                bases.rim(), bases.spacings()} {
    set_.texel = options.texel > 0 ? options.texel : default_texel(points, bases);
    set_.points = points.size();
    set_.oriented = source_.oriented;
  }

  Result<DomainSet> run(const DomainBasis& basis) {
    const std::vector<Domain> domains = domains_of(basis);
    unfold(tile_domains(basis, domains, source_.triangles));
    if (Status fitted = fit(); !fitted.ok()) return fitted;
    link(domain_neighbors(domains, points_.size()));
    allocate();
    draw_tiles();
    measure();
    if (stopped_) return {StatusCode::cancelled, ""};
    return std::move(set_);
  }

 private:
  /// Support polygons, with texels so large that all fit into an atlas.
  Status fit() {
    set_.primitives.resize(tiles_.size());
    while (true) {
      parallel_for(
          tiles_.size(),
          [&](std::size_t d) { set_.primitives[d] = amg::support(source_, tiles_[d], set_.texel); }, 4);
      if (amg::pack(set_.primitives, options_.most_atlas, set_.atlas)) break;
      if (set_.primitives.size() * 9.0 > double(options_.most_atlas) * options_.most_atlas)
        return {StatusCode::limit, "more domains than an atlas can hold: choose a coarser level"};
      set_.texel *= kTexelGrowth;
    }
    for (std::size_t d = 0; d < tiles_.size(); ++d) {
      set_.primitives[d].face = main_face(points_, tiles_[d]);
      const DomainPrimitive& p = set_.primitives[d];
      set_.texel = std::max({set_.texel, 2 * p.half_u / p.width, 2 * p.half_v / p.height});
    }
    return {};
  }

  void unfold(const std::vector<TileDomain>& whole) {
    std::vector<std::vector<TileDomain>> pieces(whole.size());
    parallel_for(
        whole.size(), [&](std::size_t d) { pieces[d] = amg::unfolded(source_, whole[d]); }, 4);
    for (std::uint32_t d = 0; d < pieces.size(); ++d)
      for (TileDomain& piece : pieces[d]) {
        tiles_.push_back(std::move(piece));
        domain_of_.push_back(d);
      }
  }

  /// Pieces blend with those pieces of their own and of their domain's neighbors that they have points in
  /// common with.
  void link(const std::vector<std::vector<std::uint32_t>>& neighbors) {
    const amg::Incidence of_point(
        points_.size(), tiles_.size(), [&](std::size_t t) -> const auto& { return tiles_[t].points; });
    std::vector<std::uint32_t> met(tiles_.size(), ~0U);  // the last tile that each was found for
    for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
      const std::uint32_t d = domain_of_[t];
      std::vector<std::uint32_t> found;
      for (const std::uint32_t p : tiles_[t].points)
        for (const std::uint32_t other : of_point.lists_with(p)) {
          if (other == t || met[other] == t) continue;
          met[other] = t;
          if (domain_of_[other] == d ||
              std::binary_search(neighbors[d].begin(), neighbors[d].end(), domain_of_[other]))
            found.push_back(other);
        }
      std::sort(found.begin(), found.end());
      set_.primitives[t].first_neighbor = static_cast<std::uint32_t>(set_.neighbors.size());
      set_.primitives[t].neighbors = static_cast<std::uint32_t>(found.size());
      set_.neighbors.insert(set_.neighbors.end(), found.begin(), found.end());
    }
  }

  void allocate() {
    set_.faces = points_.faces.empty() ? std::vector<std::uint32_t>{0} : points_.faces;
    std::sort(set_.faces.begin(), set_.faces.end());
    set_.faces.erase(std::unique(set_.faces.begin(), set_.faces.end()), set_.faces.end());
    DomainAtlas& atlas = set_.atlas;
    const std::size_t texels = std::size_t(atlas.width) * atlas.height;
    atlas.psi.resize(texels);
    atlas.normal_height.resize(texels, {128, 128, 255, 0});
    if (!points_.colors.empty()) atlas.color.resize(texels);
    if (set_.faces.size() > 1 && set_.faces.back() <= 0xffff)
      atlas.face.resize(texels, static_cast<std::uint16_t>(set_.faces.front()));
  }

  void draw_tiles() {
    deviations_.resize(tiles_.size());
    std::atomic<std::size_t> done{0};
    parallel_for(tiles_.size(), [&](std::size_t d) {
      if (stopped_) return;
      DomainPrimitive& p = set_.primitives[d];
      Tile tile = amg::make_tile(source_, tiles_[d], set_.texel, p);
      copy(tile, p);
      deviations_[d] = std::move(tile.deviations);
      if (!report(options_.progress, "domains", double(++done) / double(tiles_.size()))) stopped_ = true;
    });
  }

  void copy(const Tile& tile, const DomainPrimitive& p) {
    DomainAtlas& atlas = set_.atlas;
    for (std::uint32_t y = 0; y < p.height; ++y)
      for (std::uint32_t x = 0; x < p.width; ++x) {
        const std::size_t from = std::size_t(y) * p.width + x,
                          to = std::size_t(p.y + y) * atlas.width + p.x + x;
        atlas.psi[to] = tile.psi[from];
        atlas.normal_height[to] = tile.normal_height[from];
        if (!atlas.color.empty()) atlas.color[to] = points_.colors[tile.nearest[from]];
        if (!atlas.face.empty())
          atlas.face[to] = static_cast<std::uint16_t>(points_.faces[tile.nearest[from]]);
      }
  }

  void measure() {
    std::vector<float> all;
    for (const auto& some : deviations_) all.insert(all.end(), some.begin(), some.end());
    if (all.empty()) return;
    double sum = 0;
    for (const float d : all) sum += double(d) * d;
    set_.deviation_rms = std::sqrt(sum / static_cast<double>(all.size()));
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), at, all.end());
    set_.deviation_99 = *at;
  }

  const SurfacePoints& points_;
  const DomainPrimitiveOptions& options_;
  std::vector<Vec3> normals_;
  TileSource source_;
  std::vector<TileDomain> tiles_;
  std::vector<std::uint32_t> domain_of_;  // per tile
  std::vector<std::vector<float>> deviations_;
  std::atomic<bool> stopped_{false};
  DomainSet set_;
};

bool valid(const DomainPrimitive& p, const DomainSet& set) {
  const auto unit = [](const Vec3& v) { return std::abs(dot(v, v) - 1) < 1e-6; };
  return is_finite(p.center) && unit(p.u) && unit(p.v) && std::abs(dot(p.u, p.v)) < 1e-6 && p.half_u > 0 &&
         p.half_v > 0 && std::isfinite(p.half_u) && std::isfinite(p.half_v) && std::isfinite(p.lo) &&
         std::isfinite(p.hi) && p.lo <= p.hi && p.width >= 3 && p.height >= 3 && p.width <= kMostDomainTile &&
         p.height <= kMostDomainTile && std::uint64_t(p.x) + p.width <= set.atlas.width &&
         std::uint64_t(p.y) + p.height <= set.atlas.height &&
         std::uint64_t(p.first_neighbor) + p.neighbors <= set.neighbors.size();
}

}  // namespace

Result<DomainSet> make_domain_set(const SurfacePoints& points, const DomainBases& bases, std::size_t level,
                                  const DomainPrimitiveOptions& options) {
  if (Status good = check(points); !good.ok()) return good;
  if (level >= bases.levels() || !(options.texel >= 0) || !std::isfinite(options.texel) ||
      options.most_atlas < 16)
    return {StatusCode::invalid_argument, "no such level of domains, or texels of no such size"};
  if (bases.classifier().size() != points.size())
    return {StatusCode::invalid_argument, "the domains are not those of these points"};
  if (bases.domains(level) > kMostDomains)
    return {StatusCode::limit, "more domains than can be drawn: choose a coarser level"};
  if (points.size() == 0) return DomainSet{};
  return SetMaker(points, bases, options).run(bases.level(level));
}

Status check(const DomainSet& set) {
  const auto bad = [](const char* why) { return Status{StatusCode::invalid_argument, why}; };
  const DomainAtlas& atlas = set.atlas;
  const std::size_t texels = std::size_t(atlas.width) * atlas.height;
  if (set.primitives.size() > kMostDomains) return bad("too many domains");
  if (!std::is_sorted(set.faces.begin(), set.faces.end())) return bad("faces that are not in order");
  if (atlas.psi.size() != texels || atlas.normal_height.size() != texels ||
      (!atlas.color.empty() && atlas.color.size() != texels) ||
      (!atlas.face.empty() && atlas.face.size() != texels))
    return bad("an atlas that is not as large as it says");
  for (const DomainPrimitive& p : set.primitives)
    if (!valid(p, set) || !std::binary_search(set.faces.begin(), set.faces.end(), p.face))
      return bad("a domain that is out of range");
  for (const std::uint32_t n : set.neighbors)
    if (n >= set.primitives.size()) return bad("a neighbor that there is not");
  for (const std::uint16_t f : atlas.face)
    if (!std::binary_search(set.faces.begin(), set.faces.end(), f))
      return bad("a texel of a face that there is not");
  return {};
}

}  // namespace dupin
