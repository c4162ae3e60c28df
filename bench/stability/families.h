// The surfaces of the stability report: random ones, and families of hard ones.
#ifndef DUPIN_BENCH_STABILITY_FAMILIES_H
#define DUPIN_BENCH_STABILITY_FAMILIES_H

#include <string>
#include <vector>

#include "../../nurbs/surface.h"

namespace dupin::bench {

/// splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double between(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }
  double log_between(double lo, double hi);
  int integer(int lo, int hi) {
    return lo + static_cast<int>(next() % static_cast<std::uint64_t>(hi - lo + 1));
  }

 private:
  std::uint64_t state_;
};

/// A surface, and parameters at which it is looked at, at least 1e-6 from where it is singular.
struct Trial {
  BsplineSurface surface;
  double u = 0.5, v = 0.5;
};

/// Of degrees 1 to 15, independent each way, over a bumpy grid with weights from 0.1 to 10.
Trial random_patch(Random& random);
/// The same with poles anywhere in a cube: folded, and with partials at any angle.
Trial wild_patch(Random& random);

struct Family {
  std::string name;
  Trial (*make)(Random& random);
};
const std::vector<Family>& hard_families();

}  // namespace dupin::bench

#endif
