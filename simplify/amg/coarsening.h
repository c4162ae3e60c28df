// From one level of domains to the next coarser (Reniers & Telea, §2.3).
//
// The bases of a level, not its Galerkin matrix, say how strongly its domains hold together: W = Ψᵀ(−A)Ψ, the
// couplings of all pairs of points weighted by how much they belong to the two domains (weighted aggregation,
// as in their reference 19). Its entries are positive and grow with the border that two domains share, while
// a Galerkin matrix, being exact, lets a crease fade as domains grow: a long thin resistor is none. The same
// sum with C = 1 tells how flat the border is, C̄ = W / W₁.
//
// 1. *Borders.* Two domains hold together if C̄ of their border is at least `contrast` times the C of each of
//    them. A domain that is much less flat than those beside it, and holds to them more than to its like (a
//    crease, a tip), is given to them.
// 2. *Multigrid* on the rest, with the couplings of what holds together.
// 3. What is coupled to nothing stays a domain of its own. When nothing else is left, the contrast is
// lowered.
#ifndef DUPIN_SIMPLIFY_AMG_COARSENING_H
#define DUPIN_SIMPLIFY_AMG_COARSENING_H

#include "multigrid.h"
#include "stiffness.h"

namespace dupin::amg {

/// The first separates every crease that the classifier sees; the others merge what is left in the order of
/// how sharp its borders are.
inline constexpr double kContrasts[] = {0.85, 0.5, 0.2, 0};

class Coarsening {
 public:
  Coarsening(Sparse<Coupling> couplings, const std::vector<double>& classifiers);

  /// How many domains there are.
  std::uint32_t count() const { return links_.columns; }
  /// The prolongation to the next coarser level; no columns: there is none.
  Result<Sparse<double>> next(Multigrid& multigrid, const Progress& progress);

 private:
  Result<Sparse<double>> step(Multigrid& multigrid, double contrast, const Progress& progress);
  Sparse<double> absorption(double contrast) const;
  Sparse<double> bordered(double contrast) const;
  void apply(const Sparse<double>& prolongation);

  Sparse<Coupling> links_;
  std::vector<double> flatness_;  ///< mean C of the points of a domain
  std::vector<double> sizes_;     ///< how many points there are
  std::size_t phase_ = 0;
};

/// Negative entries dropped and rows made to sum to 1; rows without entries get a column of their own.
Sparse<double> partition_of_unity(const Sparse<double>& prolongation);

}  // namespace dupin::amg

#endif
