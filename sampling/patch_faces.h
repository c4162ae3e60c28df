// Faces on surfaces that are no quadrics: certified subdivision in parameter space.
#ifndef DUPIN_SAMPLING_PATCH_FACES_H
#define DUPIN_SAMPLING_PATCH_FACES_H

#include "boundary.h"
#include "quadric_dp.h"
#include "tolerance_field.h"

namespace dupin {

struct PatchFaceInput {
  const Part& part;
  const Face& face;
  std::uint32_t face_index;
  const FaceBoundary& boundary;  ///< with uv
  const ToleranceField& tolerance;
  double normal_tolerance;
};

struct PatchFaceResult {
  int dps = 0;
  bool rational = true;  ///< false: the surface has no Bézier form and was interpolated (its bounds include
                         ///< the sampled error)
  bool defined = false;  ///< whether such an interpolation was possible
};

PatchFaceResult make_patch_face(const PatchFaceInput& in, PartDps& out);

}  // namespace dupin

#endif
