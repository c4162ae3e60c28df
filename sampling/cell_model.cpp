// Powers about the centre of the grown cell: exact for a polynomial patch, whose terms above the fifth degree
// are the remainder. For a rational one X/W = q + (X − qW)/W, with q the quotient's series: X − qW is a
// polynomial without terms of degree 5 or less, and known.
#include "cell_model.h"

#include <algorithm>
#include <cmath>

#include "bernstein.h"

namespace dupin {
namespace {

constexpr int kPowers = kMostModelDegree + 1;
constexpr int kOrder = kSeriesDegree;

/// Powers of (s,t), four lanes each: x, y, z and weight.
struct Powers {
  int p = 0, q = 0;
  alignas(32) double c[kPowers][kPowers][4];
};

/// k[d][j]: the coefficient of σ^d in the j-th Bernstein polynomial of degree n at centre + half·σ.
void bernstein_to_powers(int n, double centre, double half, double k[kPowers][kPowers]) {
  const auto binomial = bernstein::binomials(n);
  double up[kPowers] = {1}, down[kPowers][kPowers] = {{1}};  // (centre + half σ)^j, (1 − centre − half σ)^m
  for (int m = 1; m <= n; ++m) {
    for (int d = 0; d <= m; ++d)
      down[m][d] = (d < m ? down[m - 1][d] * (1 - centre) : 0) - (d > 0 ? down[m - 1][d - 1] * half : 0);
  }
  for (int j = 0; j <= n; ++j) {
    for (int d = 0; d <= n; ++d) {
      double sum = 0;
      for (int e = std::max(0, d - (n - j)); e <= std::min(d, j); ++e) sum += up[e] * down[n - j][d - e];
      k[d][j] = sum * binomial[static_cast<std::size_t>(j)];
    }
    for (int d = j + 1; d >= 0 && j < n; --d)
      up[d] = (d <= j ? up[d] * centre : 0) + (d > 0 ? up[d - 1] * half : 0);
  }
}

/// to[a] += k[a][b] from[b], four lanes each, for `lines` lines.
__attribute__((target_clones("avx2", "default"))) void apply(const double k[kPowers][kPowers], int n,
                                                             int lines, const double* from, int from_step,
                                                             int from_line, double* to, int to_step,
                                                             int to_line) {
  for (int l = 0; l < lines; ++l)
    for (int a = 0; a <= n; ++a) {
      double sum[4] = {};
      for (int b = 0; b <= n; ++b) {
        const double s = k[a][b];
        const double* x = from + l * from_line + b * from_step;
        for (int i = 0; i < 4; ++i) sum[i] += s * x[i];
      }
      double* out = to + l * to_line + a * to_step;
      for (int i = 0; i < 4; ++i) out[i] = sum[i];
    }
}

void to_powers(const BezierPatch& cell, const CellMargins& m, const Vec3& reference, Powers& out) {
  const int p = cell.degree_u, q = cell.degree_v;
  out.p = p, out.q = q;
  double ku[kPowers][kPowers], kv[kPowers][kPowers];
  bernstein_to_powers(p, 0.5 + 0.5 * (m.side[1] - m.side[3]), 0.5 * (1 + m.side[1] + m.side[3]), ku);
  bernstein_to_powers(q, 0.5 + 0.5 * (m.side[2] - m.side[0]), 0.5 * (1 + m.side[0] + m.side[2]), kv);
  alignas(32) double poles[kPowers][kPowers][4], half[kPowers][kPowers][4];
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const Vec4& b = cell.pole(i, j);
      poles[i][j][0] = b.x - reference.x * b.w, poles[i][j][1] = b.y - reference.y * b.w;
      poles[i][j][2] = b.z - reference.z * b.w, poles[i][j][3] = b.w;
    }
  constexpr int kLine = kPowers * 4;
  apply(kv, q, p + 1, &poles[0][0][0], 4, kLine, &half[0][0][0], 4, kLine);
  apply(ku, p, q + 1, &half[0][0][0], kLine, 4, &out.c[0][0][0], kLine, 4);
}

/// Sums of the lengths of terms, and of those of their derivatives.
void add_term(int i, int j, double size, Remainder& r) {
  r.value += size, r.ds += i * size, r.dt += j * size;
}

void polynomial_model(const Powers& a, CellModel& out) {
  out.r = {};
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j) {
      const double* c = a.c[i][j];
      if (i + j <= kOrder)
        for (int k = 0; k < 3; ++k) out.p[static_cast<std::size_t>(k)].c[i][j] = c[k];
      else
        add_term(i, j, std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), out.r);
    }
}

bool rational_model(const Powers& a, CellModel& out) {
  const double w0 = a.c[0][0][3];
  Remainder w;  // of its variation
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j)
      if (i + j > 0) add_term(i, j, std::abs(a.c[i][j][3]), w);
  const double least = w0 - w.value;
  if (!(least > 0)) return false;
  // The quotient's series, term by term.
  constexpr int kAll = kPowers + kOrder;
  double rest[kAll][kAll][3] = {};
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j)
      for (int k = 0; k < 3; ++k) rest[i][j][k] = a.c[i][j][k];
  for (int n = 0; n <= kOrder; ++n)
    for (int j = 0; j <= n; ++j) {
      const int i = n - j;
      double x[3];
      for (int k = 0; k < 3; ++k) {
        x[k] = rest[i][j][k] / w0;
        out.p[static_cast<std::size_t>(k)].c[i][j] = x[k];
      }
      for (int d = 0; d <= a.p; ++d)
        for (int e = 0; e <= a.q; ++e) {
          const double weight = a.c[d][e][3];
          for (int k = 0; k < 3; ++k) rest[i + d][j + e][k] -= weight * x[k];
        }
    }
  Remainder e;
  for (int i = 0; i <= a.p + kOrder; ++i)
    for (int j = 0; j <= a.q + kOrder; ++j) {
      if (i + j <= kOrder) continue;
      const double* c = rest[i][j];
      add_term(i, j, std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), e);
    }
  out.r.value = e.value / least;
  out.r.ds = (e.ds + out.r.value * w.ds) / least;
  out.r.dt = (e.dt + out.r.value * w.dt) / least;
  return true;
}

}  // namespace

bool make_model(const BezierPatch& cell, const CellMargins& margins, CellModel& out) {
  if (cell.degree_u > kMostModelDegree || cell.degree_v > kMostModelDegree) return false;
  const Vec4& first = cell.poles[0];
  const Vec3 reference = Vec3{first.x, first.y, first.z} / first.w;
  Powers powers;
  to_powers(cell, margins, reference, powers);
  out.p = {};
  if (!cell.rational)
    polynomial_model(powers, out);
  else if (!rational_model(powers, out))
    return false;
  out.origin = reference;
  for (int k = 0; k < 3; ++k) {
    Series& s = out.p[static_cast<std::size_t>(k)];
    out.origin[k] += s.c[0][0];
    s.c[0][0] = 0;
  }
  return true;
}

}  // namespace dupin
