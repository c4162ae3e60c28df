#include "coarsening.h"

#include <algorithm>
#include <numeric>

namespace dupin::amg {
namespace {

/// Less progress than this part of the domains is not worth a level of its own.
constexpr double kLeastProgress = 0.02;
/// A domain that is absorbed is shared by at most as many others.
constexpr std::size_t kMostHeirs = 8;

struct Share {
  std::uint32_t column;
  double value;
};

/// Shares of equal columns summed, the largest kept, in the order of columns, with sum 1.
void settle(std::vector<Share>& shares) {
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.column < b.column; });
  std::size_t count = 0;
  for (const Share& s : shares) {
    if (count > 0 && shares[count - 1].column == s.column)
      shares[count - 1].value += s.value;
    else
      shares[count++] = s;
  }
  shares.resize(count);
  if (count > kMostHeirs) {
    std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
      return a.value != b.value ? a.value > b.value : a.column < b.column;
    });
    shares.resize(kMostHeirs);
    std::sort(shares.begin(), shares.end(),
              [](const Share& a, const Share& b) { return a.column < b.column; });
  }
  double sum = 0;
  for (const Share& s : shares) sum += s.value;
  for (Share& s : shares) s.value /= sum;
}

double border_flatness(const Coupling& c) {
  return c.flat > 0 ? c.weight / c.flat : 0;
}

Sparse<double> identity(std::uint32_t n) {
  Sparse<double> one;
  one.columns = n;
  for (std::uint32_t i = 0; i < n; ++i) {
    one.add(i, 1);
    one.end_row();
  }
  return one;
}

}  // namespace

Sparse<double> partition_of_unity(const Sparse<double>& p) {
  Sparse<double> q;
  q.columns = p.columns;
  for (std::uint32_t i = 0; i < p.rows(); ++i) {
    double sum = 0;
    for (const double v : p.values_of(i)) sum += std::max(0.0, v);
    if (sum > 0) {
      for (std::uint64_t k = p.starts[i]; k < p.starts[i + 1]; ++k)
        if (p.value[k] > 0) q.add(p.column[k], p.value[k] / sum);
    } else {
      q.add(q.columns++, 1);
    }
    q.end_row();
  }
  return q;
}

Coarsening::Coarsening(Sparse<Coupling> couplings, const std::vector<double>& classifiers)
    : links_(std::move(couplings)), flatness_(classifiers), sizes_(classifiers.size(), 1) {
  // Obtuse angles make couplings negative: such points do not hold together.
  for (Coupling& c : links_.value)
    if (!(c.weight > 0 && c.flat > 0)) c = {};
}

/// Domains that are given to flatter ones beside them; an identity row for the others.
Sparse<double> Coarsening::absorption(double contrast) const {
  const std::uint32_t n = count();
  std::vector<std::vector<Share>> shares(n);
  std::vector<std::uint32_t> absorbed;
  for (std::uint32_t i = 0; i < n; ++i) {
    double to_flatter = 0, to_like = 0;
    for (std::uint64_t k = links_.starts[i]; k < links_.starts[i + 1]; ++k) {
      const std::uint32_t j = links_.column[k];
      const double weight = links_.value[k].weight, border = border_flatness(links_.value[k]);
      if (j == i || !(weight > 0) || border < contrast * flatness_[i]) continue;
      if (border >= contrast * flatness_[j]) {
        to_like += weight;
      } else {
        to_flatter += weight;
        shares[i].push_back({j, weight});
      }
    }
    if (to_flatter > to_like)
      absorbed.push_back(i);
    else
      shares[i].clear();
  }
  // Flattest first: whom a domain is given to may itself have been given away, but then is flatter.
  std::sort(absorbed.begin(), absorbed.end(), [&](std::uint32_t a, std::uint32_t b) {
    return flatness_[a] != flatness_[b] ? flatness_[a] > flatness_[b] : a < b;
  });
  Sparse<double> p;
  std::vector<std::uint32_t> number(n);
  for (std::uint32_t i = 0; i < n; ++i) number[i] = shares[i].empty() ? p.columns++ : n;
  for (const std::uint32_t i : absorbed) {
    std::vector<Share> heirs;
    double sum = 0;
    for (const Share& s : shares[i]) sum += s.value;
    for (const Share& s : shares[i]) {
      if (number[s.column] < n)
        heirs.push_back({number[s.column], s.value / sum});
      else
        for (const Share& t : shares[s.column]) heirs.push_back({t.column, t.value * s.value / sum});
    }
    settle(heirs);
    shares[i] = std::move(heirs);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    if (number[i] < n) p.add(number[i], 1);
    for (const Share& s : shares[i]) p.add(s.column, s.value);
    p.end_row();
  }
  return p;
}

/// The couplings of domains that hold together, as multigrid wants its matrix.
Sparse<double> Coarsening::bordered(double contrast) const {
  Sparse<double> a;
  a.columns = count();
  for (std::uint32_t i = 0; i < count(); ++i) {
    const std::size_t diagonal = a.column.size();
    a.add(i, 0);
    for (std::uint64_t k = links_.starts[i]; k < links_.starts[i + 1]; ++k) {
      const std::uint32_t j = links_.column[k];
      const Coupling& c = links_.value[k];
      if (j == i || !(c.weight > 0)) continue;
      if (border_flatness(c) < contrast * std::max(flatness_[i], flatness_[j])) continue;
      a.add(j, -c.weight);
      a.value[diagonal] += c.weight;
    }
    if (a.column.size() == diagonal + 1) a.value[diagonal] = 1;
    a.end_row();
  }
  return a;
}

void Coarsening::apply(const Sparse<double>& p) {
  links_ = coarse(links_, p);
  std::vector<double> flatness(p.columns), sizes(p.columns);
  for (std::uint32_t i = 0; i < p.rows(); ++i)
    for (std::uint64_t k = p.starts[i]; k < p.starts[i + 1]; ++k) {
      sizes[p.column[k]] += p.value[k] * sizes_[i];
      flatness[p.column[k]] += p.value[k] * sizes_[i] * flatness_[i];
    }
  for (std::size_t j = 0; j < sizes.size(); ++j) flatness[j] /= sizes[j];
  flatness_ = std::move(flatness);
  sizes_ = std::move(sizes);
}

Result<Sparse<double>> Coarsening::step(Multigrid& multigrid, double contrast, const Progress& progress) {
  Sparse<double> p = absorption(contrast);
  if (p.columns < p.rows()) apply(p);
  const Sparse<double> matrix = bordered(contrast);
  Sparse<double> q = identity(count());
  if (matrix.column.size() > matrix.rows()) {
    const Result<Sparse<double>> made = multigrid.prolongation(matrix, progress);
    if (!made) return made.status();
    q = partition_of_unity(*made);
  }
  if (q.columns < q.rows()) apply(q);
  return p.columns < p.rows() ? product(p, q) : std::move(q);
}

Result<Sparse<double>> Coarsening::next(Multigrid& multigrid, const Progress& progress) {
  Sparse<double> all = identity(count());
  const std::uint32_t before = count();
  while (phase_ < std::size(kContrasts)) {
    const std::uint32_t here = count();
    const Result<Sparse<double>> p = step(multigrid, kContrasts[phase_], progress);
    if (!p) return p.status();
    if (count() < here) all = product(all, *p);
    if (here - count() < std::max(1.0, kLeastProgress * here)) ++phase_;
    if (before - count() >= std::max(1.0, kLeastProgress * before)) return all;
  }
  if (count() < before) return all;
  return Sparse<double>{};
}

}  // namespace dupin::amg
