#include "gpu_encode.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace dupin {
namespace {

std::uint32_t bits(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}
float value(std::uint32_t bits) {
  return std::bit_cast<float>(bits);
}
Texel texel(double x, double y, double z, double w) {
  return {bits(x), bits(y), bits(z), bits(w)};
}

/// 16 bits each, ±kMostTilt.
std::uint32_t tilt_word(const std::array<double, 2>& tilt) {
  std::uint32_t word = 0;
  for (int i = 0; i < 2; ++i) {
    const long n = std::lround(std::clamp(tilt[static_cast<std::size_t>(i)] / kMostTilt, -1.0, 1.0) * 32767);
    word |= (static_cast<std::uint32_t>(n) & 0xFFFFu) << 16 * i;
  }
  return word;
}

/// The unit quaternion (x, y, z, w) of the rotation whose columns are u, v, n, by its largest part
/// (Shepperd's method).
std::array<double, 4> quaternion(const Vec3& u, const Vec3& v, const Vec3& n) {
  const double trace = u.x + v.y + n.z;
  const std::array<double, 4> squares{1 + 2 * u.x - trace, 1 + 2 * v.y - trace, 1 + 2 * n.z - trace,
                                      1 + trace};
  const int largest = static_cast<int>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const double m = std::sqrt(squares[static_cast<std::size_t>(largest)]);
  std::array<double, 4> q;
  switch (largest) {
    case 0:
      q = {m * m, v.x + u.y, n.x + u.z, v.z - n.y};
      break;
    case 1:
      q = {v.x + u.y, m * m, n.y + v.z, n.x - u.z};
      break;
    case 2:
      q = {n.x + u.z, n.y + v.z, m * m, u.y - v.x};
      break;
    default:
      q = {v.z - n.y, n.x - u.z, u.y - v.x, m * m};
      break;
  }
  double length = 0;
  for (const double part : q) length += part * part;
  length = std::sqrt(length);
  for (double& part : q) part /= length;
  return q;
}

/// Only the three smallest parts are stored: the largest, at least ½, follows from them without loss.
Texel encode_frame(const QuadricDp& dp, std::uint32_t face, std::uint32_t& meta) {
  std::array<double, 4> q = quaternion(dp.u, dp.v, dp.n());
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (std::abs(q[i]) > std::abs(q[largest])) largest = i;
  const double sign = q[largest] < 0 ? -1 : 1;
  Texel result{0, 0, 0, face};
  for (std::size_t i = 0, k = 0; i < 4; ++i)
    if (i != largest) result[k++] = bits(sign * q[i]);
  meta |= static_cast<std::uint32_t>(largest) << kLargestPartShift;
  return result;
}

bool is_rectangle(const std::array<Vec2, 4>& f) {
  return f[0].y == f[1].y && f[1].x == f[2].x && f[2].y == f[3].y && f[3].x == f[0].x && f[0].x < f[2].x &&
         f[0].y < f[2].y;
}

/// Calls put on the pieces [first, first + count) that are feature edges, then on the others; the number of
/// the former.
template <class Piece, class Put>
std::uint32_t features_first(const std::vector<Piece>& pieces, std::uint32_t first, std::uint32_t count,
                             Put put) {
  std::uint32_t features = 0;
  for (const bool wanted : {true, false})
    for (std::uint32_t i = first; i < first + count; ++i)
      if (pieces[i].feature == wanted) {
        put(pieces[i]);
        features += wanted;
      }
  return features;
}

void encode_pieces(const PartDps& part, const QuadricDp& dp, std::vector<Texel>& texels) {
  const Vec2 r = dp.reference;
  const auto put_line = [&](const LinePiece& p) {
    const Vec2 a = p.p0 - r, b = p.p1 - r;
    texels.push_back(texel(a.x, a.y, b.x, b.y));
  };
  const auto put_arc = [&](const ArcPiece& p) { append_arc(p, r, texels); };
  const auto put_ellipse = [&](const EllipsePiece& p) {
    texels.push_back(texel(p.center.x - r.x, p.center.y - r.y, p.mxx, p.mxy));
    texels.push_back(texel(p.myy, 0, 0, 0));
  };
  const std::uint32_t lines = features_first(part.lines, dp.first_line, dp.lines, put_line);
  const std::uint32_t arcs = features_first(part.arcs, dp.first_arc, dp.arcs, put_arc);
  const std::uint32_t ellipses = features_first(part.ellipses, dp.first_ellipse, dp.ellipses, put_ellipse);
  const auto pack = [](std::uint32_t l, std::uint32_t a, std::uint32_t e) { return l | a << 12 | e << 24; };
  const std::size_t own = texels.size() - dp.lines - 2u * dp.arcs - 2u * dp.ellipses - dp.planes - 1;
  texels[own] = {pack(dp.lines, dp.arcs, dp.ellipses), pack(lines, arcs, ellipses), bits(dp.reference.x),
                 bits(dp.reference.y)};
}

}  // namespace

void append_arc(const ArcPiece& p, Vec2 r, std::vector<Texel>& texels) {
  const bool turn = cross(p.p1 - p.p0, p.p2 - p.p0) < 0;
  const Vec2 a = (turn ? p.p2 : p.p0) - r, b = p.p1 - r, c = (turn ? p.p0 : p.p2) - r;
  texels.push_back(texel(a.x, a.y, b.x, b.y));
  texels.push_back(texel(c.x, c.y, 4 * p.w * p.w, 0));
}

Status encode_dp(const PartDps& part, const QuadricDp& dp, const Vec3& anchor, std::uint32_t face,
                 std::vector<Texel>& texels) {
  if (dp.planes > kMaxPlanes || dp.lines > kMaxLines || dp.arcs > kMaxArcs || dp.ellipses > kMaxEllipses)
    return {StatusCode::limit, "a primitive has more boundary pieces than its record can count"};
  const bool pieces = dp.lines || dp.arcs || dp.ellipses || dp.planes || !dp.reference_inside;
  std::uint32_t meta =
      dp.planar * kPlanar | dp.flipped * kFlipped | pieces * kPieces | dp.reference_inside * kReferenceInside;
  meta |= static_cast<std::uint32_t>(dp.feature_sides & 63) << kFeatureSidesShift;
  const bool rectangle = is_rectangle(dp.footprint);
  if (rectangle) meta |= kRectangle;
  const std::size_t start = texels.size();
  const Vec3 o = dp.origin - anchor;
  texels.push_back(texel(o.x, o.y, o.z, 0));
  texels.push_back(encode_frame(dp, face, meta));
  const auto& f = dp.footprint;
  if (rectangle) {
    texels.push_back(texel(f[0].x, f[0].y, f[2].x, f[2].y));
  } else {
    texels.push_back(texel(f[0].x, f[0].y, f[1].x, f[1].y));
    texels.push_back(texel(f[2].x, f[2].y, f[3].x, f[3].y));
  }
  if (!dp.planar) {
    texels.push_back(texel(dp.lambda_u, dp.lambda_v, dp.a, dp.b));
    texels.push_back(texel(dp.c, dp.z_lo, dp.z_hi, 0));
    texels.back()[3] = tilt_word(dp.tilt);
    if (dp.cubic != std::array<double, 4>{} || dp.tilt != std::array<double, 2>{}) {
      meta |= kCubic;
      texels.push_back(texel(dp.cubic[0], dp.cubic[1], dp.cubic[2], dp.cubic[3]));
    }
  }
  if (pieces) {
    texels.push_back({});
    const std::uint32_t features =
        features_first(part.planes, dp.first_plane, dp.planes,
                       [&](const ClipPlane& p) { texels.push_back(texel(p.n.x, p.n.y, p.n.z, p.d)); });
    meta |= static_cast<std::uint32_t>(dp.planes) << kPlaneCountShift | features << kFeaturePlaneShift;
    encode_pieces(part, dp, texels);
  }
  texels[start][3] = meta;
  return {};
}

std::array<Vec3, 3> decode_frame(const Texel& second, std::uint32_t meta) {
  const std::uint32_t largest = meta >> kLargestPartShift & 3;
  const float a = value(second[0]), b = value(second[1]), c = value(second[2]);
  const float m = std::sqrt(std::max(0.0F, 1 - a * a - b * b - c * c));
  float q[4];
  const float small[3] = {a, b, c};
  for (std::uint32_t i = 0, k = 0; i < 4; ++i) q[i] = i == largest ? m : small[k++];
  const float x = q[0], y = q[1], z = q[2], w = q[3];
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          Vec3{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          Vec3{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

}  // namespace dupin
