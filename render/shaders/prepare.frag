// Nothing is rasterised. But in a compatibility context a program without a fragment shader has OpenGL 1's, with which nothing, not
// even feedback, may be drawn while integer pictures are bound.
void main() {}
