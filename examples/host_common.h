// What the windows among the examples have in common: arguments, a camera, a red sheet's place, a picture
// file.
#ifndef DUPIN_EXAMPLES_HOST_COMMON_H
#define DUPIN_EXAMPLES_HOST_COMMON_H

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "../host/host_scene.h"
#include "../host/load_job.h"
#include "../render/image.h"

namespace example {

struct Arguments {
  const char* model = nullptr;
  const char* picture = nullptr;  ///< write the last frame there
  int frames = 0;                 ///< 0: until the window is closed
  bool alone = false;             ///< nothing of the host's own
};

/// NAME MODEL [--frames N] [--picture FILE.png] [--alone]
inline Arguments arguments(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--frames" && i + 1 < argc) {
      a.frames = std::atoi(argv[++i]);
    } else if (word == "--picture" && i + 1 < argc) {
      a.picture = argv[++i];
    } else if (word == "--alone") {
      a.alone = true;
    } else {
      a.model = argv[i];
    }
  }
  return a;
}

inline int fail(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  return 1;
}

struct Look {
  dupin::Vec3 eye, target, up{0, 0, 1};
  double fov_degrees = 40, near = 1, far = 10;
};

/// From outside a box, turned about the vertical by an angle.
inline Look look_at(const dupin::Box3& box, double angle_radians) {
  const double size = box.diagonal();
  Look look;
  look.target = box.center();
  look.eye = look.target + dupin::Vec3{std::sin(angle_radians), -std::cos(angle_radians), 0.6} * (1.3 * size);
  look.near = 0.2 * size, look.far = 4 * size;
  return look;
}

/// As OpenGL has them.
inline dupin::HostView host_view(const Look& look, int width, int height) {
  const dupin::Vec3 f = normalized(look.target - look.eye), r = normalized(cross(f, look.up)),
                    u = cross(r, f);
  const double scale = 1 / std::tan(look.fov_degrees * M_PI / 360), n = look.near, far = look.far;
  dupin::HostView view;
  view.view = {r.x,
               u.x,
               -f.x,
               0,
               r.y,
               u.y,
               -f.y,
               0,
               r.z,
               u.z,
               -f.z,
               0,
               -dot(r, look.eye),
               -dot(u, look.eye),
               dot(f, look.eye),
               1};
  view.projection = {scale * height / width,  0, 0, 0, 0, scale, 0, 0, 0, 0, (far + n) / (n - far), -1, 0, 0,
                     2 * far * n / (n - far), 0};
  view.viewport = {0, 0, width, height};
  return view;
}

/// As arguments of `dupin render`.
inline void print_camera(const Look& look, int width, int height) {
  std::printf(
      "camera: --eye %.17g,%.17g,%.17g --target %.17g,%.17g,%.17g --up-vector 0,0,1 --fov %.17g --resolution "
      "%d,%d\n",
      look.eye.x, look.eye.y, look.eye.z, look.target.x, look.target.y, look.target.z, look.fov_degrees,
      width, height);
}

/// Three or four bytes a pixel, bottom row first.
inline bool write(const char* path, const std::vector<unsigned char>& pixels, int width, int height,
                  int channels) {
  dupin::Image8 image;
  image.width = width, image.height = height, image.channels = 3;
  image.values.resize(static_cast<std::size_t>(3 * width * height));
  for (int row = 0; row < height; ++row)
    for (int i = 0; i < width; ++i)
      for (int k = 0; k < 3; ++k)
        image.values[static_cast<std::size_t>(3 * (row * width + i) + k)] =
            pixels[static_cast<std::size_t>(channels * ((height - 1 - row) * width + i) + k)];
  return dupin::write_png(path, image).ok();
}

#ifdef DUPIN_HOST_CHECKS
/// Draws, and says what of the context's state changed by that: tests/host/checked_draw.cpp.
dupin::Status draw(dupin::HostScene& scene, const dupin::HostView& view, const dupin::DrawOptions& options,
                   const dupin::GetProcAddress& loader);
#else
inline dupin::Status draw(dupin::HostScene& scene, const dupin::HostView& view,
                          const dupin::DrawOptions& options, const dupin::GetProcAddress&) {
  return scene.draw(view, options);
}
#endif

}  // namespace example

#endif
