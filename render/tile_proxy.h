// What a tile of a curved DP is drawn by: a quadrilateral of the picture close around the tile.
#ifndef DUPIN_RENDER_TILE_PROXY_H
#define DUPIN_RENDER_TILE_PROXY_H

#include <array>

#include "part_camera.h"

namespace dupin {

/// Convex; in pixels from the picture's middle, right and down. A corner may be repeated.
struct TileProxy {
  std::array<Vec2, 4> corners;
  double area = 0;  ///< in pixels
};

/// A DP's frame on the picture.
class PictureOfDp {
 public:
  PictureOfDp() = default;
  /// Half the picture's size is what clip coordinates are multiplied by.
  PictureOfDp(const PartCamera& camera, const Vec3& origin, const Vec3& u, const Vec3& v, const Vec3& n,
              Vec2 half_size);

  /// What can be seen of a body is near the eye, where its picture may be unbounded; or is in the proxy; or
  /// there is none, as it is out of the picture or between pixels.
  enum class Seen { nothing, near_eye, in_proxy };
  /// Around the points' hull, 0–3 the corners of one end and 4–7 those of the other, and a quarter of a pixel
  /// more, as vertices are rounded to parts of a pixel.
  Seen around(const std::array<Vec3, 8>& hull, TileProxy& proxy) const;
  /// Where the ray of a point of the picture, in pixels from its middle, is at the depth of the DP's origin.
  Vec3 at(Vec2 pixel) const;
  /// How many pixels a length is at most, at the nearest of the points; infinite behind the eye.
  double px_per_unit(const std::array<Vec3, 8>& points) const;

 private:
  /// Of a point of the DP's frame: n·p + d.
  Plane3 x_, y_, depth_;
  Vec2 half_size_;
  std::array<Vec3, 2> steps_;  ///< how the point of the ray moves with x_ and y_
  bool perspective_ = true;
};

}  // namespace dupin

#endif
