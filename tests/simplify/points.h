// Differential points for tests, and files for them.
#ifndef DUPIN_TESTS_SIMPLIFY_POINTS_H
#define DUPIN_TESTS_SIMPLIFY_POINTS_H

#include <random>
#include <string>
#include <vector>

#include "../../sampling/differential_point.h"

namespace dupin::testing {

inline constexpr double kEpsilon = 0.02, kDelta = 0.5;

/// With frames turned at random, curvatures of both signs over six decades, some planes, cylinders and
/// umbilics; `own_sizes`: every third has a size of its own.
std::vector<DifferentialPoint> random_points(std::size_t count, unsigned seed, bool own_sizes);

/// A path in a folder of this process's own.
std::string scratch_file(const std::string& name);
std::vector<unsigned char> bytes_of(const std::string& path);
void write_bytes(const std::string& path, const std::vector<unsigned char>& bytes);

}  // namespace dupin::testing

#endif
