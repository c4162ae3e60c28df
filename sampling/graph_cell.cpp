// See docs/mathematics.md, "Certificates".
#include "graph_cell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "small_solve.h"

namespace dupin {
namespace {

constexpr double kLeastSheet = 0.3;  ///< ∂F/∂z stays above this over an accepted cell
constexpr double kMostSteep = 0.5;   ///< what a, b, c may take of it
constexpr double kMostTwist = 0.5;   ///< the chart's Jacobian changes by at most this much, relative
/// Where the difference's gradient is more than this part of what is allowed cubic terms correct the normal.
constexpr double kPlainNormals = 0.6;
constexpr double kHopeless = 1.2;  ///< a chart that twists more than this is not looked at
constexpr int kMostPieces = 5;     ///< in one direction, at a time
/// The room a side gets, in terms of its sagitta; what the sagittas of pieces are to take of it; and the
/// overlap with a neighbour, in tolerances and at most in widths.
constexpr double kRoom = 1.15, kMostBend = 0.2, kOverlap = 2.5, kMostOverlap = 0.05, kMostThinMargin = 8;
constexpr int kN = Series::kRows;

struct Matrix2 {
  double a = 0, b = 0, c = 0, d = 0;  ///< rows (a b), (c d)
};
bool invert(const Matrix2& m, Matrix2& out) {
  const double det = m.a * m.d - m.b * m.c;
  if (!(std::abs(det) > 0)) return false;
  out = {m.d / det, -m.b / det, -m.c / det, m.a / det};
  return true;
}

/// F = z − ½(l11 x² + 2 l12 xy + l22 y²) − a xz − b yz − ½c z².
struct Form {
  double l11 = 0, l12 = 0, l22 = 0, a = 0, b = 0, c = 0;
};

/// Coordinates in some frame, and their products.
struct Coordinates {
  Bounded x, y, z;
};
struct Squares {
  Bounded xx, xy, yy;
};

double size_of(const Bounded& b) {
  double sum = b.r.value;
  for (double n : b.norm) sum += n;
  return sum;
}

void subtract(Bounded& f, double s, const Bounded& g) {
  if (s == 0) return;
  add(f.p, -s, g.p);
  f.r = f.r + g.r * std::abs(s);
}

/// The quadratic part q20 s² + q11 st + q02 t² as ½ dᵀ(x,y)(x,y), to first order.
struct Quadratic {
  double l11, l12, l22;
};
Quadratic pulled_back(double q20, double q11, double q02, const Matrix2& inverse) {
  // (s,t) = inverse (x,y): L = 2 inverseᵀ Q inverse.
  const Matrix2& m = inverse;
  const double h = q11 / 2;
  return {2 * (q20 * m.a * m.a + 2 * h * m.a * m.c + q02 * m.c * m.c),
          2 * (q20 * m.a * m.b + h * (m.a * m.d + m.b * m.c) + q02 * m.c * m.d),
          2 * (q20 * m.b * m.b + 2 * h * m.b * m.d + q02 * m.d * m.d)};
}

/// Into n × m pieces, as few as `error` (of a piece, of what is allowed) says will do; of as many the better.
template <class Error>
void fewest_pieces(CellFit& out, const Error& error) {
  int fewest = 1 << 20;
  double least = 0;
  for (int n = 1; n <= kMostPieces; ++n)
    for (int m = 1; m <= kMostPieces; ++m) {
      if (n * m < 2 || n * m > fewest) continue;
      const double e = error(n, m);
      if (!(e <= 1) || (n * m == fewest && e >= least)) continue;
      fewest = n * m, least = e, out.pieces_u = n, out.pieces_v = m;
    }
  if (fewest < 1 << 20) return;
  // Not in one go: then only in the direction that matters, if it is one.
  const double both = error(kMostPieces, kMostPieces) * 1.5;
  const bool u = error(kMostPieces, 1) <= both, v = !u && error(1, kMostPieces) <= both;
  out.pieces_u = v ? 1 : kMostPieces, out.pieces_v = u ? 1 : kMostPieces;
}

class GraphFitter {
 public:
  GraphFitter(const BezierPatch& cell, const CellRequest& request) : cell_(cell), request_(request) {}

  CellFit fit() {
    out_.margins = request_.margins;
    out_.pieces_u = out_.pieces_v = 2;
    if (!model() || !place() || !make_room() || !tilt_frame()) return std::move(out_);
    fit_form();
    place_principal_frame();
    out_.valid = certify();
    if (out_.valid) make_borders();
    return std::move(out_);
  }

 private:
  Bounded combined(const Vec3& axis) const {
    Bounded out;
    for (int k = 0; k < 3; ++k) add(out.p, axis[k], model_.p[static_cast<std::size_t>(k)]);
    out.r = model_.r;
    measure(out);
    return out;
  }

  bool model() {
    if (!make_model(cell_, out_.margins, model_)) return false;
    model_.r = model_.r + request_.beyond;
    return true;
  }

  Vec3 coefficient(int i, int j) const {
    return Vec3{model_.p[0].c[i][j], model_.p[1].c[i][j], model_.p[2].c[i][j]};
  }

  /// The frame at the centre, x along Su; cells that twist too much are turned away here.
  bool place() {
    const Vec3 pu = coefficient(1, 0), pv = coefficient(0, 1), n = cross(pu, pv);
    if (!(length(n) > 1e-9 * length(pu) * length(pv))) return longer_side(length(pu), length(pv));
    u_ = normalized(pu), n_ = normalized(n), v_ = cross(n_, u_);
    if (!is_finite(u_) || !is_finite(n_)) return false;
    if (!set_jacobian()) return longer_side(length(pu), length(pv));
    return !twists_too_much();
  }

  /// Margins wide enough for the chords of curved sides, and for the overlap with the neighbours; a cell
  /// whose sides would take too much is cut along them.
  bool make_room() {
    const Vec3 s = coefficient(1, 0), t = coefficient(0, 1);
    const double area = length(cross(s, t)), along_u = length(s), along_v = length(t);
    // In terms of the cell's width across them: the sides' sagittas, and the overlap.
    bend_u_ = std::abs(dot(cross(coefficient(2, 0), s), n_)) / (2 * area);
    bend_v_ = std::abs(dot(cross(coefficient(0, 2), t), n_)) / (2 * area);
    const double overlap = kOverlap * request_.tolerance + 2e-4 * std::max(along_u, along_v);
    const double across_v = std::min(overlap * along_u / (2 * area), kMostOverlap),
                 across_u = std::min(overlap * along_v / (2 * area), kMostOverlap);
    const double needed[2] = {kRoom * bend_u_ + across_v, kRoom * bend_v_ + across_u};
    // A cell that is thinner than the tolerance may be grown by as much.
    const double most[2] = {most_margin(area / along_u), most_margin(area / along_v)};
    if (!(needed[0] <= most[0] && needed[1] <= most[1])) {
      fewest_pieces(out_, [&](int n, int m) { return bent(n, m); });
      return false;
    }
    bool wider = false;
    for (int k = 0; k < 4; ++k) {
      double& margin = out_.margins.side[k];
      if (margin >= needed[k % 2]) continue;
      wider |= needed[k % 2] > margin + 0.005;
      margin = std::max(margin, needed[k % 2]);
    }
    if (!wider) return out_.margins = request_.margins, true;
    return model() && place();
  }
  double most_margin(double half_width) const {
    return std::max(kMostMargin, std::min(kMostThinMargin, request_.tolerance / (2 * half_width)));
  }
  /// What the sides of a piece take of the room there is.
  double bent(int n, int m) const {
    return std::max(bend_u_ * m / (n * n), bend_v_ * n / (m * m)) * (kRoom / kMostBend);
  }

  /// At the centre, in the present frame.
  bool set_jacobian() {
    const Vec3 pu = coefficient(1, 0), pv = coefficient(0, 1);
    return invert({dot(pu, u_), dot(pv, u_), dot(pu, v_), dot(pv, v_)}, inverse_);
  }

  bool longer_side(double along_u, double along_v) {
    out_.pieces_u = along_u >= along_v ? 2 : 1, out_.pieces_v = 3 - out_.pieces_u;
    return false;
  }

  /// ‖J J₀⁻¹ − I‖ to first order, apart for what s and t bring; pieces for a cell that has too much of it.
  bool twists_too_much() {
    const Vec3 ss = coefficient(2, 0) * 2, st = coefficient(1, 1), tt = coefficient(0, 2) * 2;
    const auto change = [&](const Vec3& by_s, const Vec3& by_t) {
      const Matrix2& i = inverse_;
      const double xs = dot(by_s, u_), xt = dot(by_t, u_), ys = dot(by_s, v_), yt = dot(by_t, v_);
      return std::sqrt(squared(xs * i.a + xt * i.c) + squared(xs * i.b + xt * i.d) +
                       squared(ys * i.a + yt * i.c) + squared(ys * i.b + yt * i.d));
    };
    twist_s_ = change(ss, st), twist_t_ = change(st, tt);
    if (twist_s_ + twist_t_ <= kHopeless) return false;
    cut_by_twist();
    return true;
  }
  static double squared(double x) { return x * x; }
  void cut_by_twist() {
    fewest_pieces(
        out_, [&](int n, int m) { return std::max((twist_s_ / n + twist_t_ / m) / kMostTwist, bent(n, m)); });
  }

  /// A cubic difference is economised by a linear term: the frame is turned by it. Only terms of degree 3 and
  /// less count here.
  bool tilt_frame() {
    using Form3 = std::array<double, 4>;  // s³, s²t, st², t³
    const auto times = [](const double one[2], const double two[3]) {
      return Form3{one[0] * two[0], one[0] * two[1] + one[1] * two[0], one[0] * two[2] + one[1] * two[1],
                   one[1] * two[2]};
    };
    double x1[2], y1[2], x2[3], y2[3], z2[3];
    for (int k = 0; k < 2; ++k)
      x1[k] = dot(coefficient(1 - k, k), u_), y1[k] = dot(coefficient(1 - k, k), v_);
    for (int k = 0; k < 3; ++k) {
      const Vec3 c = coefficient(2 - k, k);
      x2[k] = dot(c, u_), y2[k] = dot(c, v_), z2[k] = dot(c, n_);
    }
    const Quadratic l = pulled_back(z2[0], z2[1], z2[2], inverse_);
    double gx[2], gy[2];
    for (int k = 0; k < 2; ++k) gx[k] = l.l11 * x1[k] + l.l12 * y1[k], gy[k] = l.l12 * x1[k] + l.l22 * y1[k];
    const Form3 bx = times(gx, x2), by = times(gy, y2), xz = times(x1, z2), yz = times(y1, z2);
    static constexpr double kWeight[4] = {0.25, 0.5, 0.5, 0.25};  // of T₃, T₂T₁ in the powers
    double g[3][3] = {}, r[3] = {};
    Form3 f;
    for (int k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(k);
      f[i] = dot(coefficient(3 - k, k), n_) - bx[i] - by[i];
      const double w = kWeight[k] * kWeight[k];
      g[0][0] += w * xz[i] * xz[i], g[0][1] += w * xz[i] * yz[i], g[1][1] += w * yz[i] * yz[i];
      r[0] += w * xz[i] * f[i], r[1] += w * yz[i] * f[i];
    }
    g[1][0] = g[0][1];
    const Vec3 ab = solve_ridge(g, r, 2);
    const double size_x = std::abs(x1[0]) + std::abs(x1[1]), size_y = std::abs(y1[0]) + std::abs(y1[1]);
    if (is_finite(ab) && std::abs(ab.x) * size_x + std::abs(ab.y) * size_y <= kMostSteep)
      for (std::size_t i = 0; i < 4; ++i) f[i] -= ab.x * xz[i] + ab.y * yz[i];
    const double s = 0.75 * f[0] + 0.5 * f[2], t = 0.75 * f[3] + 0.5 * f[1];
    const double e1 = inverse_.a * s + inverse_.c * t, e2 = inverse_.b * s + inverse_.d * t;
    if (std::hypot(e1, e2) < 0.3) {
      n_ = normalized(n_ - u_ * e1 - v_ * e2);
      u_ = normalized(u_ - n_ * dot(u_, n_)), v_ = cross(n_, u_);
    }
    at_ = {combined(u_), combined(v_), combined(n_)};
    return set_jacobian();
  }

  Bounded value_of(const Form& f) const {
    Bounded v = at_.z;
    subtract(v, 0.5 * f.l11, squares_.xx), subtract(v, f.l12, squares_.xy),
        subtract(v, 0.5 * f.l22, squares_.yy);
    subtract(v, f.a, xz_), subtract(v, f.b, yz_), subtract(v, 0.5 * f.c, zz_);
    return v;
  }

  void fit_form() {
    squares_ = {product(at_.x, at_.x), product(at_.x, at_.y), product(at_.y, at_.y)};
    xz_ = product(at_.x, at_.z), yz_ = product(at_.y, at_.z), zz_ = product(at_.z, at_.z);
    const auto& z = at_.z.p.c;
    const Quadratic l = pulled_back(z[2][0], z[1][1], z[0][2], inverse_);
    form_ = {l.l11, l.l12, l.l22};
    fit_steepness();
    value_ = value_of(form_);
    const Series c = chebyshev(value_.p);
    const Bounded unbent = value_;
    const Form straight = form_;
    bend(2 * c.c[2][0], c.c[1][1], 2 * c.c[0][2]);
    corrects_normals_ = gradient_bound(value_) > kPlainNormals * request_.normal_tolerance;
    if (corrects_normals_) {
      value_ = unbent, form_ = straight;
      fit_cubic();
    }
    shift();
  }

  void bend(double q20, double q11, double q02) {
    const Quadratic l = pulled_back(q20, q11, q02, inverse_);
    form_.l11 += l.l11, form_.l12 += l.l12, form_.l22 += l.l22;
    for (Bounded* f : {&value_, &rest_})
      subtract(*f, 0.5 * l.l11, squares_.xx), subtract(*f, l.l12, squares_.xy),
          subtract(*f, 0.5 * l.l22, squares_.yy);
  }

  /// a, b, c by least squares on the Chebyshev coefficients of degree 3 and more, which no economy removes.
  void fit_steepness() {
    const Series basis[3] = {chebyshev(xz_.p), chebyshev(yz_.p), chebyshev(zz_.p)},
                 target = chebyshev(value_of(form_).p);
    double g[3][3] = {}, r[3] = {};
    for (int i = 0; i < kN; ++i)
      for (int j = std::max(0, 3 - i); j < kN - i; ++j) {
        const double e[3] = {basis[0].c[i][j], basis[1].c[i][j], 0.5 * basis[2].c[i][j]}, t = target.c[i][j];
        for (int k = 0; k < 3; ++k) {
          r[k] += e[k] * t;
          for (int l = 0; l < 3; ++l) g[k][l] += e[k] * e[l];
        }
      }
    // Where the cell is all but flat c means next to nothing, and comes out as large as it likes; likewise a
    // and b.
    const double ax = size_of(at_.x), ay = size_of(at_.y), az = size_of(at_.z) + request_.tolerance;
    for (int unknowns = 3; unknowns > 1; --unknowns) {
      const Vec3 x = solve_ridge(g, r, unknowns);
      const double steep = std::abs(x.x) * ax + std::abs(x.y) * ay + std::abs(x.z) * az;
      if (!is_finite(x) || !(steep <= kMostSteep)) continue;
      form_.a = x.x, form_.b = x.y, form_.c = x.z;
      return;
    }
  }

  /// The cubic form of (x,y) and the tilt that, with the quadric's own bend, take the difference's gradient
  /// away as far as they can.
  void fit_cubic() {
    const Bounded cubes[4] = {product(squares_.xx, at_.x), product(squares_.xx, at_.y),
                              product(squares_.yy, at_.x), product(squares_.yy, at_.y)};
    rest_ = value_;
    for (int pass = 0; pass < 2; ++pass) {
      const Series c = chebyshev(rest_.p);
      // Leading powers of the Chebyshev polynomials of degree 3, as a form of (x,y).
      const std::array<double, 4> form =
          substituted({4 * c.c[3][0], 2 * c.c[2][1], 2 * c.c[1][2], 4 * c.c[0][3]}, inverse_);
      for (std::size_t k = 0; k < 4; ++k) cubic_[k] += form[k], subtract(rest_, form[k], cubes[k]);
      const Series s = chebyshev(derivative_s(rest_.p)), t = chebyshev(derivative_t(rest_.p));
      bend(0.5 * s.c[1][0], 0.5 * (s.c[0][1] + t.c[1][0]), 0.5 * t.c[0][1]);
    }
    const Series s = chebyshev(derivative_s(rest_.p)), t = chebyshev(derivative_t(rest_.p));
    tilt_ = {inverse_.a * s.c[0][0] + inverse_.c * t.c[0][0],
             inverse_.b * s.c[0][0] + inverse_.d * t.c[0][0]};
    subtract(rest_, tilt_.x, at_.x), subtract(rest_, tilt_.y, at_.y);
  }

  /// A cubic form of (s,t), (s,t) = m (x,y), as one of (x,y).
  static std::array<double, 4> substituted(const std::array<double, 4>& f, const Matrix2& m) {
    const double s[2] = {m.a, m.b}, t[2] = {m.c, m.d};
    std::array<double, 4> out{};
    const double* factor[4][3] = {{s, s, s}, {s, s, t}, {s, t, t}, {t, t, t}};
    for (std::size_t k = 0; k < 4; ++k)
      for (int i = 0; i < 8; ++i) {
        const int a = i & 1, b = i >> 1 & 1, c = i >> 2;
        out[static_cast<std::size_t>(a + b + c)] +=
            f[k] * factor[k][0][a] * factor[k][1][b] * factor[k][2][c];
      }
    return out;
  }

  /// The quadric, and with it the frame, moved along z so that the difference has no constant part.
  void shift() {
    const double e0 = chebyshev(value_.p).c[0][0];
    model_.origin += n_ * e0;
    for (int k = 0; k < 3; ++k) model_.p[static_cast<std::size_t>(k)].c[0][0] -= n_[k] * e0;
    const Bounded old = at_.z;
    at_.z.p.c[0][0] -= e0;
    measure(at_.z);
    subtract(xz_, e0, at_.x), subtract(yz_, e0, at_.y), subtract(zz_, 2 * e0, old);
    zz_.p.c[0][0] += e0 * e0;
    const Bounded before = value_;
    value_ = value_of(form_);
    if (!corrects_normals_) return;
    add(rest_.p, 1, value_.p), add(rest_.p, -1, before.p);
    rest_.r =
        rest_.r + (at_.x.r * std::abs(form_.a) + at_.y.r * std::abs(form_.b) + at_.z.r * std::abs(form_.c)) *
                      std::abs(e0);
  }

  /// The frame turned about z into the quadric's principal directions.
  void place_principal_frame() {
    const double mean = 0.5 * (form_.l11 + form_.l22), half = 0.5 * (form_.l11 - form_.l22),
                 r = std::hypot(half, form_.l12);
    double angle = r > 0 ? 0.5 * std::atan2(form_.l12, half) : 0, k1 = mean + r, k2 = mean - r;
    if (std::abs(k2) > std::abs(k1)) std::swap(k1, k2), angle += 0.5 * 3.14159265358979323846;
    const double c = std::cos(angle), s = std::sin(angle);
    QuadricDp& dp = out_.dp;
    dp.origin = model_.origin;
    dp.u = normalized(u_ * c + v_ * s), dp.v = cross(n_, dp.u);
    dp.lambda_u = k1, dp.lambda_v = k2;
    dp.a = form_.a * c + form_.b * s, dp.b = form_.b * c - form_.a * s, dp.c = form_.c;
    at_.x = combined(dp.u), at_.y = combined(dp.v);
    if (!corrects_normals_) return;
    dp.cubic = substituted(cubic_, {c, -s, s, c});
    dp.tilt = {tilt_.x * c + tilt_.y * s, tilt_.y * c - tilt_.x * s};
  }

  bool certify() {
    QuadricDp& dp = out_.dp;
    Series g;  // ∂F/∂z = 1 − a x − b y − c z
    g.c[0][0] = 1;
    add(g, -dp.a, at_.x.p), add(g, -dp.b, at_.y.p), add(g, -dp.c, at_.z.p);
    g = chebyshev(g);
    const double off = (std::abs(dp.a) + std::abs(dp.b) + std::abs(dp.c)) * model_.r.value;
    gz_ = g.c[0][0] - variation(g) - off - std::abs(dp.c) * request_.tolerance;
    if (!(gz_ >= kLeastSheet)) return cut_by_twist(), false;
    const Series c = chebyshev(value_.p);
    out_.bound = (magnitude(c) + value_.r.value) / gz_;
    if (!(out_.bound <= request_.tolerance)) return cut_by_position(c), false;
    if (!certify_chart()) return cut_by_twist(), false;
    out_.quadric_decides = true;
    const Series z = chebyshev(at_.z.p);
    const double rise = variation(z) + model_.r.value + out_.bound;
    dp.z_lo = z.c[0][0] - rise, dp.z_hi = z.c[0][0] + rise;
    return certify_normals();
  }

  void cut_by_position(const Series& c) {
    out_.quadric_decides = true, out_.excess = out_.bound / request_.tolerance;
    fewest_pieces(out_, [&](int n, int m) {
      return std::max(predicted(c, n, m) / (request_.tolerance * gz_), bent(n, m));
    });
  }
  /// What a cut leaves of a remainder, by the directions that its terms, of degree 6 and more, run in.
  static double left_of(const Remainder& r, int n, int m) {
    const double all = r.ds + r.dt;
    if (!(all > 0)) return r.value;
    return r.value * std::pow(n, -6 * r.ds / all) * std::pow(m, -6 * r.dt / all);
  }
  /// The difference after a cut, economised again.
  double predicted(const Series& c, int n, int m) const {
    double sum = left_of(value_.r, n, m);
    for (int i = 0; i < kN; ++i)
      for (int j = std::max(0, 3 - i); j < kN - i; ++j)
        sum += std::abs(c.c[i][j]) / (power(n, i) * power(m, j));
    return sum;
  }
  static double power(int n, int i) {
    double p = 1;
    for (; i > 0; --i) p *= n;
    return p;
  }

  /// J₀, the mean Jacobian, and ‖J J₀⁻¹ − I‖: below 1 the chart is one to one, and |J⁻ᵀg| <= |J₀⁻ᵀg| / (1 −
  /// twist).
  bool certify_chart() {
    const Series xs = chebyshev(derivative_s(at_.x.p)), xt = chebyshev(derivative_t(at_.x.p)),
                 ys = chebyshev(derivative_s(at_.y.p)), yt = chebyshev(derivative_t(at_.y.p));
    if (!invert({xs.c[0][0], xt.c[0][0], ys.c[0][0], yt.c[0][0]}, inverse_)) return false;
    const auto changes = [&](const Series& s, const Series& t, double by_s, double by_t) {
      Series b;
      add(b, by_s, s), add(b, by_t, t);
      return variation(b) + std::abs(by_s) * model_.r.ds + std::abs(by_t) * model_.r.dt;
    };
    twist_ = std::sqrt(
        squared(changes(xs, xt, inverse_.a, inverse_.c)) + squared(changes(xs, xt, inverse_.b, inverse_.d)) +
        squared(changes(ys, yt, inverse_.a, inverse_.c)) + squared(changes(ys, yt, inverse_.b, inverse_.d)));
    if (!(twist_ <= kMostTwist)) return false;
    const double* m = out_.margins.side;
    out_.gradient_s = std::hypot(inverse_.a, inverse_.b) / (1 - twist_) * (1 + m[1] + m[3]) / 2;
    out_.gradient_t = std::hypot(inverse_.c, inverse_.d) / (1 - twist_) * (1 + m[0] + m[2]) / 2;
    return true;
  }

  /// Largest |J₀⁻ᵀ ∇| of a function.
  double gradient_bound(const Bounded& f) const {
    const Series s = derivative_s(f.p), t = derivative_t(f.p);
    Series x, y;
    add(x, inverse_.a, s), add(x, inverse_.c, t), add(y, inverse_.b, s), add(y, inverse_.d, t);
    return std::hypot(bound_of(x) + std::abs(inverse_.a) * f.r.ds + std::abs(inverse_.c) * f.r.dt,
                      bound_of(y) + std::abs(inverse_.b) * f.r.ds + std::abs(inverse_.d) * f.r.dt);
  }

  /// From the surface's point to the quadric's, `bound` along z, the drawn slope (C − F)x / Fz changes by
  /// this much a length.
  double drift() const {
    const QuadricDp& dp = out_.dp;
    const double ax = size_of(at_.x), ay = size_of(at_.y), az = size_of(at_.z);
    const double* c = dp.cubic.data();
    const double cx = std::abs(dp.tilt[0]) + 3 * std::abs(c[0]) * ax * ax + 2 * std::abs(c[1]) * ax * ay +
                      std::abs(c[2]) * ay * ay;
    const double cy = std::abs(dp.tilt[1]) + std::abs(c[1]) * ax * ax + 2 * std::abs(c[2]) * ax * ay +
                      3 * std::abs(c[3]) * ay * ay;
    const double fx = std::abs(dp.lambda_u) * ax + std::abs(dp.a) * az + cx,
                 fy = std::abs(dp.lambda_v) * ay + std::abs(dp.b) * az + cy;
    return std::hypot(std::abs(dp.a) / gz_ + std::abs(dp.c) * fx / (gz_ * gz_),
                      std::abs(dp.b) / gz_ + std::abs(dp.c) * fy / (gz_ * gz_));
  }

  bool certify_normals() {
    const double over = 1 / ((1 - twist_) * gz_);
    if (std::hypot(out_.dp.tilt[0], out_.dp.tilt[1]) > kMostTilt) return cut_by_normals(), false;
    out_.normal_bound = gradient_bound(corrects_normals_ ? rest_ : value_) * over + out_.bound * drift();
    return out_.normal_bound <= request_.normal_tolerance || (cut_by_normals(), false);
  }

  void cut_by_normals() {
    out_.excess = out_.normal_bound / request_.normal_tolerance;
    const Bounded& f = corrects_normals_ ? rest_ : value_;
    const Series c = chebyshev(f.p);
    const double over = 1 / ((1 - twist_) * gz_);
    const int lowest = corrects_normals_ ? 4 : 3;
    const double by_s = std::hypot(inverse_.a, inverse_.b), by_t = std::hypot(inverse_.c, inverse_.d);
    fewest_pieces(out_, [&](int n, int m) {
      double sum =
          (f.r.ds * by_s * n + f.r.dt * by_t * m) * (f.r.value > 0 ? left_of(f.r, n, m) / f.r.value : 1);
      for (int i = 0; i < kN; ++i)
        for (int j = std::max(0, lowest - i); j < kN - i; ++j)
          sum += std::abs(c.c[i][j]) * (i * i * by_s * n + j * j * by_t * m) / (power(n, i) * power(m, j));
      return std::max(sum * over / request_.normal_tolerance, bent(n, m));
    });
  }

  void make_borders() {
    const int p = cell_.degree_u, q = cell_.degree_v;
    const auto own = [&](int i, int j) {
      const Vec4& w = cell_.pole(i, j);
      const Vec3 d = Vec3{w.x, w.y, w.z} / w.w - out_.dp.origin;
      return Vec2{dot(d, out_.dp.u), dot(d, out_.dp.v)};
    };
    for (int i = 0; i <= p; ++i) out_.border[0].push_back(own(i, 0)), out_.border[2].push_back(own(i, q));
    for (int j = 0; j <= q; ++j) out_.border[1].push_back(own(p, j)), out_.border[3].push_back(own(0, j));
    grown_side(false, -1, out_.grown_border[0]), grown_side(true, 1, out_.grown_border[1]);
    grown_side(false, 1, out_.grown_border[2]), grown_side(true, -1, out_.grown_border[3]);
    out_.border_slack = model_.r.value;
  }

  /// The Bernstein coefficients of the side s (or t) = at.
  void grown_side(bool fixed_s, double at, BorderPoles& out) const {
    std::array<Vec2, kN> c{};
    for (int i = 0; i < kN; ++i)
      for (int j = 0; j < kN - i; ++j) {
        const int free = fixed_s ? j : i, fixed = fixed_s ? i : j;
        const double sign = at < 0 && fixed % 2 ? -1 : 1;
        c[static_cast<std::size_t>(free)].x += sign * at_.x.p.c[i][j];
        c[static_cast<std::size_t>(free)].y += sign * at_.y.p.c[i][j];
      }
    for (int k = 0; k < kN; ++k) out.push_back(bernstein_coefficient(c, k));
  }
  /// Of degree 5 over [−1,1]: by blossoming, k arguments 1 and 5 − k arguments −1.
  static Vec2 bernstein_coefficient(const std::array<Vec2, kN>& c, int k) {
    // The blossom of s^d is the mean over d of 5 arguments of their product: Σ_i (−1)^(d−i) C(k,i) C(5−k,d−i)
    // / C(5,d).
    static constexpr double kBinomial[6][6] = {{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0}, {1, 2, 1, 0, 0, 0},
                                               {1, 3, 3, 1, 0, 0}, {1, 4, 6, 4, 1, 0}, {1, 5, 10, 10, 5, 1}};
    Vec2 sum{};
    for (int d = 0; d < kN; ++d) {
      double factor = 0;
      for (int i = std::max(0, d - (5 - k)); i <= std::min(k, d); ++i)
        factor += ((d - i) % 2 ? -1 : 1) * kBinomial[k][i] * kBinomial[5 - k][d - i];
      sum = sum + c[static_cast<std::size_t>(d)] * (factor / kBinomial[5][d]);
    }
    return sum;
  }

  const BezierPatch& cell_;
  const CellRequest& request_;
  CellFit out_;
  CellModel model_;
  Vec3 u_, v_, n_;
  Coordinates at_;
  Matrix2 inverse_;  ///< of the chart's Jacobian, at the centre; then of the mean one
  Form form_;
  Squares squares_;
  Bounded xz_, yz_, zz_, value_, rest_;
  std::array<double, 4> cubic_{};
  Vec2 tilt_;
  bool corrects_normals_ = false;
  double gz_ = 1, twist_ = 0, twist_s_ = 0, twist_t_ = 0, bend_u_ = 0, bend_v_ = 0;
};

}  // namespace

CellFit fit_graph(const BezierPatch& cell, const CellRequest& request) {
  return GraphFitter(cell, request).fit();
}

}  // namespace dupin
