// The last line of defence before the hand-over: what would make the whole model unacceptable is left out by
// name.
#ifndef DUPIN_CAD_IMPORT_READER_SANITIZE_H
#define DUPIN_CAD_IMPORT_READER_SANITIZE_H

#include <vector>

#include "../../nurbs/model.h"

namespace dupin::reader {

/// Moves faces that `check` refuses from the part to the returned list, with check's reason; `index` gets the
/// old indices of those that stay.
std::vector<SkippedFace> remove_invalid_faces(Part& part, std::vector<std::size_t>& index);

}  // namespace dupin::reader

#endif
