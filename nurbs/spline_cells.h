// Inside the folder: a spline surface as Bézier cells, each with the poles of its derivatives up to an order,
// ready to be summed with Bernstein values, which are positive: nothing cancels but what cancels in the
// surface itself.
#ifndef DUPIN_NURBS_SPLINE_CELLS_H
#define DUPIN_NURBS_SPLINE_CELLS_H

#include <vector>

#include "batch_kernels.h"

namespace dupin {

/// The knot spans of one direction, and which holds a parameter.
class SpanTable {
 public:
  SpanTable(const std::vector<double>& knots, int degree, bool periodic, int order);
  std::size_t size() const { return spans_.size(); }
  kernels::LocalRange range(std::size_t cell) const { return {bounds_[cell], bounds_[cell + 1]}; }
  int span(std::size_t cell) const { return spans_[cell]; }
  /// t brought into the domain.
  double into_domain(double t, bool from_left) const {
    return dupin::into_domain(t, bounds_.front(), bounds_.back(), periodic_, from_left);
  }
  /// The cell of a parameter of the domain: right of a knot, or left of it.
  std::size_t find(double t, bool from_left) const;
  /// The weights of the l-th derivative's active poles in the cell's Bézier poles, (degree − l + 1)².
  const double* extraction(std::size_t cell, int l) const;

 private:
  int degree_, levels_;
  bool periodic_;
  std::vector<int> spans_;
  std::vector<double> bounds_;
  std::vector<std::uint32_t> guess_;
  double scale_ = 0;  ///< guesses a parameter unit
  std::vector<double> matrices_;
  std::size_t matrices_a_cell_ = 0;
  std::vector<std::size_t> level_offset_;
};

class SplineCells {
 public:
  /// For derivatives up to `order`, 0 … 3. The surface must outlive the cells.
  SplineCells(const BsplineSurface& surface, int order);
  const SpanTable& u() const { return u_; }
  const SpanTable& v() const { return v_; }
  const kernels::NetLayout& layout() const { return layout_; }
  /// The cell's nets: made beforehand, or into `scratch` where all of them would be too large to keep.
  kernels::Cell cell(std::size_t in_u, std::size_t in_v, std::vector<double>& scratch) const;

  /// Bytes of poles that are kept.
  static constexpr std::size_t kKept = std::size_t{64} << 20;

 private:
  struct Head {
    Vec3 reference;
    kernels::CellScale scale;
  };
  Head make(std::size_t in_u, std::size_t in_v, double* poles) const;

  const BsplineSurface& surface_;
  SpanTable u_, v_;
  kernels::NetLayout layout_;
  std::vector<double> kept_;
  std::vector<Head> heads_;
};

}  // namespace dupin

#endif
