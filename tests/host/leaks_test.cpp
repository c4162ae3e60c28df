// Memory over many frames and loads: what is allocated at the end is what was allocated after the first ones.
// The numbers that docs/hosts.md tells: DUPIN_LEAK_FRAMES=1000 DUPIN_LEAK_LOADS=100.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "../../host/host_scene.h"
#include "../../host/load_job.h"
#include "../cad_import/files.h"
#include "../render/device.h"

namespace dupin::testing {
namespace {

std::size_t allocated() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

int count(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

/// Frames of a small model from ever another side.
HostView view_at(double angle) {
  HostView view;
  const double c = std::cos(angle), s = std::sin(angle);
  view.view = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, -600, 1};
  view.projection = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.2, -1, 0, 0, -220, 0};
  view.viewport = {0, 0, 96, 96};
  return view;
}

/// Beside `slack`, 256 bytes a step would be seen.
void expect_no_growth(std::size_t before, int steps, std::size_t after, std::size_t slack, const char* what) {
  const double growth = after > before ? static_cast<double>(after - before) : 0;
  std::printf("%d %s: %zu bytes allocated before, %zu after\n", steps, what, before, after);
  EXPECT_LT(growth, static_cast<double>(slack) + 256.0 * steps) << what;
}

TEST(Leaks, FramesAllocateNothingThatStays) {
  const auto context = create_context(Device::automatic);
  ASSERT_TRUE(context.ok());
  const auto scene = HostScene::create((*context)->loader());
  const auto prepared = LoadJob::start(test::sample("bracket.step"), {}, {})->result();
  ASSERT_TRUE(prepared.ok()) << prepared.status().message;
  ASSERT_TRUE((*scene)->add(*prepared).ok());
  const int frames = count("DUPIN_LEAK_FRAMES", 60);
  const auto draw = [&](int i) {
    ASSERT_TRUE((*scene)->draw(view_at(0.01 * i), {}).ok());
    if (i % 10 == 0) {
      ASSERT_TRUE((*scene)->pick(view_at(0.01 * i), 48, 48).ok());
    }
  };
  for (int i = 0; i < 700; i += 16) draw(i);
  // A driver that rasterises later (llvmpipe) holds the buffers of some frames, two megabytes more or less
  // whatever their number: the least of several is compared, and a long run tells growth from that.
  const auto settled = [&] {
    std::size_t least = allocated();
    for (int i = 0; i < 30; ++i) {
      draw(10 * i);
      least = std::min(least, allocated());
    }
    return least;
  };
  const std::size_t before = settled();
  for (int i = 0; i < frames; ++i) draw(i);
  expect_no_growth(before, frames, settled(), 6 << 20, "frames");
}

TEST(Leaks, LoadsLeaveNothingBehind) {
  const auto context = create_context(Device::automatic);
  ASSERT_TRUE(context.ok());
  const auto load = [&] {
    const auto scene = HostScene::create((*context)->loader());
    const auto prepared = LoadJob::start(test::sample("bracket.step"), {}, {})->result();
    ASSERT_TRUE(prepared.ok()) << prepared.status().message;
    const auto object = (*scene)->add(*prepared);
    ASSERT_TRUE((*scene)->draw(view_at(0.3), {}).ok());
    ASSERT_TRUE((*scene)->remove(*object).ok());
  };
  const int loads = count("DUPIN_LEAK_LOADS", 3);
  for (int i = 0; i < 3; ++i) load();
  const std::size_t before = allocated();
  for (int i = 0; i < loads; ++i) load();
  expect_no_growth(before, loads, allocated(), 256 << 10, "loads");
}

}  // namespace
}  // namespace dupin::testing
