// A sphere made by hand, sampled into quadric DPs: the way from a Model to what is drawn, from outside.
#include <cstdio>

#include <dupin/nurbs/model.h>
#include <dupin/sampling/sampler.h>

int main() {
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

  dupin::SamplingOptions options;
  options.tolerance = 1e-3;
  const auto scene = dupin::sample_quadric_dps(model, options);
  if (!scene.ok()) return std::fprintf(stderr, "%s\n", scene.status().message.c_str()), 1;
  std::printf("%zu DPs, bound %g\n", scene->count(), scene->bound);
  return scene->count() > 0 && scene->bound <= options.tolerance ? 0 : 1;
}
