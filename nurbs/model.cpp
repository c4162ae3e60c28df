#include "model.h"

namespace dupin {

std::size_t face_count(const Part& part) {
  return part.faces.size() + face_count(part.polygons);
}

std::size_t face_instance_count(const Model& model) {
  std::size_t count = 0;
  for (const Instance& instance : model.instances) count += face_count(model.parts[instance.part]);
  return count;
}

Box3 bounding_box(const Model& model) {
  Box3 box;
  for (const Instance& instance : model.instances)
    box.add(transform_box(instance.to_world, model.parts[instance.part].box));
  return box;
}

}  // namespace dupin
