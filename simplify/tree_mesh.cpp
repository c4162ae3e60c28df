#include "tree_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "../core/parallel.h"
#include "../nurbs/mesh_triangles.h"

namespace dupin {
namespace {

constexpr std::size_t kGrain = 8192;

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (const double x : {p.x + 0.0, p.y + 0.0, p.z + 0.0}) {  // -0 is 0
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return h;
}

/// The first vertex at each vertex's place.
std::vector<std::uint32_t> find_places(const std::vector<Vec3>& positions) {
  constexpr std::uint32_t kFree = 0xffffffffu;
  std::vector<std::uint32_t> hashes(positions.size()), place(positions.size());
  parallel_for(
      positions.size(), [&](std::size_t i) { hashes[i] = static_cast<std::uint32_t>(hash(positions[i])); },
      kGrain);
  const std::size_t slots = std::bit_ceil(2 * positions.size() + 1);
  std::vector<std::uint32_t> table(slots, kFree);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    std::size_t at = hashes[i] & (slots - 1);
    while (table[at] != kFree && !(positions[table[at]] == positions[i])) at = (at + 1) & (slots - 1);
    if (table[at] == kFree) table[at] = i;
    place[i] = table[at];
  }
  return place;
}

/// Places that are joined by triangles, as trees with a root each.
class Components {
 public:
  explicit Components(std::size_t places) : parent_(places) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// For each place the places that edges run to from it, and those that edges come from.
class EdgeEnds {
 public:
  explicit EdgeEnds(const TreeMesh& mesh) : starts_(mesh.place.size() + 1, 0) {
    const auto each_edge = [&](auto&& use) {
      for (std::size_t t = 0; t < mesh.size(); ++t) {
        const std::uint32_t v[3] = {mesh.place[mesh.vertex(t, 0)], mesh.place[mesh.vertex(t, 1)],
                                    mesh.place[mesh.vertex(t, 2)]};
        for (int k = 0; k < 3; ++k)
          if (v[k] != v[(k + 1) % 3]) use(v[k], v[(k + 1) % 3]);
      }
    };
    // As many leave a place as come to it wherever triangles have three corners, but not where they are
    // degenerate.
    std::vector<std::uint32_t> in(mesh.place.size(), 0);
    each_edge([&](std::uint32_t a, std::uint32_t b) { ++starts_[a + 1], ++in[b]; });
    same_degree_ = std::equal(in.begin(), in.end(), starts_.begin() + 1);
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    if (!same_degree_) return;
    out_.resize(starts_.back()), in_.resize(starts_.back());
    std::vector<std::uint32_t> next_out(starts_.begin(), starts_.end() - 1), next_in = next_out;
    each_edge([&](std::uint32_t a, std::uint32_t b) { out_[next_out[a]++] = b, in_[next_in[b]++] = a; });
  }

  /// Whether each edge at the place is matched by one that runs the other way.
  std::vector<char> balanced() {
    std::vector<char> result(starts_.size() - 1, 0);
    if (!same_degree_) return result;
    parallel_for(
        result.size(),
        [&](std::size_t i) {
          const auto first = static_cast<std::ptrdiff_t>(starts_[i]),
                     last = static_cast<std::ptrdiff_t>(starts_[i + 1]);
          std::sort(out_.begin() + first, out_.begin() + last);
          std::sort(in_.begin() + first, in_.begin() + last);
          result[i] = std::equal(out_.begin() + first, out_.begin() + last, in_.begin() + first);
        },
        kGrain);
    return result;
  }

 private:
  std::vector<std::uint32_t> starts_, out_, in_;
  bool same_degree_ = true;
};

std::vector<std::array<std::uint32_t, 3>> triangles_of(const PolygonMesh& source) {
  const std::vector<std::uint32_t> flat = triangulate(source);
  std::vector<std::array<std::uint32_t, 3>> result(flat.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
  return result;
}

std::uint8_t srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0F, 1.0F);
  return static_cast<std::uint8_t>(
      std::lround(255 * (c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F)));
}

}  // namespace

TreeMesh::TreeMesh(const PolygonMesh& mesh)
    : source(mesh),
      corners(triangles_of(mesh)),
      normals(corner_normals(mesh)),
      place(find_places(mesh.positions)),
      closed(closed_triangles(*this)) {
  if (!mesh.all_triangles()) polygons = triangle_polygons(mesh);
}

bool TreeMesh::has_colors() const {
  if (!source.colors.empty() || !source.polygon_colors.empty()) return true;
  return std::any_of(source.groups.begin(), source.groups.end(),
                     [](const MeshGroup& g) { return g.color.has_value(); });
}

Rgba8 TreeMesh::color(std::size_t triangle, int k) const {
  if (!source.colors.empty()) return source.colors[vertex(triangle, k)];
  if (!source.polygon_colors.empty()) return source.polygon_colors[polygon(triangle)];
  const std::uint32_t g = group(triangle);
  if (g >= source.groups.size() || !source.groups[g].color) return {196, 198, 203, 255};
  const Color& c = *source.groups[g].color;
  return {srgb_byte(c.r), srgb_byte(c.g), srgb_byte(c.b), static_cast<std::uint8_t>(std::lround(255 * c.a))};
}

std::vector<bool> closed_triangles(const TreeMesh& mesh) {
  Components components(mesh.place.size());
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const std::uint32_t a = mesh.place[mesh.vertex(t, 0)];
    components.join(a, mesh.place[mesh.vertex(t, 1)]);
    components.join(a, mesh.place[mesh.vertex(t, 2)]);
  }
  const std::vector<char> balanced = EdgeEnds(mesh).balanced();
  std::vector<char> open(mesh.place.size(), 0);  // by root
  for (std::uint32_t v = 0; v < mesh.place.size(); ++v)
    if (mesh.place[v] == v && !balanced[v]) open[components.root(v)] = 1;
  std::vector<double> volume(mesh.place.size(), 0);
  std::vector<std::uint32_t> root(mesh.size());
  const Vec3 origin = mesh.source.positions.empty() ? Vec3{} : mesh.source.positions[0];
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    root[t] = components.root(mesh.place[mesh.vertex(t, 0)]);
    volume[root[t]] += dot(mesh.area_vector(t), mesh.position(t, 0) - origin);
  }
  std::vector<bool> closed(mesh.size());
  for (std::size_t t = 0; t < mesh.size(); ++t) closed[t] = !open[root[t]] && volume[root[t]] > 0;
  return closed;
}

}  // namespace dupin
