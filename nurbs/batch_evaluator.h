// Many points of a surface at once: positions, derivatives, normals and principal curvatures as arrays, in
// SIMD lanes (AVX-512, AVX2, SSE4, NEON, whichever the machine has) and on several threads.
//
//     Result<BatchEvaluator> surface = BatchEvaluator::make(face_surface);
//     SurfaceSamples samples;
//     surface->grid(us, vs, {.compute = Compute::points | Compute::curvatures}, samples);
//     samples.k1[i * vs.size() + j]                                                     // at (us[i], vs[j])
//
// Splines, rational or not, of any degree (loops are unrolled for 1 to 5), and the analytic, swept and offset
// kinds. The results do not depend on the instruction set, the number of threads, or the other points of the
// batch: every operation is one that IEEE 754 rounds correctly, and sums are formed in one order. (Sines and
// cosines are the standard library's.) `evaluate` and `principal_curvature` in surface.h are the same surface
// one point at a time; their results differ from these by rounding.
//
// Where double precision would lose the curvature (close to a pole or a collapsed edge, for almost parallel
// partials) splines are evaluated in double-double arithmetic; at singular points the limit is taken.
// Curvature::Kind says which, sample by sample.
#ifndef DUPIN_NURBS_BATCH_EVALUATOR_H
#define DUPIN_NURBS_BATCH_EVALUATOR_H

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "../core/status.h"
#include "surface.h"

namespace dupin {

/// What a batch computes: any of these, joined with |.
enum class Compute : unsigned {
  points = 1,
  first_derivatives = 2,
  second_derivatives = 4,
  third_derivatives = 8,
  normals = 16,
  curvatures = 32,  ///< k1, k2
  directions = 64,  ///< d1, d2
  mean_and_gauss = 128,
};
constexpr Compute operator|(Compute a, Compute b) {
  return static_cast<Compute>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool has(Compute set, Compute what) {
  return (static_cast<unsigned>(set) & static_cast<unsigned>(what)) != 0;
}

struct Vec3Array {
  std::span<const double> x, y, z;
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// One entry a sample in the arrays that were asked for; the others are empty. They all lie in one piece of
/// memory, which batches that are no larger use again.
struct SurfaceSamples {
  std::size_t count = 0;
  Vec3Array p, pu, pv, puu, puv, pvv, puuu, puuv, puvv, pvvv;
  Vec3Array n, d1, d2;  ///< unit; d1 × d2 = n
  std::span<const double> k1, k2, mean, gauss;
  /// With normals, curvatures, directions or mean_and_gauss: what the sample is. Where `undefined`, these are
  /// NaN.
  std::span<const Curvature::Kind> kind;

  SurfaceSamples() = default;
  SurfaceSamples(SurfaceSamples&&) = default;
  SurfaceSamples& operator=(SurfaceSamples&&) = default;

 private:
  friend class BatchEvaluator;
  std::vector<double> values_;
  std::vector<Curvature::Kind> kinds_;
};

struct BatchOptions {
  Compute compute = Compute::points;
  Sides sides;          ///< which derivatives are meant at knots
  bool scalar = false;  ///< without SIMD: the same results to the last bit
};

class BatchEvaluator {
 public:
  /// For derivatives up to `max_order` (2 or 3; curvatures need 2). Refuses what check(surface) refuses.
  static Result<BatchEvaluator> make(Surface surface, int max_order = 2);
  BatchEvaluator(BatchEvaluator&&) noexcept;
  BatchEvaluator& operator=(BatchEvaluator&&) noexcept;
  ~BatchEvaluator();

  /// Sample i · v.size() + j is that of (u[i], v[j]). Fastest where neighbours in v lie in one knot span.
  void grid(std::span<const double> u, std::span<const double> v, const BatchOptions& options,
            SurfaceSamples& out) const;
  /// Sample i is that of (u[i], v[i]); as many v as u.
  void scattered(std::span<const double> u, std::span<const double> v, const BatchOptions& options,
                 SurfaceSamples& out) const;

  const Surface& surface() const;

 private:
  class Impl;
  explicit BatchEvaluator(std::unique_ptr<Impl> impl);
  void run(std::span<const double> u, std::span<const double> v, std::size_t count, bool grid,
           const BatchOptions& options, SurfaceSamples& out) const;
  std::unique_ptr<Impl> impl_;
};

/// The instruction set that batches run on here: "AVX3" (AVX-512), "AVX2", "SSE4", "NEON", "SCALAR".
const char* batch_instruction_set();

}  // namespace dupin

#endif
