// A window made with GLFW: a program with a compatibility context and fixed-function drawing of its own into
// the window's framebuffer, among which the library draws a CAD model that is read while the window is
// already there.
//
//   glfw_host MODEL [--frames N] [--picture FILE.png] [--alone]
//
// Turns the model until the window is closed, or for N frames. The host's red sheet goes through the model's
// middle: each hides a part of the other. --alone: without it.
#include <GLFW/glfw3.h>

#include "host_common.h"

namespace {

void* function(const char* name) {
  return reinterpret_cast<void*>(glfwGetProcAddress(name));
}

/// A red upright sheet through the middle of the box.
void draw_own(const dupin::Box3& box, const dupin::HostView& view, bool sheet) {
  glViewport(0, 0, view.viewport[2], view.viewport[3]);
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glMatrixMode(GL_PROJECTION), glLoadMatrixd(view.projection.data());
  glMatrixMode(GL_MODELVIEW), glLoadMatrixd(view.view.data());
  if (!sheet) return;
  const dupin::Vec3 m = box.center();
  const double r = 0.45 * box.diagonal();
  glColor3f(1, 0, 0);
  glBegin(GL_QUADS);
  glVertex3d(m.x - r, m.y, m.z - r), glVertex3d(m.x + r, m.y, m.z - r);
  glVertex3d(m.x + r, m.y, m.z + r), glVertex3d(m.x - r, m.y, m.z + r);
  glEnd();
}

bool save(const char* path, int width, int height) {
  std::vector<unsigned char> rgba(static_cast<std::size_t>(4 * width * height));
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return example::write(path, rgba, width, height, 4);
}

int show(GLFWwindow* window, const example::Arguments& arguments) {
  const auto job = dupin::LoadJob::start(arguments.model, {}, {});
  auto scene = dupin::HostScene::create(function);
  if (!scene) return example::fail(scene.status().message);
  for (int drawn = 0;
       !glfwWindowShouldClose(window) && (arguments.frames == 0 || drawn < arguments.frames);) {
    glfwPollEvents();
    if ((*scene)->objects().empty() && job->done()) {
      const auto prepared = job->result();
      if (!prepared) return example::fail(prepared.status().message);
      (void)(*scene)->add(*prepared);
    }
    if (!(*scene)->objects().empty()) {
      int width, height;
      glfwGetFramebufferSize(window, &width, &height);
      const example::Look look = example::look_at((*scene)->box(), 0.6 + 0.02 * drawn++);
      const dupin::HostView view = example::host_view(look, width, height);
      draw_own((*scene)->box(), view, !arguments.alone);
      const dupin::Status status = example::draw(**scene, view, {}, function);
      if (!status.ok()) return example::fail(status.message);
      if (drawn == arguments.frames) {
        example::print_camera(look, width, height);
        if (arguments.picture && !save(arguments.picture, width, height))
          return example::fail("no picture could be written");
      }
    }
    glfwSwapBuffers(window);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const example::Arguments arguments = example::arguments(argc, argv);
  if (!arguments.model)
    return example::fail("usage: glfw_host MODEL [--frames N] [--picture FILE.png] [--alone]");
  if (!glfwInit()) return example::fail("no display");
  GLFWwindow* window = glfwCreateWindow(640, 480, "Dupin in GLFW", nullptr, nullptr);
  if (!window) return example::fail("no window with OpenGL");
  glfwMakeContextCurrent(window);
  const int code = show(window, arguments);
  glfwDestroyWindow(window);
  glfwTerminate();
  return code;
}
