#include "layer.h"

namespace dupin {

std::vector<std::shared_ptr<Layer>> make_layers(const Model&, const SceneContent& content) {
  return content.layers;
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
