#include "batch_kernels.h"

// Compiles this file once for every instruction set that matters; scalable vectors cannot be members of a
// struct.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch_kernels.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
// clang-format off: the order matters
#include <hwy/foreach_target.h>
#include "batch_kernels-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace dupin::kernels {
namespace HWY_NAMESPACE {

void BasisLanes(const BasisJob& job) {
  basis_of<Lanes>(job);
}
void RowLanes(const RowJob& job) {
  row_of<Lanes>(job);
}
void PointsLanes(const PointsJob& job) {
  points_of<Lanes>(job);
}
void SweptLanes(const SweptJob& job) {
  swept_of<Lanes>(job);
}
#if HWY_TARGET == HWY_STATIC_TARGET
void basis_single(const BasisJob& job) {
  basis_of<Single>(job);
}
void row_single(const RowJob& job) {
  row_of<Single>(job);
}
void points_single(const PointsJob& job) {
  points_of<Single>(job);
}
void swept_single(const SweptJob& job) {
  swept_of<Single>(job);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace dupin::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dupin::kernels {

HWY_EXPORT(BasisLanes);
HWY_EXPORT(RowLanes);
HWY_EXPORT(PointsLanes);
HWY_EXPORT(SweptLanes);

void basis(const BasisJob& job, bool scalar) {
  if (scalar) return HWY_STATIC_DISPATCH(basis_single)(job);
  HWY_DYNAMIC_DISPATCH(BasisLanes)(job);
}
void row(const RowJob& job, bool scalar) {
  if (scalar) return HWY_STATIC_DISPATCH(row_single)(job);
  HWY_DYNAMIC_DISPATCH(RowLanes)(job);
}
void points(const PointsJob& job, bool scalar) {
  if (scalar) return HWY_STATIC_DISPATCH(points_single)(job);
  HWY_DYNAMIC_DISPATCH(PointsLanes)(job);
}
void swept(const SweptJob& job, bool scalar) {
  if (scalar) return HWY_STATIC_DISPATCH(swept_single)(job);
  HWY_DYNAMIC_DISPATCH(SweptLanes)(job);
}
const char* instruction_set() {
  const std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(targets & ~(targets - 1));
}

}  // namespace dupin::kernels
#endif
