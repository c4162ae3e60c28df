#include "../domain_bases.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "coarsening.h"
#include "fan_triangles.h"
#include "incidence.h"
#include "neighborhoods.h"
#include "stiffness.h"

namespace dupin {

using amg::Sparse;

class DomainBases::Impl {
 public:
  std::vector<std::uint32_t> unique_of;
  std::uint32_t unique = 0;
  std::vector<Sparse<double>> prolongations;  ///< from finer to coarser
  std::vector<double> classifier, spacings;
  std::vector<Vec3> normals;
  std::vector<std::uint32_t> triangles;
  std::vector<bool> rim;
  Times times;
};

namespace {

using Clock = std::chrono::steady_clock;
double lap(Clock::time_point& since) {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - since).count();
  since = now;
  return seconds;
}

constexpr std::uint32_t kBasisRows = 8192;

/// Ψ after one more prolongation: what is too small to matter goes, and the rest sums to 1 again.
Sparse<double> coarser_basis(const Sparse<double>& basis, const Sparse<double>& prolongation) {
  const Sparse<double> all = product(basis, prolongation);
  std::vector<Sparse<double>> parts((all.rows() + kBasisRows - 1) / kBasisRows);
  parallel_for(parts.size(), [&](std::size_t c) {
    std::vector<std::pair<std::uint32_t, double>> row;
    const auto first = static_cast<std::uint32_t>(c) * kBasisRows;
    for (std::uint32_t i = first; i < std::min(all.rows(), first + kBasisRows); ++i) {
      row.clear();
      double sum = 0;
      for (std::uint64_t k = all.starts[i]; k < all.starts[i + 1]; ++k)
        if (all.value[k] >= kLeastBasis) row.emplace_back(all.column[k], all.value[k]), sum += all.value[k];
      std::sort(row.begin(), row.end());
      for (const auto& [domain, value] : row) parts[c].add(domain, value / sum);
      parts[c].end_row();
    }
  });
  return joined(parts, all.columns);
}

Sparse<double> own_basis(std::uint32_t points) {
  Sparse<double> basis;
  basis.columns = points;
  for (std::uint32_t i = 0; i < points; ++i) {
    basis.add(i, 1);
    basis.end_row();
  }
  return basis;
}

template <class T>
std::vector<T> of_originals(const std::vector<T>& values, const std::vector<std::uint32_t>& unique_of) {
  std::vector<T> result(unique_of.size());
  for (std::size_t i = 0; i < unique_of.size(); ++i) result[i] = values[unique_of[i]];
  return result;
}

/// The mesh's own triangles, and those between loose points, each such point standing for all that coincide.
void keep_surface(const SurfacePoints& points, const amg::UniquePoints& unique,
                  const amg::Neighborhoods& around, DomainBases::Impl& impl) {
  const amg::FanTriangles fans = amg::fan_triangles(unique, around);
  std::vector<std::uint32_t> original(unique.positions.size());
  impl.rim.assign(points.size(), false);
  for (std::size_t i = points.size(); i-- > 0;) original[unique.unique_of[i]] = static_cast<std::uint32_t>(i);
  for (std::uint32_t u = 0; u < original.size(); ++u) impl.rim[original[u]] = fans.rim[u];
  impl.triangles = points.triangles;
  impl.triangles.reserve(impl.triangles.size() + fans.triangles.size());
  for (const std::uint32_t u : fans.triangles) impl.triangles.push_back(original[u]);
}

Status coarsen(Sparse<amg::Coupling> couplings, const std::vector<double>& classifiers,
               const Progress& progress, std::vector<Sparse<double>>& prolongations) {
  auto multigrid = amg::Multigrid::start();
  if (!multigrid) return multigrid.status();
  const double all = couplings.columns;
  amg::Coarsening coarsening(std::move(couplings), classifiers);
  while (coarsening.count() > 1) {
    if (!report(progress, "multigrid", 1 - coarsening.count() / all)) return {StatusCode::cancelled, ""};
    auto p = coarsening.next(**multigrid, progress);
    if (!p) return p.status();
    if (p->columns == 0) break;
    prolongations.push_back(std::move(*p));
  }
  return {};
}

}  // namespace

DomainBases::DomainBases(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DomainBases::DomainBases(DomainBases&&) noexcept = default;
DomainBases& DomainBases::operator=(DomainBases&&) noexcept = default;
DomainBases::~DomainBases() = default;

std::size_t DomainBases::levels() const {
  return impl_->prolongations.size() + 1;
}
std::uint32_t DomainBases::domains(std::size_t level) const {
  return level + 1 >= levels() ? impl_->unique : impl_->prolongations[levels() - 2 - level].columns;
}
const std::vector<double>& DomainBases::classifier() const {
  return impl_->classifier;
}
const std::vector<Vec3>& DomainBases::normals() const {
  return impl_->normals;
}
const std::vector<double>& DomainBases::spacings() const {
  return impl_->spacings;
}
const std::vector<std::uint32_t>& DomainBases::triangles() const {
  return impl_->triangles;
}
const std::vector<bool>& DomainBases::rim() const {
  return impl_->rim;
}
const DomainBases::Times& DomainBases::times() const {
  return impl_->times;
}

DomainBasis DomainBases::level(std::size_t level) const {
  Sparse<double> basis = own_basis(impl_->unique);
  for (std::size_t k = 0; k + level + 1 < levels(); ++k)
    basis = coarser_basis(basis, impl_->prolongations[k]);
  DomainBasis result;
  result.domains = basis.columns;
  result.starts.reserve(impl_->unique_of.size() + 1);
  for (const std::uint32_t u : impl_->unique_of)
    result.starts.push_back(result.starts.back() + (basis.starts[u + 1] - basis.starts[u]));
  result.domain.resize(result.starts.back());
  result.value.resize(result.starts.back());
  parallel_for(
      impl_->unique_of.size(),
      [&](std::size_t i) {
        const std::uint32_t u = impl_->unique_of[i];
        const auto columns = basis.columns_of(u);
        const auto values = basis.values_of(u);
        std::copy(columns.begin(), columns.end(),
                  result.domain.begin() + static_cast<std::ptrdiff_t>(result.starts[i]));
        std::copy(values.begin(), values.end(),
                  result.value.begin() + static_cast<std::ptrdiff_t>(result.starts[i]));
      },
      kBasisRows);
  return result;
}

Result<DomainBases> decompose(const SurfacePoints& points, const DecomposeOptions& options) {
  if (Status good = check(points); !good.ok()) return good;
  if (options.neighbors < 3 || !(options.radius >= 0))
    return {StatusCode::invalid_argument,
            "a classifier needs at least 3 neighbors and a radius that is not negative"};
  Clock::time_point start = Clock::now();
  auto impl = std::make_unique<DomainBases::Impl>();
  amg::UniquePoints unique = amg::unique_points(points);
  const double radius = unique.extent > 0 ? options.radius / unique.extent : 0;
  auto around = amg::neighborhoods(unique, {options.neighbors, radius}, options.progress);
  if (!around) return around.status();
  impl->times.neighborhoods = lap(start);
  Sparse<amg::Coupling> couplings = amg::couplings(unique, *around);
  impl->times.matrix = lap(start);
  // Beside multigrid, which mostly waits for the one thread of its process.
  std::future<void> surface = std::async(thread_limit() > 1 ? std::launch::async : std::launch::deferred,
                                         [&] { keep_surface(points, unique, *around, *impl); });
  impl->unique = static_cast<std::uint32_t>(unique.positions.size());
  if (impl->unique > 1)
    if (Status done =
            coarsen(std::move(couplings), around->classifiers, options.progress, impl->prolongations);
        !done.ok())
      return done;
  impl->times.multigrid = lap(start);
  surface.get();
  impl->classifier = of_originals(around->classifiers, unique.unique_of);
  impl->spacings = of_originals(around->spacings, unique.unique_of);
  for (double& s : impl->spacings) s *= unique.extent;
  impl->normals = of_originals(around->normals, unique.unique_of);
  impl->unique_of = std::move(unique.unique_of);
  return DomainBases(std::move(impl));
}

std::vector<Domain> domains_of(const DomainBasis& basis, double threshold) {
  std::vector<Domain> domains(basis.domains);
  for (std::uint32_t i = 0; i + 1 < basis.starts.size(); ++i) {
    const std::uint64_t begin = basis.starts[i], end = basis.starts[i + 1];
    const auto largest = std::max_element(basis.value.begin() + static_cast<std::ptrdiff_t>(begin),
                                          basis.value.begin() + static_cast<std::ptrdiff_t>(end)) -
                         basis.value.begin();
    for (std::uint64_t k = begin; k < end; ++k)
      if (basis.value[k] > threshold || static_cast<std::ptrdiff_t>(k) == largest) {
        domains[basis.domain[k]].points.push_back(i);
        domains[basis.domain[k]].values.push_back(basis.value[k]);
      }
  }
  return domains;
}

std::vector<std::vector<std::uint32_t>> domain_neighbors(const std::vector<Domain>& domains,
                                                         std::size_t points, double overlap) {
  const amg::Incidence of_point(
      points, domains.size(), [&](std::size_t d) -> const auto& { return domains[d].points; });
  std::vector<std::vector<std::uint32_t>> neighbors(domains.size());
  std::vector<std::uint32_t> common(domains.size());
  for (std::uint32_t d = 0; d < domains.size(); ++d) {
    std::vector<std::uint32_t> met;
    for (const std::uint32_t p : domains[d].points)
      for (const std::uint32_t e : of_point.lists_with(p))
        if (e != d && common[e]++ == 0) met.push_back(e);
    for (const std::uint32_t e : met) {
      const double least = static_cast<double>(std::min(domains[d].points.size(), domains[e].points.size()));
      if (common[e] > overlap * least) neighbors[d].push_back(e);
      common[e] = 0;
    }
    std::sort(neighbors[d].begin(), neighbors[d].end());
  }
  return neighbors;
}

}  // namespace dupin
