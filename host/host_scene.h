// What a CAD viewer, or any other program with an OpenGL context, needs of the library: a set of models in a
// context of the host's, drawn with the host's camera among what the host draws itself.
//
//   auto scene = HostScene::create([](const char* name) { return my_get_proc_address(name); });
//   const auto id = (*scene)->add(prepared);                            // prepared_model.h, load_job.h
//   (*scene)->draw({view, projection, viewport}, {});                   // each frame
//   (*scene)->refine({view, projection, viewport}, 0.5, redraw);        // when the camera rests
//   const auto hit = (*scene)->pick({view, projection, viewport}, x, y);
//
// A HostScene belongs to one context (OpenGL 3.3 and up, core or compatibility), which must be current for
// `create`, `draw`, `get_ready`, `pick…`, `picture` and the destructor. All of it is used by one thread at a
// time. Every call leaves the context's state as it found it; one that fails says why and leaves everything
// as it was.
#ifndef DUPIN_HOST_HOST_SCENE_H
#define DUPIN_HOST_HOST_SCENE_H

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../render/renderer.h"
#include "prepared_model.h"

namespace dupin {

/// A model in a scene. Never used again for another.
using ObjectId = std::uint32_t;

/// What a look is for: an object, one of its model's instances, or a face of one.
struct Target {
  ObjectId object = 0;
  std::uint32_t instance = Scene::kWhole;
  std::uint32_t face = Scene::kWhole;  ///< index in the part
  friend bool operator==(const Target&, const Target&) = default;
  friend auto operator<=>(const Target&, const Target&) = default;
};

/// What is seen at a pixel.
struct Hit {
  Target target;
  std::string part, instance, face;  ///< names, as the file has them
  std::string surface;               ///< its kind: "plane", "cylinder", …; "mesh" for polygons
  std::optional<double> radius;      ///< of cylinders, spheres (at the point: of cones), tori (the minor)
  Vec3 point, normal;                ///< model space; unit, outward
  double depth = 0;                  ///< along the view axis
  // Of the exact surface at the point; NaN for polygons.
  double k1 = 0, k2 = 0;  ///< |k1| >= |k2|, positive where the surface bends towards the normal
  Vec3 direction;         ///< of k1, unit
  Vec2 uv;
  /// The part's edge that is seen within kEdgeReach pixels of the pixel, and how far off it is.
  std::optional<std::uint32_t> edge;
  double edge_distance_px = 0;
};
inline constexpr double kEdgeReach = 4;

class HostScene {
 public:
  /// no_device where the context is older than OpenGL 3.3, or there is none.
  static Result<std::unique_ptr<HostScene>> create(const GetProcAddress& get_proc_address);
  ~HostScene();

  // ---- what is in it. The GPU's memory follows with the next frame.
  Result<ObjectId> add(std::shared_ptr<const PreparedModel> model, const Affine3& to_world = {});
  /// What was edited: looks stay.
  Status replace(ObjectId object, std::shared_ptr<const PreparedModel> model);
  Status remove(ObjectId object);
  /// May turn, shift, mirror and scale, but not flatten.
  Status place(ObjectId object, const Affine3& to_world);
  std::vector<ObjectId> objects() const;
  const PreparedModel* model(ObjectId object) const;
  /// As placed; empty if there is none.
  Box3 box(ObjectId object) const;
  /// Of everything, visible or not.
  Box3 box() const;

  // ---- how it is shown. What is said of a face goes before what is said of its instance, and that before
  // what is said of the object.
  Status set_visible(const Target& target, bool visible);
  /// None: the file's.
  Status set_color(const Target& target, const std::optional<Color>& color);
  /// Before every color and through every shading; none: not highlighted.
  Status set_highlight(const Target& target, const std::optional<Color>& color);

  // ---- drawing. `exact_model` of the options is not looked at.
  /// Into the framebuffer that is bound for drawing, against and into its depth buffer.
  Status draw(const HostView& view, const DrawOptions& options, FrameStats* stats = nullptr);
  /// For a host that wants to stay responsive while objects come: does a part of what a frame does when they
  /// are new, uploading or building programs for about `milliseconds`, and draws nothing. True: it had
  /// nothing to do, so that `draw` takes no longer than any frame. A host calls it in a frame's place until
  /// it is.
  Result<bool> get_ready(const HostView& view, const DrawOptions& options, double milliseconds);
  /// Into memory. With `exact`, curvatures are the exact surfaces' at every pixel, which takes a microsecond
  /// or so for each.
  Result<Frame> picture(const Camera& camera, const DrawOptions& options, bool exact = true);
  /// What a number of a picture's face channel stands for.
  std::optional<Target> face_target(std::uint32_t number) const;

  // ---- picking, in pixels from the viewport's lower left corner.
  Result<std::optional<Hit>> pick(const HostView& view, int x, int y, const DrawOptions& options = {});
  /// The faces that are seen in a rectangle (x, y, width, height), in no order that matters.
  Result<std::vector<Target>> pick_rectangle(const HostView& view, const std::array<int, 4>& rectangle,
                                             const DrawOptions& options = {});

  // ---- zooming in
  /// Starts to prepare, on a thread, everything in this view to `tolerance_px` pixels where it is coarser;
  /// the first frame after that is done draws it. `ready` is called on that thread then. What was begun for
  /// another view is given up. FrameStats::bound_px says whether it is worth it.
  Status refine(const HostView& view, double tolerance_px, std::function<void()> ready = {});
  bool refining() const;

  std::string gl_renderer() const;
  class Impl;

 private:
  explicit HostScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dupin

#endif
