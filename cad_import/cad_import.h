// Reading CAD and mesh files into a Model, in a child process with limits.
#ifndef DUPIN_CAD_IMPORT_CAD_IMPORT_H
#define DUPIN_CAD_IMPORT_CAD_IMPORT_H

#include <cstdint>
#include <string>

#include "../core/progress.h"
#include "../core/status.h"
#include "../nurbs/model.h"

namespace dupin {

struct ImportOptions {
  double time_limit_seconds = 0;         ///< 0: none
  std::uint64_t memory_limit_bytes = 0;  ///< of the reading process; 0: none
  std::string assumed_unit = "mm";       ///< for files that have none: mm, cm, m, inch, ft, um
  /// > 0: also tessellate every face by OCCT's BRepMesh_IncrementalMesh at this fraction of the model's
  /// diagonal (Part::mesh, Model::mesh_seconds).
  double mesh_deflection = 0;
  double mesh_angle_radians = 0.5;
  /// The reader's executable; empty: $DUPIN_READER, then beside this program, then where it was installed.
  std::string reader;
  Progress progress;
};

/// Reads STEP, IGES, BREP and FCStd, and the polygons of OBJ, PLY, STL and OFF; all but FCStd may be
/// compressed by gzip. The file's kind is found from its content; its name is asked only where a mesh's
/// content says nothing. Never throws, never lets a crash or a hang of the kernel through: a reader that dies
/// or exceeds a limit is reported as such.
Result<Model> import_cad(const std::string& path, const ImportOptions& options);

}  // namespace dupin

#endif
