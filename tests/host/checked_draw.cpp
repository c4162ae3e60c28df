// What the examples with windows draw by where they are built with the tests (examples/host_common.h): asks
// for all of the context's state before and after.
#include <cstdio>

#include "../../host/host_scene.h"
#include "../render/host_state.h"

namespace example {
namespace {

struct Current final : dupin::Context {
  explicit Current(const dupin::GetProcAddress& get) : get_(get) {}
  dupin::Status make_current() override { return {}; }
  void release() override {}
  void* proc_address(const char* name) const override { return get_(name); }
  std::string name() const override { return "the host's"; }
  const dupin::GetProcAddress& get_;
};

}  // namespace

dupin::Status draw(dupin::HostScene& scene, const dupin::HostView& view, const dupin::DrawOptions& options,
                   const dupin::GetProcAddress& loader) {
  using namespace dupin::testing;
  const Current context(loader);
  while (gl_error(context)) std::printf("the host itself left an OpenGL error\n");
  const GlState before = gl_state(context);
  while (gl_error(context)) {
  }  // what an older context could not be asked for
  const dupin::Status drawn = scene.draw(view, options);
  if (gl_error(context)) std::printf("an OpenGL error is left\n");
  const GlState after = gl_state(context);
  while (gl_error(context)) {
  }
  std::printf("state: %zu values, changed: %s\n", before.size(), differences(before, after).c_str());
  return drawn;
}

}  // namespace example
