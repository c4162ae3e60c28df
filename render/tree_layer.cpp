#include "tree_layer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "../core/parallel.h"
#include "layer.h"
#include "occlusion.h"
#include "splat_raster.h"
#include "tree_lists.h"

namespace dupin {
namespace {

/// Placements are drawn in so many turns, each of which may hide those that follow.
constexpr std::size_t kBatches = 16;
/// Points that one task draws, and leaves.
constexpr std::size_t kPointTask = 4096, kLeafTask = 1024;

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
    begin_picture(pass);
    lists_.begin(pass, options_);
    stats_.raster_ms = 0;
    // Nearest first, so that what lies behind need not be looked at.
    const std::span<const std::size_t> order = lists_.order();
    const std::size_t step = std::max<std::size_t>(1, order.size() / kBatches);
    for (std::size_t i = 0; i < order.size(); i += step)
      if (Status status = add_trees(pass, order.subspan(i, std::min(step, order.size() - i))); !status.ok())
        return status;
    seen_.collect(raster_, lists_.point_count(), kMostLeafTriangles * lists_.leaf_count());
    lists_.gather(pass.scene, seen_);
    upload_lists();
    stats_.cut_ms = lists_.cut_ms;
    stats_.gather_ms = milliseconds_since(start) - stats_.cut_ms - stats_.raster_ms;
    stats_.points = lists_.point_count(), stats_.triangles = lists_.triangle_count();
    stats_.hidden = order.size() - lists_.drawn().size();
    stats_.visited = 0;
    for (const std::size_t i : lists_.drawn()) stats_.visited += lists_.placed()[i].cut.visited();
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

  Status add_trees(const LayerPass& pass, std::span<const std::size_t> candidates) {
    // Before anything has been drawn nothing can be hidden.
    const bool hiding = options_.occlusion && !lists_.drawn().empty();
    if (hiding) occlusion_.refresh(raster_);
    std::vector<std::size_t> batch;
    for (const std::size_t i : candidates)
      if (!hiding || !occlusion_.hides(lists_.placed()[i].extent)) batch.push_back(i);
    lists_.update(pass, batch, options_, hiding ? &occlusion_ : nullptr);
    if (Status status = check_sizes(pass); !status.ok()) return status;
    const auto start = std::chrono::steady_clock::now();
    rasterise(pass, batch);
    for (const std::size_t i : batch) occlusion_.mark(lists_.placed()[i].extent);
    stats_.raster_ms += milliseconds_since(start);
    return {};
  }

  Status check_sizes(const LayerPass& pass) const {
    const auto texels = static_cast<std::size_t>(pass.renderer.max_texels);
    const MeshArena& arena = lists_.arena();
    if (lists_.point_count() <= SplatRaster::kHole &&
        kMostLeafTriangles * lists_.leaf_count() <= SplatRaster::kTriangle &&
        std::max(arena.vertices().size(), arena.triangles().size()) <= texels)
      return {};
    return {StatusCode::limit,
            "more points and triangles in view than this OpenGL context's texture buffers can hold"};
  }

  void upload_lists() {
    const auto put = [](TexelBuffer& buffer, const auto& list) {
      buffer.reserve(list.size() * sizeof(list[0]), GL_STREAM_DRAW);
      if (!list.empty()) buffer.write(0, list.data(), list.size() * sizeof(list[0]));
    };
    put(points_buffer_, lists_.points()), put(extras_buffer_, lists_.extras());
    put(drawn_buffer_, lists_.triangles());
    std::vector<TreeRun> runs = lists_.point_runs();
    runs.insert(runs.end(), lists_.triangle_runs().begin(), lists_.triangle_runs().end());
    runs_buffer_.assign(runs.data(), runs.size() * sizeof(TreeRun), GL_STREAM_DRAW);
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
    projection.eye = p.view.eye;
    projection.foreshortened = options_.foreshortened;
    projection.flat = p.cut.tree().info().kind == PointTreeKind::qsplat;
    return projection;
  }

  void begin_picture(const LayerPass& pass) {
    raster_.begin(pass.view.width, pass.view.height);
    occlusion_.begin(pass.view.width, pass.view.height);
    sections_.clear();
    for (const DrawOptions::Section& section : pass.options.sections)
      sections_.push_back(section_terms(section, pass.view));
  }

  /// Some of a placement's lists.
  struct RasterTask {
    const PlacedTree* placed;
    bool triangles;
    std::vector<SplatList> lists;
  };

  /// Long lists in several tasks, short ones together in one.
  static void add_tasks(const PlacedTree& p, bool triangles, std::vector<RasterTask>& tasks) {
    const std::size_t first = triangles ? kMostLeafTriangles * p.first_leaf : p.first_point;
    const std::uint32_t numbers = triangles ? kMostLeafTriangles : 1;
    std::size_t room = 0;
    for (const SplatList& list : triangles ? p.leaves : p.points)
      for (std::size_t from = 0; from < list.items.size();) {
        if (room == 0) tasks.push_back({&p, triangles, {}}), room = triangles ? kLeafTask : kPointTask;
        const std::size_t count = std::min(room, list.items.size() - from);
        tasks.back().lists.push_back({list.items.subspan(from, count),
                                      static_cast<std::uint32_t>(first + list.first + numbers * from)});
        from += count, room -= count;
      }
  }

  void rasterise(const LayerPass& pass, std::span<const std::size_t> batch) {
    const Splatting splatting = options_.reconstruct ? Splatting::visibility : Splatting::simple;
    std::vector<RasterTask> tasks;
    for (const std::size_t i : batch)
      for (const bool triangles : {true, false}) add_tasks(lists_.placed()[i], triangles, tasks);
    parallel_for(tasks.size(), [&](std::size_t i) {
      const PlacedTree& p = *tasks[i].placed;
      const SplatProjection projection = this->projection(pass, p);
      if (tasks[i].triangles)
        add_triangles(projection, p, tasks[i].lists);
      else
        add_points(projection, p, tasks[i].lists, splatting);
    });
  }

  void add_points(const SplatProjection& projection, const PlacedTree& p, std::span<const SplatList> lists,
                  Splatting splatting) {
    const PointTree& tree = p.cut.tree();
    raster_.add_points(
        projection, lists,
        [&](std::span<const std::uint32_t> items, EncodedNode* nodes) { tree.copy_nodes(items, nodes); },
        splatting);
  }

  void add_triangles(const SplatProjection& projection, const PlacedTree& p,
                     std::span<const SplatList> lists) {
    const MeshArena& arena = lists_.arena();
    raster_.add_triangles(projection, arena.vertices(), arena.triangles(), lists,
                          [&](std::uint32_t rank) { return arena.triangles_of(p.tree, rank); });
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
  SeenNumbers seen_;
  Occlusion occlusion_;
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
