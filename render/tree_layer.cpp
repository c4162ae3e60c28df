#include "tree_layer.h"

#include <chrono>
#include <cmath>
#include <cstring>

#include "../core/parallel.h"
#include "layer.h"
#include "splat_raster.h"
#include "tree_lists.h"

namespace dupin {
namespace {

constexpr std::size_t kMostPoints = SplatRaster::kHole, kMostTriangles = SplatRaster::kTriangle;

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::array<double, 4> grid_row(const Plane3& plane, const PointGrid& grid, const Vec3& anchor) {
  return {plane.n.x * grid.step, plane.n.y * grid.step, plane.n.z * grid.step,
          dot(plane.n, grid.origin - anchor) + plane.d};
}

}  // namespace

class TreeLayers::Impl : public Layer {
 public:
  Impl(std::vector<PartTree> trees, const TreeLayerOptions& options)
      : trees_(std::move(trees)), options_(options) {}

  LayerPart part(std::size_t index) const override {
    LayerPart part;
    if (index >= trees_.size() || !trees_[index].tree) return part;
    const PointTree& tree = *trees_[index].tree;
    const PointTreeInfo& info = tree.info();
    part.box = drawn_box(info);
    part.anchor = part.box.center();
    part.primitives =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(info.nodes + info.triangles, 0xffffffffU));
    for (std::uint32_t face = 0; face < std::max<std::size_t>(1, tree.groups().size()); ++face)
      part.faces.push_back(trees_[index].first_face + face);
    return part;
  }

  std::size_t bytes() const override {
    std::size_t bytes = 0;
    for (const PartTree& t : trees_)
      if (t.tree) bytes += t.tree->byte_count();
    return bytes;
  }

  Status upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t layer) override {
    const Gl& gl = *renderer.gl;
    lists_ = TreeLists(gl, trees_, scene, layer);
    points_buffer_ = TexelBuffer(gl, GL_RGBA32UI), extras_buffer_ = TexelBuffer(gl, GL_RGBA32UI);
    drawn_buffer_ = TexelBuffer(gl, GL_RG32UI), runs_buffer_ = TexelBuffer(gl, GL_RGBA32UI);
    grids_buffer_ = TexelBuffer(gl, GL_RGBA32F);
    upload_grids(scene);
    picture_ = {};
    scene_ = &scene;
    return {};
  }

  void release(const Scene::Impl& scene) override {
    if (scene_ != &scene) return;  // another scene has them since
    lists_ = {};
    points_buffer_ = {}, extras_buffer_ = {}, drawn_buffer_ = {}, runs_buffer_ = {}, grids_buffer_ = {};
    picture_ = {};
    scene_ = nullptr;
  }

  Status find(const LayerPass& pass) override {
    const auto start = std::chrono::steady_clock::now();
    lists_.find(pass.scene, pass.view, pass.options.sections, options_);
    stats_.cut_ms = milliseconds_since(start);
    const auto cut_done = std::chrono::steady_clock::now();
    if (lists_.gather(pass.scene))
      if (Status status = upload_lists(pass); !status.ok()) return status;
    stats_.gather_ms = milliseconds_since(cut_done);
    const auto gather_done = std::chrono::steady_clock::now();
    rasterise(pass);
    stats_.raster_ms = milliseconds_since(gather_done);
    stats_.points = lists_.points().size(), stats_.triangles = lists_.triangles().size();
    stats_.visited = 0;
    for (const PlacedTree& p : lists_.placed()) stats_.visited += p.cut.visited();
    return damage();
  }

  Status draw(const LayerPass& pass) override { return draw_picture(pass); }

  std::uint32_t drawn() const override {
    return static_cast<std::uint32_t>(stats_.points + stats_.triangles);
  }

  LayerShading shading() const override {
    LayerShading shading;
    shading.key = "tree";
    if (options_.reconstruct) shading.defines.push_back("RECONSTRUCT");
    shading.surface = {"runs.glsl", "tree_node.glsl", "surface_tree.glsl"};
    shading.units = {
        {"points", kVerticesUnit}, {"point_extras", kIndicesUnit}, {"drawn_triangles", kTriangleFacesUnit},
        {"vertices", kLayerUnit},  {"triangles", kLayerUnit + 1},  {"grids", kLayerUnit + 2},
        {"colors", kHeapUnit}};
    return shading;
  }

  void bind(const LayerPass& pass, GLuint program) const override {
    const Gl& gl = *pass.renderer.gl;
    gl.Uniform1i(gl.GetUniformLocation(program, "point_runs"),
                 static_cast<GLint>(lists_.point_runs().size()));
    gl.Uniform1i(gl.GetUniformLocation(program, "run_count"),
                 static_cast<GLint>(lists_.point_runs().size() + lists_.triangle_runs().size()));
    gl.Uniform1i(gl.GetUniformLocation(program, "filter_radius"), filter_radius());
    points_buffer_.bind(kVerticesUnit);
    extras_buffer_.bind(kIndicesUnit);
    drawn_buffer_.bind(kTriangleFacesUnit);
    lists_.arena().vertex_buffer().bind(kLayerUnit);
    lists_.arena().triangle_buffer().bind(kLayerUnit + 1);
    grids_buffer_.bind(kLayerUnit + 2);
    runs_buffer_.bind(kRunsUnit);
    pass.scene.colors.bind(kHeapUnit);
  }

  const TreeLayerStats& stats() const { return stats_; }
  Status damage() const {
    for (const PartTree& t : trees_)
      if (t.tree)
        if (Status status = t.tree->damage(); !status.ok()) return status;
    return {};
  }

 private:
  int filter_radius() const { return std::max(1, static_cast<int>(std::ceil(0.5 * options_.threshold_px))); }

  /// Points are larger than what they stand for, by no more than the root's sphere.
  static Box3 drawn_box(const PointTreeInfo& info) {
    Box3 box = info.box;
    if (info.kind == PointTreeKind::qsplat) {
      const Vec3 margin = Vec3{1, 1, 1} * (1e-3 * box.diagonal() + info.grid.step);
      box.lo -= margin, box.hi += margin;
    }
    return box;
  }

  void upload_grids(const Scene::Impl& scene) {
    std::vector<float> grids(8 * scene.instances.size(), 0);
    for (const PlacedTree& p : lists_.placed()) {
      const PointTreeInfo& info = p.cut.tree().info();
      const Vec3 origin = info.grid.origin - scene.parts[p.tree].anchor;
      float* const grid = grids.data() + 8 * p.instance;
      for (int k = 0; k < 3; ++k) grid[k] = static_cast<float>(origin[k]);
      grid[3] = static_cast<float>(info.grid.step);
      const auto nodes = static_cast<std::uint32_t>(info.nodes);
      std::memcpy(grid + 4, &nodes, 4);
      grid[5] = info.colors ? 1 : 0;
    }
    grids_buffer_.assign(grids.data(), grids.size() * 4, GL_STATIC_DRAW);
  }

  Status upload_lists(const LayerPass& pass) {
    const auto texels = static_cast<std::size_t>(pass.renderer.max_texels);
    const MeshArena& arena = lists_.arena();
    if (lists_.points().size() > std::min<std::size_t>(SplatRaster::kHole, texels) ||
        lists_.triangles().size() > std::min<std::size_t>(SplatRaster::kTriangle, texels) ||
        std::max(arena.vertices().size(), arena.triangles().size()) > texels)
      return {StatusCode::limit,
              "more points and triangles in view than this OpenGL context's texture buffers can hold"};
    const auto put = [](TexelBuffer& buffer, const auto& list) {
      buffer.assign(list.data(), list.size() * sizeof(list[0]), GL_STREAM_DRAW);
    };
    put(points_buffer_, lists_.points());
    put(extras_buffer_, lists_.extras());
    put(drawn_buffer_, lists_.triangles());
    std::vector<TreeRun> runs = lists_.point_runs();
    runs.insert(runs.end(), lists_.triangle_runs().begin(), lists_.triangle_runs().end());
    put(runs_buffer_, runs);
    return {};
  }

  SplatProjection projection(const LayerPass& pass, const PlacedTree& p) const {
    const PointGrid& grid = p.cut.tree().info().grid;
    const Vec3& anchor = pass.scene.parts[p.tree].anchor;
    const DrawList& list = pass.renderer.draw_list();
    SplatProjection projection;
    projection.x = grid_row(p.camera.rows[0], grid, anchor),
    projection.y = grid_row(p.camera.rows[1], grid, anchor);
    projection.depth = grid_row(p.camera.depth, grid, anchor);
    projection.perspective = p.camera.perspective;
    projection.depth_terms = list.depth_terms;
    projection.nearest_depth = list.near_depth;
    projection.pixels_per_step = p.view.pixels_per_step;
    projection.depth_per_step = length(p.camera.depth.n) * grid.step;
    projection.sections = sections_;
    return projection;
  }

  void rasterise(const LayerPass& pass) {
    raster_.begin(pass.view.width, pass.view.height);
    sections_.clear();
    for (const DrawOptions::Section& section : pass.options.sections)
      sections_.push_back(section_terms(section, pass.view));
    const Splatting splatting = options_.reconstruct ? Splatting::visibility : Splatting::simple;
    const MeshArena& arena = lists_.arena();
    parallel_for(lists_.placed().size(), [&](std::size_t i) {
      const PlacedTree& p = lists_.placed()[i];
      if (p.points + p.triangles == 0) return;
      const SplatProjection projection = this->projection(pass, p);
      raster_.add_points(projection, std::span(lists_.points()).subspan(p.first_point, p.points),
                         static_cast<std::uint32_t>(p.first_point), splatting);
      raster_.add_triangles(projection, arena.vertices(), arena.triangles(),
                            std::span(lists_.triangle_indices()).subspan(p.first_triangle, p.triangles),
                            static_cast<std::uint32_t>(p.first_triangle));
    });
  }

  Status draw_picture(const LayerPass& pass) {
    const auto [first, last] = raster_.rows();
    if (first >= last) return {};
    const Gl& gl = *pass.renderer.gl;
    const auto name =
        layer_program(pass, "raster", {{"screen.vert"}, {"raster.frag"}, {}, {}, {{"splats", kLayerUnit}}});
    if (!name) return name.status();
    upload_picture(gl, first, last);
    for (std::size_t i = 0; i < sections_.size(); ++i) gl.Disable(static_cast<GLenum>(GL_CLIP_DISTANCE0 + i));
    gl.BindVertexArray(pass.renderer.empty_array().name());
    gl.Uniform1f(gl.GetUniformLocation(*name, "screen_depth"), 0.5F);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(0, first, raster_.width(), last - first);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.Disable(GL_SCISSOR_TEST);
    return {};
  }

  void upload_picture(const Gl& gl, int first, int last) {
    if (!picture_ || picture_width_ != raster_.width() || picture_height_ != raster_.height()) {
      picture_ = GlTexture(gl);
      picture_width_ = raster_.width(), picture_height_ = raster_.height();
      gl.ActiveTexture(GL_TEXTURE0 + kLayerUnit);
      gl.BindTexture(GL_TEXTURE_2D, picture_.name());
      gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32UI, picture_width_, picture_height_, 0, GL_RG_INTEGER,
                    GL_UNSIGNED_INT, nullptr);
      for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    }
    gl.ActiveTexture(GL_TEXTURE0 + kLayerUnit);
    gl.BindTexture(GL_TEXTURE_2D, picture_.name());
    const std::uint64_t* const from =
        raster_.pixels().data() + static_cast<std::size_t>(first) * static_cast<std::size_t>(raster_.width());
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, first, raster_.width(), last - first, GL_RG_INTEGER,
                     GL_UNSIGNED_INT, from);
  }

  std::vector<PartTree> trees_;
  TreeLayerOptions options_;
  TreeLayerStats stats_;
  const Scene::Impl* scene_ = nullptr;  ///< whose buffers these are
  TreeLists lists_;
  SplatRaster raster_;
  std::vector<std::array<double, 4>> sections_;  ///< this pass's
  TexelBuffer points_buffer_, extras_buffer_, drawn_buffer_, runs_buffer_, grids_buffer_;
  GlTexture picture_;
  int picture_width_ = 0, picture_height_ = 0;
};

TreeLayers::TreeLayers(std::vector<PartTree> trees, const TreeLayerOptions& options)
    : impl_(std::make_shared<Impl>(std::move(trees), options)) {}
TreeLayers::~TreeLayers() = default;
std::shared_ptr<Layer> TreeLayers::layer() const {
  return impl_;
}
TreeLayerStats TreeLayers::stats() const {
  return impl_->stats();
}
Status TreeLayers::damage() const {
  return impl_->damage();
}

}  // namespace dupin
