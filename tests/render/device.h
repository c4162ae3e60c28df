// A context and a renderer for a test.
#ifndef DUPIN_TESTS_RENDER_DEVICE_H
#define DUPIN_TESTS_RENDER_DEVICE_H

#include <gtest/gtest.h>

#include "../../render/renderer.h"
#include "hand_made.h"

namespace dupin::testing {

inline constexpr unsigned kEverything =
    kColor | kNormal | kDepth | kPosition | kCurvature | kDirection | kFace | kPrimitive;

struct TestDevice {
  std::unique_ptr<Context> context;
  std::unique_ptr<Renderer> renderer;  // before its context

  explicit TestDevice(Device device = Device::automatic) : TestDevice(create_context(device)) {}
  explicit TestDevice(Result<std::unique_ptr<Context>> made) {
    if (!made) throw std::runtime_error(made.status().message);
    context = std::move(*made);
    auto drawn = Renderer::create(context->loader());
    if (!drawn) throw std::runtime_error(drawn.status().message);
    renderer = std::move(*drawn);
  }
  std::unique_ptr<Scene> upload(const HandMade& made) {
    auto scene = renderer->upload(made.model, &made.dps);
    EXPECT_TRUE(scene.ok()) << scene.status().message;
    return scene ? std::move(*scene) : nullptr;
  }
  Frame draw(Scene& scene, const Camera& camera, DrawOptions options = {}) {
    auto frame = renderer->draw(scene, camera, options);
    EXPECT_TRUE(frame.ok()) << frame.status().message;
    return frame ? std::move(*frame) : Frame{};
  }
};

}  // namespace dupin::testing

#endif
