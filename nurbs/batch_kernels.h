// Inside the folder: the loops of the batch evaluator that run in SIMD lanes, and their scalar twin.
//
// One source, batch_kernels-inl.h, is compiled for every instruction set and once for plain doubles. It uses
// additions, multiplications, divisions and square roots alone, each rounded on its own: whichever of them
// runs gives the same results to the last bit.
#ifndef DUPIN_NURBS_BATCH_KERNELS_H
#define DUPIN_NURBS_BATCH_KERNELS_H

#include <array>
#include <cstddef>
#include <cstdint>

#include "jets.h"

namespace dupin::kernels {

/// The results that can be stored, each as arrays of doubles. Jets come first, in the order of jet_index.
enum Channel : int {
  kJet = 0,
  kNormal = 3 * jet_size(3),
  kDirection1 = kNormal + 3,
  kDirection2 = kDirection1 + 3,
  kK1 = kDirection2 + 3,
  kK2,
  kMean,
  kGauss,
  kChannels
};
/// Where a run of consecutive samples goes; null: not wanted.
struct Outputs {
  std::array<double*, kChannels> at{};
  std::uint8_t* kind = nullptr;  ///< a Curvature::Kind, or kCareful
};
/// Instead of a kind: double precision may not do here, or the curvature has no value; the caller sees to it.
inline constexpr std::uint8_t kCareful = 255;

/// A derivative of the numerator and the weight, as Bézier poles: poles[(i · columns + j) · components + c].
/// Derivatives by the surface's own parameters: the chain rule's factors are in the poles.
struct Net {
  std::uint32_t offset = 0;  ///< into the cell's poles
  std::uint8_t degree_u = 0, degree_v = 0;
  bool zero = true;  ///< beyond the degree
};

/// Loads and stores of whole blocks of lanes may reach this far beyond what counts.
inline constexpr std::size_t kPadding = 16;

/// What all cells of a spline share.
struct NetLayout {
  int degree_u = 0, degree_v = 0, order = 2;
  int components = 3;  ///< 4: the last one is the weight
  std::array<Net, jet_size(3)> nets;
  std::uint32_t size = 0;  ///< doubles a cell, and kPadding more that may be read
};

/// Numbers that say when a cell's curvature is safe in double precision.
struct CellScale {
  double size[jet_size(2)] = {};  ///< the largest coordinate of each net's poles, by the smallest weight
  double least_curvature = 0;     ///< smaller ones count as this
};

struct Cell {
  const NetLayout* layout = nullptr;
  const double* poles = nullptr;  ///< relative to `reference`
  Vec3 reference;
  CellScale scale;
};

/// What to compute: jets up to `order`, and more.
struct Wanted {
  int order = 0;           ///< of the jets that are stored, or needed
  bool normal = false;     ///< only with order >= 1
  bool curvature = false;  ///< only with order >= 2; normal, directions and values, as channels say
};

/// Bernstein values of a row of parameters s in [0,1]: of the degree, and of 1 … order less. Row
/// `basis_row(degree, k, i)` holds the i-th polynomial of degree `degree − k`.
constexpr int basis_row(int degree, int k, int i) {
  return k * (degree + 1) - k * (k - 1) / 2 + i;
}
constexpr int basis_rows(int degree, int order) {
  return basis_row(degree, order + 1, 0);
}

/// Where a point lies in its cell: s for what is left of the middle, 1 − s for what is right of it, exact to
/// rounding at both ends.
struct LocalRange {
  double lo = 0, hi = 1;
};

/// values[row · stride + n] for the parameters t[n].
struct BasisJob {
  const double* t = nullptr;
  std::size_t count = 0;
  LocalRange range;
  int degree = 0, order = 0;
  double* values = nullptr;
  std::size_t stride = 0;
};

/// One u against consecutive v of one cell.
struct RowJob {
  const Cell* cell = nullptr;
  const double* basis_u = nullptr;  ///< of this u, rows 1 apart
  const double* basis_v = nullptr;  ///< of the first v, rows `stride` apart
  std::size_t stride = 0, count = 0;
  Wanted wanted;
  const Outputs* out = nullptr;
  std::size_t first = 0;  ///< the first v's sample
};

/// Points of one cell.
struct PointsJob {
  const Cell* cell = nullptr;
  const double *u = nullptr, *v = nullptr;
  std::size_t count = 0;
  LocalRange range_u, range_v;
  Wanted wanted;
  const Outputs* out = nullptr;
  std::size_t first = 0;  ///< the first point's sample
};

/// A surface of revolution, or an extrusion: derivatives of its profile, and what is constant along the
/// sweep, in components along the turning (fixed) axes. profile[3k + c] is component c of the k-th
/// derivative. Everything is an array; a stride of 0 repeats one value.
struct SweptJob {
  bool turned = false;
  std::array<const double*, 12> profile{};
  std::array<const double*, 9> frame{};  ///< normal, first and second direction
  std::array<const double*, 2> k{};      ///< k1, k2
  const std::uint8_t* kind = nullptr;
  std::size_t profile_stride = 1;
  const double *cosine = nullptr, *sine = nullptr;  ///< turned: of the angle
  const double* length = nullptr;                   ///< moved: along the direction
  std::size_t sweep_stride = 0;
  Vec3 origin, x, y, z;  ///< turned: the axes; moved: x, y, z are those of space and `direction` counts
  Vec3 direction;
  std::size_t count = 0;
  Wanted wanted;
  const Outputs* out = nullptr;
  std::size_t first = 0;
};

/// The fastest instruction set of this machine, or the scalar twin.
void basis(const BasisJob& job, bool scalar);
void row(const RowJob& job, bool scalar);
void points(const PointsJob& job, bool scalar);
void swept(const SweptJob& job, bool scalar);
/// "AVX3", "SSE4", …
const char* instruction_set();

}  // namespace dupin::kernels

#endif
