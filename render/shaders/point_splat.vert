// A splat: SPLAT 0 a square as wide as the point's ball has a radius, 1 the rectangle around the ball's disc seen along the view axis, 2 the
// same, for an ellipse. All lie in a plane parallel to the picture.
uniform samplerBuffer points;  // two texels each: position, radius | normal, face
uniform int instance;
uniform uint first_number;
uniform float radius_scale;    // of the placement
uniform vec2 axis_scale, axis_offset;
uniform float push;            // moves the splat away from the viewer by this part of its radius
flat out uint number;
#if SPLAT == 2
flat out float slimness;
out vec2 place;                // in the unit square that the ellipse of that slimness lies in
#endif

vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }

void main() {
  int point = gl_VertexID >> 2, i = gl_VertexID & 3;
  vec4 t0 = texelFetch(points, 2 * point);
  number = first_number + uint(point);
  vec2 corner = vec2(i == 1 || i == 2 ? 1.0 : -1.0, i >= 2 ? 1.0 : -1.0);
  float radius = radius_scale * t0.w;
#if SPLAT == 0
  vec2 offset = 0.5 * radius * corner;
#else
  vec3 n = texelFetch(points, 2 * point + 1).xyz, f = instance_texel(2);
  vec3 right = instance_texel(3) * axis_scale.x, up = instance_texel(4) * axis_scale.y;
  vec3 back = spread * (axis_offset.x * right + axis_offset.y * up) - f;
  vec3 view = normalize(vec3(dot(n, right), dot(n, up), dot(n, back)));
  float l = length(view.xy), minor = abs(view.z);
  vec2 tilt = l > 1e-6 ? view.xy / l : vec2(1.0, 0.0);  // the disc is foreshortened along this
  vec2 offset = radius * (corner.x * vec2(-tilt.y, tilt.x) + corner.y * minor * tilt);
#endif
#if SPLAT == 2
  slimness = floor(minor * 255.0 + 0.5);
  place = corner * vec2(1.0, slimness / 255.0);
#endif
  vec3 r = (t0.xyz - instance_texel(0)) - instance_texel(1);
  float depth = start_depth + dot(instance_texel(7), r) + push * radius;
  // The center moves along its ray; offsets are those at its own depth.
  vec2 center = vec2(dot(instance_texel(5), r), dot(instance_texel(6), r));
  float own = start_depth + dot(instance_texel(7), r), along = spread > 0.0 ? depth / own : 1.0;
  gl_Position = to_clip((center + offset * axis_scale) * along, depth);
}
