// The order in which the figure 10 of Reniers & Telea (2006) draws domains: front to back, each blended with
// the neighbors that are not drawn yet before its own pixels are locked.
#ifndef DUPIN_RENDER_DOMAIN_PREFIXES_H
#define DUPIN_RENDER_DOMAIN_PREFIXES_H

#include <cstdint>
#include <vector>

namespace dupin {

/// A domain that may be drawn.
struct PrefixDomain {
  double distance = 0;                   ///< of its center from the viewer
  bool facing = true;                    ///< else it is not drawn at all
  std::vector<std::uint32_t> neighbors;  ///< indices of domains
};

struct PrefixStep {
  std::uint32_t first = 0, count = 0;  ///< of `order`: drawn and blended now
  std::uint32_t lock = 0;              ///< of `order`: whose pixels are then locked
};
struct PrefixPlan {
  std::vector<std::uint32_t> order;  ///< every facing domain, once
  std::vector<PrefixStep> steps;     ///< one each
};

/// Of equally distant ones the first comes first.
PrefixPlan plan_prefixes(const std::vector<PrefixDomain>& domains);

}  // namespace dupin

#endif
