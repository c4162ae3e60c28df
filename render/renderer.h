// Drawing models into pictures, in any current OpenGL 3.3 core context.
//
//   auto context = create_context(Device::automatic);           // or the host's own
//   auto renderer = Renderer::create((*context)->loader());
//   auto scene = (*renderer)->upload(model, &dps);
//   auto frame = (*renderer)->draw(**scene, camera, options);
//
// A Renderer and its Scenes belong to one context, which must be current whenever they are used or destroyed.
// Every call leaves the context's state as it found it. Nothing here is global: any number of contexts,
// renderers and threads (one a context) can coexist.
#ifndef DUPIN_RENDER_RENDERER_H
#define DUPIN_RENDER_RENDERER_H

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../core/camera.h"
#include "../core/status.h"
#include "../nurbs/model.h"
#include "../sampling/differential_point.h"
#include "../sampling/quadric_dp.h"
#include "../simplify/domain_primitives.h"
#include "context.h"

namespace dupin {

/// What the colours of a picture show.
enum class Shading {
  lit,     ///< the file's colours under a head, a key and a fill light; both sides of a surface alike
  normal,  ///< ½ + ½ n, in model space
  k1,
  k2,
  mean,
  gaussian,   ///< curvatures, blue below and red above zero
  zebra,      ///< reflected stripes: shows breaks of tangent and of curvature
  face,       ///< a colour a face
  primitive,  ///< a colour a primitive
};
inline constexpr std::string_view kShadingNames[] = {"lit",      "normal", "k1",   "k2",       "mean",
                                                     "gaussian", "zebra",  "face", "primitive"};

/// Pictures of numbers that a frame can hold besides its colours; bits of DrawOptions::outputs.
enum Output : unsigned {
  kColor = 1,
  kNormal = 2,       ///< unit, model space, outward
  kDepth = 4,        ///< along the view axis, in model units; +inf where nothing is drawn
  kPosition = 8,     ///< model space
  kCurvature = 16,   ///< k1, k2: |k1| >= |k2|, positive towards the outward normal
  kDirection = 32,   ///< of k1, unit, model space
  kFace = 64,        ///< 1-based, over the drawn face instances in the model's order; 0: background
  kPrimitive = 128,  ///< 1-based
  kUv = 256,         ///< the surface's parameters; NaN where nothing that has any is drawn. Needs exact_model
  kScreen = 512,     ///< the colors in 8 bits, for a PNG: sRGB, straight alpha; costs least
};

inline constexpr std::size_t kMostLights = 8;
inline constexpr std::size_t kMostSections = 6;

struct DrawOptions {
  unsigned outputs = kColor;
  Shading shading = Shading::lit;
  bool edges = true;  ///< draw feature edges
  double edge_width_px = 1.2;
  std::optional<Color> background = Color{1, 1, 1, 1};  ///< linear; none: transparent
  std::optional<Color> color;                           ///< instead of the file's colours
  int samples = 1;  ///< a pixel, for its colour; 1 … 256. The other outputs are those of the pixel's centre.
  /// Point lights in model space, in place of the built-in ones around the camera; at most kMostLights.
  struct Light {
    Vec3 position;
    Color color{1, 1, 1, 1};  ///< linear
  };
  std::vector<Light> lights;
  /// Cuts the model open: only points with normal·p + offset >= 0 are drawn, in model space, for each of at
  /// most kMostSections. Where one looks into a solid that is cut its colour is hatched; everything else says
  /// what is seen there of its inner side.
  struct Section {
    Vec3 normal;
    double offset = 0;
  };
  std::vector<Section> sections;
  double curvature_scale = 0;  ///< |curvature| that gets the full colour; 0: chosen from the scene's size
  /// The model that the scene was made from, for draw() and draw_only(). With it curvatures, as outputs and
  /// as colours, are the exact surface's at its point nearest to the drawn one. That is worked out on the
  /// CPU, in microseconds a pixel. Without it they are those of the quadric drawn, which are exact on planes,
  /// cylinders, cones and spheres and at the middle of other DPs, and 0 on triangles.
  const Model* exact_model = nullptr;
};

/// What one frame took.
struct FrameStats {
  std::uint32_t primitives = 0;  ///< drawn after culling (DP instances, or triangles)
  std::uint64_t covered_pixels = 0;
  /// Certified: the largest of what is drawn, in pixels where it is nearest; 0 for what promises nothing.
  double bound_px = 0;
  double milliseconds = 0;  ///< culling and drawing, until the GPU is done; not reading back
};

/// Row 0 is the top. Only what was asked for is there; vectors have 1, 2, 3 or 4 numbers a pixel, pixel after
/// pixel.
struct Frame {
  int width = 0, height = 0;
  double pixel_constant = 0, pixel_per_depth = 0;  ///< see Image
  std::vector<float> color;                        ///< R G B A, linear, premultiplied by A
  std::vector<std::uint8_t> screen;                ///< R G B A, sRGB, straight alpha
  std::vector<float> normal;                       ///< 3
  std::vector<float> depth;                        ///< 1
  std::vector<float> position;                     ///< 3
  std::vector<float> curvature;                    ///< 2
  std::vector<float> direction;                    ///< 3
  std::vector<std::uint32_t> face, primitive;
  std::vector<float> uv;  ///< 2
  FrameStats stats;
};

/// What a scene is made of.
struct SceneInfo {
  std::size_t primitives = 0;         ///< stored: DPs, or triangles; a part that is placed twice counts once
  std::size_t placed_primitives = 0;  ///< counting every placement
  std::size_t bytes = 0;              ///< uploaded for geometry
  std::size_t clips = 0;              ///< planes, lines, arcs and ellipses that bound the stored DPs
  std::size_t drawn_faces = 0;  ///< face instances; those out of the picture count, those left out do not
};

/// What a number of the face picture stands for.
struct FaceName {
  std::uint32_t instance = 0;  ///< of the model
  std::uint32_t face = 0;      ///< of its part: an exact one, or after those a group of its polygons
};

/// A model on the GPU. Destroy it with its context current; nothing else of it needs that.
class Scene {
 public:
  class Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  ~Scene();
  const SceneInfo& info() const;
  /// Of everything placed, in model space.
  const Box3& box() const;
  /// `number` is 1 … info().drawn_faces.
  FaceName face_name(std::uint32_t number) const;

  // How the model is shown, from the next frame on: as its file has it until something else is said. `face`
  // is an index in the part, or kWhole for all of the placement; what is said of a face goes before what is
  // said of the whole.
  static constexpr std::uint32_t kWhole = 0xffffffff;
  void set_visible(std::uint32_t instance, bool visible, std::uint32_t face = kWhole);
  /// None: the file's own.
  void set_color(std::uint32_t instance, const std::optional<Color>& color, std::uint32_t face = kWhole);
  /// Shown before every color, and through every kind of shading: a selection, or what the pointer is on.
  void set_highlight(std::uint32_t instance, const std::optional<Color>& color, std::uint32_t face = kWhole);
  /// Everything visible, colored and placed as at first.
  void reset_looks();
  /// Moves a placement; it may turn, shift, mirror and scale, but not flatten.
  void place(std::uint32_t instance, const Affine3& to_world);
  Impl& impl() { return *impl_; }
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// How a host draws: its camera, and the part of its framebuffer that it draws into. The host's current draw
/// framebuffer, depth function, depth range and clip-control convention are used as they are.
struct HostView {
  std::array<double, 16> view, projection;  ///< column-major, as OpenGL's
  std::array<int, 4> viewport;              ///< x, y, width, height
};

class Layer;

/// How differential points are drawn (Kalaiah & Varshney 2001, 2003).
enum class PointPrimitive {
  differential_point,  ///< the flat rectangle in the tangent plane, with the point's normal field
  square,     ///< parallel to the picture, as wide as the point's ball has a radius (sampling/ball_radius.h)
  rectangle,  ///< around the ball's disc in the tangent plane, as seen along the view axis
  ellipse,    ///< the disc as seen along the view axis
};
struct PointContent {
  const PointScene* scene = nullptr;  ///< one entry a part of the model
  PointPrimitive primitive = PointPrimitive::differential_point;
  /// Differential points as published: normals from 256 maps over λv/λu, light vectors linear over each
  /// rectangle. Else both are computed for each pixel: normals by eq. 10 (2003).
  bool published = true;
};

/// How domains that overlap become one surface.
enum class DomainBlend {
  surface,    ///< all that a pixel's place belongs to, weighted with Ψ, at the place itself
  published,  ///< flat rectangles front to back, blended with their neighbors, then locked (figure 10)
  opaque,     ///< none: the nearest hides the others
};

/// Domain primitives (simplify/domain_primitives.h).
struct DomainContent {
  const DomainScene* scene = nullptr;  ///< one entry a part of the model
  DomainBlend blend = DomainBlend::surface;
  bool normal_maps = true;  ///< else each domain has the normal of its plane
  bool heights = true;      ///< else each is flat
  double tolerance_px =
      0.5;  ///< of a part's levels the coarsest is drawn whose errors and texels are smaller
};

/// What a scene is drawn from, beside its model: one entry a kind of representation.
struct SceneContent {
  /// One entry a part of the model.
  const DpScene* dps = nullptr;
  /// Further kinds, made with what stands in render/layer.h.
  std::vector<std::shared_ptr<Layer>> layers;
  PointContent points;
  DomainContent domains;
};

class Renderer {
 public:
  class Impl;
  /// Compiles what every frame needs in the current context; no_device where that is older than OpenGL 3.3
  /// core.
  static Result<std::unique_ptr<Renderer>> create(const GetProcAddress& get_proc_address);
  ~Renderer();

  /// Parts that none of `content` has are drawn by their meshes: those without faces, and every part if there
  /// are no DPs. What `content` points to is not needed afterwards.
  Result<std::unique_ptr<Scene>> upload(const Model& model, const SceneContent& content);
  /// Of DPs alone; null: of meshes.
  Result<std::unique_ptr<Scene>> upload(const Model& model, const DpScene* dps) {
    return upload(model, SceneContent{dps, {}});
  }

  /// Draws into framebuffers of its own and reads back what was asked for.
  Result<Frame> draw(Scene& scene, const Camera& camera, const DrawOptions& options);

  /// Draws without reading anything back; for timing. The picture is gone with the next call.
  Result<FrameStats> draw_only(Scene& scene, const Camera& camera, const DrawOptions& options);

  /// Draws into the framebuffer that is bound for drawing, against and into its depth buffer. `stats`, if
  /// any, has no covered pixels, and the time until the GPU has its orders.
  Status draw_into_host(Scene& scene, const HostView& host, const DrawOptions& options,
                        FrameStats* stats = nullptr);

  /// Does a part of what the first such frame takes time for: builds programs, and has the driver compile
  /// them by drawing into pictures of its own, until that took about `milliseconds` (one program at least).
  /// True: nothing is left to build.
  Result<bool> build_for(Scene& scene, const HostView& host, const DrawOptions& options, double milliseconds);

  /// What draw_into_host would draw in a rectangle (x, y, width, height) of the viewport, in pixels from its
  /// lower left corner: for picking. The host's framebuffer is neither looked at nor touched.
  Result<Frame> read_host_view(Scene& scene, const HostView& host, const std::array<int, 4>& rectangle,
                               const DrawOptions& options);

  /// GL_RENDERER and GL_VERSION of the context.
  std::string gl_renderer() const;
  std::string gl_version() const;

 private:
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dupin

#endif
