#include "layer.h"

#include "domain_layer.h"
#include "point_layer.h"

namespace dupin {

Result<std::vector<std::shared_ptr<Layer>>> make_layers(const Model& model, const SceneContent& content) {
  std::vector<std::shared_ptr<Layer>> layers = content.layers;
  if (content.points.scene) {
    if (content.points.scene->parts.size() != model.parts.size())
      return {StatusCode::invalid_argument,
              "the points are not those of this model: the numbers of parts differ"};
    layers.push_back(make_point_layer(content.points));
  }
  if (content.domains.scene) {
    if (content.domains.scene->parts.size() != model.parts.size())
      return {StatusCode::invalid_argument,
              "the domains are not those of this model: the numbers of parts differ"};
    layers.push_back(make_domain_layer(content.domains));
  }
  if (layers.size() > kMostLayers)
    return {StatusCode::limit, "a scene can have " + std::to_string(kMostLayers) + " layers"};
  return layers;
}

std::string layer_define(std::uint32_t layer) {
  return "LAYER " + std::to_string(3U << 30 | layer << kOwnBits) + 'u';
}

Result<GLuint> layer_program(const LayerPass& pass, const std::string& key, ProgramText text) {
  text.defines.push_back(layer_define(pass.layer));
  const auto name = pass.renderer.program(key + ' ' + text.defines.back(), text);
  if (name) pass.renderer.set_view(*name, pass.view);
  return name;
}

}  // namespace dupin
