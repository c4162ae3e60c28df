#include "point_layer.h"

#include <bit>
#include <limits>

#include "../core/parallel.h"
#include "../sampling/ball_radius.h"
#include "normal_maps.h"
#include "part_camera.h"

namespace dupin {
namespace {

/// Ellipses write depths this part of their radius behind themselves, and show whatever is in front of those
/// last (QSplat's offset): neighbours that cross do not hide each other in turn.
constexpr float kEllipsePush = 0.25F;

constexpr int kPointsUnit = kLayerUnit, kTextureUnit = kLayerUnit + 1, kColorsUnit = kHeapUnit;

/// A placement's points that a pass draws.
struct PointRun {
  std::uint32_t instance, first, count;
};

class PointLayer : public Layer {
 public:
  explicit PointLayer(const PointContent& content) : scene_(*content.scene), primitive_(content.primitive) {
    const bool dp = primitive_ == PointPrimitive::differential_point;
    splat_ = dp ? -1 : static_cast<int>(primitive_) - 1;
    published_ = dp ? content.published : true;
    first_.push_back(0);
    for (const PartPoints& part : scene_.parts)
      first_.push_back(first_.back() + static_cast<std::uint32_t>(part.points.size()));
    if (dp) return;
    radii_.resize(scene_.parts.size());
    for (std::size_t i = 0; i < radii_.size(); ++i) radii_[i] = ball_radii(scene_.parts[i]);
  }

  LayerPart part(std::size_t index) const override;
  std::size_t bytes() const override {
    return first_.back() * (splat_ < 0 ? kRecordBytes + kCornerBytes : kSplatBytes);
  }
  Status upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t layer) override;
  Status find(const LayerPass& pass) override;
  Status draw(const LayerPass& pass) override;
  std::uint32_t drawn() const override { return drawn_; }
  LayerShading shading() const override;
  void bind(const LayerPass& pass, GLuint program) const override;

 private:
  static constexpr std::size_t kRecordBytes = 48, kCornerBytes = 48, kSplatBytes = 32;

  void fill_part(std::size_t index, const ScenePart& part, float* records, float* corners) const;
  Status draw_runs(const LayerPass& pass, float push) const;
  ProgramText visibility_text() const;

  const PointScene& scene_;  // until upload
  PointPrimitive primitive_;
  int splat_ = -1;
  bool published_ = true;
  std::vector<std::uint32_t> first_;  ///< point of each part, and their number
  std::vector<std::vector<float>> radii_;
  TexelBuffer points_, runs_;
  GlBuffer corners_, indices_;
  GlVertexArray array_;
  GlTexture texture_;
  std::vector<PointRun> run_list_;
  std::uint32_t drawn_ = 0;
};

LayerPart PointLayer::part(std::size_t index) const {
  LayerPart part;
  const std::vector<DifferentialPoint>& points = scene_.parts[index].points;
  std::vector<bool> faces;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DifferentialPoint& p = points[i];
    // A splat may lie in any plane.
    const double r = splat_ < 0 ? 0 : radii_[index][i] * std::sqrt(2.0);
    const auto half = [&](int k) {
      return splat_ < 0 ? std::abs(p.u[k]) * p.half_u + std::abs(p.v[k]) * p.half_v : r;
    };
    const Vec3 reach{half(0), half(1), half(2)};
    part.box.add(p.position - reach);
    part.box.add(p.position + reach);
    if (p.face >= faces.size()) faces.resize(p.face + 1, false);
    faces[p.face] = true;
  }
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    if (faces[f]) part.faces.push_back(f);
  part.anchor = part.box.empty() ? Vec3{} : part.box.center();
  part.primitives = static_cast<std::uint32_t>(points.size());
  return part;
}

void PointLayer::fill_part(std::size_t index, const ScenePart& part, float* records, float* corners) const {
  const std::vector<DifferentialPoint>& points = scene_.parts[index].points;
  const auto put = [](float*& at, const Vec3& v, float w) {
    for (int k = 0; k < 3; ++k) *at++ = static_cast<float>(v[k]);
    *at++ = w;
  };
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        const DifferentialPoint& p = points[i];
        const Vec3 center = p.position - part.anchor;
        const auto face = std::bit_cast<float>(part.face_numbers[p.face]);
        float* at = records + (first_[index] + i) * (splat_ < 0 ? 12 : 8);
        if (splat_ >= 0) {
          put(at, center, radii_[index][i]);
          put(at, p.n(), face);
          return;
        }
        put(at, center, face);
        put(at, p.u, static_cast<float>(p.lambda_u));
        put(at, p.v, static_cast<float>(p.lambda_v));
        float* corner = corners + (first_[index] + i) * 12;
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
          const Vec3 c = center + p.u * (x * p.half_u) + p.v * (y * p.half_v);
          for (int k = 0; k < 3; ++k) *corner++ = static_cast<float>(c[k]);
        }
      },
      4096);
}

Status PointLayer::upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t) {
  const Gl& gl = *renderer.gl;
  const std::size_t count = first_.back(), record = splat_ < 0 ? 12 : 8;
  if (count * record / 4 > static_cast<std::size_t>(renderer.max_texels))
    return {StatusCode::limit, "the points are more than this OpenGL context's texture buffers can hold"};
  std::vector<float> records(count * record), corners(splat_ < 0 ? count * 12 : 0);
  std::uint32_t most = 0;
  for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
    fill_part(i, scene.parts[i], records.data(), corners.data());
    most = std::max(most, first_[i + 1] - first_[i]);
  }
  points_ = TexelBuffer(gl, GL_RGBA32F);
  points_.assign(records.data(), records.size() * 4, GL_STATIC_DRAW);
  runs_ = TexelBuffer(gl, GL_RGBA32UI);
  array_ = GlVertexArray(gl);
  gl.BindVertexArray(array_.name());
  if (splat_ < 0) {
    corners_ = GlBuffer(gl);
    gl.BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * 4), corners.data(),
                  GL_STATIC_DRAW);
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 12, nullptr);
  }
  std::vector<std::uint32_t> quads;
  quads.reserve(std::size_t{most} * 6);
  for (std::uint32_t i = 0; i < most; ++i)
    for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) quads.push_back(4 * i + k);
  indices_ = GlBuffer(gl);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(quads.size() * 4), quads.data(),
                GL_STATIC_DRAW);
  if (splat_ < 0 && published_) texture_ = make_normal_maps(gl);
  if (primitive_ == PointPrimitive::ellipse) texture_ = make_ellipses(gl);
  radii_ = {};
  return {};
}

Status PointLayer::find(const LayerPass& pass) {
  run_list_.clear();
  drawn_ = 0;
  std::vector<std::uint32_t> texels;
  const SidePlanes sides = side_planes(pass.view, pass.options.sections);
  for (std::uint32_t i = 0; i < pass.scene.instances.size(); ++i) {
    const SceneInstance& instance = pass.scene.instances[i];
    const ScenePart& part = pass.scene.parts[instance.part];
    const std::uint32_t first = first_[instance.part], count = first_[instance.part + 1] - first;
    if (count == 0 || !instance.visible ||
        out_of_view(part_camera(instance, part, pass.view, sides), part.layer_box, part.anchor))
      continue;
    if (count > (1U << kOwnBits) - drawn_)
      return {StatusCode::limit, "more points in view than a picture has numbers for"};
    texels.insert(texels.end(),
                  {drawn_, i, first, instance.first_primitive + part.first_in_layer[pass.layer]});
    run_list_.push_back({i, first, count});
    drawn_ += count;
  }
  runs_.assign(texels.data(), texels.size() * 4, GL_STREAM_DRAW);
  return {};
}

ProgramText PointLayer::visibility_text() const {
  ProgramText text{
      {"proxy.glsl", splat_ < 0 ? "point_dp.vert" : "point_splat.vert"}, {"point.frag"}, {}, {}, {}};
  text.defines.push_back("SPLAT " + std::to_string(splat_));
  text.units = {{"points", kPointsUnit}, {"ellipses", kTextureUnit}};
  return text;
}

Status PointLayer::draw_runs(const LayerPass& pass, float push) const {
  const Gl& gl = *pass.renderer.gl;
  const auto name = layer_program(pass, "points " + std::to_string(splat_), visibility_text());
  if (!name) return name.status();
  const auto uniform = [&](const char* n) { return gl.GetUniformLocation(*name, n); };
  gl.Uniform1f(uniform("push"), push);
  std::uint32_t number = 0;
  for (const PointRun& run : run_list_) {
    const Mat3& placement = pass.scene.instances[run.instance].to_world.linear;
    gl.Uniform1i(uniform("instance"), static_cast<GLint>(run.instance));
    gl.Uniform1ui(uniform("first_number"), number - run.first);  // gl_VertexID counts all parts' points
    gl.Uniform1f(uniform("radius_scale"), static_cast<float>(std::cbrt(std::abs(determinant(placement)))));
    gl.DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(6 * run.count), GL_UNSIGNED_INT, nullptr,
                              static_cast<GLint>(4 * run.first));
    number += run.count;
  }
  return {};
}

Status PointLayer::draw(const LayerPass& pass) {
  const Gl& gl = *pass.renderer.gl;
  points_.bind(kPointsUnit);
  gl.ActiveTexture(GL_TEXTURE0 + kTextureUnit);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
  gl.BindVertexArray(array_.name());
  if (primitive_ != PointPrimitive::ellipse) return draw_runs(pass, 0);
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  Status status = draw_runs(pass, kEllipsePush);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.DepthMask(GL_FALSE);
  if (status.ok()) status = draw_runs(pass, 0);
  gl.DepthMask(GL_TRUE);
  return status;
}

LayerShading PointLayer::shading() const {
  LayerShading shading;
  shading.key = "points";
  shading.surface = {"runs.glsl", "curvatures.glsl", "surface_point.glsl"};
  shading.defines.push_back("SPLAT " + std::to_string(splat_));
  if (splat_ < 0 && published_) shading.defines.push_back("NORMAL_MAPS");
  if (published_) shading.defines.push_back("OWN_VECTORS");
  shading.units = {{"points", kPointsUnit}, {"normal_maps", kTextureUnit}, {"colors", kColorsUnit}};
  return shading;
}

void PointLayer::bind(const LayerPass& pass, GLuint program) const {
  const Gl& gl = *pass.renderer.gl;
  gl.Uniform1i(gl.GetUniformLocation(program, "run_count"), static_cast<GLint>(run_list_.size()));
  gl.Uniform1f(gl.GetUniformLocation(program, "pixel_size"), static_cast<float>(pixel_size(pass.view, 1)));
  points_.bind(kPointsUnit);
  runs_.bind(kRunsUnit);
  pass.scene.colors.bind(kColorsUnit);
  gl.ActiveTexture(GL_TEXTURE0 + kTextureUnit);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
}

}  // namespace

std::shared_ptr<Layer> make_point_layer(const PointContent& content) {
  return std::make_shared<PointLayer>(content);
}

}  // namespace dupin
