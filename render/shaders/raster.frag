// Numbers and depths that the CPU made (splat_raster.h), into the pictures.
uniform usampler2D splats;  // the number's complement, the depth's bits
layout(location = 0) out uint out_id;

void main() {
  uvec2 splat = texelFetch(splats, ivec2(gl_FragCoord.xy), 0).xy;
  if (splat.y == 0u) discard;
  out_id = LAYER | ~splat.x;
  gl_FragDepth = uintBitsToFloat(splat.y);
}
