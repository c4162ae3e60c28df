// What the shading of DPs and of triangles share.
uniform usampler2D ids;
uniform vec2 pixel;           // 2 / picture
uniform vec2 axis_scale;      // 1 / (sx, sy) of view_rays.h
uniform vec2 axis_offset;     // (ox, oy)
uniform mat3 to_model;        // columns: right, up, towards the viewer
uniform vec4 under;            // what the picture holds already for this sample
uniform float curvature_scale;
uniform uint only_color;      // 0: the file's

// What is known of a pixel; view space has z towards the viewer.
struct Surface {
  vec3 normal;      // view space, outward
  float depth;
  vec3 direction;   // of k1, view space
  vec2 curvature;
  uint face, primitive, color;
  float edge;       // how much of the pixel an edge covers
};

vec3 ray_to_viewer(vec2 at) {
  return spread > 0.0 ? normalize(vec3(-(axis_offset + at / axis_scale), 1.0)) : vec3(0.0, 0.0, 1.0);
}
