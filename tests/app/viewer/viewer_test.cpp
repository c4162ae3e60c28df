// The viewer's camera, and how it cuts a model into pieces: without a window.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "../../../app/viewer/loader.h"
#include "../../../app/viewer/orbit_camera.h"
#include "../../cad_import/files.h"

namespace dupin::app {
namespace {

OrbitCamera looking_at_a_box() {
  OrbitCamera camera;
  camera.resize(800, 600);
  Box3 box;
  box.add(Vec3{10, 20, 30}), box.add(Vec3{40, 30, 50});
  camera.set_box(box);
  camera.look_from("iso");
  return camera;
}

/// Where a point is in the picture, in pixels from the top left.
Vec2 pixel_of(const OrbitCamera& camera, const Vec3& p) {
  const HostView v = camera.view();
  const double in[4] = {p.x, p.y, p.z, 1};
  double eye[4] = {}, clip[4] = {};
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c) eye[r] += v.view[4 * c + r] * in[c];
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c) clip[r] += v.projection[4 * c + r] * eye[c];
  EXPECT_LE(std::abs(clip[2]), std::abs(clip[3]) * (1 + 1e-9)) << "out of the depth range";
  return {(clip[0] / clip[3] + 1) * 400, (1 - clip[1] / clip[3]) * 300};
}

TEST(OrbitCamera, FitsTheBoxFromEverySide) {
  for (const bool parallel : {false, true})
    for (const char* side : {"iso", "front", "top", "left"}) {
      OrbitCamera camera = looking_at_a_box();
      camera.set_parallel(parallel);
      camera.look_from(side);
      Box3 box;
      box.add(Vec3{10, 20, 30}), box.add(Vec3{40, 30, 50});
      double nearest = 1e9;
      for (int i = 0; i < 8; ++i) {
        const Vec2 at = pixel_of(camera, box.corner(i));
        nearest = std::min({nearest, at.x, at.y, 800 - at.x, 600 - at.y});
      }
      EXPECT_GT(nearest, 1) << side;
      EXPECT_LT(nearest, 40) << side;
    }
}

TEST(OrbitCamera, ZoomKeepsWhatIsUnderThePointer) {
  for (const bool parallel : {false, true}) {
    OrbitCamera camera = looking_at_a_box();
    camera.set_parallel(parallel);
    const Camera before = camera.camera();
    const CameraAxes axes = camera_axes(before);
    const Vec3 p = camera.center() + (axes.right * 150 - axes.up * 80) * camera.pixel();
    const Vec2 at = pixel_of(camera, p);
    EXPECT_NEAR(at.x, 550, 1e-6);
    EXPECT_NEAR(at.y, 380, 1e-6);
    camera.zoom(3, at.x, at.y);
    const Vec2 after = pixel_of(camera, p);
    EXPECT_NEAR(after.x, at.x, 1e-6);
    EXPECT_NEAR(after.y, at.y, 1e-6);
    EXPECT_NEAR(camera.camera().ortho_height, before.ortho_height / 3, 1e-9);
  }
}

TEST(OrbitCamera, PansWithThePointerAndTurnsAroundTheMiddle) {
  OrbitCamera camera = looking_at_a_box();
  const Vec3 p = camera.center();
  camera.pan(35, -20);
  EXPECT_NEAR(pixel_of(camera, p).x, 435, 1e-6);
  EXPECT_NEAR(pixel_of(camera, p).y, 280, 1e-6);
  const Vec3 center = camera.center();
  const double far = distance(camera.camera().eye, center);
  camera.orbit(120, 45);
  EXPECT_NEAR(distance(camera.camera().eye, center), far, 1e-9);
  EXPECT_NEAR(pixel_of(camera, center).x, 400, 1e-6);
  EXPECT_NEAR(dot(camera_axes(camera.camera()).right, {0, 0, 1}), 0, 1e-9);  // stays level
}

TEST(Loader, PiecesHoldEveryPartAndPlacementOnce) {
  Model model;
  for (int i = 0; i < 40; ++i) {
    Part& part = model.parts.emplace_back();
    part.name = "p" + std::to_string(i);
    part.faces.resize(100);
    for (int k = 0; k < 1 + i % 3; ++k) {
      Instance& instance = model.instances.emplace_back();
      instance.part = static_cast<std::uint32_t>(i);
      instance.name = part.name;
    }
  }
  const std::size_t faces = face_instance_count(model), instances = model.instances.size();
  const auto pieces = pieces_of(std::move(model));
  EXPECT_EQ(pieces.size(), 4U);
  std::size_t parts = 0, placed = 0, all_faces = 0;
  for (const Model& piece : pieces) {
    parts += piece.parts.size(), placed += piece.instances.size(), all_faces += face_instance_count(piece);
    for (const Instance& instance : piece.instances)
      EXPECT_EQ(instance.name, piece.parts[instance.part].name);
  }
  EXPECT_EQ(parts, 40U);
  EXPECT_EQ(placed, instances);
  EXPECT_EQ(all_faces, faces);
  EXPECT_LT(pieces[0].parts.size(), pieces[2].parts.size());
}

/// What a loader says of an assembly that is stopped at the first word of `stage`, or never.
struct Heard {
  std::size_t instances = 0;
  Status status;
};

Heard load(const std::string& stop_at) {
  Heard heard;
  std::atomic<bool> stop{false}, done{false};
  {
    Loader loader(test::sample("assembly.step"), {},
                  {[&](const std::string& stage, double) { stop = stop || stage == stop_at; },
                   [&](const auto& prepared) { heard.instances += prepared->model->instances.size(); },
                   [&](const Status& status) { heard.status = status, done = true; }});
    while (!done) {
      if (stop) loader.cancel();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  return heard;
}

TEST(Loader, HandsOverEverythingOrSaysThatItWasStopped) {
  const Heard all = load("no such stage");
  EXPECT_EQ(all.status.message, "");
  EXPECT_GT(all.instances, 1U);
  // A word may come too late to stop what is small; what is handed over is whole all the same.
  const Heard stopped = load("read");
  EXPECT_TRUE(stopped.status.code == StatusCode::cancelled || stopped.status.ok()) << stopped.status.message;
  EXPECT_LE(stopped.instances, all.instances);
  if (stopped.status.ok()) {
    EXPECT_EQ(stopped.instances, all.instances);
  }
}

}  // namespace
}  // namespace dupin::app
