// Domains as rectangles with textures: what they describe is the surface, and nothing is lost on hard input.
#include "../../simplify/domain_primitives.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../core/parallel.h"
#include "../../simplify/domain_file.h"
#include "surfaces.h"

namespace dupin {
namespace {

DomainBases decomposed(const SurfacePoints& points) {
  Result<DomainBases> bases = decompose(points, {});
  if (!bases) throw std::runtime_error(bases.status().message);
  return std::move(*bases);
}

DomainSet made(const SurfacePoints& points, const DomainBases& bases, std::size_t level,
               const DomainPrimitiveOptions& options = {}) {
  Result<DomainSet> set = make_domain_set(points, bases, level, options);
  if (!set) throw std::runtime_error(set.status().message);
  const Status good = check(*set);
  EXPECT_TRUE(good.ok()) << good.message;
  return std::move(*set);
}

struct Place {
  Vec3 position, normal;
  double psi = 0;
};

Place place_of(const DomainSet& set, const DomainPrimitive& p, std::uint32_t i, std::uint32_t j) {
  const std::size_t at = std::size_t(p.y + j) * set.atlas.width + p.x + i;
  const auto& t = set.atlas.normal_height[at];
  const double x = p.half_u * (2 * (i + 0.5) / p.width - 1), y = p.half_v * (2 * (j + 0.5) / p.height - 1);
  const auto of_byte = [](std::uint8_t b) { return (b - 128) / 127.0; };
  return {p.center + p.u * x + p.v * y + p.n() * (p.lo + (p.hi - p.lo) * t[3] / 255.0),
          p.u * of_byte(t[0]) + p.v * of_byte(t[1]) + p.n() * of_byte(t[2]), set.atlas.psi[at] / 255.0};
}

template <class What>
void each_texel(const DomainSet& set, const What& what) {
  for (const DomainPrimitive& p : set.primitives)
    for (std::uint32_t j = 0; j < p.height; ++j)
      for (std::uint32_t i = 0; i < p.width; ++i) what(place_of(set, p, i, j), p);
}

/// A level with about so many domains.
std::size_t level_near(const DomainBases& bases, double domains) {
  std::size_t best = 0;
  for (std::size_t level = 0; level < bases.levels(); ++level)
    if (std::abs(std::log(bases.domains(level) / domains)) <
        std::abs(std::log(bases.domains(best) / domains)))
      best = level;
  return best;
}

TEST(DomainPrimitives, OfASphereLieOnItAndHaveItsNormals) {
  const SurfacePoints points = test::sphere_mesh(60);
  const DomainBases bases = decomposed(points);
  const DomainSet set = made(points, bases, level_near(bases, 60));
  ASSERT_GT(set.primitives.size(), 20U);
  std::size_t seen = 0;
  double worst = 0, worst_cosine = 1;
  each_texel(set, [&](const Place& at, const DomainPrimitive&) {
    if (at.psi < 0.3) return;
    ++seen;
    worst = std::max(worst, std::abs(length(at.position) - 1));
    worst_cosine = std::min(worst_cosine, dot(normalized(at.normal), normalized(at.position)));
  });
  EXPECT_GT(seen, points.size() / 2);
  EXPECT_LT(worst, 0.5 * set.texel);
  EXPECT_GT(worst_cosine, 0.995);
  EXPECT_LT(set.deviation_99, 0.2 * set.texel);
  EXPECT_LE(set.deviation_rms, set.deviation_99);
}

TEST(DomainPrimitives, ShowAllOfADomainThatFolds) {
  for (const bool oriented : {true, false}) {
    SurfacePoints points = test::sphere_mesh(40);
    if (!oriented) points.normals.clear(), points.triangles.clear();
    const DomainBases bases = decomposed(points);
    ASSERT_LE(bases.domains(0), 8U);
    const DomainSet set = made(points, bases, 0);
    EXPECT_GE(set.primitives.size(), 4U);
    EXPECT_LE(set.primitives.size(), 20U);
    EXPECT_LT(set.deviation_99, 0.1);
    EXPECT_EQ(set.oriented, oriented);
    std::vector<Place> seen;
    each_texel(set, [&](const Place& at, const DomainPrimitive&) {
      if (at.psi > 0.3) seen.push_back(at);
    });
    for (const Vec3& p : points.positions)
      ASSERT_TRUE(std::any_of(seen.begin(), seen.end(),
                              [&](const Place& at) { return distance(at.position, p) < 2 * set.texel; }));
  }
}

TEST(DomainPrimitives, TexturesOfAllDomainsSumToOne) {
  const SurfacePoints points = test::sphere_mesh(60);
  const DomainBases bases = decomposed(points);
  const DomainSet set = made(points, bases, level_near(bases, 60));
  double sum = 0;
  each_texel(set, [&](const Place& at, const DomainPrimitive& p) {
    const double texel = 4 * p.half_u * p.half_v / (p.width * p.height);
    // Seen from along n a piece of surface is smaller by the cosine.
    if (at.psi > 0) sum += at.psi * texel / std::max(0.3, dot(normalized(at.position), p.n()));
  });
  EXPECT_NEAR(sum / (4 * 3.14159265358979), 1, 0.06)
      << "the sphere's area, each piece weighted with its Ψ, but for those below τ";
}

TEST(DomainPrimitives, CarryTheColorsAndFacesOfTheirPoints) {
  SurfacePoints points = test::cube(6000);
  for (const std::uint32_t f : points.faces) points.colors.push_back(0xff000000U + 40 * f);
  const DomainBases bases = decomposed(points);
  const DomainSet set = made(points, bases, level_near(bases, 100));
  EXPECT_EQ(set.faces, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(set.atlas.face.size(), set.atlas.psi.size());
  std::size_t seen = 0;
  for (const DomainPrimitive& p : set.primitives)
    for (std::uint32_t k = 0; k < p.width * p.height; ++k) {
      const std::size_t at = std::size_t(p.y + k / p.width) * set.atlas.width + p.x + k % p.width;
      ASSERT_EQ(set.atlas.color[at], 0xff000000U + 40U * set.atlas.face[at]);
      seen += set.atlas.psi[at] > 128;
    }
  EXPECT_GT(seen, 1000U);
}

TEST(DomainPrimitives, LoseNothingOnHardInput) {
  const auto line = [] {
    SurfacePoints points;
    for (int i = 0; i < 200; ++i) points.positions.push_back({0.01 * i, 0.02 * i, 0});
    return points;
  };
  const auto copies = [] {
    SurfacePoints points;
    points.positions.assign(100, Vec3{1, 2, 3});
    return points;
  };
  const auto islands = [] {
    SurfacePoints points = test::cube(120);
    for (int i = 0; i < 20; ++i) points.positions.push_back({100.0 * i, 50, 0});
    points.faces.clear();
    return points;
  };
  const auto one = [] { return SurfacePoints{{{5, 5, 5}}, {}, {}, {}, {}}; };
  for (const SurfacePoints& points : {line(), copies(), islands(), one()}) {
    const DomainBases bases = decomposed(points);
    for (std::size_t level = 0; level < bases.levels(); ++level) {
      const DomainSet set = made(points, bases, level);
      EXPECT_GE(set.primitives.size(), bases.domains(level));
      std::vector<Place> seen;
      each_texel(set, [&](const Place& at, const DomainPrimitive&) {
        if (at.psi > 0.1) seen.push_back(at);
      });
      for (const Vec3& p : points.positions)
        EXPECT_TRUE(std::any_of(seen.begin(), seen.end(),
                                [&](const Place& at) { return distance(at.position, p) < 2 * set.texel; }))
            << p.x << ' ' << p.y << ' ' << p.z << " level " << level << " of " << bases.levels() << ' '
            << bases.domains(level) << ' ' << set.primitives.size() << ' ' << set.texel << ' '
            << points.size();
    }
  }
  EXPECT_TRUE(make_domain_set({}, decomposed({}), 0, {})->primitives.empty());
}

TEST(DomainPrimitives, GetLargerTexelsWhereTheAtlasIsSmall) {
  const SurfacePoints points = test::sphere_mesh(40);
  const DomainBases bases = decomposed(points);
  const std::size_t level = level_near(bases, 30);
  DomainPrimitiveOptions small;
  small.most_atlas = 48;
  const DomainSet set = made(points, bases, level, small), large = made(points, bases, level);
  EXPECT_LE(set.atlas.width, 48U);
  EXPECT_LE(set.atlas.height, 48U);
  EXPECT_GT(set.texel, large.texel);
  small.most_atlas = 16;
  EXPECT_EQ(make_domain_set(points, bases, bases.levels() - 1, small).status().code, StatusCode::limit);
}

TEST(DomainPrimitives, DoNotDependOnTheNumberOfThreads) {
  const SurfacePoints points = test::sphere_mesh(30);
  const DomainBases bases = decomposed(points);
  const std::size_t level = level_near(bases, 40);
  set_thread_limit(1);
  const DomainSet alone = made(points, bases, level);
  set_thread_limit(4);
  const DomainSet together = made(points, bases, level);
  set_thread_limit(0);
  EXPECT_EQ(alone.atlas.psi, together.atlas.psi);
  EXPECT_EQ(alone.atlas.normal_height, together.atlas.normal_height);
  EXPECT_EQ(alone.neighbors, together.neighbors);
  EXPECT_EQ(alone.deviation_99, together.deviation_99);
}

TEST(DomainPrimitives, RefuseWhatTheyCannotUse) {
  const SurfacePoints points = test::cube(200);
  const DomainBases bases = decomposed(points);
  DomainPrimitiveOptions options;
  EXPECT_EQ(make_domain_set(points, bases, bases.levels(), options).status().code,
            StatusCode::invalid_argument);
  EXPECT_EQ(make_domain_set(test::cube(100), bases, 0, options).status().code, StatusCode::invalid_argument);
  options.texel = -1;
  EXPECT_EQ(make_domain_set(points, bases, 0, options).status().code, StatusCode::invalid_argument);
  options = {};
  options.progress = [](std::string_view, double) { return false; };
  EXPECT_EQ(make_domain_set(points, bases, 0, options).status().code, StatusCode::cancelled);
}

TEST(DomainPrimitives, AreCheckedBeforeTheyAreDrawn) {
  const SurfacePoints points = test::cube(2000);
  const DomainBases bases = decomposed(points);
  const DomainSet good = made(points, bases, level_near(bases, 12));
  const auto broken = [&](auto&& change) {
    DomainSet set = good;
    change(set);
    return !check(set).ok();
  };
  EXPECT_TRUE(broken([](DomainSet& s) { s.primitives[0].width = 5000; }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.primitives[0].x = s.atlas.width; }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.primitives[0].u = {1, 1, 1}; }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.primitives[0].half_u = std::nan(""); }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.primitives[0].face = 99; }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.neighbors.push_back(99); }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.primitives[0].neighbors = 1000; }));
  EXPECT_TRUE(broken([](DomainSet& s) { s.atlas.psi.pop_back(); }));
}

TEST(DomainFile, GivesBackWhatWasWritten) {
  SurfacePoints points = test::cube(3000);
  for (const std::uint32_t f : points.faces) points.colors.push_back(0xff000000U + 1000 * f);
  const DomainBases bases = decomposed(points);
  DomainScene scene;
  scene.parts.resize(3);
  scene.parts[1] = {made(points, bases, 1), made(points, bases, level_near(bases, 40))};
  const std::string bytes = write_domains(scene, 77);
  const Result<DomainFile> file = read_domains(bytes);
  ASSERT_TRUE(file.ok()) << file.status().message;
  EXPECT_EQ(file->key, 77U);
  ASSERT_EQ(file->scene.parts.size(), 3U);
  EXPECT_TRUE(file->scene.parts[0].empty());
  ASSERT_EQ(file->scene.parts[1].size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const DomainSet &a = scene.parts[1][k], &b = file->scene.parts[1][k];
    ASSERT_EQ(a.primitives.size(), b.primitives.size());
    for (std::size_t i = 0; i < a.primitives.size(); ++i) {
      EXPECT_EQ(a.primitives[i].center, b.primitives[i].center);
      EXPECT_LT(distance(a.primitives[i].n(), b.primitives[i].n()), 1e-6);
      EXPECT_EQ(a.primitives[i].hi, b.primitives[i].hi);
      EXPECT_EQ(a.primitives[i].x, b.primitives[i].x);
    }
    EXPECT_EQ(a.neighbors, b.neighbors);
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(a.atlas.psi, b.atlas.psi);
    EXPECT_EQ(a.atlas.normal_height, b.atlas.normal_height);
    EXPECT_EQ(a.atlas.color, b.atlas.color);
    EXPECT_EQ(a.atlas.face, b.atlas.face);
    EXPECT_EQ(a.deviation_99, b.deviation_99);
    EXPECT_EQ(a.points, b.points);
  }
}

TEST(DomainFile, IsRefusedWhereAnyByteIsDamaged) {
  const SurfacePoints points = test::cube(120);
  const DomainBases bases = decomposed(points);
  DomainScene scene;
  scene.parts = {{made(points, bases, 1)}};
  const std::string bytes = write_domains(scene, 1);
  for (std::size_t i = 0; i < bytes.size(); i += 1 + i / 50) {
    std::string bad = bytes;
    bad[i] = static_cast<char>(bad[i] ^ 4);
    ASSERT_EQ(read_domains(bad).status().code, StatusCode::unreadable) << i;
    ASSERT_EQ(read_domains(bytes.substr(0, i)).status().code, StatusCode::unreadable) << i;
  }
  EXPECT_FALSE(read_domains(bytes + "x").ok());
  EXPECT_FALSE(read_domains("").ok());
}

}  // namespace
}  // namespace dupin
