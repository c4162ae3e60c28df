// A mesh that is measured, and what it is drawn with.
#ifndef DUPIN_BENCH_POP_SUBJECT_H
#define DUPIN_BENCH_POP_SUBJECT_H

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../core/camera.h"
#include "../../render/context.h"
#include "../../render/renderer.h"
#include "../../render/tree_layer.h"

namespace dupin::bench {

struct PopOptions {
  std::vector<std::string> files, what;
  std::vector<int> loop{0};
  int size = 1024, repeat = 9, frames = 200;
  std::string dupin, output;
};

struct Subject {
  std::string name;
  Model model;  ///< one part, placed once
  std::shared_ptr<const PointTree> pop, qsplat;
  const PolygonMesh& mesh() const { return model.parts[0].polygons; }
};

/// A context and a renderer of its own.
class Device3d {
 public:
  static Result<std::unique_ptr<Device3d>> create();
  Renderer& renderer() { return *renderer_; }

 private:
  std::unique_ptr<Context> context_;
  std::unique_ptr<Renderer> renderer_;
};

/// A scene of trees; or, without any, of the model's triangles.
struct DrawnTrees {
  std::unique_ptr<TreeLayers> layers;
  std::unique_ptr<Scene> scene;
};
DrawnTrees make_scene(Renderer& renderer, const Model& model, const std::shared_ptr<const PointTree>& tree,
                      const TreeLayerOptions& options);

/// The model from the isometric view; its middle `times` as far away as where the box fills the picture.
Camera camera_at(const Box3& box, int size, double times);
/// Looks from the same side at the surface's nearest part, so near that the picture is `part` of the box's
/// diagonal high.
Camera close_camera(const PolygonMesh& mesh, int size, double part);

double milliseconds(const std::chrono::steady_clock::time_point& start);

// Each prints what it finds and returns it.
nlohmann::json measure_build(Subject& subject, int repeat);
nlohmann::json measure_file(const Subject& subject, const PopOptions& options);
nlohmann::json measure_cuts(const Subject& subject, Renderer& renderer, const PopOptions& options);
nlohmann::json measure_error(const Subject& subject, Renderer& renderer, const PopOptions& options);
nlohmann::json measure_frames(const Subject& subject, Renderer& renderer, const PopOptions& options);
nlohmann::json measure_orbit(const Subject& subject, Renderer& renderer, const PopOptions& options);
nlohmann::json measure_instances(const Subject& subject, Renderer& renderer, const PopOptions& options);

}  // namespace dupin::bench

#endif
