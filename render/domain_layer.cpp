#include "domain_layer.h"

#include "domain_painter.h"
#include "domain_records.h"
#include "part_camera.h"

namespace dupin {
namespace {

constexpr int kDomainsUnit = kLayerUnit, kNeighborsUnit = kLayerUnit + 1, kPsiUnit = kLayerUnit + 2,
              kNormalsUnit = kLayerUnit + 3, kFacesUnit = kIndicesUnit, kColorsUnit = kHeapUnit;

class DomainLayer : public Layer {
 public:
  explicit DomainLayer(const DomainContent& content) : scene_(content.scene), content_(content) {
    for (const auto& levels : scene_->parts)
      for (const DomainSet& set : levels) {
        primitives_ += set.primitives.size();
        texels_ += set.atlas.psi.size();
        neighbors_ += set.neighbors.size();
        colors_ = colors_ || !set.atlas.color.empty();
        faces_ = faces_ || !set.atlas.face.empty();
      }
  }

  LayerPart part(std::size_t index) const override;
  std::size_t bytes() const override {
    return primitives_ * kDomainTexels * 16 + neighbors_ * 4 +
           texels_ * (4 + (colors_ ? 4 : 1) + (faces_ ? 2 : 0));
  }
  Status upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t layer) override;
  Status find(const LayerPass& pass) override;
  Status draw(const LayerPass& pass) override;
  std::uint32_t drawn() const override { return drawn_; }
  LayerShading shading() const override;
  void bind(const LayerPass& pass, GLuint program) const override;

 private:
  bool published() const { return content_.blend == DomainBlend::published; }
  void set_pixels(const LayerPass& pass, GLuint program) const;
  Result<GLuint> use_program(const LayerPass& pass, std::string what, const ProgramText& text);
  Status paint(const LayerPass& pass);
  void bind_textures(const LayerPass& pass) const;
  std::vector<std::string> defines() const;
  std::vector<std::pair<const char*, int>> units() const {
    return {{"domains", kDomainsUnit},        {"domain_neighbors", kNeighborsUnit}, {"psi_picture", kPsiUnit},
            {"normal_picture", kNormalsUnit}, {"face_picture", kFacesUnit},         {"colors", kColorsUnit}};
  }
  const PlacedSet& choose(const LayerPass& pass, const SceneInstance& instance,
                          const PartCamera& camera) const;

  const DomainScene* scene_;  // until upload
  DomainContent content_;
  std::size_t primitives_ = 0, texels_ = 0, neighbors_ = 0;
  bool colors_ = false, faces_ = false;
  DomainPackage package_;  // without records and pictures
  DomainPainter painter_;
  TexelBuffer domains_buffer_, neighbors_buffer_, runs_;
  GlTexture psi_, normals_, face_;
  std::uint32_t width_ = 1, height_ = 1;
  std::uint32_t drawn_ = 0, runs_count_ = 0;
};

/// The finest level's primitives are numbered; coarser ones, being fewer, use the first of those numbers.
LayerPart DomainLayer::part(std::size_t index) const {
  LayerPart part;
  std::vector<std::uint32_t> faces;
  for (const DomainSet& set : scene_->parts[index]) {
    for (const DomainPrimitive& p : set.primitives)
      for (int i = 0; i < 8; ++i)
        part.box.add(p.center + p.u * (i & 1 ? p.half_u : -p.half_u) + p.v * (i & 2 ? p.half_v : -p.half_v) +
                     p.n() * (i & 4 ? p.hi : p.lo));
    faces.insert(faces.end(), set.faces.begin(), set.faces.end());
    part.primitives = std::max(part.primitives, static_cast<std::uint32_t>(set.primitives.size()));
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  part.faces = std::move(faces);
  part.anchor = part.box.empty() ? Vec3{} : part.box.center();
  return part;
}

template <class T>
GlTexture picture(const Gl& gl, std::uint32_t width, std::uint32_t height, GLint internal, GLenum format,
                  GLenum type, GLint filter, const std::vector<T>& texels) {
  GlTexture texture(gl);
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, internal, static_cast<GLsizei>(width), static_cast<GLsizei>(height), 0,
                format, type, texels.data());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

Status DomainLayer::upload(Renderer::Impl& renderer, const Scene::Impl& scene, std::uint32_t) {
  const Gl& gl = *renderer.gl;
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  DomainPackage package;
  const Status packed = pack_domains(*scene_, scene, static_cast<std::uint32_t>(most),
                                     static_cast<std::size_t>(renderer.max_texels), package);
  if (!packed.ok()) return packed;
  const DomainPictures& p = package.pictures;
  width_ = p.width;
  height_ = p.height;
  domains_buffer_ = TexelBuffer(gl, GL_RGBA32F);
  domains_buffer_.assign(package.records.data(), package.records.size() * 4, GL_STATIC_DRAW);
  neighbors_buffer_ = TexelBuffer(gl, GL_R32UI);
  neighbors_buffer_.assign(package.neighbors.data(), package.neighbors.size() * 4, GL_STATIC_DRAW);
  runs_ = TexelBuffer(gl, GL_RGBA32UI);
  psi_ = colors_ ? picture(gl, width_, height_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR, p.color_psi)
                 : picture(gl, width_, height_, GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR, p.psi);
  normals_ = picture(gl, width_, height_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR, p.normal_height);
  if (faces_)
    face_ = picture(gl, width_, height_, GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT, GL_NEAREST, p.face);
  package_ = std::move(package);
  package_.pictures = {};
  package_.records = {};
  scene_ = nullptr;
  return {};
}

/// The coarsest level whose detail is below the tolerance where the part is nearest; else the finest.
const PlacedSet& DomainLayer::choose(const LayerPass& pass, const SceneInstance& instance,
                                     const PartCamera& camera) const {
  const std::vector<PlacedSet>& levels = package_.sets[instance.part];
  const ScenePart& part = pass.scene.parts[instance.part];
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = part.layer_box.corner(i) - part.anchor;
    nearest = std::min(nearest, dot(camera.depth.n, corner) + camera.depth.d);
  }
  if (!(nearest > 0) && pass.view.perspective) return levels.back();
  const double scale = std::cbrt(std::abs(determinant(instance.to_world.linear)));
  const double pixel = pixel_size(pass.view, pass.view.perspective ? nearest : 1) / scale;
  for (const PlacedSet& set : levels)
    if (set.detail <= content_.tolerance_px * pixel) return set;
  return levels.back();
}

Status DomainLayer::find(const LayerPass& pass) {
  drawn_ = runs_count_ = 0;
  painter_.clear();
  std::vector<std::uint32_t> texels;
  const SidePlanes sides = side_planes(pass.view, pass.options.sections);
  for (std::uint32_t i = 0; i < pass.scene.instances.size(); ++i) {
    const SceneInstance& instance = pass.scene.instances[i];
    const ScenePart& part = pass.scene.parts[instance.part];
    if (package_.sets[instance.part].empty() || !instance.visible) continue;
    const PartCamera camera = part_camera(instance, part, pass.view, sides);
    if (out_of_view(camera, part.layer_box, part.anchor)) continue;
    const PlacedSet& set = choose(pass, instance, camera);
    if (set.count == 0) continue;
    if (set.count > (1U << kOwnBits) / 36 - drawn_)
      return {StatusCode::limit, "more domains in view than a picture has numbers for"};
    texels.insert(texels.end(),
                  {drawn_, i, set.first, instance.first_primitive + part.first_in_layer[pass.layer]});
    if (published())
      painter_.add(package_, set, i, drawn_, camera,
                   std::cbrt(std::abs(determinant(instance.to_world.linear))));
    drawn_ += set.count;
    ++runs_count_;
  }
  runs_.assign(texels.data(), texels.size() * 4, GL_STREAM_DRAW);
  return {};
}

std::vector<std::string> DomainLayer::defines() const {
  std::vector<std::string> defines;
  if (content_.heights && !published()) defines.push_back("HEIGHTS");
  if (content_.normal_maps) defines.push_back("NORMAL_MAPS");
  if (colors_) defines.push_back("TEXTURE_COLORS");
  if (faces_) defines.push_back("TEXTURE_FACES");
  if (content_.blend == DomainBlend::opaque) defines.push_back("OPAQUE");
  return defines;
}

void DomainLayer::bind_textures(const LayerPass& pass) const {
  const Gl& gl = *pass.renderer.gl;
  domains_buffer_.bind(kDomainsUnit);
  neighbors_buffer_.bind(kNeighborsUnit);
  runs_.bind(kRunsUnit);
  for (const auto& [unit, texture] :
       {std::pair{kPsiUnit, &psi_}, {kNormalsUnit, &normals_}, {kFacesUnit, &face_}}) {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(GL_TEXTURE_2D, texture->name());
  }
}

/// The program that `what` and its defines tell from others, in use, with all that it reads.
Result<GLuint> DomainLayer::use_program(const LayerPass& pass, std::string what, const ProgramText& text) {
  for (const std::string& d : text.defines) what += ' ' + d;
  const auto name = layer_program(pass, what, text);
  if (!name) return name;
  bind_textures(pass);
  set_pixels(pass, *name);
  pass.renderer.gl->BindVertexArray(pass.renderer.empty_array().name());
  return name;
}

/// Figure 10.
Status DomainLayer::paint(const LayerPass& pass) {
  ProgramText text{{"proxy.glsl", "domain_plane.vert"},
                   {"placed.glsl", "domain.glsl", "domain_plane.frag"},
                   defines(),
                   {},
                   units()};
  text.units.emplace_back("order", kNeighborsUnit);
  const auto name = use_program(pass, "domain planes", text);
  if (!name) return name.status();
  return painter_.draw(pass, *name, kNeighborsUnit);
}

void DomainLayer::set_pixels(const LayerPass& pass, GLuint program) const {
  const Gl& gl = *pass.renderer.gl;
  const auto uniform = [&](const char* name) { return gl.GetUniformLocation(program, name); };
  gl.Uniform1i(uniform("run_count"), static_cast<GLint>(runs_count_));
  gl.Uniform2f(uniform("pixel"), 2.0F / static_cast<float>(pass.view.width),
               2.0F / static_cast<float>(pass.view.height));
  gl.Uniform2f(uniform("atlas_texel"), 1.0F / static_cast<float>(width_), 1.0F / static_cast<float>(height_));
}

Status DomainLayer::draw(const LayerPass& pass) {
  if (drawn_ == 0) return {};
  if (published()) return paint(pass);
  const Gl& gl = *pass.renderer.gl;
  ProgramText text{{"runs.glsl", "proxy.glsl", "domain.vert"},
                   {"runs.glsl", "placed.glsl", "domain.glsl", "domain.frag"},
                   defines(),
                   {},
                   units()};
  const auto name = use_program(pass, "domains", text);
  if (!name) return name.status();
  gl.Enable(GL_CULL_FACE);
  gl.CullFace(GL_BACK);  // the far sides of the boxes: they are there with the eye inside, too
  gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(36 * drawn_));
  gl.CullFace(GL_FRONT);
  gl.Disable(GL_CULL_FACE);
  return {};
}

LayerShading DomainLayer::shading() const {
  LayerShading shading;
  shading.key = "domains";
  shading.defines = defines();
  for (const std::string& d : shading.defines) shading.key += ' ' + d;
  shading.surface = {"runs.glsl", "domain.glsl", published() ? "surface_prefix.glsl" : "surface_domain.glsl"};
  shading.units = units();
  if (published()) {
    shading.key += " prefixes";
    shading.units.emplace_back("prefix_normal", kNeighborsUnit);
    shading.units.emplace_back("prefix_color", kNormalsUnit);
  }
  return shading;
}

void DomainLayer::bind(const LayerPass& pass, GLuint program) const {
  const Gl& gl = *pass.renderer.gl;
  bind_textures(pass);
  if (published()) painter_.bind(gl, kNeighborsUnit, kNormalsUnit);
  pass.scene.colors.bind(kColorsUnit);
  gl.Uniform1i(gl.GetUniformLocation(program, "run_count"), static_cast<GLint>(runs_count_));
  gl.Uniform2f(gl.GetUniformLocation(program, "atlas_texel"), 1.0F / static_cast<float>(width_),
               1.0F / static_cast<float>(height_));
}

}  // namespace

std::shared_ptr<Layer> make_domain_layer(const DomainContent& content) {
  return std::make_shared<DomainLayer>(content);
}

}  // namespace dupin
