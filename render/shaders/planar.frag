uniform vec2 pixel;  // 2 / picture
flat in vec3 side0, side1, side2, side3;
flat in uint id;
#ifdef PIECES
flat in vec3 row_x, row_y, row_w;
flat in ivec2 pieces;
flat in float rounding;
#endif
layout(location = 0) out uint out_id;

void main() {
  vec3 at = vec3(gl_FragCoord.xy * pixel - 1.0, 1.0);
  if (min(min(dot(side0, at), dot(side1, at)), min(dot(side2, at), dot(side3, at))) < 0.0) discard;
#ifdef PIECES
  vec2 p = vec2(dot(row_x, at), dot(row_y, at)) / dot(row_w, at);
  if (!bounded(pieces.x, uint(pieces.y), vec3(p, 0.0), rounding)) discard;
#endif
  out_id = id;
}
