// Batches of a spline: samples are gathered by cell, and each cell's go through the kernels together.
#include <algorithm>
#include <cstring>
#include <numeric>

#include "../core/parallel.h"
#include "batch_families.h"
#include "knots.h"
#include "precise.h"
#include "spline_cells.h"

namespace dupin {
namespace {

using kernels::basis_rows;
using kernels::Cell;
using kernels::Outputs;
using kernels::Wanted;

/// Rows of a grid, or scattered points, that one task takes.
constexpr std::size_t kRowsATask = 16, kPointsATask = 4096;
/// Fewer samples than this are not worth a thread.
constexpr std::size_t kLeast = 4096;
/// Grids with fewer samples in v a cell than this on average are evaluated as points of cells.
constexpr std::size_t kShortRun = 4;
/// Scattered samples of a cell that are computed before they are put in their places.
constexpr std::size_t kScatteredAtOnce = 128;

/// Consecutive parameters in one cell.
struct Run {
  std::size_t cell, first, count;
};

struct Axis {
  std::vector<double> t;  ///< in the domain
  std::vector<Run> runs;
  std::unique_ptr<double[]> basis;  ///< rows of `stride`
  std::size_t stride = 0;
};

Axis make_axis(const SpanTable& table, std::span<const double> parameters, bool from_left,
               std::size_t longest) {
  Axis axis;
  axis.t.reserve(parameters.size());
  kernels::LocalRange here{1, 0};
  std::size_t cell = 0;
  for (double parameter : parameters) {
    const std::size_t i = axis.t.size();
    const bool inside = parameter > here.lo && parameter < here.hi;
    const double t = inside ? parameter : table.into_domain(parameter, from_left);
    axis.t.push_back(t);
    const std::size_t before = cell;
    if (!inside) cell = table.find(t, from_left), here = table.range(cell);
    if (i == 0 || cell != before || axis.runs.back().count == longest) axis.runs.push_back({cell, i, 0});
    ++axis.runs.back().count;
  }
  return axis;
}

/// Each sample's rows together (`by_sample`), or each row's samples.
void add_basis(const SpanTable& table, int degree, int order, bool by_sample, bool scalar, Axis& axis) {
  const std::size_t rows = static_cast<std::size_t>(basis_rows(degree, std::min(order, degree)));
  axis.stride = by_sample ? rows : axis.t.size() + kernels::kPadding;
  axis.basis.reset(new double[rows * (by_sample ? axis.t.size() : axis.stride)]);
  for (const Run& run : axis.runs) {
    kernels::BasisJob job{&axis.t[run.first], run.count, table.range(run.cell), degree, order, nullptr, 1};
    if (!by_sample) {
      job.values = axis.basis.get() + run.first, job.stride = axis.stride;
      kernels::basis(job, scalar);
      continue;
    }
    for (std::size_t i = 0; i < run.count; ++i) {
      job.t = &axis.t[run.first + i], job.count = 1;
      job.values = axis.basis.get() + (run.first + i) * rows;
      kernels::basis(job, scalar);
    }
  }
}

/// Contiguous room for the results of samples that go to different places.
class Gather {
 public:
  Gather(const Outputs& like, std::size_t count) {
    const std::size_t stride = ((count + 7) / 8 | 1) * 8;  // an odd number of cache lines apart
    const auto used = std::count_if(like.at.begin(), like.at.end(), [](const double* p) { return p; });
    // Not initialised: the kernels write all that is read.
    values_.reset(new double[static_cast<std::size_t>(used) * stride]);
    kinds_.resize(like.kind ? count : 0);
    double* next = values_.get();
    for (int c = 0; c < kernels::kChannels; ++c)
      if (like.at[c]) out_.at[c] = next, next += stride;
    out_.kind = like.kind ? kinds_.data() : nullptr;
  }
  const Outputs& outputs() const { return out_; }
  /// place(i): where the i-th of the first `count` samples goes, in `to`.
  template <class Place>
  void scatter(std::size_t count, const Outputs& to, const Place& place) const {
    for (int c = 0; c < kernels::kChannels; ++c)
      if (to.at[c])
        for (std::size_t i = 0; i < count; ++i) to.at[c][place(i)] = out_.at[c][i];
    if (to.kind)
      for (std::size_t i = 0; i < count; ++i) to.kind[place(i)] = out_.kind[i];
  }

 private:
  std::unique_ptr<double[]> values_;
  std::vector<std::uint8_t> kinds_;
  Outputs out_;
};

class SplineFamily : public BatchFamily {
 public:
  SplineFamily(const BsplineSurface& spline, const Surface& surface, int order)
      : spline_(spline), surface_(surface), cells_(spline, order) {}

  void grid(const Batch& batch) const override {
    Axis u = make_axis(cells_.u(), batch.u, batch.sides.u_from_left, kRowsATask);
    Axis v = make_axis(cells_.v(), batch.v, batch.sides.v_from_left, batch.v.size());
    if (batch.v.size() < kShortRun * v.runs.size()) return grid_of_points(batch, u, v);
    grid_of_rows(batch, u, v);
  }

  void scattered(const Batch& batch) const override {
    const std::size_t tasks = (batch.u.size() + kPointsATask - 1) / kPointsATask;
    parallel_for(tasks, [&](std::size_t task) {
      const std::size_t first = task * kPointsATask;
      scattered_task(batch, first, std::min(kPointsATask, batch.u.size() - first));
    });
  }

 private:
  static std::size_t grain(const Axis& v) {
    return std::max<std::size_t>(1, kLeast / (kRowsATask * std::max<std::size_t>(1, v.t.size())));
  }

  void grid_of_rows(const Batch& batch, Axis& u, Axis& v) const {
    const int order = batch.wanted.order;
    add_basis(cells_.u(), spline_.degree_u, order, true, batch.scalar, u);
    add_basis(cells_.v(), spline_.degree_v, order, false, batch.scalar, v);
    parallel_for(
        u.runs.size(),
        [&](std::size_t task) {
          const Run& in_u = u.runs[task];
          std::vector<double> scratch;
          for (const Run& in_v : v.runs) {
            const Cell cell = cells_.cell(in_u.cell, in_v.cell, scratch);
            for (std::size_t i = in_u.first; i < in_u.first + in_u.count; ++i) {
              const std::size_t first = i * v.t.size() + in_v.first;
              kernels::row({&cell, &u.basis[i * u.stride], &v.basis[in_v.first], v.stride, in_v.count,
                            batch.wanted, &batch.out, first},
                           batch.scalar);
              repair(batch, in_v.count, first, [&](std::size_t k) {
                return Vec2{u.t[i], v.t[in_v.first + k]};
              });
            }
          }
        },
        grain(v));
  }

  void grid_of_points(const Batch& batch, const Axis& u, const Axis& v) const {
    std::size_t longest = 0;
    for (const Run& run : v.runs) longest = std::max(longest, run.count);
    parallel_for(
        u.runs.size(),
        [&](std::size_t task) {
          const Run& in_u = u.runs[task];
          std::vector<double> scratch, at_u(in_u.count * longest), at_v(at_u.size());
          const Gather gather(batch.out, at_u.size());
          for (const Run& in_v : v.runs) {
            const std::size_t count = in_u.count * in_v.count;
            for (std::size_t k = 0; k < count; ++k) {
              at_u[k] = u.t[in_u.first + k / in_v.count];
              at_v[k] = v.t[in_v.first + k % in_v.count];
            }
            const Cell cell = cells_.cell(in_u.cell, in_v.cell, scratch);
            points(batch, cell, in_u.cell, in_v.cell, at_u.data(), at_v.data(), count, gather.outputs(), 0);
            gather.scatter(count, batch.out, [&](std::size_t k) {
              return (in_u.first + k / in_v.count) * v.t.size() + in_v.first + k % in_v.count;
            });
          }
        },
        grain(v));
  }

  void scattered_task(const Batch& batch, std::size_t first, std::size_t count) const {
    const SpanTable &table_u = cells_.u(), &table_v = cells_.v();
    std::vector<double> u(count), v(count), sorted_u(count), sorted_v(count), scratch;
    std::vector<std::size_t> cell_of(count);
    for (std::size_t i = 0; i < count; ++i) {
      u[i] = table_u.into_domain(batch.u[first + i], batch.sides.u_from_left);
      v[i] = table_v.into_domain(batch.v[first + i], batch.sides.v_from_left);
      cell_of[i] = table_u.find(u[i], batch.sides.u_from_left) * table_v.size() +
                   table_v.find(v[i], batch.sides.v_from_left);
    }
    const std::vector<std::uint32_t> order = by_cell(cell_of, table_u.size() * table_v.size());
    for (std::size_t i = 0; i < count; ++i) sorted_u[i] = u[order[i]], sorted_v[i] = v[order[i]];
    // A few at a time, so that they are scattered from the nearest cache.
    const Gather gather(batch.out, std::min(count, kScatteredAtOnce));
    for (std::size_t i = 0, end; i < count; i = end) {
      const std::size_t cell = cell_of[order[i]];
      for (end = i + 1; end < count && end - i < kScatteredAtOnce && cell_of[order[end]] == cell;) ++end;
      const std::size_t in_u = cell / table_v.size(), in_v = cell % table_v.size();
      points(batch, cells_.cell(in_u, in_v, scratch), in_u, in_v, &sorted_u[i], &sorted_v[i], end - i,
             gather.outputs(), 0);
      gather.scatter(end - i, batch.out, [&](std::size_t k) { return first + order[i + k]; });
    }
  }

  /// Indices in the order of their cells; of one cell in their own order.
  static std::vector<std::uint32_t> by_cell(const std::vector<std::size_t>& cell_of, std::size_t cells) {
    std::vector<std::uint32_t> order(cell_of.size());
    if (cells > 4 * cell_of.size()) {
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(), order.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return cell_of[a] < cell_of[b]; });
      return order;
    }
    std::vector<std::uint32_t> next(cells + 1, 0);
    for (std::size_t cell : cell_of) ++next[cell + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t i = 0; i < cell_of.size(); ++i)
      order[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
    return order;
  }

  void points(const Batch& batch, const Cell& cell, std::size_t in_u, std::size_t in_v, const double* u,
              const double* v, std::size_t count, const Outputs& out, std::size_t first) const {
    kernels::points(
        {&cell, u, v, count, cells_.u().range(in_u), cells_.v().range(in_v), batch.wanted, &out, first},
        batch.scalar);
    Batch here = batch;
    here.out = out;
    repair(here, count, first, [&](std::size_t k) { return Vec2{u[k], v[k]}; });
  }

  /// What the kernels left to the careful, of `count` samples from `first` on.
  template <class At>
  void repair(const Batch& batch, std::size_t count, std::size_t first, const At& at) const {
    if (!batch.out.kind) return;
    const std::uint8_t *const begin = batch.out.kind + first, *const end = begin + count;
    const std::uint8_t* kind = begin;
    while (kind != end && (kind = static_cast<const std::uint8_t*>(std::memchr(
                               kind, kernels::kCareful, static_cast<std::size_t>(end - kind)))) != nullptr) {
      const std::size_t k = static_cast<std::size_t>(kind++ - begin);
      careful(batch, at(k), batch.out_at(first + k));
    }
  }

  void careful(const Batch& batch, Vec2 uv, const Outputs& out) const {
    const PreciseJet jet = precise_jet(spline_, uv.x, uv.y, std::max(2, batch.wanted.order), batch.sides);
    std::optional<Curvature> k = precise_curvature(jet);
    if (!k) k = careful_curvature(surface_, uv.x, uv.y);
    store(jet.rounded(), *k, batch.wanted, out);
  }

  const BsplineSurface& spline_;
  const Surface& surface_;
  const SplineCells cells_;
};

}  // namespace

std::unique_ptr<BatchFamily> make_spline_family(const BsplineSurface& spline, const Surface& surface,
                                                int order) {
  return std::make_unique<SplineFamily>(spline, surface, order);
}

}  // namespace dupin
