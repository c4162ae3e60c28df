// A model as the GPU holds it: geometry once a part, and what culling needs to know on the CPU.
#ifndef DUPIN_RENDER_SCENE_H
#define DUPIN_RENDER_SCENE_H

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "dp_bounds.h"
#include "gl_objects.h"
#include "gpu_encode.h"
#include "renderer.h"

namespace dupin {

struct ScenePart {
  Vec3 anchor;
  Box3 box;  ///< of what is drawn, in the part's space
  bool closed = false;
  std::vector<DpBounds> dps;
  std::uint32_t drawn_faces = 0;
  std::uint32_t first_triangle = 0, triangles = 0;
  std::uint32_t primitives = 0;               ///< of all kinds
  Box3 layer_box;                             ///< of what layers have of it
  std::vector<std::uint32_t> first_in_layer;  ///< per layer: primitives of this part before the layer's
  std::vector<std::uint32_t> face_numbers;    ///< per face of the part: its number among the drawn ones
};

/// A color's word is sRGB of 8 bits each, r lowest; the highest byte says more of the face.
inline constexpr std::uint32_t kPlainColor = 0xff000000, kHighlightColor = 0xfe000000,
                               kSolidColor = 0xfd000000, kHiddenColor = 0;
constexpr bool is_hidden(std::uint32_t color) {
  return color >> 24 == 0;
}
constexpr bool is_highlighted(std::uint32_t color) {
  return color >> 24 == 0xfe;
}

struct FaceColors {
  std::uint32_t whole = kPlainColor;  ///< of faces that have none of their own
  std::vector<std::uint32_t> faces;   ///< per face of the part; empty: all `whole`
  std::uint32_t of(std::size_t face) const { return faces.empty() ? whole : faces[face]; }
};

struct SceneInstance {
  std::uint32_t part = 0;
  Affine3 to_world, to_part;
  std::uint32_t first_face = 0;       ///< drawn face instances before it
  std::uint32_t first_primitive = 0;  ///< primitives before it
  FaceColors colors;                  ///< as they are shown
  FaceColors file_colors;
  bool visible = true;        ///< any of it is; what is not is not drawn, and that holds for layers too
  bool hidden_faces = false;  ///< some are
  double scale_ratio = 1;     ///< largest over smallest scale
};

/// What a host asked to be shown differently.
struct Look {
  std::optional<bool> visible;
  std::optional<Color> color, highlight;
};
struct InstanceLook {
  Look whole;
  std::map<std::uint32_t, Look> faces;
};

class Layer;

class Scene::Impl {
 public:
  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  std::shared_ptr<const Gl> gl;  ///< outlives the buffers below
  std::vector<ScenePart> parts;
  std::vector<SceneInstance> instances;
  std::vector<FaceName> faces;      ///< index 0 is number 1
  std::vector<InstanceLook> looks;  ///< per instance; empty: none asks for anything
  bool highlights = false;          ///< any
  Box3 box;
  SceneInfo info;
  TexelBuffer heap;                     ///< the DPs' records (RGBA32UI)
  TexelBuffer vertices;                 ///< 6 floats each, as RG32F
  TexelBuffer indices;                  ///< R32UI, also the element array
  TexelBuffer triangle_faces;           ///< R32UI: the drawn face's number in its part
  mutable TexelBuffer colors;           ///< R32UI: of every drawn face instance; for triangles and layers
  mutable bool colors_changed = false;  ///< since they were uploaded
  GlVertexArray mesh_array;
  std::vector<std::shared_ptr<Layer>> layers;  ///< lose their own buffers before `gl` goes

  Look& look(std::uint32_t instance, std::uint32_t face);
  /// After a change of the instance's look.
  void apply_look(std::uint32_t instance);
  /// Of every drawn face instance.
  std::vector<std::uint32_t> color_words() const;
};

void place(const Affine3& to_world, SceneInstance& instance);

/// What does not need a context: everything of the Impl but its buffers, with the bytes to put into them; its
/// layers are there already.
struct ScenePackage {
  std::vector<Texel> heap;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices, triangle_faces;
};
Status pack_scene(const Model& model, const DpScene* dps, Scene::Impl& scene, ScenePackage& package);

}  // namespace dupin

#endif
