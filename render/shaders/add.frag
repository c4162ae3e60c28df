// A sample's colors, drawn together with its ids, added to the sum of the pixel's samples.
uniform sampler2D colors;
uniform usampler2D ids;
uniform vec4 under;  // what the sum holds already for this sample
layout(location = 0) out vec4 out_color;

void main() {
  ivec2 where = ivec2(gl_FragCoord.xy);
#ifdef LAYERS
  if (texelFetch(ids, where, 0).x >= 0xc0000000u) discard;  // they shade their own
#endif
  out_color = texelFetch(colors, where, 0) - under;
}
