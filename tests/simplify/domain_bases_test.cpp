// Decompositions into domains: what belongs together, what does not, and that nothing is lost on hard input.
#include "../../simplify/domain_bases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>

#include "../../core/parallel.h"
#include "surfaces.h"

namespace dupin {
namespace {

DomainBases decomposed(const SurfacePoints& points, const DecomposeOptions& options = {}) {
  Result<DomainBases> bases = decompose(points, options);
  if (!bases) throw std::runtime_error(bases.status().message);
  return std::move(*bases);
}

/// Ψ sum to 1, are positive, name domains that there are, and leave no domain without a point.
void expect_partition(const DomainBasis& basis, std::size_t points) {
  ASSERT_EQ(basis.starts.size(), points + 1);
  std::vector<bool> used(basis.domains);
  for (std::size_t i = 0; i < points; ++i) {
    double sum = 0;
    for (std::uint64_t k = basis.starts[i]; k < basis.starts[i + 1]; ++k) {
      ASSERT_LT(basis.domain[k], basis.domains);
      ASSERT_GT(basis.value[k], 0);
      used[basis.domain[k]] = true;
      sum += basis.value[k];
    }
    ASSERT_NEAR(sum, 1, kPartitionError);
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

void expect_partitions(const DomainBases& bases, std::size_t points) {
  for (std::size_t level = 0; level < bases.levels(); ++level) {
    const DomainBasis basis = bases.level(level);
    EXPECT_EQ(basis.domains, bases.domains(level));
    if (level > 0) {
      EXPECT_GT(bases.domains(level), bases.domains(level - 1));
    }
    expect_partition(basis, points);
  }
}

std::vector<std::uint32_t> owners(const DomainBasis& basis) {
  std::vector<std::uint32_t> owner(basis.starts.size() - 1);
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const auto begin = basis.value.begin() + static_cast<std::ptrdiff_t>(basis.starts[i]),
               end = basis.value.begin() + static_cast<std::ptrdiff_t>(basis.starts[i + 1]);
    owner[i] = basis.domain[static_cast<std::size_t>(std::max_element(begin, end) - basis.value.begin())];
  }
  return owner;
}

/// The part of the points that are owned by the domain which most points of their face are owned by, each
/// domain counting for one face.
double purity(const DomainBasis& basis, const std::vector<std::uint32_t>& face) {
  const std::vector<std::uint32_t> owner = owners(basis);
  std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> counts;
  for (std::size_t i = 0; i < face.size(); ++i) ++counts[owner[i]][face[i]];
  std::size_t pure = 0;
  for (const auto& [domain, of_faces] : counts) {
    std::size_t most = 0;
    for (const auto& [f, count] : of_faces) most = std::max(most, count);
    pure += most;
  }
  return static_cast<double>(pure) / static_cast<double>(face.size());
}

/// The level that has exactly so many domains, if any.
std::optional<DomainBasis> level_of(const DomainBases& bases, std::uint32_t domains) {
  for (std::size_t level = 0; level < bases.levels(); ++level)
    if (bases.domains(level) == domains) return bases.level(level);
  return std::nullopt;
}

void expect_one_domain_a_side(const SurfacePoints& points, std::uint32_t sides,
                              const DecomposeOptions& options = {}) {
  const DomainBases bases = decomposed(points, options);
  const auto basis = level_of(bases, sides);
  ASSERT_TRUE(basis) << "no level has a domain for each side";
  EXPECT_GT(purity(*basis, points.faces), 0.93);
}

TEST(DomainBases, OfAnOctahedronAreItsEightSides) {
  expect_one_domain_a_side(test::octahedron(16000), 8);
  expect_one_domain_a_side(test::octahedron_lattice(16000), 8);
  DecomposeOptions options;
  options.neighbors = 100;
  expect_one_domain_a_side(test::octahedron(16000, 2), 8, options);
}

TEST(DomainBases, OfACubeAreItsSixSides) {
  expect_one_domain_a_side(test::cube(16000), 6);
  expect_one_domain_a_side(test::cube_lattice(16000), 6);
}

TEST(DomainBases, HaveMoreAndSmallerDomainsLevelByLevel) {
  const SurfacePoints points = test::octahedron(8000);
  const DomainBases bases = decomposed(points);
  EXPECT_EQ(bases.domains(bases.levels() - 1), 8000U);
  EXPECT_EQ(bases.domains(0), 1U);
  expect_partitions(bases, points.size());
}

TEST(DomainBases, ClassifyEdgesAsSharp) {
  const SurfacePoints points = test::cube(12000);
  const DomainBases bases = decomposed(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points.positions[i];
    std::array<double, 3> a{std::abs(p.x), std::abs(p.y), std::abs(p.z)};
    std::sort(a.begin(), a.end());
    if (a[1] < 0.7) {
      EXPECT_NEAR(bases.classifier()[i], 100, 1e-6) << "in the middle of a side";
    } else if (a[1] > 0.99 && a[0] < 0.7) {
      EXPECT_LT(bases.classifier()[i], 30) << "at an edge";
    } else if (a[0] > 0.98) {
      EXPECT_LT(bases.classifier()[i], 5) << "at a corner";
    }
  }
}

struct HardInput {
  const char* name;
  SurfacePoints points;
  std::uint32_t coarsest;  ///< domains of the coarsest level; 0: any
};

std::vector<HardInput> hard_inputs() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<HardInput> inputs;
  const auto add = [&](const char* name, std::uint32_t coarsest, std::vector<Vec3> positions) {
    inputs.push_back({name, {std::move(positions), {}, {}, {}, {}}, coarsest});
  };
  const auto many = [&](int count, const std::function<Vec3(int)>& at) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(at(i));
    return points;
  };
  const auto uniform = [&] { return unit(random); };
  add("nothing", 0, {});
  add("a point", 1, {{1, 2, 3}});
  add("a point twice", 1, {{1, 2, 3}, {1, 2, 3}});
  add("two points", 1, {{1, 2, 3}, {1, 2, 4}});
  add("a triangle", 1, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add("one place", 1, many(1000, [](int) { return Vec3{1, 2, 3}; }));
  add("a line", 1, many(1000, [](int i) { return Vec3{0.1 * i, 0.2 * i, 1}; }));
  add("islands", 20, many(4000, [&](int i) { return Vec3{uniform() + 100 * (i % 20), uniform(), 0}; }));
  add("small islands", 200, many(1000, [&](int i) {
        return Vec3{uniform() + 100 * (i % 20), uniform() + 100 * (i / 20 % 10), 0};
      }));
  add("dust", 0, many(300, [&](int) { return Vec3{uniform(), uniform(), uniform()} * 1e6; }));
  add("a volume", 1, many(8000, [&](int) { return Vec3{uniform(), uniform(), uniform()}; }));
  add("scan lines", 1, many(4900, [](int i) { return Vec3{double(i % 70), 10.0 * (i / 70), 0}; }));
  add("tiny", 1, many(900, [&](int) { return Vec3{uniform(), uniform(), 0} * 1e-290; }));
  add("huge", 1, many(900, [&](int) { return Vec3{uniform(), uniform(), 0} * 1e290; }));
  add("far away", 1, many(900, [&](int) { return Vec3{1e9 + uniform(), uniform(), 0}; }));
  std::vector<Vec3> twins;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{uniform(), uniform(), 0};
    twins.insert(twins.end(), {p, p, p + Vec3{1e-8, 0, 0}});
  }
  add("doubles and twins", 0, twins);
  return inputs;
}

TEST(DomainBases, LoseNothingOnHardInput) {
  for (const HardInput& input : hard_inputs()) {
    SCOPED_TRACE(input.name);
    const DomainBases bases = decomposed(input.points);
    expect_partitions(bases, input.points.size());
    if (input.coarsest > 0) {
      EXPECT_EQ(bases.domains(0), input.coarsest);
    }
  }
}

TEST(DomainBases, KeepTheTwoSidesOfAThinPlateApart) {
  SurfacePoints points;
  for (int i = 0; i < 5000; ++i) {
    points.positions.push_back({double(i % 50), double(i / 50 % 50), i < 2500 ? 0 : 0.3});
    points.normals.push_back({0, 0, i < 2500 ? -1.0 : 1.0});
    points.faces.push_back(i < 2500 ? 0 : 1);
  }
  const DomainBases bases = decomposed(points);
  EXPECT_EQ(bases.domains(0), 2U);
  EXPECT_EQ(purity(bases.level(0), points.faces), 1);
}

TEST(DomainBases, OfAMeshFollowItsConnections) {
  SurfacePoints sphere = test::sphere_mesh(40);
  const std::uint32_t n = static_cast<std::uint32_t>(sphere.size());
  // A second sphere of the same size that almost touches it, vertices and all.
  SurfacePoints two = sphere;
  for (const Vec3& p : sphere.positions) two.positions.push_back(p + Vec3{0, 0, 2.001});
  two.normals.insert(two.normals.end(), sphere.normals.begin(), sphere.normals.end());
  for (const std::uint32_t i : sphere.triangles) two.triangles.push_back(n + i);
  for (std::uint32_t i = 0; i < 2 * n; ++i) two.faces.push_back(i / n);
  const DomainBases bases = decomposed(two);
  expect_partitions(bases, two.size());
  EXPECT_EQ(bases.domains(0), 2U);
  EXPECT_EQ(purity(bases.level(0), two.faces), 1);
}

TEST(DomainBases, OfAMeshTakeInItsLoosePoints) {
  SurfacePoints points = test::sphere_mesh(20);
  const std::size_t before = points.size();
  for (int i = 0; i < 400; ++i) {
    points.positions.push_back({3 + 0.1 * (i % 20), 0.1 * (i / 20), 0});
    points.normals.push_back({0, 0, 1});
  }
  points.triangles.insert(points.triangles.end(), {0, 0, 1, 2, 2, 2});
  const DomainBases bases = decomposed(points);
  expect_partitions(bases, points.size());
  ASSERT_EQ(bases.domains(0), 2U);
  const std::vector<std::uint32_t> owner = owners(bases.level(0));
  EXPECT_NE(owner[0], owner[before]);
}

TEST(DomainBases, DoNotDependOnTheNumberOfThreads) {
  const SurfacePoints points = test::octahedron(6000);
  const auto all = [&](int threads) {
    set_thread_limit(threads);
    const DomainBases bases = decomposed(points);
    std::vector<double> values = bases.classifier();
    for (std::size_t level = 0; level < bases.levels(); ++level) {
      const DomainBasis basis = bases.level(level);
      values.insert(values.end(), basis.value.begin(), basis.value.end());
      values.insert(values.end(), basis.domain.begin(), basis.domain.end());
    }
    set_thread_limit(0);
    return values;
  };
  const std::vector<double> one = all(1);
  EXPECT_EQ(one, all(2));
  EXPECT_EQ(one, all(7));
}

TEST(DomainBases, RefuseWhatTheyCannotUse) {
  SurfacePoints points = test::cube(100);
  DecomposeOptions options;
  options.neighbors = 2;
  EXPECT_EQ(decompose(points, options).status().code, StatusCode::invalid_argument);
  points.positions[3].x = std::nan("");
  EXPECT_EQ(decompose(points, {}).status().code, StatusCode::invalid_argument);
  points = test::cube(100);
  points.triangles = {0, 1, 100};
  EXPECT_EQ(decompose(points, {}).status().code, StatusCode::invalid_argument);
}

TEST(DomainBases, StopWhenAsked) {
  DecomposeOptions options;
  options.progress = [](std::string_view, double) { return false; };
  EXPECT_EQ(decompose(test::cube(5000), options).status().code, StatusCode::cancelled);
}

TEST(DomainBases, SayWhenTheMultigridProgramIsMissing) {
  ::setenv("DUPIN_MULTIGRID", "/nowhere/dupin-multigrid", 1);
  const Status status = decompose(test::cube(100), {}).status();
  ::unsetenv("DUPIN_MULTIGRID");
  EXPECT_EQ(status.code, StatusCode::unreadable);
  EXPECT_NE(status.message.find("/nowhere/dupin-multigrid"), std::string::npos);
}

TEST(DomainBases, SurviveAMultigridProgramThatAnswersNothing) {
  ::setenv("DUPIN_MULTIGRID", "/bin/true", 1);
  const Status status = decompose(test::cube(3000), {}).status();
  ::unsetenv("DUPIN_MULTIGRID");
  EXPECT_EQ(status.code, StatusCode::unreadable);
}

TEST(Domains, HoldWhatIsAboveTheThresholdAndEveryPoint) {
  const SurfacePoints points = test::octahedron(4000);
  const DomainBases bases = decomposed(points);
  const DomainBasis basis = bases.level(3);
  const std::vector<Domain> domains = domains_of(basis);
  std::vector<int> owned(points.size());
  for (const Domain& d : domains)
    for (std::size_t k = 0; k < d.points.size(); ++k) {
      ++owned[d.points[k]];
      if (k > 0) {
        EXPECT_LT(d.points[k - 1], d.points[k]);
      }
    }
  EXPECT_EQ(std::count(owned.begin(), owned.end(), 0), 0);
  const auto neighbors = domain_neighbors(domains, points.size());
  for (std::uint32_t d = 0; d < neighbors.size(); ++d)
    for (const std::uint32_t e : neighbors[d]) {
      EXPECT_NE(d, e);
      EXPECT_TRUE(std::binary_search(neighbors[e].begin(), neighbors[e].end(), d));
    }
}

TEST(Domains, ThatShareAFewPointsOnlyDoNotBlend) {
  std::vector<Domain> domains(3);
  for (std::uint32_t i = 0; i < 100; ++i) {
    domains[0].points.push_back(i);
    domains[1].points.push_back(i + 96);  // 4 in common
    domains[2].points.push_back(i + 130);
  }
  const auto neighbors = domain_neighbors(domains, 300);
  EXPECT_TRUE(neighbors[0].empty());
  EXPECT_EQ(neighbors[1], std::vector<std::uint32_t>{2});
}

/// Which smooth region of a mesh each vertex is inside of, its sharp edges being borders; none (~0) for the
/// vertices on them.
std::vector<std::uint32_t> smooth_regions(const SurfacePoints& mesh, double sharp_degrees) {
  const auto normal = [&](std::size_t t) {
    const Vec3 &a = mesh.positions[mesh.triangles[t]], &b = mesh.positions[mesh.triangles[t + 1]],
               &c = mesh.positions[mesh.triangles[t + 2]];
    return normalized(cross(b - a, c - a));
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edge_triangle;
  std::vector<bool> on_edge(mesh.size());
  std::vector<std::uint32_t> parent(mesh.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const std::function<std::uint32_t(std::uint32_t)> root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const double cosine = std::cos(sharp_degrees * 3.14159265358979 / 180);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t + k], b = mesh.triangles[t + (k + 1) % 3];
      const auto [at, first] = edge_triangle.emplace(std::minmax(a, b), t);
      if (!first && dot(normal(at->second), normal(t)) < cosine) on_edge[a] = on_edge[b] = true;
    }
  for (const auto& [edge, t] : edge_triangle)
    if (!on_edge[edge.first] && !on_edge[edge.second]) parent[root(edge.first)] = root(edge.second);
  std::vector<std::uint32_t> region(mesh.size());
  for (std::uint32_t i = 0; i < region.size(); ++i) region[i] = on_edge[i] ? ~0U : root(i);
  return region;
}

/// Domains that reach over sharp edges: the part of the points that are inside a smooth region which most of
/// their domain is not of.
double impurity(const DomainBasis& basis, const std::vector<std::uint32_t>& region) {
  const std::vector<std::uint32_t> owner = owners(basis);
  std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> counts;
  std::size_t inside = 0, pure = 0;
  for (std::size_t i = 0; i < region.size(); ++i)
    if (region[i] != ~0U) ++counts[owner[i]][region[i]], ++inside;
  for (const auto& [domain, regions] : counts) {
    std::size_t most = 0;
    for (const auto& [r, count] : regions) most = std::max(most, count);
    pure += most;
  }
  return 1 - static_cast<double>(pure) / static_cast<double>(inside);
}

TEST(DomainBases, OfTheRockerArmAndTheFandiskEndAtCreases) {
  const char* data = std::getenv("DUPIN_DATA");
  if (!data) GTEST_SKIP() << "DUPIN_DATA is not set";
  for (const auto& [file, most] : {std::pair{"rocker-arm.obj", 500U}, {"fandisk.obj", 300U}}) {
    SCOPED_TRACE(file);
    const SurfacePoints mesh = test::read_obj(std::string(data) + "/mesh/classic/" + file);
    if (mesh.positions.empty()) GTEST_SKIP() << file << " is missing";
    const std::vector<std::uint32_t> region = smooth_regions(mesh, 45);
    const DomainBases bases = decomposed(mesh);
    std::size_t level = 0;
    while (level + 1 < bases.levels() && bases.domains(level + 1) <= most) ++level;
    const double impure = impurity(bases.level(level), region);
    RecordProperty("impurity", std::to_string(impure));
    std::printf("%s: %u domains, impurity %.4f\n", file, bases.domains(level), impure);
    EXPECT_LT(impure, 0.03);
  }
}

}  // namespace
}  // namespace dupin
