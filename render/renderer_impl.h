// The renderer's programs, buffers and pictures, and the passes of a frame.
#ifndef DUPIN_RENDER_RENDERER_IMPL_H
#define DUPIN_RENDER_RENDERER_IMPL_H

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "draw_list.h"
#include "gl_objects.h"
#include "renderer.h"
#include "scene.h"
#include "view_rays.h"

namespace dupin {

class GlStateGuard;
class Layer;
struct LayerPass;
struct Variant;  // of a shading program

/// What is out of range in a caller's options.
Status check(const DrawOptions& options);
Status check(const DrawOptions& options, const Scene::Impl& scene);

/// Texture units; every program that has a sampler of one of these names reads it there.
enum Unit {
  kHeapUnit,
  kInstancesUnit,
  kSlotsUnit,
  kIdsUnit,
  kVerticesUnit,
  kIndicesUnit,
  kTriangleFacesUnit,
  kRunsUnit,
  kLayerUnit,  ///< the first of four for layers
  kCurvaturesUnit = kLayerUnit + 4,
  kTilesUnit = kVerticesUnit  // not in one program
};

/// What the shading pass writes, a picture each.
enum Picture {
  kScreenPicture,  ///< 8 bits, sRGB
  kColorPicture,   ///< float; the samples' sum
  kNormalDepthPicture,
  kCurvaturePicture,
  kDirectionPicture,
  kNumbersPicture,
  kPictures
};
/// The pictures that the outputs asked for are read from, as bits 1 << Picture.
unsigned pictures_for(unsigned outputs);

/// Colors of curvatures of the exact surface.
bool wants_exact_colors(const DrawOptions& options);

Color premultiplied_background(const DrawOptions& options);
/// sRGB, 8 bits each, r lowest; and back.
std::uint32_t srgb_word(const Color& color);
Color linear_color(std::uint32_t word);

class Renderer::Impl {
 public:
  std::shared_ptr<const Gl> gl;
  std::string gl_renderer, gl_version;
  GLint max_texels = 0, max_picture = 0;

  Status init(const GetProcAddress& get_proc_address);

  /// One picture's worth of work, at one sample a pixel: ids and depth, then the pictures of `pictures`.
  struct Pass {
    const Scene::Impl* scene = nullptr;
    ViewRays view;
    const DrawOptions* options = nullptr;
    unsigned pictures = 0;
    int samples = 1;    ///< > 1: the color picture holds this many passes' sum
    bool first = true;  ///< of them
    /// Where colors of DPs and triangles are drawn together with their ids: the screen picture, or, with
    /// several samples, sample_. Null: nowhere.
    const GlTexture* at_once = nullptr;
    bool color() const { return pictures & (1U << kColorPicture | 1U << kScreenPicture); }
    bool edges() const { return options->edges && color(); }
    bool exact_colors() const { return color() && wants_exact_colors(*options); }
  };
  /// Makes room for pictures of this size; ids and depth always.
  Status prepare_targets(int width, int height, unsigned pictures, GLenum color_format);
  void prepare_sample(int width, int height);
  Status run(const Pass& pass);
  Status draw_samples(const Scene::Impl& scene, const ViewRays& view, const DrawOptions& options);
  Status draw_samples_within(double milliseconds, const Scene::Impl& scene, const ViewRays& view,
                             const DrawOptions& options);
  /// From the color picture, a sum of samples, to the screen picture.
  Status resolve(const ViewRays& view, int samples);
  /// Puts what the last draw_samples drew into the host's framebuffer.
  Status composite(const HostView& host, const ViewRays& view, const Box3& box, const DrawOptions& options,
                   const GlStateGuard& state);
  /// What the last draw_samples drew.
  void read_frame(const Scene::Impl& scene, const ViewRays& view, const DrawOptions& options, Frame& frame);

  const GlTexture& picture(Picture picture) const { return pictures_[picture]; }
  GLuint shading_framebuffer() const { return shading_framebuffer_.name(); }
  const GlTexture& ids() const { return ids_; }
  const GlTexture& depth() const { return depth_; }
  const DrawList& draw_list() const { return list_; }
  /// Reads a picture of the last pass, row 0 first.
  void read(Picture picture, GLenum format, GLenum type, void* pixels);
  void read_ids(std::uint32_t* pixels);

  /// The program of that key, built by `text` the first time; left in use. `cancelled` where build_for has
  /// had its time.
  Result<GLuint> program(const std::string& key, const ProgramText& text);
  Status may_build();
  /// Sets the uniforms that describe the camera, whichever of them the program in use has.
  void set_view(GLuint program, const ViewRays& view) const;
  const GlVertexArray& empty_array() const { return empty_array_; }
  /// Ids and depth, and the state that drawing into them starts from.
  void bind_visibility();
  /// What the last pass drew.
  FrameStats stats(const Scene::Impl& scene) const;
  /// Exchanges the pictures that frames are drawn into with the other set of them.
  void swap_targets();

 private:
  void upload_list(const Scene::Impl& scene);
  Status fill_slots();
  Status draw_visibility(const Pass& pass);
  Status draw_dps(const Pass& pass);
  Status draw_triangles(const Pass& pass);
  Status use_triangle_program(const Pass& pass, const TriangleRun& run, GLuint& name);
  void attach_colors(const GlTexture* colors);
  Status add_sample(const Pass& pass);
  Status find_exact_curvatures(const Pass& pass);
  void read_numbers(std::vector<float>& depth, std::vector<std::uint32_t>& numbers);
  /// Sets the uniforms that describe what colors show.
  void set_looks(GLuint program, const Pass& pass) const;
  /// What of the scene's layers is done in this pass.
  Status each_layer(const Pass& pass, const std::function<Status(Layer&, const LayerPass&)>& what);
  Status shade(const Pass& pass);
  Status bind_shading_framebuffer(unsigned pictures);
  void clear_pictures(const Pass& pass);
  Status shade_dps(const Pass& pass);
  Status shade_triangles(const Pass& pass);
  Status shade_layer(const Pass& pass, Layer& layer, const LayerPass& of_layer);
  Status use_shading_program(const Pass& pass, const Variant& variant, GLuint& name);
  void cover_bands(GLuint name);
  void grow_indices(std::uint32_t dps);

  std::map<std::string, GlProgram> programs_;
  /// While build_for draws: how long it may go on from the first program that it builds, and when that ends.
  std::optional<std::chrono::duration<double, std::milli>> build_time_;
  std::optional<std::chrono::steady_clock::time_point> build_until_;
  DrawList list_;
  std::vector<DrawOptions::Section> sections_;  ///< this pass's
  bool at_once_ = false;                        ///< vertex shaders may hand on what colors at once need
  bool flats_ = false;                          ///< vertex shaders may hand on as much as kFlatPieces need
  TexelBuffer instances_, slots_, runs_, tiles_;
  GlBuffer items_, quads_, prisms_;
  GlVertexArray item_array_, quad_array_, prism_array_, empty_array_;
  std::uint32_t indexed_dps_ = 0;
  int width_ = 0, height_ = 0;
  float view_spread_ = 1;
  GlTexture ids_, depth_, sample_, curvatures_;
  GLenum color_format_ = 0;
  std::array<GlTexture, kPictures> pictures_;
  GlFramebuffer visibility_framebuffer_, shading_framebuffer_;
  /// The other set: see swap_targets.
  struct Targets {
    int width = 0, height = 0;
    GlTexture ids, depth, sample, curvatures;
    GLenum color_format = 0;
    std::array<GlTexture, kPictures> pictures;
    GlFramebuffer visibility_framebuffer;
  } other_;
};

}  // namespace dupin

#endif
