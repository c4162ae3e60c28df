// One surface of every kind, placed at random, with a region to look at.
#ifndef DUPIN_TESTS_NURBS_KINDS_H
#define DUPIN_TESTS_NURBS_KINDS_H

#include <string>
#include <vector>

#include "../../nurbs/surface.h"

namespace dupin::testing {

struct Sample {
  std::string name;
  Surface surface;
  Box2 region;        ///< regular inside
  double extent = 4;  ///< of kEvaluateError: no radius, length or pole distance here is larger
};
std::vector<Sample> analytic_samples();
/// Profiles: line, circle, ellipse, parabola, and (not rational) hyperbola and offset.
std::vector<Sample> swept_samples(bool rational_only);
/// Offsets of a torus, a B-spline, an extrusion, and an offset of an offset.
std::vector<Sample> offset_samples();

}  // namespace dupin::testing

#endif
