// The fixed function of a compatibility context, in the same way.
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstring>

#include "host_state.h"

namespace dupin::testing {
namespace {

template <class F>
F function(const Context& context, const char* name, F) {
  void* address = context.proc_address(name);
  F result = nullptr;
  std::memcpy(&result, &address, sizeof(address));
  return result;
}
// The headers' declarations give the types; nothing is linked.
#define GL_CALL(name) function(context, #name, static_cast<decltype(&::name)>(nullptr))

struct Named {
  const char* name;
  GLenum value;
  int count = 1;
};
#define NAMED(value, ...)        \
  Named {                        \
#value, value, ##__VA_ARGS__ \
  }

constexpr Named kSwitches[] = {
    NAMED(GL_ALPHA_TEST),   NAMED(GL_POLYGON_STIPPLE), NAMED(GL_FOG),
    NAMED(GL_LIGHTING),     NAMED(GL_LIGHT0),          NAMED(GL_COLOR_MATERIAL),
    NAMED(GL_NORMALIZE),    NAMED(GL_POINT_SMOOTH),    NAMED(GL_POINT_SPRITE),
    NAMED(GL_LINE_STIPPLE), NAMED(GL_COLOR_SUM),       NAMED(GL_VERTEX_PROGRAM_TWO_SIDE),
    NAMED(GL_VERTEX_ARRAY), NAMED(GL_NORMAL_ARRAY),    NAMED(GL_COLOR_ARRAY)};
constexpr Named kNumbers[] = {NAMED(GL_ALPHA_TEST_FUNC),
                              NAMED(GL_ALPHA_TEST_REF),
                              NAMED(GL_POLYGON_MODE, 2),
                              NAMED(GL_MATRIX_MODE),
                              NAMED(GL_MODELVIEW_MATRIX, 16),
                              NAMED(GL_PROJECTION_MATRIX, 16),
                              NAMED(GL_MODELVIEW_STACK_DEPTH),
                              NAMED(GL_PROJECTION_STACK_DEPTH),
                              NAMED(GL_ATTRIB_STACK_DEPTH),
                              NAMED(GL_CLIENT_ATTRIB_STACK_DEPTH),
                              NAMED(GL_SHADE_MODEL),
                              NAMED(GL_CURRENT_COLOR, 4),
                              NAMED(GL_CURRENT_NORMAL, 3),
                              NAMED(GL_CURRENT_TEXTURE_COORDS, 4),
                              NAMED(GL_CURRENT_RASTER_POSITION, 4),
                              NAMED(GL_CLIENT_ACTIVE_TEXTURE),
                              NAMED(GL_CLAMP_VERTEX_COLOR),
                              NAMED(GL_CLAMP_FRAGMENT_COLOR),
                              NAMED(GL_FOG_DENSITY),
                              NAMED(GL_LIGHT_MODEL_AMBIENT, 4),
                              NAMED(GL_LIST_BASE),
                              NAMED(GL_RENDER_MODE),
                              NAMED(GL_ZOOM_X),
                              NAMED(GL_MAP_COLOR),
                              NAMED(GL_MAP_STENCIL),
                              NAMED(GL_INDEX_SHIFT),
                              NAMED(GL_INDEX_OFFSET),
                              NAMED(GL_RED_SCALE),
                              NAMED(GL_RED_BIAS),
                              NAMED(GL_GREEN_SCALE),
                              NAMED(GL_GREEN_BIAS),
                              NAMED(GL_BLUE_SCALE),
                              NAMED(GL_BLUE_BIAS),
                              NAMED(GL_ALPHA_SCALE),
                              NAMED(GL_ALPHA_BIAS),
                              NAMED(GL_DEPTH_SCALE),
                              NAMED(GL_DEPTH_BIAS)};

bool has_fixed_function(const Context& context) {
  GLint profile = 0;
  GL_CALL(glGetIntegerv)(GL_CONTEXT_PROFILE_MASK, &profile);
  return profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT;
}

void set_pixel_transfer(const Context& context) {
  const auto set = GL_CALL(glPixelTransferf);
  for (const GLenum scale : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE, GL_DEPTH_SCALE})
    set(scale, 0.5F);
  for (const GLenum bias : {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS, GL_DEPTH_BIAS})
    set(bias, 0.25F);
  set(GL_INDEX_SHIFT, 2), set(GL_INDEX_OFFSET, 3), set(GL_MAP_STENCIL, 1);
}

/// A pattern that lets hardly anything through; it is read from memory only while no buffer is bound.
void set_polygon_stipple(const Context& context) {
  using BindBuffer = void (*)(GLenum, GLuint);
  const auto bind = function(context, "glBindBuffer", BindBuffer{});
  GLint buffer = 0;
  GL_CALL(glGetIntegerv)(GL_PIXEL_UNPACK_BUFFER_BINDING, &buffer);
  bind(GL_PIXEL_UNPACK_BUFFER, 0);
  const GLubyte pattern[256] = {1, 2, 3};
  GL_CALL(glPolygonStipple)(pattern);
  bind(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(buffer));
}

}  // namespace

void add_fixed_function_state(const Context& context, GlState& state) {
  if (!has_fixed_function(context)) return;
  for (const Named& n : kSwitches) state[n.name] = {double(GL_CALL(glIsEnabled)(n.value))};
  for (const Named& n : kNumbers) {
    std::vector<double> values(16, 0);
    GL_CALL(glGetDoublev)(n.value, values.data());
    values.resize(static_cast<std::size_t>(n.count));
    state[n.name] = values;
  }
}

void set_unusual_fixed_function(const Context& context) {
  if (!has_fixed_function(context)) return;
  for (const Named& n : kSwitches)
    if (n.value < GL_VERTEX_ARRAY || n.value > GL_EDGE_FLAG_ARRAY) GL_CALL(glEnable)(n.value);
  GL_CALL(glAlphaFunc)(GL_NEVER, 0.5F);
  set_polygon_stipple(context);
  GL_CALL(glPolygonMode)(GL_FRONT, GL_LINE);
  GL_CALL(glPolygonMode)(GL_BACK, GL_POINT);
  GL_CALL(glMatrixMode)(GL_PROJECTION);
  GL_CALL(glPushMatrix)();
  GL_CALL(glOrtho)(-3, 2, -5, 4, 1, 9);
  GL_CALL(glMatrixMode)(GL_MODELVIEW);
  GL_CALL(glRotatef)(30, 1, 2, 3);
  GL_CALL(glMatrixMode)(GL_TEXTURE);
  GL_CALL(glPushAttrib)(GL_CURRENT_BIT);
  GL_CALL(glShadeModel)(GL_FLAT);
  GL_CALL(glColor4f)(0.1F, 0.2F, 0.3F, 0.4F);
  GL_CALL(glNormal3f)(0, 1, 0);
  GL_CALL(glTexCoord4f)(1, 2, 3, 4);
  GL_CALL(glFogf)(GL_FOG_DENSITY, 3);
  GL_CALL(glListBase)(7);
  GL_CALL(glPixelZoom)(2, 3);
  GL_CALL(glEnableClientState)(GL_COLOR_ARRAY);
  set_pixel_transfer(context);
  using ClampColor = void (*)(GLenum, GLenum);
  const auto clamp = function(context, "glClampColor", ClampColor{});
  clamp(GL_CLAMP_VERTEX_COLOR, GL_TRUE), clamp(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE);
}

}  // namespace dupin::testing
