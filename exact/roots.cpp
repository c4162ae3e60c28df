#include "roots.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dupin::exact {
namespace {

long double value(const Power& c, long double t) {
  long double sum = 0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * t + c[i];
  return sum;
}

Power derivative(const Power& c) {
  Power d;
  for (std::size_t i = 1; i < c.size(); ++i) d.push_back(c[i] * static_cast<long double>(i));
  return d;
}

/// The only root in [lo, hi], at whose ends the signs differ.
long double bracketed_root(const Power& c, const Power& slope, long double lo, long double hi) {
  const bool rising = value(c, hi) > 0;
  long double t = (lo + hi) / 2;
  for (int step = 0; step < 200; ++step) {
    const long double f = value(c, t);
    if (f == 0) return t;
    ((f > 0) == rising ? hi : lo) = t;
    const long double s = value(slope, t), newton = s != 0 ? t - f / s : hi;
    const long double next = newton > lo && newton < hi && step % 4 != 3 ? newton : (lo + hi) / 2;
    if (next == t || !(next > lo && next < hi)) return next == t ? t : (lo + hi) / 2;
    t = next;
  }
  return t;
}

/// The two halves at ½ of a polynomial in Bernstein form, by de Casteljau.
void halve(std::vector<double>& left, std::vector<double>& right) {
  const std::size_t n = left.size();
  right = left;
  for (std::size_t level = 1; level < n; ++level)
    for (std::size_t i = n - 1; i >= level; --i) left[i] = 0.5 * (left[i - 1] + left[i]);
  for (std::size_t level = n - 1; level >= 1; --level)
    for (std::size_t i = 0; i < level; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
}

int sign_changes(const std::vector<double>& c) {
  int changes = 0;
  double last = 0;
  for (const double x : c) {
    if (x == 0) continue;
    changes += last != 0 && (x > 0) != (last > 0);
    last = x;
  }
  return changes;
}

/// Appends the sign changes within [lo, hi], over which the coefficients are given.
void isolate(std::vector<double> c, double lo, double hi, std::vector<double>& roots) {
  const int changes = sign_changes(c);
  if (changes == 0) return;
  const double middle = 0.5 * (lo + hi);
  if (hi - lo <= kRootWidth) {
    if (changes % 2 == 1) roots.push_back(middle);
    return;
  }
  std::vector<double> right;
  halve(c, right);
  isolate(c, lo, middle, roots);
  // A root at the very middle is a sign change of neither half.
  const auto last = std::find_if(c.rbegin(), c.rend(), [](double x) { return x != 0; });
  const auto first = std::find_if(right.begin(), right.end(), [](double x) { return x != 0; });
  if (c.back() == 0 && last != c.rend() && first != right.end() && (*last > 0) != (*first > 0))
    roots.push_back(middle);
  isolate(std::move(right), middle, hi, roots);
}

}  // namespace

std::vector<long double> roots_between(const Power& polynomial, long double lo, long double hi) {
  Power c = polynomial;
  while (!c.empty() && c.back() == 0) c.pop_back();
  std::vector<long double> roots;
  if (c.size() < 2 || !(lo < hi)) return roots;
  const Power slope = derivative(c);
  std::vector<long double> ends{lo};
  for (const long double t : roots_between(slope, lo, hi))
    if (t > ends.back() && t < hi) ends.push_back(t);
  ends.push_back(hi);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const long double a = value(c, ends[i]), b = value(c, ends[i + 1]);
    if (a == 0)
      roots.push_back(ends[i]);
    else if ((a > 0) != (b > 0) && b != 0)
      roots.push_back(bracketed_root(c, slope, ends[i], ends[i + 1]));
  }
  if (value(c, hi) == 0) roots.push_back(hi);
  return roots;
}

std::vector<double> bernstein_sign_changes(std::span<const double> coefficients) {
  double largest = 0;
  for (const double c : coefficients) largest = std::max(largest, std::abs(c));
  std::vector<double> roots;
  if (largest == 0) return roots;
  // What is rounding of zero must not look like a sign.
  std::vector<double> c(coefficients.begin(), coefficients.end());
  for (double& x : c)
    if (std::abs(x) < 1e-15 * largest) x = 0;
  isolate(std::move(c), 0, 1, roots);
  return roots;
}

}  // namespace dupin::exact
