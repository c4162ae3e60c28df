// One triangle that covers the picture, at a depth of its own.
uniform float screen_depth;    // in the window
uniform float zero_to_one;

void main() {
  float z = zero_to_one > 0.5 ? screen_depth : 2.0 * screen_depth - 1.0;
  gl_Position = vec4(float((gl_VertexID & 1) * 4 - 1), float((gl_VertexID & 2) * 2 - 1), z, 1.0);
}
