// OCCT's tessellation of the parts: the reference that everything is compared with.
#ifndef DUPIN_CAD_IMPORT_READER_MESH_H
#define DUPIN_CAD_IMPORT_READER_MESH_H

#include <TopoDS_Face.hxx>

#include <vector>

#include "../../nurbs/model.h"

namespace dupin::reader {

struct MeshOptions {
  double deflection = 0;  ///< as a part of the model's diagonal; 0: no mesh
  double angle_radians = 0.5;
};

/// Meshes the faces in parallel, common edges alike; seconds that BRepMesh took.
double mesh_faces(const std::vector<TopoDS_Face>& faces, double deflection, double angle_radians);

/// Collects the triangles of the part's faces, with the surfaces' own normals at the vertices.
void take_mesh(const std::vector<TopoDS_Face>& faces, Part& part);

}  // namespace dupin::reader

#endif
