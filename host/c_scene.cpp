// The C interface to drawing and picking.
#include <limits>

#include "c_handles.h"

namespace dupin::c {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

HostView host_view(const dupin_view& view) {
  HostView own;
  std::copy(view.view, view.view + 16, own.view.begin());
  std::copy(view.projection, view.projection + 16, own.projection.begin());
  std::copy(view.viewport, view.viewport + 4, own.viewport.begin());
  return own;
}

Result<DrawOptions> draw_options(const dupin_draw_options* given) {
  const dupin_draw_options own = sized(given);
  DrawOptions options;
  if (own.shading < DUPIN_LIT || own.shading > DUPIN_PRIMITIVE)
    return {StatusCode::invalid_argument, "there is no such shading"};
  if ((own.light_count > 0 && !own.lights) || (own.section_count > 0 && !own.sections))
    return {StatusCode::invalid_argument, "lights or sections are NULL, but their number is not 0"};
  if (own.light_count > kMostLights || own.section_count > kMostSections)
    return {StatusCode::invalid_argument, "there are too many lights or sections"};
  options.shading = static_cast<Shading>(own.shading);
  options.edges = !own.no_edges;
  if (own.edge_width != 0) options.edge_width_px = own.edge_width;
  if (own.samples != 0) options.samples = own.samples;
  options.color = color(own.color);
  options.background = color(own.background);
  options.curvature_scale = own.curvature_scale;
  for (std::size_t i = 0; i < own.light_count; ++i) {
    const dupin_light& light = own.lights[i];
    options.lights.push_back({vec3(light.position), {light.rgb[0], light.rgb[1], light.rgb[2], 1}});
  }
  for (std::size_t i = 0; i < own.section_count; ++i)
    options.sections.push_back({vec3(own.sections + 4 * i), own.sections[4 * i + 3]});
  return options;
}

Camera camera_of(const dupin_camera& given) {
  Camera camera;
  camera.eye = vec3(given.eye), camera.target = vec3(given.target), camera.up = vec3(given.up);
  camera.orthographic = given.fov_degrees == 0;
  if (!camera.orthographic) camera.fov_degrees = given.fov_degrees;
  camera.ortho_height = given.height;
  camera.width = given.width, camera.height = given.pixels_high;
  return camera;
}

void put(const Vec3& v, double* out) {
  out[0] = v.x, out[1] = v.y, out[2] = v.z;
}

dupin_hit c_hit(const std::optional<Hit>& hit) {
  dupin_hit own{};
  own.edge = -1;
  if (!hit) return own;
  own.object = hit->target.object, own.instance = hit->target.instance, own.face = hit->target.face;
  if (hit->edge) own.edge = static_cast<std::int32_t>(*hit->edge);
  own.edge_distance_px = hit->edge_distance_px;
  put(hit->point, own.point), put(hit->normal, own.normal), put(hit->direction, own.direction);
  own.depth = hit->depth;
  own.k1 = hit->k1, own.k2 = hit->k2, own.u = hit->uv.x, own.v = hit->uv.y;
  own.radius = hit->radius.value_or(kNaN);
  const std::size_t size = std::min(hit->surface.size(), sizeof own.surface - 1);
  std::memcpy(own.surface, hit->surface.data(), size);
  return own;
}

/// Runs `work` with the scene.
template <class Work>
dupin_status with_scene(dupin_scene* scene, Work&& work) {
  return guarded([&]() -> Status {
    if (!scene) return missing("scene");
    return work(*scene->scene);
  });
}

Status draw(HostScene& scene, const dupin_view* view, const dupin_draw_options* given,
            dupin_frame_stats* stats) {
  if (!view) return missing("view");
  const auto options = draw_options(given);
  if (!options) return options.status();
  FrameStats frame;
  if (Status status = scene.draw(host_view(*view), *options, &frame); !status.ok()) return status;
  if (stats) give(dupin_frame_stats{0, frame.primitives, frame.bound_px, frame.milliseconds}, stats);
  return {};
}

Status picture(HostScene& scene, const dupin_camera* camera, const dupin_draw_options* given,
               std::uint8_t* rgba, float* depth) {
  if (!camera) return missing("camera");
  auto options = draw_options(given);
  if (!options) return options.status();
  options->outputs = (rgba ? kScreen : 0U) | (depth ? kDepth : 0U);
  if (options->outputs == 0) return {StatusCode::invalid_argument, "no output was given"};
  const auto frame = scene.picture(camera_of(*camera), *options);
  if (!frame) return frame.status();
  if (rgba) std::copy(frame->screen.begin(), frame->screen.end(), rgba);
  if (depth) std::copy(frame->depth.begin(), frame->depth.end(), depth);
  return {};
}

}  // namespace
}  // namespace dupin::c

using namespace dupin;
using namespace dupin::c;

dupin_status dupin_context_create(dupin_context** context) {
  return guarded([&]() -> Status {
    if (!context) return missing("context");
    auto made = create_context(Device::automatic);
    if (!made) return made.status();
    *context = new dupin_context{std::move(*made)};
    return {};
  });
}
void dupin_context_free(dupin_context* context) {
  delete context;
}
void* dupin_context_get_proc_address(void* context, const char* name) {
  return context && name ? static_cast<dupin_context*>(context)->context->proc_address(name) : nullptr;
}

dupin_status dupin_scene_create(dupin_get_proc_address get_proc_address, void* user, dupin_scene** scene) {
  return guarded([&]() -> Status {
    if (!get_proc_address || !scene) return missing(scene ? "get_proc_address" : "scene");
    auto made = HostScene::create([=](const char* name) { return get_proc_address(user, name); });
    if (!made) return made.status();
    *scene = new dupin_scene{std::move(*made)};
    return {};
  });
}
void dupin_scene_free(dupin_scene* scene) {
  delete scene;
}

dupin_status dupin_scene_add(dupin_scene* scene, const dupin_prepared* model, const double* matrix,
                             uint32_t* object) {
  return with_scene(scene, [&](HostScene& to) -> Status {
    if (!model) return missing("model");
    const auto added = to.add(model->prepared, affine(matrix));
    if (!added) return added.status();
    if (object) *object = *added;
    return {};
  });
}
dupin_status dupin_scene_replace(dupin_scene* scene, uint32_t object, const dupin_prepared* model) {
  return with_scene(
      scene, [&](HostScene& to) { return model ? to.replace(object, model->prepared) : missing("model"); });
}
dupin_status dupin_scene_remove(dupin_scene* scene, uint32_t object) {
  return with_scene(scene, [&](HostScene& from) { return from.remove(object); });
}
dupin_status dupin_scene_place(dupin_scene* scene, uint32_t object, const double* matrix) {
  return with_scene(scene, [&](HostScene& in) { return in.place(object, affine(matrix)); });
}
dupin_status dupin_scene_box(const dupin_scene* scene, uint32_t object, double box[6]) {
  return guarded([&]() -> Status {
    if (!scene || !box) return missing(scene ? "box" : "scene");
    if (object != 0 && !scene->scene->model(object))
      return {StatusCode::invalid_argument, "the scene has no such object"};
    const Box3 own = object != 0 ? scene->scene->box(object) : scene->scene->box();
    put(own.lo, box), put(own.hi, box + 3);
    return {};
  });
}

dupin_status dupin_scene_set_visible(dupin_scene* scene, uint32_t object, uint32_t instance, uint32_t face,
                                     int visible) {
  return with_scene(scene, [&](HostScene& in) {
    return in.set_visible({object, instance, face}, visible != 0);
  });
}
dupin_status dupin_scene_set_color(dupin_scene* scene, uint32_t object, uint32_t instance, uint32_t face,
                                   const float* rgba) {
  return with_scene(scene, [&](HostScene& in) {
    return in.set_color({object, instance, face}, color(rgba));
  });
}
dupin_status dupin_scene_set_highlight(dupin_scene* scene, uint32_t object, uint32_t instance, uint32_t face,
                                       const float* rgba) {
  return with_scene(scene, [&](HostScene& in) {
    return in.set_highlight({object, instance, face}, color(rgba));
  });
}

dupin_status dupin_scene_draw(dupin_scene* scene, const dupin_view* view, const dupin_draw_options* options,
                              dupin_frame_stats* stats) {
  return with_scene(scene, [&](HostScene& in) { return draw(in, view, options, stats); });
}
dupin_status dupin_scene_refine(dupin_scene* scene, const dupin_view* view, double tolerance_px) {
  return with_scene(scene, [&](HostScene& in) {
    return view ? in.refine(host_view(*view), tolerance_px) : missing("view");
  });
}
int dupin_scene_refining(const dupin_scene* scene) {
  return scene && scene->scene->refining();
}
dupin_status dupin_scene_picture(dupin_scene* scene, const dupin_camera* camera,
                                 const dupin_draw_options* options, uint8_t* rgba, float* depth) {
  return with_scene(scene, [&](HostScene& in) { return picture(in, camera, options, rgba, depth); });
}

dupin_status dupin_scene_pick(dupin_scene* scene, const dupin_view* view, int x, int y,
                              const dupin_draw_options* given, dupin_hit* hit) {
  return with_scene(scene, [&](HostScene& in) -> Status {
    if (!view || !hit) return missing(view ? "hit" : "view");
    const auto options = draw_options(given);
    if (!options) return options.status();
    const auto found = in.pick(host_view(*view), x, y, *options);
    if (!found) return found.status();
    give(c_hit(*found), hit);
    return {};
  });
}
dupin_status dupin_scene_pick_rectangle(dupin_scene* scene, const dupin_view* view, const int rectangle[4],
                                        const dupin_draw_options* given, dupin_target* targets,
                                        size_t capacity, size_t* count) {
  return with_scene(scene, [&](HostScene& in) -> Status {
    if (!view || !rectangle || !count || (capacity > 0 && !targets))
      return missing("view, rectangle, count or targets");
    const auto options = draw_options(given);
    if (!options) return options.status();
    const auto found = in.pick_rectangle(host_view(*view),
                                         {rectangle[0], rectangle[1], rectangle[2], rectangle[3]}, *options);
    if (!found) return found.status();
    *count = found->size();
    for (std::size_t i = 0; i < std::min(capacity, found->size()); ++i)
      targets[i] = {(*found)[i].object, (*found)[i].instance, (*found)[i].face};
    return {};
  });
}
