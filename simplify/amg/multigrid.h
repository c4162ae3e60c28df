// One step of algebraic multigrid: from a matrix to the prolongation that hypre's BoomerAMG makes of it.
//
// hypre runs in a process of its own, dupin-multigrid, which lives as long as this object: Debian's hypre is
// built on MPI, whose initialisation takes a quarter of a second, opens sockets and starts threads, none of
// which a library should do to its host.
#ifndef DUPIN_SIMPLIFY_AMG_MULTIGRID_H
#define DUPIN_SIMPLIFY_AMG_MULTIGRID_H

#include <memory>

#include "../../core/progress.h"
#include "../../core/status.h"
#include "sparse.h"

namespace dupin::amg {

class Multigrid {
 public:
  /// Starts the process. unreadable: this Dupin was built without hypre, or the program is missing.
  static Result<std::unique_ptr<Multigrid>> start();
  ~Multigrid();

  /// `matrix`: square, its diagonal first in each row, every other entry at most 0, rows summing to 0 (but
  /// those without other entries, whose diagonal is 1). The answer has a row a node; nodes without couplings
  /// have none in theirs. No column at all: it cannot be made coarser.
  Result<Sparse<double>> prolongation(const Sparse<double>& matrix, const Progress& progress);

 private:
  class Process;
  explicit Multigrid(std::unique_ptr<Process> process);
  std::unique_ptr<Process> process_;
};

/// Which coarsening, interpolation and threshold of BoomerAMG are used; decisions.md says why.
inline constexpr int kCoarsening = 6;     ///< Falgout; in one process Ruge and Stüben's
inline constexpr int kInterpolation = 0;  ///< classical
inline constexpr double kStrongThreshold = 0.25;
inline constexpr int kMostInterpolation = 4;  ///< entries of a row

}  // namespace dupin::amg

#endif
