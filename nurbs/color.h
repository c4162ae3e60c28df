#ifndef DUPIN_NURBS_COLOR_H
#define DUPIN_NURBS_COLOR_H

namespace dupin {

struct Color {
  float r = 0, g = 0, b = 0, a = 1;  ///< linear light, straight alpha
  friend bool operator==(const Color&, const Color&) = default;
};

}  // namespace dupin

#endif
