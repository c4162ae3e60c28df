// What a study's pictures are compared with: the exact ray caster, or fine triangles; and cameras that go
// close to the surface.
#ifndef DUPIN_APP_STUDY_TRUTH_H
#define DUPIN_APP_STUDY_TRUTH_H

#include <map>
#include <memory>
#include <string>

#include "../../exact/exact_scene.h"
#include "../../render/image.h"
#include "study.h"

namespace dupin::app {

/// The surfaces of one model, for rays.
class Truth {
 public:
  /// The model must outlive it.
  /// Without `has_faces` the model's faces are but names and colors: of points that were read from a file.
  explicit Truth(const Model& model, bool has_faces = true) : model_(model), has_faces_(has_faces) {}
  /// Parts whose faces are meshes alone are not known to the caster.
  bool has_exact_faces() const;
  const exact::ExactScene& scene();
  /// The row's camera, zoomed.
  Result<Camera> camera(const StudyRow& row);
  Result<Image> picture(const StudyRow& row, const Camera& camera);

 private:
  const Model& model_;
  bool has_faces_;
  std::unique_ptr<exact::ExactScene> scene_;
};

/// "--eye … --target …": as `dupin render` takes it, to the last digit.
std::string camera_arguments(const Camera& camera);

}  // namespace dupin::app

#endif
