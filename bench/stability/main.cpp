// How exact the batch evaluator's curvatures are: random patches and families of hard ones, beside 100-digit
// arithmetic.
//
// Errors are relative to the larger of the two curvatures. Where it is itself small beside the surface's
// second derivatives the problem is ill-conditioned: the condition number says by how much
// (hundred_digits.h), and errors are also given divided by it. Directions are compared where the curvatures
// differ by more than a millionth.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../../core/parallel.h"
#include "../../nurbs/batch_evaluator.h"
#include "families.h"
#include "hundred_digits.h"

namespace dupin::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Outcome {
  double error = 0, condition = 1, angle = 0;
  bool regular = false;    ///< there is a curvature
  bool undefined = false;  ///< the evaluator says that there is none
  bool unflagged = false;  ///< not finite, and not said
};

constexpr double kApart = 1e-6;

Outcome measure(const Trial& trial) {
  Outcome out;
  const ExactCurvature exact = exact_curvature(trial.surface, trial.u, trial.v);
  out.regular = exact.regular;
  const auto batch = BatchEvaluator::make({trial.surface});
  if (!batch.ok()) {
    out.unflagged = true;
    return out;
  }
  SurfaceSamples samples;
  const double u[] = {trial.u}, v[] = {trial.v};
  batch.value().scattered(
      u, v, {.compute = Compute::points | Compute::normals | Compute::curvatures | Compute::directions},
      samples);
  const double k1 = samples.k1[0], k2 = samples.k2[0];
  const Vec3 d1 = samples.d1[0];
  out.undefined = samples.kind[0] == Curvature::Kind::undefined;
  const bool finite = std::isfinite(k1) && std::isfinite(k2) && is_finite(d1) && is_finite(samples.n[0]);
  out.unflagged = !finite && !out.undefined;
  if (!exact.regular || !finite || exact.k1 == 0) return out;
  out.error = std::max(std::abs(k1 - exact.k1), std::abs(k2 - exact.k2)) / std::abs(exact.k1);
  // Where both are almost as large and of opposite signs, which of them is the first is rounding's choice.
  const bool swapped = std::abs(k1 + exact.k1) < std::abs(k1 - exact.k1);
  if (swapped) out.error = std::max(std::abs(k1 - exact.k2), std::abs(k2 - exact.k1)) / std::abs(exact.k1);
  out.condition = std::max(exact.condition, 1.0);
  if (!swapped && std::abs(exact.k1 - exact.k2) > kApart * std::abs(exact.k1))
    out.angle = std::atan2(length(cross(d1, exact.d1)), std::abs(dot(d1, exact.d1)));
  return out;
}

struct Summary {
  std::string name;
  std::size_t count = 0, unflagged = 0, undefined = 0;
  double largest = 0, median = 0, p99 = 0, worst_condition = 0, largest_by_condition = 0, angle = 0;
};

double quantile(std::vector<double>& values, double part) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Summary summarize(const std::string& name, const std::vector<Outcome>& outcomes) {
  Summary s;
  s.name = name, s.count = outcomes.size();
  std::vector<double> errors;
  for (const Outcome& o : outcomes) {
    s.unflagged += o.unflagged;
    s.undefined += o.regular && o.undefined;
    errors.push_back(o.error);
    if (o.error > s.largest) s.largest = o.error, s.worst_condition = o.condition;
    s.largest_by_condition = std::max(s.largest_by_condition, o.error / o.condition);
    s.angle = std::max(s.angle, o.angle);
  }
  s.median = quantile(errors, 0.5), s.p99 = quantile(errors, 0.99);
  return s;
}

Summary run(const std::string& name, std::size_t count, std::uint64_t seed, Trial (*make)(Random&)) {
  std::vector<Outcome> outcomes(count);
  parallel_for(
      count,
      [&](std::size_t i) {
        Random random(seed + i);
        outcomes[i] = measure(make(random));
      },
      64);
  return summarize(name, outcomes);
}

void print(const Summary& s) {
  std::printf("| %s | %zu | %.1e | %.1e | %.1e | %.0e | %.1e | %.1e | %zu | %zu |\n", s.name.c_str(), s.count,
              s.median, s.p99, s.largest, s.worst_condition, s.largest_by_condition, s.angle, s.undefined,
              s.unflagged);
  std::fflush(stdout);
}

Json to_json(const Summary& s) {
  return {{"family", s.name},
          {"trials", s.count},
          {"median", s.median},
          {"p99", s.p99},
          {"largest", s.largest},
          {"condition_there", s.worst_condition},
          {"largest_by_condition", s.largest_by_condition},
          {"direction_radians", s.angle},
          {"said_undefined", s.undefined},
          {"unflagged", s.unflagged}};
}

}  // namespace

int run_main(int argc, char** argv) {
  CLI::App app("Curvatures of the batch evaluator beside 100-digit arithmetic");
  std::size_t patches = 1'000'000, hard = 1000, wild = 100'000;
  std::uint64_t seed = 1;
  std::string output;
  app.add_option("--patches", patches, "random patches");
  app.add_option("--wild", wild, "random patches with poles anywhere in a cube");
  app.add_option("--hard", hard, "of each hard family");
  app.add_option("--seed", seed);
  app.add_option("-o", output, "JSON lines");
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| surfaces | trials | median error | 99 %% below | largest | condition there | largest by condition | "
      "direction, rad | said undefined | not finite, unsaid |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  std::ofstream out;
  if (!output.empty()) out.open(output);
  std::size_t unflagged = 0;
  const auto add = [&](const Summary& s) {
    print(s);
    unflagged += s.unflagged;
    if (out.is_open()) out << to_json(s).dump() << "\n";
  };
  for (const Family& family : hard_families())
    if (hard > 0) add(run(family.name, hard, seed * 1'000'003, family.make));
  if (patches > 0) add(run("random, degrees 1 to 15", patches, seed * 7'000'003, random_patch));
  if (wild > 0) add(run("the same, poles anywhere", wild, seed * 9'000'011, wild_patch));
  return unflagged == 0 ? 0 : 1;
}

}  // namespace dupin::bench

int main(int argc, char** argv) {
  return dupin::bench::run_main(argc, argv);
}
