// A sphere made by hand, sampled into quadric DPs and drawn: the way from a Model to a picture, from outside.
#include <cstdio>

#include <dupin/nurbs/model.h>
#include <dupin/render/context.h>
#include <dupin/render/renderer.h>
#include <dupin/sampling/sampler.h>

namespace {

dupin::Model sphere() {
  dupin::Part part;
  part.surfaces.push_back({dupin::Sphere{{}, 2.0}});
  dupin::Face face;
  face.uv_box.add(dupin::Vec2{0, -1.5707963267948966});
  face.uv_box.add(dupin::Vec2{6.283185307179586, 1.5707963267948966});
  part.faces.push_back(face);
  part.box.add(dupin::Vec3{-2, -2, -2});
  part.box.add(dupin::Vec3{2, 2, 2});
  dupin::Model model;
  model.parts.push_back(part);
  model.instances.push_back({});
  return model;
}

/// The part of the picture that the sphere covers, or -1.
double covered_part(const dupin::Model& model, const dupin::DpScene& dps) {
  const auto context = dupin::create_context(dupin::Device::automatic);
  if (!context.ok()) return -1;
  const auto renderer = dupin::Renderer::create((*context)->loader());
  if (!renderer.ok()) return -1;
  const auto scene = (*renderer)->upload(model, &dps);
  if (!scene.ok()) return -1;
  dupin::Camera camera;
  camera.eye = {0, -10, 0};
  camera.orthographic = true;
  camera.ortho_height = 4;  // the sphere touches the border
  camera.width = camera.height = 100;
  const auto frame = (*renderer)->draw(**scene, camera, {});
  return frame.ok() ? frame->stats.covered_pixels / 1e4 : -1;
}

}  // namespace

int main() {
  const dupin::Model model = sphere();
  dupin::SamplingOptions options;
  options.tolerance = 1e-3;
  const auto scene = dupin::sample_quadric_dps(model, options);
  if (!scene.ok()) return std::fprintf(stderr, "%s\n", scene.status().message.c_str()), 1;
  const double part = covered_part(model, *scene);
  std::printf("%zu DPs, bound %g, %.1f %% of the picture\n", scene->count(), scene->bound, 100 * part);
  // A disc in its square: π/4.
  return scene->count() > 0 && scene->bound <= options.tolerance && part > 0.77 && part < 0.80 ? 0 : 1;
}
