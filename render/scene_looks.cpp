// What a host changes about a scene: which of it is visible, in which colors, and where.
#include <algorithm>
#include <cmath>

#include "layer.h"
#include "renderer_impl.h"

namespace dupin {
namespace {

/// The columns' lengths bound how a placement stretches directions well enough for proxies.
double scale_ratio(const Mat3& m) {
  const double a = length(m.x), b = length(m.y), c = length(m.z);
  return std::max({a, b, c}) / std::max(std::min({a, b, c}), 1e-300);
}

bool asks_for_anything(const Look& look) {
  return look.visible || look.color || look.highlight;
}

/// `file`: what it is without either.
std::uint32_t shown_color(std::uint32_t file, const Look& whole, const Look* face) {
  const auto choose = [&](auto member) { return face && face->*member ? face->*member : whole.*member; };
  if (!choose(&Look::visible).value_or(true)) return kHiddenColor;
  if (const auto highlight = choose(&Look::highlight))
    return (srgb_word(*highlight) & 0xffffff) | kHighlightColor;
  const auto color = choose(&Look::color);
  return color ? srgb_word(*color) : file;
}

}  // namespace

void place(const Affine3& to_world, SceneInstance& instance) {
  instance.to_world = to_world;
  instance.to_part = inverse(to_world);
  instance.scale_ratio = scale_ratio(to_world.linear);
}

Look& Scene::Impl::look(std::uint32_t instance, std::uint32_t face) {
  if (looks.empty()) looks.resize(instances.size());
  InstanceLook& own = looks[instance];
  return face == kWhole ? own.whole : own.faces[face];
}

void Scene::Impl::apply_look(std::uint32_t index) {
  SceneInstance& instance = instances[index];
  InstanceLook& own = looks[index];
  std::erase_if(own.faces, [](const auto& entry) { return !asks_for_anything(entry.second); });
  FaceColors& shown = instance.colors;
  shown = instance.file_colors;
  shown.whole = shown_color(shown.whole, own.whole, nullptr);
  if (!own.faces.empty())
    shown.faces.resize(parts[instance.part].face_numbers.size(), instance.file_colors.whole);
  for (std::size_t f = 0; f < shown.faces.size(); ++f) {
    const auto found = own.faces.find(static_cast<std::uint32_t>(f));
    shown.faces[f] =
        shown_color(shown.faces[f], own.whole, found == own.faces.end() ? nullptr : &found->second);
  }
  instance.hidden_faces = std::any_of(shown.faces.begin(), shown.faces.end(), is_hidden);
  instance.visible = shown.faces.empty() ? !is_hidden(shown.whole)
                                         : !std::all_of(shown.faces.begin(), shown.faces.end(), is_hidden);
  highlights = std::any_of(looks.begin(), looks.end(), [](const InstanceLook& look) {
    return look.whole.highlight || std::any_of(look.faces.begin(), look.faces.end(), [](const auto& entry) {
             return entry.second.highlight.has_value();
           });
  });
  colors_changed = true;
}

std::vector<std::uint32_t> Scene::Impl::color_words() const {
  std::vector<std::uint32_t> words;
  words.reserve(faces.size());
  for (const FaceName& name : faces) words.push_back(instances[name.instance].colors.of(name.face));
  return words;
}

Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Scene::~Scene() = default;
Scene::Impl::~Impl() {
  for (const auto& layer : layers) layer->release(*this);
}
const SceneInfo& Scene::info() const {
  return impl_->info;
}
const Box3& Scene::box() const {
  return impl_->box;
}
FaceName Scene::face_name(std::uint32_t number) const {
  return impl_->faces[number - 1];
}

void Scene::set_visible(std::uint32_t instance, bool visible, std::uint32_t face) {
  impl_->look(instance, face).visible = visible;
  impl_->apply_look(instance);
}

void Scene::set_color(std::uint32_t instance, const std::optional<Color>& color, std::uint32_t face) {
  impl_->look(instance, face).color = color;
  impl_->apply_look(instance);
}

void Scene::set_highlight(std::uint32_t instance, const std::optional<Color>& color, std::uint32_t face) {
  impl_->look(instance, face).highlight = color;
  impl_->apply_look(instance);
}

void Scene::reset_looks() {
  for (std::uint32_t i = 0; i < impl_->looks.size(); ++i) {
    impl_->looks[i] = {};
    impl_->apply_look(i);
  }
}

void Scene::place(std::uint32_t instance, const Affine3& to_world) {
  dupin::place(to_world, impl_->instances[instance]);
  impl_->box = {};
  for (const SceneInstance& placed : impl_->instances)
    impl_->box.add(transform_box(placed.to_world, impl_->parts[placed.part].box));
}

}  // namespace dupin
