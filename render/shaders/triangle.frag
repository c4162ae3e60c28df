uniform uint first_number;
layout(location = 0) out uint out_id;

void main() { out_id = (first_number + uint(gl_PrimitiveID)) | kTriangle; }
