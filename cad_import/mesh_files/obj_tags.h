// OBJ's "t name ints/floats/strings …" statements, which describe a cage's subdivision.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_OBJ_TAGS_H
#define DUPIN_CAD_IMPORT_MESH_FILES_OBJ_TAGS_H

#include <string>
#include <vector>

#include "../../nurbs/polygon_mesh.h"
#include "text_cursor.h"

namespace dupin::mesh_files {

class ObjTags {
 public:
  static constexpr std::uint32_t kNoPolygon = 0xffffffffu;

  /// The rest of a "t" statement.
  Status read(TextCursor& text);
  /// Puts them into the mesh, those that refer to what is there; `polygon_numbers` gives a polygon's number
  /// in the mesh by its number in the file.
  void finish(const std::vector<std::uint32_t>& polygon_numbers, PolygonMesh& mesh,
              std::vector<std::string>& notes);

 private:
  struct Tag {
    std::string name;
    std::vector<std::int64_t> ints;
    std::vector<double> floats;
    std::vector<std::string> words;
  };
  void use(const Tag& tag);
  void use_crease(const Tag& tag);
  void use_corner(const Tag& tag);
  void use_boundary(const Tag& tag);

  SubdivisionTags tags_;
  std::vector<std::int64_t> holes_;
  std::size_t unknown_ = 0;
};

}  // namespace dupin::mesh_files

#endif
