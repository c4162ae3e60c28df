#include "host_state.h"

#include <GL/glcorearb.h>

#include <array>
#include <cstring>

namespace dupin::testing {
namespace {

template <class F>
F function(const Context& context, const char* name) {
  void* address = context.proc_address(name);
  F result = nullptr;
  std::memcpy(&result, &address, sizeof(address));
  return result;
}
#define GL_FUNCTION(type, name) const auto name = function<PFNGL##type##PROC>(context, "gl" #name)

struct Named {
  const char* name;
  GLenum value;
  int count = 1;
};
#define NAMED(value, ...)        \
  Named {                        \
#value, value, ##__VA_ARGS__ \
  }

constexpr Named kCapabilities[] = {NAMED(GL_DEPTH_TEST),
                                   NAMED(GL_SCISSOR_TEST),
                                   NAMED(GL_STENCIL_TEST),
                                   NAMED(GL_CULL_FACE),
                                   NAMED(GL_FRAMEBUFFER_SRGB),
                                   NAMED(GL_POLYGON_OFFSET_FILL),
                                   NAMED(GL_POLYGON_OFFSET_LINE),
                                   NAMED(GL_POLYGON_OFFSET_POINT),
                                   NAMED(GL_POLYGON_SMOOTH),
                                   NAMED(GL_LINE_SMOOTH),
                                   NAMED(GL_PRIMITIVE_RESTART),
                                   NAMED(GL_DEPTH_CLAMP),
                                   NAMED(GL_SAMPLE_ALPHA_TO_COVERAGE),
                                   NAMED(GL_SAMPLE_ALPHA_TO_ONE),
                                   NAMED(GL_SAMPLE_COVERAGE),
                                   NAMED(GL_SAMPLE_MASK),
                                   NAMED(GL_COLOR_LOGIC_OP),
                                   NAMED(GL_DITHER),
                                   NAMED(GL_MULTISAMPLE),
                                   NAMED(GL_PROGRAM_POINT_SIZE),
                                   NAMED(GL_TEXTURE_CUBE_MAP_SEAMLESS),
                                   NAMED(GL_CLIP_DISTANCE0),
                                   NAMED(GL_CLIP_DISTANCE1),
                                   NAMED(GL_CLIP_DISTANCE5)};
// Off, so that the host's framebuffer can be drawn into at all; and what 3.3 does not have is set where it is
// there.
constexpr Named kLaterCapabilities[] = {NAMED(GL_PRIMITIVE_RESTART_FIXED_INDEX), NAMED(GL_SAMPLE_SHADING)};

constexpr Named kNumbers[] = {NAMED(GL_CURRENT_PROGRAM),
                              NAMED(GL_VERTEX_ARRAY_BINDING),
                              NAMED(GL_ARRAY_BUFFER_BINDING),
                              NAMED(GL_ELEMENT_ARRAY_BUFFER_BINDING),
                              NAMED(GL_COPY_READ_BUFFER_BINDING),
                              NAMED(GL_COPY_WRITE_BUFFER_BINDING),
                              NAMED(GL_UNIFORM_BUFFER_BINDING),
                              NAMED(GL_TEXTURE_BUFFER_BINDING),
                              NAMED(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING),
                              NAMED(GL_PIXEL_PACK_BUFFER_BINDING),
                              NAMED(GL_PIXEL_UNPACK_BUFFER_BINDING),
                              NAMED(GL_DRAW_FRAMEBUFFER_BINDING),
                              NAMED(GL_READ_FRAMEBUFFER_BINDING),
                              NAMED(GL_RENDERBUFFER_BINDING),
                              NAMED(GL_ACTIVE_TEXTURE),
                              NAMED(GL_READ_BUFFER),
                              NAMED(GL_DRAW_BUFFER0),
                              NAMED(GL_DRAW_BUFFER1),
                              NAMED(GL_POLYGON_MODE, 2),
                              NAMED(GL_POLYGON_OFFSET_FACTOR),
                              NAMED(GL_POLYGON_OFFSET_UNITS),
                              NAMED(GL_CULL_FACE_MODE),
                              NAMED(GL_FRONT_FACE),
                              NAMED(GL_VIEWPORT, 4),
                              NAMED(GL_SCISSOR_BOX, 4),
                              NAMED(GL_DEPTH_RANGE, 2),
                              NAMED(GL_DEPTH_FUNC),
                              NAMED(GL_DEPTH_WRITEMASK),
                              NAMED(GL_DEPTH_CLEAR_VALUE),
                              NAMED(GL_COLOR_CLEAR_VALUE, 4),
                              NAMED(GL_STENCIL_CLEAR_VALUE),
                              NAMED(GL_STENCIL_FUNC),
                              NAMED(GL_STENCIL_REF),
                              NAMED(GL_STENCIL_VALUE_MASK),
                              NAMED(GL_STENCIL_WRITEMASK),
                              NAMED(GL_STENCIL_FAIL),
                              NAMED(GL_STENCIL_PASS_DEPTH_FAIL),
                              NAMED(GL_STENCIL_PASS_DEPTH_PASS),
                              NAMED(GL_STENCIL_BACK_FUNC),
                              NAMED(GL_STENCIL_BACK_REF),
                              NAMED(GL_STENCIL_BACK_WRITEMASK),
                              NAMED(GL_BLEND_COLOR, 4),
                              NAMED(GL_LOGIC_OP_MODE),
                              NAMED(GL_LINE_WIDTH),
                              NAMED(GL_POINT_SIZE),
                              NAMED(GL_POINT_FADE_THRESHOLD_SIZE),
                              NAMED(GL_POINT_SPRITE_COORD_ORIGIN),
                              NAMED(GL_SAMPLE_COVERAGE_VALUE),
                              NAMED(GL_SAMPLE_COVERAGE_INVERT),
                              NAMED(GL_PRIMITIVE_RESTART_INDEX),
                              NAMED(GL_PROVOKING_VERTEX),
                              NAMED(GL_CLAMP_READ_COLOR),
                              NAMED(GL_PACK_SWAP_BYTES),
                              NAMED(GL_PACK_LSB_FIRST),
                              NAMED(GL_PACK_ROW_LENGTH),
                              NAMED(GL_PACK_IMAGE_HEIGHT),
                              NAMED(GL_PACK_SKIP_PIXELS),
                              NAMED(GL_PACK_SKIP_ROWS),
                              NAMED(GL_PACK_SKIP_IMAGES),
                              NAMED(GL_PACK_ALIGNMENT),
                              NAMED(GL_UNPACK_SWAP_BYTES),
                              NAMED(GL_UNPACK_LSB_FIRST),
                              NAMED(GL_UNPACK_ROW_LENGTH),
                              NAMED(GL_UNPACK_IMAGE_HEIGHT),
                              NAMED(GL_UNPACK_SKIP_PIXELS),
                              NAMED(GL_UNPACK_SKIP_ROWS),
                              NAMED(GL_UNPACK_SKIP_IMAGES),
                              NAMED(GL_UNPACK_ALIGNMENT)};
constexpr Named kLaterNumbers[] = {NAMED(GL_CLIP_ORIGIN), NAMED(GL_CLIP_DEPTH_MODE),
                                   NAMED(GL_PROGRAM_PIPELINE_BINDING), NAMED(GL_TRANSFORM_FEEDBACK_BINDING)};

constexpr Named kPerDrawBuffer[] = {NAMED(GL_BLEND_SRC_RGB),      NAMED(GL_BLEND_DST_RGB),
                                    NAMED(GL_BLEND_SRC_ALPHA),    NAMED(GL_BLEND_DST_ALPHA),
                                    NAMED(GL_BLEND_EQUATION_RGB), NAMED(GL_BLEND_EQUATION_ALPHA)};
constexpr Named kPerUnit[] = {NAMED(GL_TEXTURE_BINDING_1D),       NAMED(GL_TEXTURE_BINDING_2D),
                              NAMED(GL_TEXTURE_BINDING_3D),       NAMED(GL_TEXTURE_BINDING_1D_ARRAY),
                              NAMED(GL_TEXTURE_BINDING_2D_ARRAY), NAMED(GL_TEXTURE_BINDING_BUFFER),
                              NAMED(GL_TEXTURE_BINDING_CUBE_MAP), NAMED(GL_TEXTURE_BINDING_RECTANGLE),
                              NAMED(GL_SAMPLER_BINDING),          NAMED(GL_TEXTURE_BINDING_2D_MULTISAMPLE)};
constexpr Named kIndexedBuffers[] = {
    NAMED(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING), NAMED(GL_TRANSFORM_FEEDBACK_BUFFER_START),
    NAMED(GL_TRANSFORM_FEEDBACK_BUFFER_SIZE), NAMED(GL_UNIFORM_BUFFER_BINDING)};
constexpr GLuint kUnits = 16, kDrawBuffers = 8, kViewports = 16;

GLint integer(const Context& context, GLenum name) {
  GL_FUNCTION(GETINTEGERV, GetIntegerv);
  GLint value[16] = {};
  GetIntegerv(name, value);
  return value[0];
}

bool at_least(const Context& context, int version) {
  return integer(context, GL_MAJOR_VERSION) * 10 + integer(context, GL_MINOR_VERSION) >= version;
}

}  // namespace

unsigned gl_error(const Context& context) {
  GL_FUNCTION(GETERROR, GetError);
  return GetError();
}

GlState gl_state(const Context& context) {
  GL_FUNCTION(GETDOUBLEV, GetDoublev);
  GL_FUNCTION(ISENABLED, IsEnabled);
  GL_FUNCTION(ISENABLEDI, IsEnabledi);
  GL_FUNCTION(GETINTEGERI_V, GetIntegeri_v);
  GL_FUNCTION(GETINTEGER64I_V, GetInteger64i_v);
  GL_FUNCTION(GETBOOLEANI_V, GetBooleani_v);
  GL_FUNCTION(ACTIVETEXTURE, ActiveTexture);
  GlState state;
  const auto numbers = [&](const Named& n, const std::string& name) {
    std::vector<double> values(16, 0);
    GetDoublev(n.value, values.data());
    values.resize(static_cast<std::size_t>(n.count));
    state[name] = values;
  };
  const bool later = at_least(context, 45);
  for (const Named& n : kCapabilities) state[n.name] = {double(IsEnabled(n.value))};
  for (const Named& n : kNumbers) numbers(n, n.name);
  if (later) {
    for (const Named& n : kLaterCapabilities) state[n.name] = {double(IsEnabled(n.value))};
    for (const Named& n : kLaterNumbers) numbers(n, n.name);
    GL_FUNCTION(GETFLOATI_V, GetFloati_v);
    GL_FUNCTION(GETDOUBLEI_V, GetDoublei_v);
    for (GLuint i = 0; i < kViewports; ++i) {
      GLfloat viewport[4];
      GLdouble range[2];
      GLint scissor[4];
      GetFloati_v(GL_VIEWPORT, i, viewport);
      GetDoublei_v(GL_DEPTH_RANGE, i, range);
      GetIntegeri_v(GL_SCISSOR_BOX, i, scissor);
      const std::string suffix = " " + std::to_string(i);
      state["viewport" + suffix] = {viewport, viewport + 4};
      state["depth range" + suffix] = {range, range + 2};
      state["scissor" + suffix] = {scissor, scissor + 4};
      state["scissor test" + suffix] = {double(IsEnabledi(GL_SCISSOR_TEST, i))};
    }
  }
  for (GLuint i = 0; i < kDrawBuffers; ++i) {
    const std::string suffix = " " + std::to_string(i);
    GLboolean mask[4];
    GetBooleani_v(GL_COLOR_WRITEMASK, i, mask);
    state["color mask" + suffix] = {mask, mask + 4};
    state["blend" + suffix] = {double(IsEnabledi(GL_BLEND, i))};
    for (const Named& n : kPerDrawBuffer) {
      GLint value = 0;
      if (later) GetIntegeri_v(n.value, i, &value);
      if (!later && i == 0) value = integer(context, n.value);
      state[n.name + suffix] = {double(value)};
    }
  }
  const GLint active = integer(context, GL_ACTIVE_TEXTURE);
  for (GLuint i = 0; i < kUnits; ++i) {
    ActiveTexture(GL_TEXTURE0 + i);
    for (const Named& n : kPerUnit) numbers(n, n.name + (" " + std::to_string(i)));
  }
  ActiveTexture(static_cast<GLenum>(active));
  for (const Named& n : kIndexedBuffers)
    for (GLuint i = 0; i < 2; ++i) {
      GLint64 value = 0;
      GetInteger64i_v(n.value, i, &value);
      state[n.name + (" " + std::to_string(i))] = {double(value)};
    }
  add_fixed_function_state(context, state);
  return state;
}

std::string differences(const GlState& before, const GlState& after) {
  std::string text;
  for (const auto& [name, values] : before) {
    const auto found = after.find(name);
    if (found != after.end() && found->second == values) continue;
    text += name + ":";
    for (const double v : values) text += ' ' + std::to_string(v);
    text += " became";
    if (found != after.end())
      for (const double v : found->second) text += ' ' + std::to_string(v);
    text += '\n';
  }
  return text;
}

namespace {

GLuint make_program(const Context& context) {
  GL_FUNCTION(CREATESHADER, CreateShader);
  GL_FUNCTION(SHADERSOURCE, ShaderSource);
  GL_FUNCTION(COMPILESHADER, CompileShader);
  GL_FUNCTION(CREATEPROGRAM, CreateProgram);
  GL_FUNCTION(ATTACHSHADER, AttachShader);
  GL_FUNCTION(LINKPROGRAM, LinkProgram);
  const char* vertex = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n";
  const GLuint shader = CreateShader(GL_VERTEX_SHADER), program = CreateProgram();
  ShaderSource(shader, 1, &vertex, nullptr);
  CompileShader(shader);
  AttachShader(program, shader);
  LinkProgram(program);
  return program;
}

void bind_textures(const Context& context) {
  GL_FUNCTION(GENTEXTURES, GenTextures);
  GL_FUNCTION(GENSAMPLERS, GenSamplers);
  GL_FUNCTION(BINDTEXTURE, BindTexture);
  GL_FUNCTION(BINDSAMPLER, BindSampler);
  GL_FUNCTION(ACTIVETEXTURE, ActiveTexture);
  constexpr GLenum kTargets[] = {GL_TEXTURE_1D,       GL_TEXTURE_2D,       GL_TEXTURE_3D,
                                 GL_TEXTURE_1D_ARRAY, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BUFFER,
                                 GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE};
  for (GLuint i = 0; i < kUnits; ++i) {
    ActiveTexture(GL_TEXTURE0 + i);
    for (const GLenum target : kTargets) {
      GLuint texture = 0;
      GenTextures(1, &texture);
      BindTexture(target, texture);
    }
    GLuint sampler = 0;
    GenSamplers(1, &sampler);
    BindSampler(i, sampler);
  }
  ActiveTexture(GL_TEXTURE7);
}

void bind_buffers(const Context& context) {
  GL_FUNCTION(GENVERTEXARRAYS, GenVertexArrays);
  GL_FUNCTION(BINDVERTEXARRAY, BindVertexArray);
  GL_FUNCTION(GENBUFFERS, GenBuffers);
  GL_FUNCTION(BINDBUFFER, BindBuffer);
  GL_FUNCTION(BUFFERDATA, BufferData);
  GL_FUNCTION(BINDBUFFERBASE, BindBufferBase);
  GL_FUNCTION(BINDBUFFERRANGE, BindBufferRange);
  GLuint array = 0;
  GenVertexArrays(1, &array);
  BindVertexArray(array);
  constexpr GLenum kTargets[] = {
      GL_ARRAY_BUFFER,       GL_ELEMENT_ARRAY_BUFFER, GL_COPY_READ_BUFFER,  GL_COPY_WRITE_BUFFER,
      GL_UNIFORM_BUFFER,     GL_TEXTURE_BUFFER,       GL_PIXEL_PACK_BUFFER, GL_TRANSFORM_FEEDBACK_BUFFER,
      GL_PIXEL_UNPACK_BUFFER};
  const auto make = [&](GLenum target) {
    GLuint buffer = 0;
    GenBuffers(1, &buffer);
    BindBuffer(target, buffer);
    BufferData(target, 4096, nullptr, GL_STATIC_DRAW);
    return buffer;
  };
  for (const GLenum target : kTargets) make(target);
  BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, make(GL_TRANSFORM_FEEDBACK_BUFFER), 256, 512);
  BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 1, make(GL_TRANSFORM_FEEDBACK_BUFFER));
  BindBufferBase(GL_UNIFORM_BUFFER, 0, make(GL_UNIFORM_BUFFER));
  make(GL_TRANSFORM_FEEDBACK_BUFFER);
}

void bind_framebuffers(const Context& context, int width, int height) {
  GL_FUNCTION(GENFRAMEBUFFERS, GenFramebuffers);
  GL_FUNCTION(BINDFRAMEBUFFER, BindFramebuffer);
  GL_FUNCTION(GENRENDERBUFFERS, GenRenderbuffers);
  GL_FUNCTION(BINDRENDERBUFFER, BindRenderbuffer);
  GL_FUNCTION(RENDERBUFFERSTORAGE, RenderbufferStorage);
  GL_FUNCTION(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer);
  GL_FUNCTION(DRAWBUFFERS, DrawBuffers);
  GL_FUNCTION(READBUFFER, ReadBuffer);
  const auto attach = [&](GLenum format, GLenum attachment) {
    GLuint buffer = 0;
    GenRenderbuffers(1, &buffer);
    BindRenderbuffer(GL_RENDERBUFFER, buffer);
    RenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  };
  GLuint framebuffers[2] = {};
  GenFramebuffers(2, framebuffers);
  for (const GLuint framebuffer : framebuffers) {
    BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    attach(GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(GL_RGBA8, GL_COLOR_ATTACHMENT1);
    attach(GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT);
    constexpr GLenum kBoth[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    DrawBuffers(2, kBoth);
    ReadBuffer(GL_COLOR_ATTACHMENT1);
  }
  BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers[0]);
}

void set_numbers(const Context& context) {
  function<PFNGLPOLYGONMODEPROC>(context, "glPolygonMode")(GL_FRONT_AND_BACK, GL_LINE);
  function<PFNGLPOLYGONOFFSETPROC>(context, "glPolygonOffset")(2, 3);
  function<PFNGLCULLFACEPROC>(context, "glCullFace")(GL_FRONT_AND_BACK);
  function<PFNGLFRONTFACEPROC>(context, "glFrontFace")(GL_CW);
  function<PFNGLVIEWPORTPROC>(context, "glViewport")(3, 4, 50, 60);
  function<PFNGLSCISSORPROC>(context, "glScissor")(5, 6, 20, 10);
  function<PFNGLDEPTHRANGEPROC>(context, "glDepthRange")(0.25, 0.75);
  function<PFNGLDEPTHFUNCPROC>(context, "glDepthFunc")(GL_GEQUAL);
  function<PFNGLDEPTHMASKPROC>(context, "glDepthMask")(GL_FALSE);
  function<PFNGLCLEARDEPTHPROC>(context, "glClearDepth")(0.3);
  function<PFNGLCLEARCOLORPROC>(context, "glClearColor")(0.1F, 0.2F, 0.3F, 0.4F);
  function<PFNGLCLEARSTENCILPROC>(context, "glClearStencil")(7);
  function<PFNGLSTENCILFUNCSEPARATEPROC>(context, "glStencilFuncSeparate")(GL_FRONT, GL_LESS, 3, 0x5a);
  function<PFNGLSTENCILFUNCSEPARATEPROC>(context, "glStencilFuncSeparate")(GL_BACK, GL_GREATER, 4, 0xa5);
  function<PFNGLSTENCILOPPROC>(context, "glStencilOp")(GL_INCR, GL_DECR, GL_INVERT);
  function<PFNGLSTENCILMASKPROC>(context, "glStencilMask")(0x33);
  function<PFNGLBLENDFUNCSEPARATEPROC>(context, "glBlendFuncSeparate")(GL_DST_COLOR, GL_SRC_ALPHA, GL_ONE,
                                                                       GL_CONSTANT_COLOR);
  function<PFNGLBLENDEQUATIONSEPARATEPROC>(context, "glBlendEquationSeparate")(GL_MAX, GL_FUNC_SUBTRACT);
  function<PFNGLBLENDCOLORPROC>(context, "glBlendColor")(0.5F, 0.4F, 0.3F, 0.2F);
  function<PFNGLLOGICOPPROC>(context, "glLogicOp")(GL_XOR);
  function<PFNGLLINEWIDTHPROC>(context, "glLineWidth")(1);
  function<PFNGLPOINTSIZEPROC>(context, "glPointSize")(3);
  function<PFNGLSAMPLECOVERAGEPROC>(context, "glSampleCoverage")(0.5F, GL_TRUE);
  function<PFNGLSAMPLEMASKIPROC>(context, "glSampleMaski")(0, 0);
  function<PFNGLPRIMITIVERESTARTINDEXPROC>(context, "glPrimitiveRestartIndex")(2);
  function<PFNGLPROVOKINGVERTEXPROC>(context, "glProvokingVertex")(GL_FIRST_VERTEX_CONVENTION);
}

void set_pixel_stores(const Context& context) {
  GL_FUNCTION(PIXELSTOREI, PixelStorei);
  PixelStorei(GL_PACK_SWAP_BYTES, 1), PixelStorei(GL_UNPACK_SWAP_BYTES, 1);
  PixelStorei(GL_PACK_LSB_FIRST, 1), PixelStorei(GL_UNPACK_LSB_FIRST, 1);
  int value = 5;
  for (const GLenum store : {GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS,
                             GL_PACK_SKIP_IMAGES, GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT,
                             GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES})
    PixelStorei(store, value++);
  PixelStorei(GL_PACK_ALIGNMENT, 8), PixelStorei(GL_UNPACK_ALIGNMENT, 2);
}

void set_per_draw_buffer(const Context& context) {
  GL_FUNCTION(COLORMASKI, ColorMaski);
  GL_FUNCTION(ENABLEI, Enablei);
  for (GLuint i = 0; i < kDrawBuffers; ++i) {
    ColorMaski(i, i & 1, i != 2, i == 0, i != 0);
    if (i != 3) Enablei(GL_BLEND, i);
  }
  if (!at_least(context, 45)) return;
  function<PFNGLBLENDFUNCIPROC>(context, "glBlendFunci")(1, GL_ONE_MINUS_DST_ALPHA, GL_ZERO);
  function<PFNGLBLENDEQUATIONIPROC>(context, "glBlendEquationi")(1, GL_MIN);
}

void set_per_viewport(const Context& context) {
  if (!at_least(context, 45)) return;
  function<PFNGLVIEWPORTINDEXEDFPROC>(context, "glViewportIndexedf")(3, 1.5F, 2.5F, 30, 40);
  function<PFNGLVIEWPORTINDEXEDFPROC>(context, "glViewportIndexedf")(0, 3.25F, 4.5F, 50, 60);
  function<PFNGLSCISSORINDEXEDPROC>(context, "glScissorIndexed")(3, 1, 2, 3, 4);
  function<PFNGLDEPTHRANGEINDEXEDPROC>(context, "glDepthRangeIndexed")(3, 0.1, 0.9);
  function<PFNGLDISABLEIPROC>(context, "glDisablei")(GL_SCISSOR_TEST, 3);
  function<PFNGLCLIPCONTROLPROC>(context, "glClipControl")(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
}

}  // namespace

void set_unusual_state(const Context& context, int width, int height) {
  bind_buffers(context);
  bind_textures(context);
  bind_framebuffers(context, width, height);
  function<PFNGLUSEPROGRAMPROC>(context, "glUseProgram")(make_program(context));
  GL_FUNCTION(ENABLE, Enable);
  GL_FUNCTION(DISABLE, Disable);
  for (const Named& n : kCapabilities) {
    if (n.value == GL_DITHER || n.value == GL_MULTISAMPLE) {
      Disable(n.value);
    } else {
      Enable(n.value);
    }
  }
  if (at_least(context, 45))
    for (const Named& n : kLaterCapabilities) Enable(n.value);
  set_numbers(context);
  set_pixel_stores(context);
  set_per_draw_buffer(context);
  set_per_viewport(context);
  function<PFNGLCLAMPCOLORPROC>(context, "glClampColor")(GL_CLAMP_READ_COLOR, GL_TRUE);
  set_unusual_fixed_function(context);
}

void draw_into_window(const Context& context) {
  function<PFNGLBINDFRAMEBUFFERPROC>(context, "glBindFramebuffer")(GL_FRAMEBUFFER, 0);
}

}  // namespace dupin::testing
