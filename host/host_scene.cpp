#include "host_scene.h"

#include <algorithm>
#include <cmath>

#include "../render/view_rays.h"
#include "host_scene_impl.h"

namespace dupin {
namespace {

Status no_object() {
  return {StatusCode::invalid_argument, "the scene has no such object, instance or face"};
}

/// A symmetric camera that sees all that the view sees, with pixels as small as its.
Camera camera_around(const ViewRays& view) {
  Camera camera;
  camera.eye = view.eye;
  camera.target = view.eye + view.forward;
  camera.up = view.up;
  camera.orthographic = !view.perspective;
  const double sx = std::abs(view.sx), sy = std::abs(view.sy);
  const double x = sx + std::abs(view.ox), y = sy + std::abs(view.oy);
  camera.width = static_cast<int>(std::ceil(view.width * x / sx));
  camera.height = static_cast<int>(std::ceil(view.height * y / sy));
  camera.fov_degrees = 2 * std::atan(y) * 180 / 3.14159265358979323846;
  camera.ortho_height = 2 * y;
  return camera;
}

bool same(const Camera& a, const Camera& b) {
  return distance(a.eye, b.eye) == 0 && distance(a.target, b.target) == 0 && distance(a.up, b.up) == 0 &&
         a.fov_degrees == b.fov_degrees && a.orthographic == b.orthographic &&
         a.ortho_height == b.ortho_height && a.width == b.width && a.height == b.height;
}

bool flattens(const Affine3& to_world) {
  const Mat3& m = to_world.linear;
  const double size = length(m.x) * length(m.y) * length(m.z), volume = std::abs(determinant(m));
  return !is_finite(to_world.translation) || !std::isfinite(size) || !(volume > 1e-12 * size);
}

}  // namespace

Result<std::unique_ptr<HostScene>> HostScene::create(const GetProcAddress& get_proc_address) {
  if (!get_proc_address) return {StatusCode::invalid_argument, "no way to find OpenGL's functions was given"};
  auto renderer = Renderer::create(get_proc_address);
  if (!renderer) return renderer.status();
  auto impl = std::make_unique<Impl>();
  impl->renderer = std::move(*renderer);
  return std::unique_ptr<HostScene>(new HostScene(std::move(impl)));
}

HostScene::HostScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HostScene::~HostScene() = default;

std::string HostScene::gl_renderer() const {
  return impl_->renderer->gl_renderer();
}

// ---- objects

Result<ObjectId> HostScene::add(std::shared_ptr<const PreparedModel> model, const Affine3& to_world) {
  if (!model) return {StatusCode::invalid_argument, "there is no model to add"};
  if (flattens(to_world)) return {StatusCode::invalid_argument, "a placement must not flatten its object"};
  const ObjectId id = impl_->next++;
  impl_->objects[id] = {std::move(model), to_world, {}};
  impl_->stale = true;
  return id;
}

Status HostScene::replace(ObjectId object, std::shared_ptr<const PreparedModel> model) {
  const auto found = impl_->find({object});
  if (!found) return found.status();
  if (!model) return {StatusCode::invalid_argument, "there is no model to replace it"};
  (*found)->prepared = std::move(model);
  impl_->stale = true;
  return {};
}

Status HostScene::remove(ObjectId object) {
  if (impl_->objects.erase(object) == 0) return no_object();
  impl_->stale = true;
  return {};
}

Status HostScene::place(ObjectId object, const Affine3& to_world) {
  const auto found = impl_->find({object});
  if (!found) return found.status();
  if (flattens(to_world)) return {StatusCode::invalid_argument, "a placement must not flatten its object"};
  (*found)->to_world = to_world;
  if (!impl_->stale) impl_->place(**found);
  return {};
}

std::vector<ObjectId> HostScene::objects() const {
  std::vector<ObjectId> ids;
  for (const auto& [id, object] : impl_->objects) ids.push_back(id);
  return ids;
}

const PreparedModel* HostScene::model(ObjectId object) const {
  const auto found = impl_->objects.find(object);
  return found == impl_->objects.end() ? nullptr : found->second.prepared.get();
}

Box3 HostScene::box(ObjectId object) const {
  Box3 box;
  const auto found = impl_->objects.find(object);
  if (found == impl_->objects.end()) return box;
  const Model& model = *found->second.prepared->model;
  for (const Instance& instance : model.instances)
    if (const Box3& own = model.parts[instance.part].box; !own.empty())
      box.add(transform_box(found->second.to_world * instance.to_world, own));
  return box;
}

Box3 HostScene::box() const {
  Box3 all;
  for (const auto& [id, object] : impl_->objects)
    if (const Box3 own = box(id); !own.empty()) all.add(own);
  return all;
}

// ---- looks

template <class Set>
Status HostScene::Impl::look(const Target& target, Set&& set) {
  const auto found = find(target);
  if (!found) return found.status();
  // A face of all instances is a face of each.
  std::vector<std::uint32_t> instances{target.instance};
  if (target.instance == Scene::kWhole && target.face != Scene::kWhole) {
    instances.resize((*found)->prepared->model->instances.size());
    for (std::uint32_t i = 0; i < instances.size(); ++i) instances[i] = i;
  }
  for (const std::uint32_t instance : instances) {
    set((*found)->looks[{instance, target.face}]);
    if (stale || !scene) continue;
    if (instance == Scene::kWhole)
      show_all(**found);
    else
      show(**found, instance, target.face);
  }
  return {};
}

Status HostScene::set_visible(const Target& target, bool visible) {
  return impl_->look(target, [&](Impl::Look& look) { look.visible = visible; });
}
Status HostScene::set_color(const Target& target, const std::optional<Color>& color) {
  return impl_->look(target, [&](Impl::Look& look) { look.color = color; });
}
Status HostScene::set_highlight(const Target& target, const std::optional<Color>& color) {
  return impl_->look(target, [&](Impl::Look& look) { look.highlight = color; });
}

Result<HostScene::Impl::Object*> HostScene::Impl::find(const Target& target) {
  const auto found = objects.find(target.object);
  if (found == objects.end()) return no_object();
  const Model& own = *found->second.prepared->model;
  if (target.instance == Scene::kWhole) {
    std::size_t faces = 0;
    for (const Part& part : own.parts) faces = std::max(faces, face_count(part));
    if (target.face != Scene::kWhole && target.face >= faces) return no_object();
  } else {
    if (target.instance >= own.instances.size()) return no_object();
    if (target.face != Scene::kWhole &&
        target.face >= face_count(own.parts[own.instances[target.instance].part]))
      return no_object();
  }
  return &found->second;
}

void HostScene::Impl::show(const Object& object, std::uint32_t instance, std::uint32_t face) {
  const Model& own = *object.prepared->model;
  if (instance >= own.instances.size()) return;  // of a model that was replaced
  const auto said = [&](std::uint32_t i, std::uint32_t f) {
    const auto found = object.looks.find({i, f});
    return found == object.looks.end() ? Look{} : found->second;
  };
  Look look = said(instance, face);
  const std::uint32_t number = object.first_instance + instance;
  if (face == Scene::kWhole) {
    const Look whole = said(Scene::kWhole, Scene::kWhole);
    look.visible = look.visible.value_or(whole.visible.value_or(true));
    if (!look.color) look.color = whole.color;
    if (!look.highlight) look.highlight = whole.highlight;
  } else if (face >= face_count(own.parts[own.instances[instance].part])) {
    return;
  }
  if (look.visible) scene->set_visible(number, *look.visible, face);
  scene->set_color(number, look.color, face);
  scene->set_highlight(number, look.highlight, face);
}

void HostScene::Impl::show_all(const Object& object) {
  if (object.looks.empty()) return;
  for (std::uint32_t i = 0; i < object.prepared->model->instances.size(); ++i) show(object, i, Scene::kWhole);
  for (const auto& [key, look] : object.looks)
    if (key.second != Scene::kWhole) show(object, key.first, key.second);
}

void HostScene::Impl::place(const Object& object) {
  if (!scene) return;
  const auto& instances = object.prepared->model->instances;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    scene->place(object.first_instance + i, object.to_world * instances[i].to_world);
}

// ---- uploading

Status HostScene::Impl::upload(PreparedModel all) {
  SceneContent content{&all.dps, {}};
  std::unique_ptr<TreeLayers> layers;
  const auto has_tree = [](const PartTree& tree) { return tree.tree != nullptr; };
  if (std::any_of(all.trees.begin(), all.trees.end(), has_tree)) {
    layers = std::make_unique<TreeLayers>(std::move(all.trees), TreeLayerOptions{});
    content.layers.push_back(layers->layer());
  }
  auto made = renderer->upload(*all.model, content);
  if (!made) return made.status();
  scene = std::move(*made);
  built = false;
  trees = std::move(layers);
  model = all.model;
  for (const auto& [id, object] : objects) place(object), show_all(object);
  return {};
}

Status HostScene::Impl::update() {
  if (!stale) return use_refinement();
  refinement.reset();
  refined.reset();
  std::vector<std::shared_ptr<const PreparedModel>> all;
  std::uint32_t instances = 0;
  for (auto& [id, object] : objects) {
    object.first_instance = instances;
    instances += static_cast<std::uint32_t>(object.prepared->model->instances.size());
    all.push_back(object.prepared);
  }
  if (all.empty()) {
    scene.reset(), trees.reset(), model.reset();
    stale = false;
    return {};
  }
  const Status status = upload(all.size() == 1 ? *all[0] : joined(all));
  if (status.ok()) stale = false;
  return status;
}

Status HostScene::Impl::use_refinement() {
  if (!refinement || !refinement->done()) return {};
  const auto finer = refinement->result();
  refinement.reset();
  // One that failed leaves what is there, which is drawn no worse than before.
  return finer ? upload(**finer) : Status{};
}

// ---- drawing

Status HostScene::draw(const HostView& view, const DrawOptions& options, FrameStats* stats) {
  if (stats) *stats = {};
  if (const Status status = impl_->update(); !status.ok()) return status;
  if (!impl_->scene) return {};
  DrawOptions own = options;
  own.exact_model = nullptr;
  return impl_->renderer->draw_into_host(*impl_->scene, view, own, stats);
}

Result<bool> HostScene::get_ready(const HostView& view, const DrawOptions& options, double milliseconds) {
  const Scene* const before = impl_->scene.get();
  if (const Status status = impl_->update(); !status.ok()) return status;
  if (!impl_->scene || (impl_->built && impl_->scene.get() == before)) return true;
  if (impl_->scene.get() != before) return false;
  DrawOptions own = options;
  own.exact_model = nullptr;
  const auto done = impl_->renderer->build_for(*impl_->scene, view, own, milliseconds);
  if (!done) return done.status();
  impl_->built = *done;
  return false;
}

Result<Frame> HostScene::picture(const Camera& camera, const DrawOptions& options, bool exact) {
  if (const Status status = impl_->update(); !status.ok()) return status;
  if (!impl_->scene) return {StatusCode::invalid_argument, "there is nothing in the scene to draw"};
  DrawOptions own = options;
  own.exact_model = exact ? impl_->model.get() : nullptr;
  return impl_->renderer->draw(*impl_->scene, camera, own);
}

std::optional<Target> HostScene::face_target(std::uint32_t number) const {
  if (!impl_->scene || number < 1 || number > impl_->scene->info().drawn_faces) return {};
  return impl_->target_of(impl_->scene->face_name(number));
}

Target HostScene::Impl::target_of(const FaceName& name) const {
  Target target;
  for (const auto& [id, object] : objects)
    if (object.first_instance <= name.instance)
      target = {id, name.instance - object.first_instance, name.face};
  return target;
}

Status HostScene::refine(const HostView& view, double tolerance_px, std::function<void()> ready) {
  if (!(tolerance_px > 0)) return {StatusCode::invalid_argument, "tolerances must be positive"};
  const auto rays = view_rays(view.view, view.projection, view.viewport[2], view.viewport[3]);
  if (!rays) return rays.status();
  if (const Status status = impl_->update(); !status.ok()) return status;
  const Camera camera = camera_around(*rays);
  if (!impl_->scene || (impl_->refined && same(*impl_->refined, camera))) return {};
  impl_->refinement.reset();  // stops it
  auto placed = std::make_shared<Model>(*impl_->model);
  PrepareOptions options;
  for (const auto& [id, object] : impl_->objects) {
    for (std::size_t i = 0; i < object.prepared->model->instances.size(); ++i) {
      Affine3& to_world = placed->instances[object.first_instance + i].to_world;
      to_world = object.to_world * to_world;
    }
    const double own = object.prepared->tolerance;
    options.tolerance = options.tolerance > 0 ? std::min(options.tolerance, own) : own;
  }
  options.camera = camera;
  options.tolerance_px = tolerance_px;
  impl_->refined = camera;
  impl_->refinement = LoadJob::start(std::move(placed), options, std::move(ready));
  return {};
}

bool HostScene::refining() const {
  return impl_->refinement && !impl_->refinement->done();
}

}  // namespace dupin
