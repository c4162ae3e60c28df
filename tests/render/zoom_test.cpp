// A camera a thousand times closer, on the fillets and spline faces of models: what is drawn keeps to the
// bounds asked for at every pixel, and shows no facet.
#include "../../sampling/sampler.h"
#include "../cad_import/files.h"
#include "device.h"

namespace dupin::testing {
namespace {

constexpr double kDegree = 180 / 3.14159265358979323846;
constexpr double kCloser = 1000;
/// Facets would show as jumps of the normal from one pixel to the next that the surface does not make. By
/// their bounds of a quarter degree neighbouring DPs may be half a degree apart.
constexpr double kJumpDegrees = 0.15;

/// A point inside a face: the origin of a DP that is bounded by its footprint alone.
struct Spot {
  std::uint32_t part, face;
  Vec3 point, normal;
};
std::vector<Spot> spots(const Model& model) {
  SamplingOptions options;
  options.tolerance = 1e-3 * bounding_box(model).diagonal();
  const auto scene = sample_quadric_dps(model, options);
  std::vector<Spot> result;
  if (!scene.ok()) return result;
  for (std::uint32_t part = 0; part < model.parts.size(); ++part) {
    std::int64_t last = -1;
    for (const QuadricDp& dp : scene->parts[part].dps) {
      const Surface& surface = model.parts[part].surfaces[model.parts[part].faces[dp.face].surface];
      const bool whole = dp.lines + dp.arcs + dp.ellipses + dp.planes == 0 && dp.reference_inside;
      if (is_quadric(surface) || !whole || dp.speck || last == dp.face) continue;
      last = dp.face;
      result.push_back({part, dp.face, dp.origin, dp.n() * (dp.flipped ? -1 : 1)});
    }
  }
  return result;
}

Camera close_to(const Spot& spot, const Affine3& to_world, double diagonal) {
  Camera camera;
  camera.width = 120, camera.height = 90;
  camera.target = transform_point(to_world, spot.point);
  const Vec3 n = normalized(transform_vector(to_world, spot.normal)), side = any_perpendicular(n);
  const double distance = 1.9 * diagonal / kCloser;
  camera.eye = camera.target + (n + side * 0.5) * distance;
  camera.up = side;
  return camera;
}

Vec3 vector_at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// What a close picture shows, at worst.
struct Worst {
  int covered = 0;
  double position_px = 0, normal_degrees = 0, jump_degrees = 0;
};

/// What a number of the face picture stands for, where no face was left out.
struct PlacedFace {
  const Instance* instance;
  const Part* part;
  const Face* face;
};
PlacedFace placed_face(const Model& model, std::uint32_t number) {
  std::size_t index = number - 1;
  for (const Instance& instance : model.instances) {
    const Part& part = model.parts[instance.part];
    if (index < part.faces.size()) return {&instance, &part, &part.faces[index]};
    index -= part.faces.size();
  }
  throw std::out_of_range("a face's number");
}

/// Against the exact surface at the parameters of every pixel.
Worst look(const Model& model, const Frame& frame) {
  Worst worst;
  const std::size_t width = static_cast<std::size_t>(frame.width);
  const auto exact_at = [&](std::size_t i, Vec3& normal) {
    const auto [instance, part, face] = placed_face(model, frame.face[i]);
    const SurfaceJet jet = evaluate(part->surfaces[face->surface], frame.uv[2 * i], frame.uv[2 * i + 1], 1);
    const Affine3& to_world = instance->to_world;
    normal = normalized(cross(transform_vector(to_world, jet.pu), transform_vector(to_world, jet.pv))) *
             (face->reversed ? -1.0 : 1.0);
    return transform_point(to_world, jet.p);
  };
  for (std::size_t i = 0; i < frame.face.size(); ++i) {
    if (frame.face[i] == 0) continue;
    ++worst.covered;
    Vec3 normal, before;
    const Vec3 point = exact_at(i, normal), drawn = vector_at(frame.normal, i);
    const double pixel = frame.pixel_constant + frame.pixel_per_depth * frame.depth[i];
    worst.position_px = std::max(worst.position_px, length(vector_at(frame.position, i) - point) / pixel);
    if (length(normal) == 0) continue;  // a pole, where the partials have none
    worst.normal_degrees = std::max(worst.normal_degrees, length(drawn - normal) * kDegree);
    if (i % width == 0 || frame.face[i - 1] != frame.face[i]) continue;
    exact_at(i - 1, before);
    if (length(before) == 0) continue;
    const Vec3 change = (drawn - vector_at(frame.normal, i - 1)) - (normal - before);
    worst.jump_degrees = std::max(worst.jump_degrees, length(change) * kDegree);
  }
  return worst;
}

Affine3 placement(const Model& model, std::uint32_t part) {
  for (const Instance& instance : model.instances)
    if (instance.part == part) return instance.to_world;
  return {};
}

void expect_no_facets(const Model& model, std::size_t most) {
  const double diagonal = bounding_box(model).diagonal();
  TestDevice gl;
  std::vector<Spot> all = spots(model);
  ASSERT_FALSE(all.empty());
  for (std::size_t k = 0; k < std::min(most, all.size()); ++k) {
    const Spot& spot = all[k * all.size() / std::min(most, all.size())];
    SCOPED_TRACE("face " + std::to_string(spot.face));
    const Camera camera = close_to(spot, placement(model, spot.part), diagonal);
    SamplingOptions sampling;
    sampling.camera = camera;
    const auto dps = sample_quadric_dps(model, sampling);
    ASSERT_TRUE(dps.ok());
    const auto scene = gl.renderer->upload(model, &*dps);
    ASSERT_TRUE(scene.ok());
    DrawOptions options;
    options.outputs = kNormal | kDepth | kPosition | kFace | kUv;
    options.exact_model = &model;
    const Worst worst = look(model, gl.draw(**scene, camera, options));
    EXPECT_GT(worst.covered, 0.9 * camera.width * camera.height);
    EXPECT_LE(worst.position_px, sampling.tolerance_px + 0.05);
    EXPECT_LE(worst.normal_degrees, sampling.normal_tolerance * kDegree + 0.01);
    EXPECT_LE(worst.jump_degrees, kJumpDegrees);
  }
}

TEST(Zoom, FilletsAndSplinesOfASampleShowNoFacet) {
  const auto model = test::import_file(test::sample("freeform.step"));
  ASSERT_TRUE(model.ok()) << model.status().message;
  expect_no_facets(*model, 6);
}

TEST(Zoom, FilletsOfARealPartShowNoFacet) {
  DUPIN_NEED_DATA(file, "cad/nist/nist_ctc_02_asme1_ap242.stp");
  const auto model = test::import_file(file);
  ASSERT_TRUE(model.ok()) << model.status().message;
  expect_no_facets(*model, 3);
}

TEST(Zoom, TheTeapotShowsNoFacet) {
  DUPIN_NEED_DATA(file, "nurbs/converted/teapot.step");
  const auto model = test::import_file(file);
  ASSERT_TRUE(model.ok()) << model.status().message;
  expect_no_facets(*model, 5);
}

}  // namespace
}  // namespace dupin::testing
