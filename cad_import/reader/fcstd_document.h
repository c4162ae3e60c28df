// FreeCAD's document as its two XML files describe it: objects, where they are, whether they are shown, their
// colours.
#ifndef DUPIN_CAD_IMPORT_READER_FCSTD_DOCUMENT_H
#define DUPIN_CAD_IMPORT_READER_FCSTD_DOCUMENT_H

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../../core/status.h"
#include "../../nurbs/model.h"

namespace dupin::reader {

struct FcObject {
  std::string name, type, label;
  std::string shape_file;  ///< the member that holds its shape; empty: it has none
  bool has_placement = false;
  Affine3 placement;
  std::vector<std::string> group;   ///< what a container holds
  std::vector<std::string> inputs;  ///< other objects that it was made from or points at
  std::string linked;               ///< App::Link: the object that it shows
  bool link_to_other_file = false;
  int link_elements = 0;  ///< an App::Link array; 0: a single link
  Vec3 link_scale{1, 1, 1};
  bool link_keeps_placement = false;  ///< the linked object's own placement counts too
  std::optional<bool> visible;        ///< as the view says, or else the object
  std::optional<Color> color;
  std::string face_colors_file;  ///< the member with a colour a face; empty: none
  double transparency = 0;       ///< 0 … 1
};

struct FcDocument {
  std::vector<FcObject> objects;
  bool has_view = false;  ///< GuiDocument.xml was there: a file made without a window has none
};

/// `view` may be empty.
Result<FcDocument> parse_fcstd(const std::string& document, const std::string& view);

/// FreeCAD's 0xRRGGBBAA in sRGB as linear light; its alpha has meant opposite things and is not used.
Color unpack_color(std::uint32_t packed);

/// A colour list member: a count, then that many packed colours.
std::vector<Color> parse_colors(const std::string& bytes);

}  // namespace dupin::reader

#endif
