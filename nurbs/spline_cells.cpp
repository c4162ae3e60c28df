#include "spline_cells.h"

#include <algorithm>
#include <cmath>

#include "../core/parallel.h"
#include "extraction.h"
#include "knots.h"

namespace dupin {

using kernels::Cell;
using kernels::CellScale;
using kernels::Net;
using kernels::NetLayout;

SpanTable::SpanTable(const std::vector<double>& knots, int degree, bool periodic, int order)
    : degree_(degree), levels_(std::min(order, degree) + 1), periodic_(periodic) {
  const int count = static_cast<int>(knots.size()) - degree - 1;
  for (int span = degree; span < count; ++span)
    if (knots[span] < knots[span + 1]) {
      spans_.push_back(span);
      bounds_.push_back(knots[span]);
    }
  bounds_.push_back(knots[count]);

  const std::size_t guesses = 2 * spans_.size();
  const double lo = bounds_.front(), length = bounds_.back() - lo;
  scale_ = static_cast<double>(guesses) / length;
  for (std::size_t i = 0, cell = 0; i < guesses; ++i) {
    const double t = lo + length * static_cast<double>(i) / static_cast<double>(guesses);
    while (cell + 1 < spans_.size() && bounds_[cell + 1] <= t) ++cell;
    guess_.push_back(static_cast<std::uint32_t>(cell));
  }

  for (int l = 0; l < levels_; ++l) {
    level_offset_.push_back(matrices_a_cell_);
    matrices_a_cell_ += static_cast<std::size_t>((degree - l + 1) * (degree - l + 1));
  }
  matrices_.resize(matrices_a_cell_ * spans_.size());
  const std::span<const double> all(knots);
  for (std::size_t cell = 0; cell < spans_.size(); ++cell)
    for (int l = 0; l < levels_; ++l) {
      // The derivative's knots are the spline's own without the outermost.
      const SplinePiece piece{bounds_[cell], bounds_[cell + 1], 0, spans_[cell] - l};
      extraction_matrix(all.subspan(l, all.size() - 2 * static_cast<std::size_t>(l)), degree - l, piece,
                        &matrices_[cell * matrices_a_cell_ + level_offset_[l]]);
    }
}

std::size_t SpanTable::find(double t, bool from_left) const {
  const double position = (t - bounds_.front()) * scale_;
  const std::size_t last = spans_.size() - 1;
  std::size_t cell =
      position > 0 ? guess_[std::min(static_cast<std::size_t>(position), guess_.size() - 1)] : 0;
  if (from_left) {
    while (cell > 0 && t <= bounds_[cell]) --cell;
    while (cell < last && t > bounds_[cell + 1]) ++cell;
  } else {
    while (cell > 0 && t < bounds_[cell]) --cell;
    while (cell < last && t >= bounds_[cell + 1]) ++cell;
  }
  return cell;
}

const double* SpanTable::extraction(std::size_t cell, int l) const {
  return &matrices_[cell * matrices_a_cell_ + level_offset_[l]];
}

namespace {

bool has_weights(const BsplineSurface& s) {
  return std::any_of(s.weights.begin(), s.weights.end(), [&s](double w) { return w != s.weights.front(); });
}

NetLayout make_layout(const BsplineSurface& s, int order) {
  NetLayout layout;
  layout.degree_u = s.degree_u;
  layout.degree_v = s.degree_v;
  layout.order = order;
  layout.components = has_weights(s) ? 4 : 3;
  for (int a = 0; a <= order; ++a)
    for (int b = 0; a + b <= order; ++b) {
      Net& net = layout.nets[jet_index(a, b)];
      net.zero = a > s.degree_u || b > s.degree_v;
      if (net.zero) continue;
      net.offset = layout.size;
      net.degree_u = static_cast<std::uint8_t>(s.degree_u - a);
      net.degree_v = static_cast<std::uint8_t>(s.degree_v - b);
      layout.size += static_cast<std::uint32_t>((net.degree_u + 1) * (net.degree_v + 1) * layout.components);
    }
  return layout;
}

/// Differences along one direction of `lines` rows of `width` doubles: poles of the next derivative, in
/// place. `degree` is that of what is differentiated.
void differentiate(double* poles, int degree, std::size_t stride, std::size_t lines, std::size_t line_stride,
                   std::size_t width, const std::vector<double>& knots, int span) {
  for (int r = 0; r < degree; ++r) {
    const double factor = degree / (knots[span + 1 + r] - knots[span + 1 - degree + r]);
    for (std::size_t line = 0; line < lines; ++line)
      for (std::size_t c = 0; c < width; ++c) {
        double* at = poles + line * line_stride + r * stride + c;
        at[0] = (at[stride] - at[0]) * factor;
      }
  }
}

using Grid = std::array<double, (kMaxDegree + 1) * (kMaxDegree + 1) * 4>;

/// out = E_u · in · E_vᵀ for a (p+1)(q+1) grid; rows of `in` are `row` doubles apart.
void extract(const double* in, std::size_t row, int p, int q, int components, const double* eu,
             const double* ev, double* out) {
  Grid half;
  const std::size_t width = static_cast<std::size_t>((q + 1) * components);
  for (int k = 0; k <= p; ++k)
    for (std::size_t x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = 0; i <= p; ++i) sum += eu[k * (p + 1) + i] * in[i * row + x];
      half[k * width + x] = sum;
    }
  for (int k = 0; k <= p; ++k)
    for (int l = 0; l <= q; ++l)
      for (int c = 0; c < components; ++c) {
        double sum = 0;
        for (int j = 0; j <= q; ++j) sum += ev[l * (q + 1) + j] * half[k * width + j * components + c];
        out[k * width + l * components + c] = sum;
      }
}

CellScale scale_of(const NetLayout& layout, const double* poles) {
  CellScale scale;
  const int n = layout.components;
  std::array<double, jet_size(2)> largest{}, largest_w{};
  double least_w = n == 4 ? std::numeric_limits<double>::infinity() : 1;
  for (int m = 0; m < jet_size(std::min(layout.order, 2)); ++m) {
    const Net& net = layout.nets[m];
    if (net.zero) continue;
    const double* at = poles + net.offset;
    for (int i = 0; i < (net.degree_u + 1) * (net.degree_v + 1); ++i, at += n) {
      largest[m] = std::max({largest[m], std::abs(at[0]), std::abs(at[1]), std::abs(at[2])});
      if (n != 4) continue;
      largest_w[m] = std::max(largest_w[m], std::abs(at[3]));
      if (m == 0) least_w = std::min(least_w, at[3]);
    }
  }
  const double extent = largest[0] / least_w;
  for (int m = 1; m < jet_size(2); ++m) scale.size[m] = (largest[m] + extent * largest_w[m]) / least_w;
  scale.least_curvature = 0.1 / extent;
  return scale;
}

}  // namespace

SplineCells::SplineCells(const BsplineSurface& surface, int order)
    : surface_(surface),
      u_(surface.knots_u, surface.degree_u, surface.periodic_u, order),
      v_(surface.knots_v, surface.degree_v, surface.periodic_v, order),
      layout_(make_layout(surface, order)) {
  const std::size_t cells = u_.size() * v_.size();
  if (cells * layout_.size * sizeof(double) > kKept) return;
  kept_.resize(cells * layout_.size + kernels::kPadding);
  heads_.resize(cells);
  parallel_for(u_.size(), [this](std::size_t i) {
    for (std::size_t j = 0; j < v_.size(); ++j) {
      const std::size_t cell = i * v_.size() + j;
      heads_[cell] = make(i, j, &kept_[cell * layout_.size]);
    }
  });
}

Cell SplineCells::cell(std::size_t in_u, std::size_t in_v, std::vector<double>& scratch) const {
  const std::size_t index = in_u * v_.size() + in_v;
  if (!heads_.empty())
    return {&layout_, &kept_[index * layout_.size], heads_[index].reference, heads_[index].scale};
  scratch.resize(layout_.size + kernels::kPadding);
  const Head head = make(in_u, in_v, scratch.data());
  return {&layout_, scratch.data(), head.reference, head.scale};
}

SplineCells::Head SplineCells::make(std::size_t in_u, std::size_t in_v, double* out) const {
  const BsplineSurface& s = surface_;
  const int p = s.degree_u, q = s.degree_v, n = layout_.components;
  const int span_u = u_.span(in_u), span_v = v_.span(in_v);
  const auto index = [&](int i, int j) {
    return static_cast<std::size_t>(span_u - p + i) * s.count_v + static_cast<std::size_t>(span_v - q + j);
  };
  Head head;
  head.reference = s.poles[index(p / 2, q / 2)];
  // A factor common to all weights changes nothing; near 1 their powers stay in range.
  const double common = n == 4 ? std::exp2(-std::ilogb(s.weights[index(p / 2, q / 2)])) : 1;
  Grid base;
  const std::size_t row = static_cast<std::size_t>((q + 1) * n);
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const Vec3 d = s.poles[index(i, j)] - head.reference;
      const double w = n == 4 ? s.weights[index(i, j)] * common : 1;
      double* at = &base[i * row + static_cast<std::size_t>(j * n)];
      at[0] = d.x * w, at[1] = d.y * w, at[2] = d.z * w;
      if (n == 4) at[3] = w;
    }
  for (int a = 0; a <= std::min(layout_.order, p); ++a) {
    Grid along = base;
    for (int b = 0; a + b <= layout_.order && b <= q; ++b) {
      const Net& net = layout_.nets[jet_index(a, b)];
      extract(along.data(), row, p - a, q - b, n, u_.extraction(in_u, a), v_.extraction(in_v, b),
              out + net.offset);
      if (b < q)
        differentiate(along.data(), q - b, static_cast<std::size_t>(n), static_cast<std::size_t>(p - a + 1),
                      row, static_cast<std::size_t>(n), s.knots_v, span_v);
    }
    if (a < p) differentiate(base.data(), p - a, row, 1, 0, row, s.knots_u, span_u);
  }
  head.scale = scale_of(layout_, out);
  return head;
}

}  // namespace dupin
