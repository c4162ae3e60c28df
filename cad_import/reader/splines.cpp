#include "splines.h"

#include <algorithm>

namespace dupin::reader {

std::vector<double> full_knots(const TColStd_Array1OfReal& knots,
                               const TColStd_Array1OfInteger& multiplicities, int degree, bool periodic) {
  std::vector<double> flat;
  const int last = knots.Upper() - (periodic ? 1 : 0);
  for (int i = knots.Lower(); i <= last; ++i) flat.insert(flat.end(), multiplicities(i), knots(i));
  if (!periodic) return flat;

  // One period of knots, continued both ways: F(i) = flat[i mod n] + T·⌊i/n⌋. The domain begins at the last
  // of the copies of the first knot, which gets the index `degree`.
  const int n = static_cast<int>(flat.size());
  const double period = knots(knots.Upper()) - knots(knots.Lower());
  const int shift = multiplicities(multiplicities.Lower()) - 1 - degree;
  std::vector<double> full(n + 2 * degree + 1);
  for (int i = 0; i < static_cast<int>(full.size()); ++i) {
    const int j = i + shift, turn = j >= 0 ? j / n : -((n - 1 - j) / n);
    full[i] = flat[j - turn * n] + turn * period;
  }
  return full;
}

void drop_equal_weights(std::vector<double>& weights) {
  if (std::all_of(weights.begin(), weights.end(), [&](double w) { return w == weights.front(); }))
    weights.clear();
}

}  // namespace dupin::reader
