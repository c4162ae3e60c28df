#include "stiffness.h"

#include <algorithm>
#include <cmath>

#include "../../core/parallel.h"

namespace dupin::amg {
namespace {

constexpr std::size_t kGrain = 1024;
/// Triangles whose height is less than this part of their sides count as if it were that.
constexpr double kFlattest = 1e-4;

struct Link {
  std::uint32_t from, to;
  Coupling coupling;
};

/// −∇Φi·∇Φj |T| of the triangle's corners i, j opposite to `apex`: half the cotangent of the angle there.
double half_cotangent(const Vec3& apex, const Vec3& i, const Vec3& j) {
  const Vec3 a = i - apex, b = j - apex;
  const double sine = length(cross(a, b)), least = kFlattest * length(a) * length(b);
  return sine > 0 || least > 0 ? 0.5 * dot(a, b) / std::max(sine, least) : 0;
}

/// Collects Ã: each pair that a fan couples, seen from one of the two.
class Assembly {
 public:
  Assembly(const UniquePoints& points, const Neighborhoods& around) : points_(points), around_(around) {}

  void add_mesh() {
    const auto& t = points_.triangles;
    links_.reserve(2 * t.size());
    for (std::size_t k = 0; k < t.size(); k += 3) {
      const double c = mean_classifier(t[k], t[k + 1], t[k + 2]);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t apex = t[k + corner], i = t[k + (corner + 1) % 3], j = t[k + (corner + 2) % 3];
        const double w = half_cotangent(at(apex), at(i), at(j));
        links_.push_back({i, j, {c * w, w}});
        links_.push_back({j, i, {c * w, w}});
      }
    }
  }

  void add_fans() {
    std::vector<std::vector<Link>> parts((points_.loose.size() + kGrain - 1) / kGrain);
    parallel_for(parts.size(), [&](std::size_t p) {
      for (std::size_t f = p * kGrain; f < std::min(points_.loose.size(), (p + 1) * kGrain); ++f)
        add_fan(f, parts[p]);
    });
    for (const auto& part : parts) links_.insert(links_.end(), part.begin(), part.end());
  }

  Sparse<Coupling> symmetric() const;

 private:
  const Vec3& at(std::uint32_t i) const { return points_.positions[i]; }
  double mean_classifier(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (around_.classifiers[a] + around_.classifiers[b] + around_.classifiers[c]) / 3;
  }
  void add_fan(std::size_t f, std::vector<Link>& out) const {
    const Fans& fans = around_.fans;
    const std::uint32_t i = points_.loose[f], *star = fans.points.data() + fans.first[f];
    const std::size_t count = fans.first[f + 1] - fans.first[f], before = out.size();
    for (std::size_t k = 0; k + (fans.closed[f] ? 0 : 1) < count; ++k) {
      const std::uint32_t a = star[k], b = star[(k + 1) % count];
      if (!together(points_, around_, i, a) || !together(points_, around_, i, b) ||
          !together(points_, around_, a, b))
        continue;
      const double c = mean_classifier(i, a, b), wa = half_cotangent(at(b), at(i), at(a)),
                   wb = half_cotangent(at(a), at(i), at(b));
      out.push_back({i, a, {c * wa, wa}});
      out.push_back({i, b, {c * wb, wb}});
    }
    if (out.size() > before) return;
    // No triangle: elements of a curve, as wide as they are long.
    for (std::size_t k = 0; k < count; ++k)
      if (together(points_, around_, i, star[k]))
        out.push_back({i, star[k], {0.5 * (around_.classifiers[i] + around_.classifiers[star[k]]), 1}});
  }

  const UniquePoints& points_;
  const Neighborhoods& around_;
  std::vector<Link> links_;
};

/// Each link and its mirror image, half of each; equal columns summed.
Sparse<Coupling> Assembly::symmetric() const {
  const std::size_t n = points_.positions.size();
  std::vector<std::uint64_t> place(n + 1);
  for (const Link& l : links_) ++place[l.from + 1], ++place[l.to + 1];
  for (std::size_t i = 0; i < n; ++i) place[i + 1] += place[i];
  struct Entry {
    std::uint32_t column;
    Coupling coupling;
  };
  std::vector<Entry> entries(place[n]);
  std::vector<std::uint64_t> next(place.begin(), place.end() - 1);
  for (const Link& l : links_) {
    entries[next[l.from]++] = {l.to, l.coupling * 0.5};
    entries[next[l.to]++] = {l.from, l.coupling * 0.5};
  }
  std::vector<std::uint32_t> counts(n);
  parallel_for(
      n,
      [&](std::size_t i) {
        Entry *begin = entries.data() + place[i], *end = entries.data() + place[i + 1], *out = begin;
        std::stable_sort(begin, end, [](const Entry& a, const Entry& b) { return a.column < b.column; });
        for (Entry* e = begin; e != end; ++e) {
          if (out != begin && out[-1].column == e->column)
            out[-1].coupling += e->coupling;
          else
            *out++ = *e;
        }
        counts[i] = static_cast<std::uint32_t>(out - begin);
      },
      kGrain);
  Sparse<Coupling> matrix;
  matrix.columns = static_cast<std::uint32_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::uint64_t k = place[i]; k < place[i] + counts[i]; ++k)
      matrix.add(entries[k].column, entries[k].coupling);
    matrix.end_row();
  }
  return matrix;
}

}  // namespace

Sparse<Coupling> couplings(const UniquePoints& points, const Neighborhoods& around) {
  Assembly assembly(points, around);
  assembly.add_mesh();
  assembly.add_fans();
  return assembly.symmetric();
}

Sparse<double> stiffness(const Sparse<Coupling>& couplings) {
  Sparse<double> a;
  a.columns = couplings.columns;
  for (std::uint32_t i = 0; i < couplings.rows(); ++i) {
    double diagonal = 0;
    for (const Coupling& c : couplings.values_of(i)) diagonal += c.weight;
    a.add(i, diagonal);
    for (std::uint64_t k = couplings.starts[i]; k < couplings.starts[i + 1]; ++k)
      a.add(couplings.column[k], -couplings.value[k].weight);
    a.end_row();
  }
  return a;
}

}  // namespace dupin::amg
