#include "../../sampling/bernstein.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dupin::bernstein {
namespace {

Net random_net(int p, int q, std::mt19937& rng) {
  Net net;
  net.reset(p, q);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) net.at(i, j) = value(rng) * binomials(p)[i] * binomials(q)[j];
  return net;
}

/// Straight from the definition: Σ c_ij s^i (1−s)^(p−i) t^j (1−t)^(q−j), the binomials being in c.
double evaluate(const Net& n, double s, double t) {
  double sum = 0;
  for (int i = 0; i <= n.p; ++i)
    for (int j = 0; j <= n.q; ++j)
      sum +=
          n.at(i, j) * std::pow(s, i) * std::pow(1 - s, n.p - i) * std::pow(t, j) * std::pow(1 - t, n.q - j);
  return sum;
}

TEST(Bernstein, ProductIsTheProductOfTheValues) {
  std::mt19937 rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Net a = random_net(trial % 6, (trial * 7) % 5, rng),
              b = random_net((trial * 3) % 4, trial % 7, rng);
    Net c;
    multiply(a, b, c);
    for (double s : {0.0, 0.3, 1.0})
      for (double t : {0.0, 0.7, 1.0})
        EXPECT_NEAR(evaluate(c, s, t), evaluate(a, s, t) * evaluate(b, s, t), 1e-13);
  }
}

TEST(Bernstein, DerivativesAgreeWithDifferences) {
  std::mt19937 rng(2);
  const Net a = random_net(5, 3, rng);
  Net u, v;
  derivative_u(a, u), derivative_v(a, v);
  const double h = 1e-6;
  for (double s : {0.2, 0.5, 0.9})
    for (double t : {0.1, 0.6}) {
      EXPECT_NEAR(evaluate(u, s, t), (evaluate(a, s + h, t) - evaluate(a, s - h, t)) / (2 * h), 1e-7);
      EXPECT_NEAR(evaluate(v, s, t), (evaluate(a, s, t + h) - evaluate(a, s, t - h)) / (2 * h), 1e-7);
    }
}

TEST(Bernstein, CoefficientsBoundTheValues) {
  std::mt19937 rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Net a = random_net(4, 4, rng);
    const Range r = range(a);
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20; ++j) {
        const double v = evaluate(a, i / 20.0, j / 20.0);
        EXPECT_GE(v, r.lo - 1e-14);
        EXPECT_LE(v, r.hi + 1e-14);
      }
  }
}

TEST(Bernstein, DivisionBySideUndoesMultiplication) {
  std::mt19937 rng(4);
  const Net a = random_net(3, 4, rng);
  const struct {
    Side side;
    int p, q;
    double c0, c1;
  } cases[] = {
      {Side::u0, 1, 0, 0, 1}, {Side::u1, 1, 0, 1, 0}, {Side::v0, 0, 1, 0, 1}, {Side::v1, 0, 1, 1, 0}};
  for (const auto& c : cases) {
    Net factor, product, quotient;
    factor.reset(c.p, c.q);
    factor.c = {c.c0, c.c1};
    multiply(a, factor, product);
    divide_by_side(product, c.side, quotient);
    ASSERT_EQ(quotient.c.size(), a.c.size());
    for (std::size_t i = 0; i < a.c.size(); ++i) EXPECT_DOUBLE_EQ(quotient.c[i], a.c[i]);
  }
}

}  // namespace
}  // namespace dupin::bernstein
