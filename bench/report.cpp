#include "report.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace dupin::bench {

// A mesh faster than this is too short to compare with: its row is shown, and left out of the medians.
constexpr double kShortestSeconds = 0.005;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::string table_line(const nlohmann::json* row) {
  char text[512];
  if (!row) {
    std::snprintf(text, sizeof text, "%-44s %7s %7s %9s %9s %7s %9s %9s %8s %9s", "file", "toler.", "normal",
                  "dupin ms", "mesh ms", "faster", "DPs", "triangles", "curved:", "triangles");
    return text;
  }
  const nlohmann::json& r = *row;
  std::string name = r.at("file");
  if (name.size() > 44) name = "…" + name.substr(name.size() - 43);
  if (r.contains("failed")) return name + ": " + r.at("failed").get<std::string>();
  std::snprintf(text, sizeof text, "%-44s %7.2g %7.3f %9.2f %9.2f %6.1fx %9ld %9ld %8ld %9ld", name.c_str(),
                r.at("tolerance").get<double>(), r.at("normal_degrees").get<double>(),
                1e3 * r.at("dupin_s").get<double>(), 1e3 * r.at("mesh_s").get<double>(),
                r.at("faster").get<double>(), r.at("dps").get<long>(), r.at("triangles").get<long>(),
                r.at("dps_on_curved").get<long>(), r.at("triangles_on_curved").get<long>());
  return text;
}

void print_summary(const std::vector<nlohmann::json>& rows) {
  std::map<double, std::vector<const nlohmann::json*>, std::greater<>> by_tolerance;
  for (const nlohmann::json& row : rows)
    if (!row.contains("failed")) by_tolerance[row.at("tolerance").get<double>()].push_back(&row);
  for (const auto& [tolerance, group] : by_tolerance) {
    std::vector<double> faster, fewer;
    std::size_t slower = 0;
    for (const nlohmann::json* row : group) {
      const auto number = [&](const char* key) { return row->at(key).get<double>(); };
      if (number("dps_on_curved") > 0)
        fewer.push_back(number("triangles_on_curved") / number("dps_on_curved"));
      if (number("mesh_s") < kShortestSeconds) continue;
      faster.push_back(number("faster"));
      slower += number("faster") < 1;
    }
    std::printf(
        "at %g of the diagonal, medians: %.1f times faster (%zu files whose mesh takes 5 ms or more; %zu "
        "slower),"
        " %.1f times fewer primitives on faces that are no quadric\n",
        tolerance, median(faster), faster.size(), slower, median(fewer));
  }
}

}  // namespace dupin::bench
