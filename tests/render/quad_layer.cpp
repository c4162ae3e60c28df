#include "quad_layer.h"

namespace dupin::testing {
namespace {

constexpr const char* kVertex = R"GLSL(
uniform samplerBuffer quads;
uniform int instance, first_quad;
uniform uint first_number;
flat out uint number;
vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }
void main() {
  const int corners[6] = int[6](0, 1, 2, 0, 2, 3);
  int quad = gl_VertexID / 6, corner = corners[gl_VertexID % 6];
  number = first_number + uint(quad);
  int at = (first_quad + quad) * 3;
  vec3 p = texelFetch(quads, at).xyz + (corner == 1 || corner == 2 ? 1.0 : -1.0) * texelFetch(quads, at + 1).xyz +
           (corner >= 2 ? 1.0 : -1.0) * texelFetch(quads, at + 2).xyz;
  vec3 r = (p - instance_texel(0)) - instance_texel(1);
  gl_Position = to_clip(vec2(dot(instance_texel(5), r), dot(instance_texel(6), r)), start_depth + dot(instance_texel(7), r));
}
)GLSL";

constexpr const char* kFragment = R"GLSL(
flat in uint number;
layout(location = 0) out uint out_id;
void main() { out_id = LAYER | number; }
)GLSL";

constexpr const char* kSurface = R"GLSL(
uniform samplerBuffer quads;
uniform usamplerBuffer colors;
Surface surface_at(uint number, vec2 at) {
  uvec4 run = run_of(own_number(number));
  uint quad = run.z + own_number(number) - run.x;
  vec4 center = texelFetch(quads, int(quad) * 3), u = texelFetch(quads, int(quad) * 3 + 1), v = texelFetch(quads, int(quad) * 3 + 2);
  Placed placed = placed_at(int(run.y), at);
  vec3 n = cross(u.xyz, v.xyz), to_center = (center.xyz - placed.hi) - placed.lo - placed.origin;
  float t = dot(n, to_center) / dot(n, placed.direction);
  Surface result;
  result.normal = normalize(placed.to_view * n);
  result.depth = start_depth + t;
  result.direction = normalize(placed.to_view * u.xyz);
  result.curvature = vec2(u.w, v.w);
  result.face = placed.first_face + uint(center.w) + 1u;
  result.primitive = run.w + quad - run.z + 1u;
  result.color = texelFetch(colors, int(result.face) - 1).x;
  result.edge = 0.0;
  return result;
}
)GLSL";

class QuadLayer : public Layer {
 public:
  explicit QuadLayer(std::vector<Quad> quads) : quads_(std::move(quads)) {}

  LayerPart part(std::size_t index) const override {
    LayerPart part;
    for (const Quad& quad : quads_) {
      if (quad.part != index) continue;
      ++part.primitives;
      part.faces.push_back(quad.face);
      for (const double s : {-1.0, 1.0})
        for (const double t : {-1.0, 1.0}) part.box.add(quad.center + quad.u * s + quad.v * t);
    }
    part.anchor = part.box.center();
    return part;
  }
  std::size_t bytes() const override { return quads_.size() * 48; }

  Status upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t) override {
    std::vector<float> texels;
    const auto add = [&](const Vec3& p, double w) {
      for (const double x : {p.x, p.y, p.z, w}) texels.push_back(static_cast<float>(x));
    };
    for (const Quad& quad : quads_) {
      const ScenePart& part = scene.parts[quad.part];
      add(quad.center - part.anchor, part.face_numbers[quad.face]);
      add(quad.u, quad.k1);
      add(quad.v, quad.k2);
    }
    texels_ = TexelBuffer(*renderer.gl, GL_RGBA32F);
    texels_.assign(texels.data(), texels.size() * 4, GL_STATIC_DRAW);
    runs_ = TexelBuffer(*renderer.gl, GL_RGBA32UI);
    return {};
  }

  Status find(const LayerPass& pass) override {
    std::vector<std::uint32_t> texels;
    run_list_.clear();
    drawn_ = 0;
    for (std::uint32_t i = 0; i < pass.scene.instances.size(); ++i) {
      const SceneInstance& instance = pass.scene.instances[i];
      if (!instance.visible) continue;
      const auto first =
          std::find_if(quads_.begin(), quads_.end(), [&](const Quad& q) { return q.part == instance.part; });
      const auto count =
          std::count_if(quads_.begin(), quads_.end(), [&](const Quad& q) { return q.part == instance.part; });
      if (count == 0) continue;
      const std::uint32_t primitive =
          instance.first_primitive + pass.scene.parts[instance.part].first_in_layer[pass.layer];
      run_list_.push_back({i, static_cast<std::uint32_t>(first - quads_.begin()),
                           static_cast<std::uint32_t>(count), primitive});
      texels.insert(texels.end(), {drawn_, i, run_list_.back().first_triangle, primitive});
      drawn_ += static_cast<std::uint32_t>(count);
    }
    runs_.assign(texels.data(), texels.size() * 4, GL_STREAM_DRAW);
    return {};
  }

  Status draw(const LayerPass& pass) override {
    const Gl& gl = *pass.renderer.gl;
    const auto name =
        layer_program(pass, "quads", {{"proxy.glsl", kVertex}, {kFragment}, {}, {}, {{"quads", kLayerUnit}}});
    if (!name) return name.status();
    texels_.bind(kLayerUnit);
    gl.BindVertexArray(pass.renderer.empty_array().name());
    std::uint32_t first = 0;
    for (const TriangleRun& run : run_list_) {
      gl.Uniform1i(gl.GetUniformLocation(*name, "instance"), static_cast<GLint>(run.instance));
      gl.Uniform1i(gl.GetUniformLocation(*name, "first_quad"), static_cast<GLint>(run.first_triangle));
      gl.Uniform1ui(gl.GetUniformLocation(*name, "first_number"), first);
      gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * run.triangles));
      first += run.triangles;
    }
    // As a layer that draws into a picture of its own would leave things.
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.DepthFunc(GL_NEVER);
    gl.DepthMask(GL_FALSE);
    gl.Viewport(0, 0, 1, 1);
    return {};
  }

  std::uint32_t drawn() const override { return drawn_; }
  LayerShading shading() const override {
    return {"quads", {"runs.glsl", kSurface}, {}, {{"quads", kLayerUnit}, {"colors", kHeapUnit}}};
  }
  void bind(const LayerPass& pass, GLuint program) const override {
    const Gl& gl = *pass.renderer.gl;
    gl.Uniform1i(gl.GetUniformLocation(program, "run_count"), static_cast<GLint>(run_list_.size()));
    texels_.bind(kLayerUnit);
    runs_.bind(kRunsUnit);
    pass.scene.colors.bind(kHeapUnit);
  }

 private:
  std::vector<Quad> quads_;
  std::vector<TriangleRun> run_list_;
  TexelBuffer texels_, runs_;
  std::uint32_t drawn_ = 0;
};

}  // namespace

std::shared_ptr<Layer> make_quad_layer(std::vector<Quad> quads) {
  return std::make_shared<QuadLayer>(std::move(quads));
}

}  // namespace dupin::testing
