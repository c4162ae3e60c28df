#include "domain_prefixes.h"

#include <algorithm>
#include <limits>

namespace dupin {

PrefixPlan plan_prefixes(const std::vector<PrefixDomain>& domains) {
  constexpr std::uint32_t kNotDrawn = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> sorted;
  for (std::uint32_t i = 0; i < domains.size(); ++i)
    if (domains[i].facing) sorted.push_back(i);
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    return domains[a].distance < domains[b].distance;
  });
  PrefixPlan plan;
  std::vector<std::uint32_t> place(domains.size(), kNotDrawn);
  const auto draw = [&](std::uint32_t i) {
    if (place[i] != kNotDrawn || !domains[i].facing) return;
    place[i] = static_cast<std::uint32_t>(plan.order.size());
    plan.order.push_back(i);
  };
  for (const std::uint32_t i : sorted) {
    const auto first = static_cast<std::uint32_t>(plan.order.size());
    draw(i);
    for (const std::uint32_t j : domains[i].neighbors) draw(j);
    plan.steps.push_back({first, static_cast<std::uint32_t>(plan.order.size()) - first, place[i]});
  }
  return plan;
}

}  // namespace dupin
