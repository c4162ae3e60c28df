// The mean of a pixel's samples, as files hold it: straight alpha. The framebuffer turns linear light into sRGB.
uniform sampler2D colors;
uniform float samples;
layout(location = 0) out vec4 out_color;

void main() {
  vec4 c = texelFetch(colors, ivec2(gl_FragCoord.xy), 0) / samples;
  out_color = c.a > 0.0 ? vec4(c.rgb / c.a, c.a) : vec4(0.0);
}
