// Points of spline surfaces: Dupin's batches beside Open CASCADE's and SISL's evaluators.
//
// All sides get the same surfaces and the same parameters and take turns; the median of the runs counts. Open
// CASCADE is asked the way its manual does: GeomAdaptor_Surface::D2 (which caches the span it is in) for
// derivatives, one GeomLProp_SLProps whose parameters are set point by point for normals, both curvatures and
// both directions. SISL's s1421 gives derivatives to second order and the normal. Dupin's results are stored
// as arrays; the peers' are summed up.
#include <sisl.h>
#include <GeomAdaptor_Surface.hxx>
#include <GeomLProp_SLProps.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <gp_Dir.hxx>
#include <gp_Vec.hxx>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../../core/parallel.h"
#include "../../nurbs/batch_evaluator.h"
#include "../report.h"

namespace dupin::bench {
namespace {

using Json = nlohmann::json;

/// splitmix64 in [0, 1).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

/// A bumpy height field over [0, 1]² with `spans` knot spans each way.
BsplineSurface bumpy(int degree, int spans, bool rational, std::uint64_t seed) {
  Random random(seed);
  BsplineSurface s;
  s.degree_u = s.degree_v = degree;
  s.count_u = s.count_v = degree + spans;
  for (int i = 0; i < degree; ++i) s.knots_u.push_back(0);
  for (int i = 0; i <= spans; ++i) s.knots_u.push_back(static_cast<double>(i) / spans);
  for (int i = 0; i < degree; ++i) s.knots_u.push_back(1);
  s.knots_v = s.knots_u;
  for (int i = 0; i < s.count_u; ++i)
    for (int j = 0; j < s.count_v; ++j) {
      s.poles.push_back({i + 0.3 * random(), j + 0.3 * random(), random()});
      if (rational) s.weights.push_back(0.5 + random());
    }
  return s;
}

Handle(Geom_BSplineSurface) occt_surface(const BsplineSurface& s, int spans) {
  TColgp_Array2OfPnt poles(1, s.count_u, 1, s.count_v);
  TColStd_Array2OfReal weights(1, s.count_u, 1, s.count_v);
  for (int i = 0; i < s.count_u; ++i)
    for (int j = 0; j < s.count_v; ++j) {
      const std::size_t at = static_cast<std::size_t>(i * s.count_v + j);
      poles(i + 1, j + 1) = gp_Pnt(s.poles[at].x, s.poles[at].y, s.poles[at].z);
      weights(i + 1, j + 1) = s.weights.empty() ? 1 : s.weights[at];
    }
  TColStd_Array1OfReal knots(1, spans + 1);
  TColStd_Array1OfInteger multiplicities(1, spans + 1);
  for (int i = 0; i <= spans; ++i) {
    knots(i + 1) = s.knots_u[static_cast<std::size_t>(s.degree_u + i)];
    multiplicities(i + 1) = i == 0 || i == spans ? s.degree_u + 1 : 1;
  }
  if (s.weights.empty())
    return new Geom_BSplineSurface(poles, knots, knots, multiplicities, multiplicities, s.degree_u,
                                   s.degree_v);
  return new Geom_BSplineSurface(poles, weights, knots, knots, multiplicities, multiplicities, s.degree_u,
                                 s.degree_v);
}

SISLSurf* sisl_surface(const BsplineSurface& s) {
  std::vector<double> poles;  // the first parameter runs fastest
  for (int j = 0; j < s.count_v; ++j)
    for (int i = 0; i < s.count_u; ++i) {
      const std::size_t at = static_cast<std::size_t>(i * s.count_v + j);
      const double w = s.weights.empty() ? 1 : s.weights[at];
      for (int c = 0; c < 3; ++c) poles.push_back(s.poles[at][c] * w);
      if (!s.weights.empty()) poles.push_back(w);
    }
  std::vector<double> u = s.knots_u, v = s.knots_v;
  return newSurf(s.count_u, s.count_v, s.degree_u + 1, s.degree_v + 1, u.data(), v.data(), poles.data(),
                 s.weights.empty() ? 1 : 2, 3, 1);
}

/// Grids of one knot span each, in turn; or as many points anywhere on the surface, in batches of one size.
/// Results of a tile fit a core's cache, as whoever works on them would choose.
struct Points {
  bool grid = true;
  std::vector<std::vector<double>> u, v;
  std::size_t count = 0;

  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t tile = 0; tile < u.size(); ++tile)
      if (grid)
        for (double a : u[tile])
          for (double b : v[tile]) visit(a, b);
      else
        for (std::size_t i = 0; i < u[tile].size(); ++i) visit(u[tile][i], v[tile][i]);
  }
};

Points make_points(bool grid, int spans, int side) {
  Points points;
  points.grid = grid;
  Random random(7);
  constexpr std::size_t kBatch = 8192;
  points.count = static_cast<std::size_t>(spans * spans * side * side);
  const auto line = [&](int span) {
    std::vector<double> t;
    for (int i = 0; i < side; ++i) t.push_back((span + (i + 0.5) / side) / spans);
    return t;
  };
  for (int i = 0; grid && i < spans; ++i)
    for (int j = 0; j < spans; ++j) points.u.push_back(line(i)), points.v.push_back(line(j));
  for (std::size_t i = 0; !grid && i < points.count; ++i) {
    if (i % kBatch == 0) points.u.emplace_back(), points.v.emplace_back();
    points.u.back().push_back(random());
    points.v.back().push_back(random());
  }
  return points;
}

double g_sink = 0;

class Sides {
 public:
  Sides(const BsplineSurface& surface, int spans)
      : batch_(std::move(*BatchEvaluator::make({surface}))),
        geometry_(occt_surface(surface, spans)),
        adaptor_(geometry_),
        properties_(geometry_, 2, 1e-12),
        sisl_(sisl_surface(surface)) {}
  ~Sides() { freeSurf(sisl_); }
  Sides(const Sides&) = delete;
  Sides& operator=(const Sides&) = delete;

  void dupin(const Points& points, Compute compute, bool threads) {
    const BatchOptions options{compute, {}, false};
    const auto tile = [&](std::size_t i, SurfaceSamples& out) {
      if (points.grid)
        batch_.grid(points.u[i], points.v[i], options, out);
      else
        batch_.scattered(points.u[i], points.v[i], options, out);
    };
    if (!threads) {
      for (std::size_t i = 0; i < points.u.size(); ++i) tile(i, samples_);
      return;
    }
    parallel_for(points.u.size(), [&](std::size_t i) {
      thread_local SurfaceSamples out;
      tile(i, out);
    });
  }
  void occt_d2(const Points& points) {
    gp_Pnt p;
    gp_Vec du, dv, duu, dvv, duv;
    points.each([&](double u, double v) {
      adaptor_.D2(u, v, p, du, dv, duu, dvv, duv);
      g_sink += p.Z() + duu.Z() + dvv.X();
    });
  }
  void occt_properties(const Points& points) {
    gp_Dir d1, d2;
    points.each([&](double u, double v) {
      properties_.SetParameters(u, v);
      if (!properties_.IsNormalDefined() || !properties_.IsCurvatureDefined()) return;
      g_sink += properties_.Normal().Z() + properties_.MaxCurvature() + properties_.MinCurvature();
      if (properties_.IsUmbilic()) return;
      properties_.CurvatureDirections(d1, d2);
      g_sink += d1.X() + d2.X();
    });
  }
  void sisl(const Points& points) {
    int left_u = 0, left_v = 0, status = 0;
    double derivatives[18], normal[3];
    points.each([&](double u, double v) {
      double at[2] = {u, v};
      s1421(sisl_, 2, at, &left_u, &left_v, derivatives, normal, &status);
      g_sink += derivatives[2] + normal[2];
    });
  }

 private:
  BatchEvaluator batch_;
  SurfaceSamples samples_;
  Handle(Geom_BSplineSurface) geometry_;
  GeomAdaptor_Surface adaptor_;
  GeomLProp_SLProps properties_;
  SISLSurf* sisl_;
};

template <class Run>
double nanoseconds(const Points& points, const Run& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
  return spent.count() / static_cast<double>(points.count);
}

constexpr Compute kDerivatives = Compute::points | Compute::first_derivatives | Compute::second_derivatives;
constexpr Compute kCurvatures =
    Compute::points | Compute::normals | Compute::curvatures | Compute::directions;

struct Options {
  int degree = 3, spans = 13, side = 40, runs = 9;
  std::string output;
};

Json measure(const Options& options, bool rational, bool grid) {
  Sides sides(bumpy(options.degree, options.spans, rational, 1), options.spans);
  const Points points = make_points(grid, options.spans, options.side);
  std::map<std::string, std::vector<double>> times;
  for (int run = 0; run < options.runs; ++run) {
    const auto time = [&](const char* name, const auto& f) { times[name].push_back(nanoseconds(points, f)); };
    set_thread_limit(1);
    time("dupin_d2", [&] { sides.dupin(points, kDerivatives, false); });
    time("dupin_curvature", [&] { sides.dupin(points, kCurvatures, false); });
    time("occt_d2", [&] { sides.occt_d2(points); });
    time("occt_curvature", [&] { sides.occt_properties(points); });
    time("sisl_d2", [&] { sides.sisl(points); });
    set_thread_limit(2);
    time("dupin_d2_2threads", [&] { sides.dupin(points, kDerivatives, true); });
    time("dupin_curvature_2threads", [&] { sides.dupin(points, kCurvatures, true); });
  }
  Json row = {{"surface", rational ? "rational" : "polynomial"},
              {"degree", options.degree},
              {"points", grid ? "grid" : "scattered"},
              {"count", points.count}};
  for (const auto& [name, values] : times) row[name + "_ns"] = median(values);
  const auto ratio = [&](const char* a, const char* b) {
    return row[a].get<double>() / row[b].get<double>();
  };
  row["d2_beside_occt"] = ratio("occt_d2_ns", "dupin_d2_ns");
  row["d2_beside_sisl"] = ratio("sisl_d2_ns", "dupin_d2_ns");
  row["curvature_beside_occt"] = ratio("occt_curvature_ns", "dupin_curvature_ns");
  row["d2_two_threads"] = ratio("dupin_d2_ns", "dupin_d2_2threads_ns");
  row["curvature_two_threads"] = ratio("dupin_curvature_ns", "dupin_curvature_2threads_ns");
  return row;
}

void print(const Json& row) {
  const auto number = [&row](const char* name) { return row[name].get<double>(); };
  std::printf("%-10s %-9s  D2: %6.1f ns  OCCT %6.1f (%5.1fx)  SISL %6.1f (%5.1fx)  2 threads %.2fx\n",
              row["surface"].get<std::string>().c_str(), row["points"].get<std::string>().c_str(),
              number("dupin_d2_ns"), number("occt_d2_ns"), number("d2_beside_occt"), number("sisl_d2_ns"),
              number("d2_beside_sisl"), number("d2_two_threads"));
  std::printf("%-20s  normal, k1, k2, d1, d2: %6.1f ns  OCCT %6.1f (%5.1fx)  2 threads %.2fx\n", "",
              number("dupin_curvature_ns"), number("occt_curvature_ns"), number("curvature_beside_occt"),
              number("curvature_two_threads"));
}

}  // namespace

int run_main(int argc, char** argv) {
  CLI::App app("Dupin's batch evaluator beside Open CASCADE's and SISL's, on one thread");
  Options options;
  app.add_option("--degree", options.degree, "of the surfaces, both ways")->check(CLI::Range(1, 15));
  app.add_option("--spans", options.spans, "knot spans each way")->check(CLI::Range(1, 1000));
  app.add_option("--side", options.side, "points a span each way")->check(CLI::Range(1, 1000));
  app.add_option("--runs", options.runs, "of which the median counts")->check(CLI::Range(1, 1000));
  app.add_option("-o", options.output, "JSON lines");
  CLI11_PARSE(app, argc, argv);
  std::printf("degree %d, %d x %d spans, %d x %d points a span, %s, medians of %d\n", options.degree,
              options.spans, options.spans, options.side, options.side, batch_instruction_set(),
              options.runs);
  std::ofstream out;
  if (!options.output.empty()) out.open(options.output);
  for (const bool rational : {false, true})
    for (const bool grid : {true, false}) {
      const Json row = measure(options, rational, grid);
      print(row);
      if (out.is_open()) out << row.dump() << "\n";
    }
  return g_sink == 12345 ? 1 : 0;
}

}  // namespace dupin::bench

int main(int argc, char** argv) {
  return dupin::bench::run_main(argc, argv);
}
