// What a HostScene is made of.
#ifndef DUPIN_HOST_HOST_SCENE_IMPL_H
#define DUPIN_HOST_HOST_SCENE_IMPL_H

#include <map>

#include "host_scene.h"
#include "load_job.h"

namespace dupin {

class HostScene::Impl {
 public:
  struct Look {
    std::optional<bool> visible;
    std::optional<Color> color, highlight;
  };
  struct Object {
    std::shared_ptr<const PreparedModel> prepared;
    Affine3 to_world;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Look> looks;  ///< instance and face; kWhole goes last
    std::uint32_t first_instance = 0;                               ///< in the scene
  };

  std::unique_ptr<Renderer> renderer;
  std::map<ObjectId, Object> objects;
  ObjectId next = 1;

  /// What is uploaded: one scene of all objects.
  std::shared_ptr<const Model> model;
  std::unique_ptr<TreeLayers> trees;
  std::unique_ptr<Scene> scene;
  bool stale = false;  ///< objects came, went or changed since
  bool built = false;  ///< nothing is left to build for what is uploaded

  /// What is prepared for a view, for the objects as they are uploaded.
  std::unique_ptr<LoadJob> refinement;
  std::optional<Camera> refined;  ///< for which it was begun

  Result<Object*> find(const Target& target);
  /// Uploads what has changed; ok and no scene where there are no objects.
  Status update();
  Status upload(PreparedModel all);
  Status use_refinement();
  void place(const Object& object);
  /// As what was said of it, or (an instance) of its object, has it.
  void show(const Object& object, std::uint32_t instance, std::uint32_t face);
  void show_all(const Object& object);
  /// One setting of one target, kept and shown.
  template <class Set>
  Status look(const Target& target, Set&& set);
  Target target_of(const FaceName& name) const;
  const Part& part_of(const FaceName& name) const {
    return model->parts[model->instances[name.instance].part];
  }
};

/// Fills in what is known of a face, and the nearest edge, where `hit` has the point.
void describe_face(const Model& model, const FaceName& name, const Affine3& to_world, Hit& hit);
void find_edge(const Model& model, const FaceName& name, const Affine3& to_world, double pixel, Hit& hit);

}  // namespace dupin

#endif
