#ifndef DUPIN_CAD_IMPORT_READER_UNITS_H
#define DUPIN_CAD_IMPORT_READER_UNITS_H

#include <string_view>

namespace dupin::reader {

/// Millimetres in one of the unit: mm, cm, m, inch, ft, um; 1 for anything else.
inline double millimetres(std::string_view unit) {
  if (unit == "cm") return 10;
  if (unit == "m") return 1000;
  if (unit == "inch") return 25.4;
  if (unit == "ft") return 304.8;
  if (unit == "um") return 0.001;
  return 1;
}

}  // namespace dupin::reader

#endif
