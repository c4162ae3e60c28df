// Layers: what a scene draws besides quadric DPs and triangles. A layer takes part in both halves of a frame:
// it draws proxies that put its numbers into the id picture and its depth into the depth buffer, and a shader
// of its own turns a number and a pixel into a `Surface`, so that every output, kind of shading and number of
// samples works for it.
//
// A scene has up to kMostLayers of them. In the id picture a layer's things are LAYER | own number, where
// LAYER stands for the two top bits and three bits for the layer, defined in each of its programs, and the
// own number, of kOwnBits bits, means to the layer what it likes in that pass.
#ifndef DUPIN_RENDER_LAYER_H
#define DUPIN_RENDER_LAYER_H

#include <memory>
#include <string>
#include <vector>

#include "gl_objects.h"
#include "renderer_impl.h"

namespace dupin {

inline constexpr std::size_t kMostLayers = 8;
inline constexpr int kOwnBits = 27;

/// What a layer has of one part.
struct LayerPart {
  Box3 box;                      ///< of what is drawn, in the part's space; empty: nothing of this part
  Vec3 anchor;                   ///< the point that the layer would like its floats to be relative to
  std::uint32_t primitives = 0;  ///< numbered 1 … primitives in each placement, after what else it has
  std::vector<std::uint32_t>
      faces;  ///< indices of the part's faces that are drawn; 0 for a part without faces
};

/// What a layer is given for a pass: one picture at one sample a pixel.
struct LayerPass {
  Renderer::Impl& renderer;  ///< gl, draw_list() (this pass's), program(), bind_visibility(), …
  const Scene::Impl& scene;
  const ViewRays& view;
  const DrawOptions& options;
  std::uint32_t layer = 0;  ///< the layer's place in the scene
};

/// The layer's half of a shading program. The file (or text) has
///     Surface surface_at(uint number, vec2 at)
/// with `number` as in the id picture; layer.glsl, which comes before it, has what it needs for that.
struct LayerShading {
  std::string key;                   ///< tells this program from others
  std::vector<std::string> surface;  ///< files of shaders/, or texts
  std::vector<std::string> defines;
  /// Samplers and their units: any but kIdsUnit, kInstancesUnit, kCurvaturesUnit and kScratchUnit.
  std::vector<std::pair<const char*, int>> units;
};

class Layer {
 public:
  virtual ~Layer() = default;

  /// Called once a part, before upload.
  virtual LayerPart part(std::size_t index) const = 0;
  /// Bytes that upload puts on the GPU for geometry.
  virtual std::size_t bytes() const = 0;
  /// Makes the layer's buffers in the current context. Floats are relative to scene.parts[i].anchor; the
  /// first primitive of a placement is SceneInstance::first_primitive + ScenePart::first_in_layer[layer], and
  /// the number of a face ScenePart::face_numbers[face].
  virtual Status upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t layer) = 0;
  /// The scene goes, in its current context, and `scene.gl` with it: drops what upload made for this scene.
  /// Only a layer that somebody besides the scene can hold has anything to do: the others go now.
  virtual void release(const Scene::Impl&) {}

  /// Chooses what this pass draws, on the CPU, and uploads what the choice needs: nothing of placements that
  /// are not visible.
  virtual Status find(const LayerPass& pass) = 0;
  /// Draws it (to_clip() cuts it by the sections). Ids and depth are bound, the depth test keeps what is
  /// nearer; nothing is culled or blended. What of that the layer changes (it may draw into pictures of its
  /// own too) is put back for the next layer, but for capabilities that it enables besides.
  virtual Status draw(const LayerPass& pass) = 0;
  /// Primitives that the last find() chose, in all placements.
  virtual std::uint32_t drawn() const = 0;

  virtual LayerShading shading() const = 0;
  /// Binds what the shading program reads and sets its own uniforms; the program is in use.
  virtual void bind(const LayerPass& pass, GLuint program) const = 0;
};

/// The layers of what `content` holds besides DPs; limit if they are more than kMostLayers.
Result<std::vector<std::shared_ptr<Layer>>> make_layers(const Model& model, const SceneContent& content);

/// A program of the layer's own, in use, with LAYER defined and the camera's uniforms set. Vertex shaders
/// include proxy.glsl for to_clip(); what they put out as an id is LAYER | own number.
Result<GLuint> layer_program(const LayerPass& pass, const std::string& key, ProgramText text);

/// "LAYER 0x…u"
std::string layer_define(std::uint32_t layer);

}  // namespace dupin

#endif
