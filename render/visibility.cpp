// The first half of a frame: which primitive is seen at every pixel.
#include "layer.h"

namespace dupin {
namespace {

constexpr std::size_t kSlotBytes = 12 * 16;
constexpr std::size_t kMostSlots = (1U << 24) - 1;  // the id picture has 24 bits for them
constexpr const char* kSlotOutputs[] = {"slot0", "slot1", "slot2", "slot3", "slot4",  "slot5",
                                        "slot6", "slot7", "slot8", "slot9", "slot10", "slot11"};

/// What a program draws besides the ids: colors, of that kind of shading (none: -1).
struct Extras {
  int shading = -1;
  void add_to(ProgramText& text) const {
    if (shading < 0) return;
    text.defines.push_back("AT_ONCE");
    text.defines.push_back("SHADING " + std::to_string(shading));
    for (auto* files : {&text.vertex, &text.fragment})
      files->insert(files->begin(), {"looks.glsl", "at_once.glsl"});
  }
  std::string key(std::string_view what) const {
    return std::string(what) + (shading < 0 ? "" : " at once " + std::to_string(shading));
  }
};

ProgramText tile_program(std::uint32_t kind) {
  ProgramText text;
  const bool curved = kind & kCurvedTile;
  const std::pair<std::uint32_t, const char*> names[] = {{kPlanesTile, "PLANES"}, {kConicTile, "CONIC"},
                                                         {kPiecesTile, "PIECES"}, {kEdgesTile, "EDGES"},
                                                         {kPrismTile, "PRISM"},   {kOneRootTile, "ONE_ROOT"}};
  for (const auto& [bit, define] : names)
    if (kind & bit) text.defines.push_back(define);
  text.defines.push_back("TILE_TEXELS " + std::to_string(tile_texels(kind)));
  if (kind & kFlatTile) {
    const FlatPieces& flat = kFlatPieces[((kind & kFlatTile) >> kFlatShift) - 1];
    text.defines.push_back("FLAT_LINES " + std::to_string(flat.lines));
    text.defines.push_back("FLAT_ARCS " + std::to_string(flat.arcs));
  }
  if ((kind & kPiecesTile) && !(kind & kFlatTile))
    for (const char* pieces : {"LINES", "ARCS", "ELLIPSES"}) text.defines.push_back(pieces);
  text.vertex = {"proxy.glsl", "tile.glsl", curved ? "curved.vert" : "planar.vert"};
  if (curved) text.fragment.push_back("quadric.glsl");
  text.fragment.push_back("pieces.glsl");
  text.fragment.push_back(curved ? "curved.frag" : "planar.frag");
  return text;
}

}  // namespace

void Renderer::Impl::upload_list(const Scene::Impl& scene) {
  instances_.assign(list_.instances.data(), list_.instances.size() * sizeof(InstanceTexels), GL_STREAM_DRAW);
  instances_.bind(kInstancesUnit);
  scene.heap.bind(kHeapUnit);
  if (!list_.items.empty()) {
    gl->BindBuffer(GL_ARRAY_BUFFER, items_.name());
    gl->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list_.items.size() * sizeof(DrawItem)),
                   list_.items.data(), GL_STREAM_DRAW);
  }
  tiles_.assign(list_.tiles.data(), list_.tiles.size() * sizeof(Texel), GL_STREAM_DRAW);
  tiles_.bind(kTilesUnit);
  std::vector<std::uint32_t> runs;
  std::uint32_t first = 0;
  for (const TriangleRun& run : list_.runs) {
    runs.insert(runs.end(), {first, run.instance, run.first_triangle, run.first_primitive});
    first += run.triangles;
  }
  if (!runs.empty()) runs_.assign(runs.data(), runs.size() * 4, GL_STREAM_DRAW);
}

Status Renderer::Impl::fill_slots() {
  const std::size_t count = list_.items.size();
  if (count == 0) return {};
  if (count > kMostSlots || count * 12 > static_cast<std::size_t>(max_texels))
    return {StatusCode::limit, "more primitives in view than this OpenGL context's texture buffers can hold"};
  // Fresh storage every pass: a driver that rasterises later (llvmpipe) may still be reading the last pass's
  // slots.
  slots_.assign(nullptr, count * kSlotBytes, GL_STREAM_COPY);
  ProgramText text{{"prepare.vert"}, {}, {}, {}, {}};
  text.feedback.assign(std::begin(kSlotOutputs), std::end(kSlotOutputs));
  const auto prepare = program("prepare", text);
  if (!prepare) return prepare.status();
  gl->Uniform1f(gl->GetUniformLocation(*prepare, "spread"), view_spread_);
  gl->Uniform1f(gl->GetUniformLocation(*prepare, "start_depth"), static_cast<float>(list_.start_depth));
  // Even what rasterises nothing needs a complete framebuffer, which a context without a surface lacks.
  gl->BindFramebuffer(GL_FRAMEBUFFER, visibility_framebuffer_.name());
  gl->BindVertexArray(item_array_.name());
  gl->Enable(GL_RASTERIZER_DISCARD);
  gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, slots_.buffer());
  gl->BeginTransformFeedback(GL_POINTS);
  gl->DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
  gl->EndTransformFeedback();
  gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  gl->Disable(GL_RASTERIZER_DISCARD);
  slots_.bind(kSlotsUnit);
  return {};
}

void Renderer::Impl::grow_indices(std::uint32_t dps) {
  if (dps <= indexed_dps_) return;
  dps = std::max(dps, indexed_dps_ * 2);
  constexpr std::uint32_t kQuad[] = {0, 1, 2, 0, 2, 3};
  // Corners 0–3 at z lo and 4–7 at z hi; counter-clockwise from outside.
  constexpr std::uint32_t kPrism[] = {0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                      1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  std::vector<std::uint32_t> quads, prisms;
  for (std::uint32_t i = 0; i < dps; ++i) {
    for (const std::uint32_t k : kQuad) quads.push_back(4 * i + k);
    for (const std::uint32_t k : kPrism) prisms.push_back(8 * i + k);
  }
  const auto fill = [&](const GlVertexArray& array, const GlBuffer& buffer,
                        const std::vector<std::uint32_t>& indices) {
    gl->BindVertexArray(array.name());
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.name());
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * 4), indices.data(),
                   GL_STATIC_DRAW);
  };
  fill(quad_array_, quads_, quads);
  fill(prism_array_, prisms_, prisms);
  indexed_dps_ = dps;
}

Status Renderer::Impl::draw_dps(const Pass& pass) {
  for (const DrawGroup& group : list_.groups) {
    const Extras extras{pass.at_once ? static_cast<int>(pass.options->shading) : -1};
    const std::string key = extras.key("tile " + std::to_string(group.kind));
    ProgramText text = tile_program(group.kind);
    extras.add_to(text);
    const auto name = program(key, text);
    if (!name) return name.status();
    set_view(*name, pass.view);
    set_looks(*name, pass);
    gl->Uniform1f(gl->GetUniformLocation(*name, "edge_half_width"),
                  static_cast<float>(pass.options->edge_width_px / 2));
    gl->Uniform1i(gl->GetUniformLocation(*name, "first"), static_cast<GLint>(group.first));
    grow_indices(group.count);
    gl->Uniform1i(gl->GetUniformLocation(*name, "first_edge"), static_cast<GLint>(list_.first_edge));
    const bool prism = group.kind & kPrismTile;
    gl->BindVertexArray(prism ? prism_array_.name() : quad_array_.name());
    if (prism) gl->Enable(GL_CULL_FACE);
    gl->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(group.count * (prism ? 36 : 6)), GL_UNSIGNED_INT,
                     nullptr);
    gl->Disable(GL_CULL_FACE);
  }
  return {};
}

Status Renderer::Impl::draw_triangles(const Pass& pass) {
  GLuint program = 0, first = 0;
  gl->BindVertexArray(pass.scene->mesh_array.name());
  for (const TriangleRun& run : list_.runs) {
    const Status status = use_triangle_program(pass, run, program);
    if (!status.ok()) return status;
    const auto uniform = [&](const char* n) { return gl->GetUniformLocation(program, n); };
    gl->Uniform1i(uniform("instance"), static_cast<GLint>(run.instance));
    gl->Uniform1ui(uniform("first_number"), first);
    gl->Uniform1i(uniform("first_triangle"), static_cast<GLint>(run.first_triangle));
    gl->Uniform1i(uniform("first_face"), static_cast<GLint>(run.first_face));
    gl->Uniform1ui(uniform("first_primitive"), run.first_primitive);
    const bool own = !pass.options->color || is_highlighted(run.color);
    const Color color = own ? linear_color(run.color) : *pass.options->color;
    gl->Uniform3f(uniform("run_color"), color.r, color.g, color.b);
    gl->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * run.triangles), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(std::size_t{12} * run.first_triangle));
    first += run.triangles;
  }
  return {};
}

/// Colors by face cost every pixel a search for its own; most parts have one color.
Status Renderer::Impl::use_triangle_program(const Pass& pass, const TriangleRun& run, GLuint& name) {
  const bool numbers = pass.options->shading == Shading::face || pass.options->shading == Shading::primitive;
  const bool own_colors =
      pass.at_once && ((run.own_colors && (!pass.options->color || pass.scene->highlights)) || numbers);
  const Extras extras{pass.at_once ? static_cast<int>(pass.options->shading) : -1};
  ProgramText text{{"proxy.glsl", "triangle.vert"}, {"triangle.frag"}, {}, {}, {{"colors", kHeapUnit}}};
  extras.add_to(text);
  if (own_colors) text.defines.push_back("OWN_COLORS");
  if (run.hidden_faces) text.defines.push_back("HIDDEN_FACES");
  const auto built = program(extras.key(std::string("triangles") + (own_colors ? " of own colors" : "") +
                                        (run.hidden_faces ? " some hidden" : "")),
                             text);
  if (!built) return built.status();
  if (*built == name) return {};
  name = *built;
  set_view(name, pass.view);
  set_looks(name, pass);
  if (own_colors || run.hidden_faces) {
    pass.scene->triangle_faces.bind(kTriangleFacesUnit);
    pass.scene->colors.bind(kHeapUnit);
  }
  return {};
}

/// Colors, too, where they are drawn at once; null: not any more.
void Renderer::Impl::attach_colors(const GlTexture* colors) {
  gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, colors ? colors->name() : 0,
                           0);
  constexpr GLenum kBuffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl->DrawBuffers(colors ? 2 : 1, kBuffers);
  (colors ? gl->Enable : gl->Disable)(GL_FRAMEBUFFER_SRGB);
}

void Renderer::Impl::bind_visibility() {
  gl->BindFramebuffer(GL_FRAMEBUFFER, visibility_framebuffer_.name());
  gl->Viewport(0, 0, width_, height_);
  gl->Enable(GL_DEPTH_TEST);
  gl->DepthMask(GL_TRUE);
  gl->DepthFunc(GL_GREATER);
  gl->FrontFace(GL_CW);  // the picture's rows run downwards
  gl->CullFace(GL_FRONT);
  if (gl->ClipControl) gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  for (std::size_t i = 0; i < sections_.size(); ++i) gl->Enable(static_cast<GLenum>(GL_CLIP_DISTANCE0 + i));
}

Status Renderer::Impl::each_layer(const Pass& pass,
                                  const std::function<Status(Layer&, const LayerPass&)>& what) {
  Status status;
  for (std::uint32_t i = 0; i < pass.scene->layers.size() && status.ok(); ++i)
    status = what(*pass.scene->layers[i], {*this, *pass.scene, pass.view, *pass.options, i});
  return status;
}

FrameStats Renderer::Impl::stats(const Scene::Impl& scene) const {
  FrameStats stats;
  stats.primitives = list_.primitives();
  for (const auto& layer : scene.layers) stats.primitives += layer->drawn();
  stats.bound_px = list_.bound_px;
  return stats;
}

Status Renderer::Impl::draw_visibility(const Pass& pass) {
  bind_visibility();
  if (pass.at_once) attach_colors(pass.at_once);
  const GLuint nothing[4] = {0, 0, 0, 0};
  const GLfloat farthest = 0;
  gl->ClearBufferuiv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &farthest);
  if (pass.at_once) {
    const Color under = premultiplied_background(*pass.options);
    const GLfloat color[4] = {under.r, under.g, under.b, under.a};
    gl->ClearBufferfv(GL_COLOR, 1, color);
  }
  Status status = draw_dps(pass);
  if (status.ok()) status = draw_triangles(pass);
  if (pass.at_once) attach_colors(nullptr);
  if (!status.ok()) return status;
  status = each_layer(pass, [&](Layer& layer, const LayerPass& own) {
    bind_visibility();
    return layer.draw(own);
  });
  for (std::size_t i = 0; i < sections_.size(); ++i) gl->Disable(static_cast<GLenum>(GL_CLIP_DISTANCE0 + i));
  return status;
}

Status Renderer::Impl::run(const Pass& pass) {
  if (pass.scene->colors_changed && pass.scene->colors.bytes() > 0) {
    const std::vector<std::uint32_t> words = pass.scene->color_words();
    pass.scene->colors.assign(words.data(), words.size() * 4, GL_STATIC_DRAW);
  }
  pass.scene->colors_changed = false;
  sections_ = pass.options->sections;
  build_draw_list(
      *pass.scene, pass.view, sections_,
      {pass.view.width, pass.view.height, flats_, pass.edges(), pass.options->edge_width_px / 2 + 0.5},
      list_);
  view_spread_ = pass.view.perspective ? 1.0F : 0.0F;
  upload_list(*pass.scene);
  Status status = each_layer(pass, [](Layer& layer, const LayerPass& own) { return layer.find(own); });
  if (status.ok()) status = fill_slots();
  if (status.ok()) status = draw_visibility(pass);
  if (status.ok() && pass.pictures) status = shade(pass);
  return status;
}

}  // namespace dupin
