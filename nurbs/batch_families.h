// Inside the folder: how the batch evaluator computes each family of surfaces.
#ifndef DUPIN_NURBS_BATCH_FAMILIES_H
#define DUPIN_NURBS_BATCH_FAMILIES_H

#include <memory>
#include <span>

#include "batch_evaluator.h"
#include "batch_kernels.h"

namespace dupin {

/// A batch on its way: parameters, what to compute, and where it goes.
struct Batch {
  std::span<const double> u, v;
  kernels::Wanted wanted;
  Sides sides;
  bool scalar = false;
  kernels::Outputs out;  ///< of sample 0

  kernels::Outputs out_at(std::size_t sample) const;
};

/// Everything about one sample, for those that a kernel leaves to the careful.
void store(const SurfaceJet& jet, const Curvature& k, const kernels::Wanted& wanted,
           const kernels::Outputs& out);

class BatchFamily {
 public:
  virtual ~BatchFamily() = default;
  virtual void grid(const Batch& batch) const = 0;
  virtual void scattered(const Batch& batch) const = 0;
};

std::unique_ptr<BatchFamily> make_spline_family(const BsplineSurface& spline, const Surface& surface,
                                                int order);
/// All kinds that sweep a profile, and planes.
std::unique_ptr<BatchFamily> make_swept_family(const Surface& surface);
/// One sample at a time: offsets.
std::unique_ptr<BatchFamily> make_single_family(const Surface& surface);

/// At a point whose curvature double precision does not see: with limits, taken towards the middle of the
/// domain.
Curvature careful_curvature(const Surface& surface, double u, double v);

}  // namespace dupin

#endif
