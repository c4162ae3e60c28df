#include "subject.h"

#include <cmath>
#include <cstdio>

#include "../../render/view.h"

namespace dupin::bench {

Result<std::unique_ptr<Device3d>> Device3d::create() {
  auto device = std::make_unique<Device3d>();
  auto context = create_context(Device::automatic);
  if (!context.ok()) return context.status();
  device->context_ = std::move(*context);
  auto renderer = Renderer::create(device->context_->loader());
  if (!renderer.ok()) return renderer.status();
  device->renderer_ = std::move(*renderer);
  return device;
}

DrawnTrees make_scene(Renderer& renderer, const Model& model, const std::shared_ptr<const PointTree>& tree,
                      const TreeLayerOptions& options) {
  DrawnTrees drawn;
  SceneContent content;
  if (tree) {
    drawn.layers =
        std::make_unique<TreeLayers>(std::vector<PartTree>(model.parts.size(), {tree, 0}), options);
    content.layers.push_back(drawn.layers->layer());
  }
  auto scene = renderer.upload(model, content);
  if (!scene.ok()) {
    std::fprintf(stderr, "%s\n", scene.status().message.c_str());
    std::exit(1);
  }
  drawn.scene = std::move(*scene);
  return drawn;
}

Camera camera_at(const Box3& box, int size, double times) {
  Camera settings;
  settings.width = settings.height = size;
  Camera camera = *fit_view(box, "iso", settings);
  camera.eye = camera.target + (camera.eye - camera.target) * times;
  return camera;
}

Camera close_camera(const PolygonMesh& mesh, int size, double part) {
  const Box3 box = bounding_box(mesh);
  Camera camera = camera_at(box, size, 1);
  const Vec3 towards = normalized(camera.eye - camera.target);
  // The vertex that is nearest to the eye among those near the line of sight.
  double best = -1e300;
  for (const Vec3& p : mesh.positions) {
    const Vec3 from = p - camera.target;
    const double along = dot(from, towards), aside = length(from - towards * along);
    if (aside < 0.1 * box.diagonal() && along > best) best = along, camera.target = p;
  }
  const double height = part * box.diagonal();
  camera.eye =
      camera.target + towards * (0.5 * height / std::tan(camera.fov_degrees * 3.14159265358979 / 360));
  return camera;
}

double milliseconds(const std::chrono::steady_clock::time_point& start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace dupin::bench
