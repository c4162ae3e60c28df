// The C++ interface for hosts: several models in one context, their looks, picking, refinement, jobs.
#include "../../host/host_scene.h"

#include <atomic>

#include "../../host/complete_model.h"
#include "../../host/face_area.h"
#include "../../host/load_job.h"
#include "../../render/view.h"
#include "../cad_import/files.h"
#include "../render/device.h"
#include "../render/host_state.h"

namespace dupin::testing {
namespace {

constexpr int kSize = 160;

/// A rectangle in z = 0 of one face, and a whole sphere above it: two parts, placed once each.
Model plate_and_ball(double radius = 1) {
  Model model;
  Part& plate = model.parts.emplace_back();
  plate.name = "plate";
  plate.color = Color{1, 0, 0, 1};
  plate.surfaces.push_back({Plane{}});
  plate.faces.emplace_back().uv_box = {{-2, -2}, {2, 2}};
  Part& ball = model.parts.emplace_back();
  ball.name = "ball";
  ball.color = Color{0, 1, 0, 1};
  ball.closed = true;
  ball.surfaces.push_back({Sphere{{{0, 0, 1.5}}, radius}});
  ball.faces.emplace_back().uv_box = {{0, -1.5707963267948966}, {6.283185307179586, 1.5707963267948966}};
  return model;
}

std::shared_ptr<const PreparedModel> prepared(Model model, double tolerance = 1e-3) {
  EXPECT_EQ(complete(model).message, "");
  PrepareOptions options;
  options.tolerance = tolerance;
  auto made = prepare(std::make_shared<Model>(std::move(model)), options);
  EXPECT_TRUE(made.ok()) << made.status().message;
  return made ? *made : nullptr;
}

/// Looking down from z = 10, parallel: 4 model units from side to side.
HostView from_above(double size = 4) {
  HostView view;
  view.view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -10, 1};
  const double s = 2 / size;
  view.projection = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, -0.1, 0, 0, 0, -1, 1};
  view.viewport = {0, 0, kSize, kSize};
  return view;
}

struct Fixture {
  std::unique_ptr<Context> context;
  std::unique_ptr<HostScene> scene;
  Fixture() {
    context = std::move(*create_context(Device::automatic));
    scene = std::move(*HostScene::create(context->loader()));
  }
  std::optional<Hit> at(int x, int y) {
    auto hit = scene->pick(from_above(), x, y);
    EXPECT_TRUE(hit.ok()) << hit.status().message;
    return hit ? *hit : std::nullopt;
  }
};

TEST(HostScene, PicksFacesPointsAndExactCurvatures) {
  Fixture f;
  const ObjectId id = *f.scene->add(prepared(plate_and_ball(0.8)));
  const auto ball = f.at(kSize / 2 + 10, kSize / 2);
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->target, (Target{id, 1, 0}));
  EXPECT_EQ(ball->part, "ball");
  EXPECT_EQ(ball->surface, "sphere");
  EXPECT_NEAR(*ball->radius, 0.8, 1e-12);
  EXPECT_NEAR(ball->k1, -1 / 0.8, 1e-5);
  EXPECT_NEAR(ball->k2, -1 / 0.8, 1e-5);
  EXPECT_NEAR(distance(ball->point, {0, 0, 1.5}), 0.8, 1e-5);
  EXPECT_NEAR(ball->point.x, (10 + 0.5) * 4 / kSize, 1e-4);
  EXPECT_NEAR(length(ball->normal - (ball->point - Vec3{0, 0, 1.5}) / 0.8), 0, 1e-4);
  EXPECT_NEAR(ball->depth, 10 - ball->point.z, 1e-4);
  const auto plate = f.at(5, 5);
  ASSERT_TRUE(plate);
  EXPECT_EQ(plate->target, (Target{id, 0, 0}));
  EXPECT_EQ(plate->surface, "plane");
  EXPECT_FALSE(plate->radius);
  EXPECT_NEAR(plate->uv.x, -2 + 5.5 * 4 / kSize, 1e-4);
}

TEST(HostScene, ObjectsComeGoMoveAndKeepTheirLooks) {
  Fixture f;
  EXPECT_FALSE(f.at(80, 80));
  const ObjectId first = *f.scene->add(prepared(plate_and_ball()));
  Affine3 above;
  above.translation = {0, 0, 4};
  const ObjectId second = *f.scene->add(prepared(plate_and_ball(0.5)), above);
  EXPECT_EQ(f.at(80, 80)->target, (Target{second, 1, 0}));
  EXPECT_NEAR(f.at(80, 80)->point.z, 6, 1e-3);
  EXPECT_NEAR(f.scene->box().hi.z, 6, 1e-9);
  ASSERT_TRUE(f.scene->set_visible({second}, false).ok());
  EXPECT_EQ(f.at(80, 80)->target, (Target{first, 1, 0}));
  ASSERT_TRUE(f.scene->set_visible({second, 1}, true).ok());  // the ball goes before its object
  EXPECT_EQ(f.at(80, 80)->target, (Target{second, 1, 0}));
  ASSERT_TRUE(f.scene->replace(second, prepared(plate_and_ball(0.25))).ok());
  EXPECT_EQ(f.at(80, 80)->target, (Target{second, 1, 0}));
  EXPECT_EQ(f.at(5, 5)->target, (Target{first, 0, 0}));  // the second's plate is still hidden
  above.translation.z = -20;
  ASSERT_TRUE(f.scene->place(second, above).ok());
  EXPECT_EQ(f.at(80, 80)->target, (Target{first, 1, 0}));
  ASSERT_TRUE(f.scene->remove(first).ok());
  EXPECT_EQ(f.at(80, 80)->target, (Target{second, 1, 0}));
  ASSERT_TRUE(f.scene->remove(second).ok());
  EXPECT_FALSE(f.at(80, 80));
  EXPECT_TRUE(f.scene->box().empty());
}

TEST(HostScene, ColorsAndHighlightsAreSeen) {
  Fixture f;
  const ObjectId id = *f.scene->add(prepared(plate_and_ball()));
  Camera camera;
  camera.eye = {0, 0, 10}, camera.up = {0, 1, 0};
  camera.orthographic = true, camera.ortho_height = 4;
  camera.width = camera.height = kSize;
  DrawOptions options;
  options.outputs = kScreen | kFace;
  options.edges = false;
  const auto pixel = [&](int x, int y) {
    const auto frame = f.scene->picture(camera, options);
    EXPECT_TRUE(frame.ok());
    const std::uint8_t* p = frame->screen.data() + 4 * (y * kSize + x);
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  EXPECT_GT(pixel(80, 80)[1], 150);
  EXPECT_LT(pixel(80, 80)[2], 20);
  ASSERT_TRUE(f.scene->set_color({id}, Color{0, 0, 1, 1}).ok());
  EXPECT_GT(pixel(80, 80)[2], 150);
  EXPECT_LT(pixel(80, 80)[1], 20);
  ASSERT_TRUE(f.scene->set_highlight({id, 1, 0}, Color{1, 1, 0, 1}).ok());
  EXPECT_GT(pixel(80, 80)[0], 150);
  EXPECT_GT(pixel(5, 5)[2], 100);
  ASSERT_TRUE(f.scene->set_highlight({id, 1, 0}, {}).ok());
  ASSERT_TRUE(f.scene->set_color({id}, {}).ok());
  EXPECT_GT(pixel(80, 80)[1], 150);
  EXPECT_LT(pixel(80, 80)[2], 20);
  const auto frame = f.scene->picture(camera, options);
  EXPECT_EQ(f.scene->face_target(frame->face[80 * kSize + 80]), (Target{id, 1, 0}));
  EXPECT_FALSE(f.scene->face_target(99));
}

TEST(HostScene, ARectangleHasTheFacesThatAreSeenInIt) {
  Fixture f;
  const ObjectId id = *f.scene->add(prepared(plate_and_ball()));
  const auto all = f.scene->pick_rectangle(from_above(), {0, 0, kSize, kSize});
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(*all, (std::vector<Target>{{id, 0, 0}, {id, 1, 0}}));
  const auto corner = f.scene->pick_rectangle(from_above(), {0, 0, 10, 10});
  EXPECT_EQ(*corner, (std::vector<Target>{{id, 0, 0}}));
}

TEST(HostScene, RefinementMakesAZoomedViewExact) {
  // A torus is no quadric: at a coarse tolerance its DPs are seen to be off.
  Model model;
  Part& part = model.parts.emplace_back();
  part.closed = true;
  part.surfaces.push_back({Torus{{}, 1.2, 0.5}});
  part.faces.emplace_back().uv_box = {{0, 0}, {6.283185307179586, 6.283185307179586}};
  Fixture f;
  (void)*f.scene->add(prepared(std::move(model), 0.02));
  HostView view = from_above(0.05);
  view.view[12] = -1.2, view.view[13] = -0.05;
  FrameStats before, after;
  ASSERT_TRUE(f.scene->draw(view, {}, &before).ok());
  EXPECT_GT(before.bound_px, 0.5);
  std::atomic<bool> ready{false};
  ASSERT_TRUE(f.scene->refine(view, 0.25, [&] { ready = true; }).ok());
  for (int i = 0; i < 3000 && !ready; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(ready);
  EXPECT_FALSE(f.scene->refining());
  ASSERT_TRUE(f.scene->draw(view, {}, &after).ok());
  EXPECT_LE(after.bound_px, 0.3);
  const auto hit = f.scene->pick(view, kSize / 2, kSize / 2);
  ASSERT_TRUE(hit.ok() && *hit);
  EXPECT_EQ((*hit)->surface, "torus");
  const double pixel = 0.05 / kSize;
  const Vec3 p = (*hit)->point;
  EXPECT_NEAR(std::hypot(std::hypot(p.x, p.y) - 1.2, p.z), 0.5, 0.3 * pixel);
  // The same view again has nothing left to do.
  ASSERT_TRUE(f.scene->refine(view, 0.25).ok());
  EXPECT_FALSE(f.scene->refining());
}

/// How often a host has to ask until everything is ready.
int slices(HostScene& scene, double milliseconds) {
  for (int i = 0; i < 100; ++i) {
    const auto ready = scene.get_ready(from_above(), {}, milliseconds);
    EXPECT_TRUE(ready.ok()) << ready.status().message;
    if (!ready || *ready) return i;
  }
  return 100;
}

TEST(HostScene, GetsReadyASliceAtATime) {
  Fixture f;
  EXPECT_EQ(slices(*f.scene, 0), 0) << "nothing is in it";
  const ObjectId id = *f.scene->add(prepared(plate_and_ball(0.8)));
  // The upload, then one program at a time: of points, of planes, of the sphere, and what shades them.
  const int one_at_a_time = slices(*f.scene, 0);
  EXPECT_GT(one_at_a_time, 3);
  EXPECT_LT(one_at_a_time, 100);
  EXPECT_EQ(slices(*f.scene, 0), 0);
  const auto ball = f.at(kSize / 2 + 10, kSize / 2);
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->target, (Target{id, 1, 0}));
  (void)*f.scene->add(prepared(plate_and_ball(0.5)));
  EXPECT_EQ(slices(*f.scene, 0), 2) << "the upload, and a look whether there is something new to build";
  HostView bad = from_above();
  bad.projection = {};
  (void)*f.scene->add(prepared(plate_and_ball(0.4)));
  EXPECT_FALSE(*f.scene->get_ready(bad, {}, 0)) << "the upload needs no view";
  EXPECT_EQ(f.scene->get_ready(bad, {}, 0).status().code, StatusCode::invalid_argument);
  EXPECT_EQ(slices(*f.scene, 1e6), 1);
}

TEST(HostScene, LeavesAHostsStateAsItWas) {
  const auto model = prepared(plate_and_ball());
  auto context = create_context(Device::automatic);
  ASSERT_TRUE(context.ok());
  set_unusual_state(**context, kSize, kSize);
  const GlState before = gl_state(**context);
  const auto expect_unchanged = [&](const char* call) {
    EXPECT_EQ(gl_error(**context), 0U) << call;
    EXPECT_EQ(differences(before, gl_state(**context)), "") << "after " << call;
  };
  {
    auto scene = HostScene::create((*context)->loader());
    ASSERT_TRUE(scene.ok());
    (void)*(*scene)->add(model);
    for (int i = 0; i < 3; ++i) {
      EXPECT_FALSE(*(*scene)->get_ready(from_above(), {}, 0));
      expect_unchanged("get_ready");
    }
    ASSERT_TRUE((*scene)->draw(from_above(), {}).ok());
    expect_unchanged("draw");
    ASSERT_TRUE((*scene)->pick(from_above(), 80, 80).ok());
    expect_unchanged("pick");
    ASSERT_TRUE((*scene)->pick_rectangle(from_above(), {10, 10, 60, 30}).ok());
    expect_unchanged("pick_rectangle");
    const ObjectId second = *(*scene)->add(model);
    ASSERT_TRUE((*scene)->remove(second).ok());
    ASSERT_TRUE((*scene)->draw(from_above(), {}).ok());
    expect_unchanged("draw after changes");
    HostView bad = from_above();
    bad.projection = {};
    EXPECT_EQ((*scene)->draw(bad, {}).code, StatusCode::invalid_argument);
    EXPECT_FALSE((*scene)->pick(bad, 0, 0).ok());
    expect_unchanged("failures");
  }
  expect_unchanged("destruction");
}

TEST(HostScene, SaysWhatIsWrongAndGoesOn) {
  Fixture f;
  const ObjectId id = *f.scene->add(prepared(plate_and_ball()));
  Affine3 flat;
  flat.linear.z = {};
  EXPECT_EQ(f.scene->place(id, flat).code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->add(prepared(plate_and_ball()), flat).status().code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->add(nullptr).status().code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->remove(77).code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->set_visible({id, 2}, false).code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->set_visible({id, 0, 1}, false).code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->refine(from_above(), 0).code, StatusCode::invalid_argument);
  EXPECT_EQ(f.scene->pick_rectangle(from_above(), {0, 0, 0, 5}).status().code, StatusCode::invalid_argument);
  EXPECT_EQ(HostScene::create({}).status().code, StatusCode::invalid_argument);
  EXPECT_EQ(HostScene::create([](const char*) -> void* { return nullptr; }).status().code,
            StatusCode::no_device);
  EXPECT_TRUE(f.at(80, 80));
}

TEST(CompleteModel, SaysWhatIsWrong) {
  const auto message = [](auto&& change) {
    Model model = plate_and_ball();
    change(model);
    return complete(model).message;
  };
  EXPECT_EQ(message([](Model&) {}), "");
  EXPECT_NE(message([](Model& m) { m.parts[0].faces[0].surface = 9; }), "");
  EXPECT_NE(
      message([](Model& m) { m.parts[0].faces[0].uv_box.hi.x = std::numeric_limits<double>::infinity(); }),
      "");
  EXPECT_NE(message([](Model& m) { m.parts[1].surfaces[0] = {Sphere{{}, -1}}; }), "");
}

TEST(FaceArea, IsThatOfClosedForms) {
  Model model = plate_and_ball(0.8);
  ASSERT_TRUE(complete(model).ok());
  constexpr double kPi = 3.14159265358979323846;
  EXPECT_NEAR(face_area(model.parts[0], model.parts[0].faces[0]), 16, 1e-9);
  EXPECT_NEAR(face_area(model.parts[1], model.parts[1].faces[0]), 4 * kPi * 0.64, 1e-6);
  // A round hole, which the face lies outside of.
  Part& plate = model.parts[0];
  Edge& rim = plate.edges.emplace_back();
  rim.curve = Curve3{CircleOf<Vec3>{{0.5, 0, 0}, {1, 0, 0}, {0, -1, 0}, 0.75}};
  rim.t1 = 2 * kPi;
  Trim trim;
  trim.edge = static_cast<std::uint32_t>(plate.edges.size() - 1);
  trim.pcurve = Curve2{CircleOf<Vec2>{{0.5, 0}, {1, 0}, {0, -1}, 0.75}};
  plate.faces[0].loops.push_back({trim});
  EXPECT_NEAR(face_area(plate, plate.faces[0]), 16 - kPi * 0.5625, 1e-6);
}

TEST(LoadJob, ReadsAndPreparesOnItsThread) {
  std::atomic<int> calls{0};
  PrepareOptions options;
  options.progress = [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    ++calls;
    return true;
  };
  const auto job = LoadJob::start(test::sample("bracket.step"), {}, options);
  const auto result = job->result();
  ASSERT_TRUE(result.ok()) << result.status().message;
  EXPECT_TRUE(job->done());
  EXPECT_TRUE(job->wait(0));
  EXPECT_GT(calls, 0);
  EXPECT_GT((*result)->dps.count(), 10U);
}

TEST(LoadJob, CanBeStopped) {
  const auto job = LoadJob::start(test::sample("freeform.step"), {}, {});
  job->cancel();
  EXPECT_EQ(job->result().status().code, StatusCode::cancelled);
  LoadJob::start(test::sample("assembly.step"), {}, {}).reset();  // waits for what it began
}

TEST(LoadJob, SaysWhyAFileCannotBeRead) {
  const auto job = LoadJob::start("/nowhere/at/all.step", {}, {});
  EXPECT_EQ(job->result().status().code, StatusCode::unreadable);
}

}  // namespace
}  // namespace dupin::testing
