// Inside the folder: polynomials in two variables over the unit square, in scaled Bernstein form.
//
// Coefficient (i, j) is stored times C(p, i)·C(q, j): products are then plain convolutions (Farouki & Rajan),
// and the convex-hull property bounds the polynomial by its unscaled coefficients.
#ifndef DUPIN_NURBS_TENSOR_H
#define DUPIN_NURBS_TENSOR_H

#include <array>
#include <span>
#include <vector>

#include "bezier.h"
#include "knots.h"

namespace dupin {

struct Tensor {
  int p = 0, q = 0;
  std::vector<double> c;
  Tensor() : c(1, 0.0) {}
  Tensor(int degree_u, int degree_v)
      : p(degree_u), q(degree_v), c(static_cast<std::size_t>((degree_u + 1) * (degree_v + 1)), 0.0) {}
  double& at(int i, int j) { return c[static_cast<std::size_t>(i * (q + 1) + j)]; }
  double at(int i, int j) const { return c[static_cast<std::size_t>(i * (q + 1) + j)]; }
};

/// Four times the highest degree of a spline, as in a torus's equation.
inline constexpr int kMaxTensorDegree = 4 * kMaxDegree;

/// C(n, 0) … C(n, n), n up to kMaxTensorDegree.
std::span<const double> binomials(int n);

Tensor operator*(const Tensor& a, const Tensor& b);
Tensor operator*(const Tensor& a, double s);
/// Of any two degrees: the lower is raised.
Tensor operator+(const Tensor& a, const Tensor& b);
Tensor operator-(const Tensor& a, const Tensor& b);
inline Tensor squared(const Tensor& a) {
  return a * a;
}
Tensor raised(const Tensor& a, int p, int q);
Tensor derivative_u(const Tensor& a);
Tensor derivative_v(const Tensor& a);

/// The smallest and largest coefficient, between which the polynomial stays.
ParameterRange coefficient_range(const Tensor& a);
double largest_coefficient(const Tensor& a);
/// max |a / b| by the coefficients' quotients; b's must be positive, else infinite. Equal degrees.
double largest_quotient(const Tensor& a, const Tensor& b);

/// The numerators X = w·S relative to `origin`, along three axes, and the weight w, of a patch.
struct HomogeneousTensors {
  std::array<Tensor, 3> x;
  Tensor w;
};
HomogeneousTensors homogeneous_tensors(const BezierPatch& patch, const Frame3& frame);

/// w³ Su × Sv = w Xu × Xv − wv Xu × X − wu X × Xv (without the weights if the patch has none).
std::array<Tensor, 3> normal_tensors(const HomogeneousTensors& t, bool rational);

}  // namespace dupin

#endif
