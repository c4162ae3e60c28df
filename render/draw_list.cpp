#include "draw_list.h"

#include <bit>
#include <limits>

#include "part_camera.h"

namespace dupin {
namespace {

/// With a perspective camera among the model's parts, what is nearer to the eye than this part of the
/// farthest depth is not drawn.
constexpr double kNearestOfFar = 1e-6;

void depth_range(const Scene::Impl& scene, const ViewRays& view, DrawList& list) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (int i = 0; i < 8 && !scene.box.empty(); ++i) {
    const double z = view.depth(scene.box.corner(i));
    lo = std::min(lo, z);
    hi = std::max(hi, z);
  }
  if (!(lo <= hi)) lo = hi = 1;
  // Rounding must not bring a face that lies on the box in front of the nearest depth.
  const double slack = 1e-6 * (hi - lo) + 1e-12 * std::abs(hi);
  lo -= slack;
  hi += slack;
  list.far_depth = hi;
  if (!view.perspective) {
    list.near_depth = lo;
    list.start_depth = lo;
    const double range = std::max(hi - lo, std::numeric_limits<double>::min());
    list.farthest_in_buffer = 0.25;
    list.depth_terms = {1 + 0.75 * lo / range, -0.75 / range, 0};
    return;
  }
  list.far_depth = std::max(hi, std::numeric_limits<double>::min());
  list.near_depth = std::max(lo, kNearestOfFar * list.far_depth);
  list.start_depth = std::max(lo, 0.0);
  list.depth_terms = {0, 0, list.near_depth};
  list.farthest_in_buffer = list.near_depth / list.far_depth;
}

std::array<float, 4> texel(const Vec3& v, float w = 0) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
}
Vec3 rounded(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

InstanceTexels instance_texels(const SceneInstance& instance, const ScenePart& part, const ViewRays& view,
                               double start_depth) {
  const Mat3& in = instance.to_part.linear;
  const Mat3& out = instance.to_world.linear;
  // A ray is S + ka (X P + Y Q) + t (F + kp (X P + Y Q)), t its depth beyond start_depth.
  Vec3 start = view.eye + view.forward * start_depth;
  const double at_start = view.perspective ? start_depth : 1;
  start += (view.right * view.ox + view.up * view.oy) * at_start;
  Vec3 forward = view.forward;
  if (view.perspective) forward += view.right * view.ox + view.up * view.oy;
  const Vec3 s = transform_point(instance.to_part, start) - part.anchor, high = rounded(s);
  // clip X = row_x·(p − S), and likewise Y; the depth is start_depth + row_f·(p − S).
  const Vec3 offset = view.perspective ? view.forward : Vec3{};
  const Vec3 row_x = (view.right - offset * view.ox) / view.sx,
             row_y = (view.up - offset * view.oy) / view.sy;
  const auto word = [](std::uint32_t v) { return std::bit_cast<float>(v); };
  InstanceTexels t{};
  t[0] = texel(high, word(instance.first_face));
  t[1] = texel(s - high, static_cast<float>(instance.scale_ratio));
  t[2] = texel(in * forward);
  t[3] = texel(in * (view.right * view.sx));
  t[4] = texel(in * (view.up * view.sy));
  t[5] = texel(transpose_times(out, row_x));
  t[6] = texel(transpose_times(out, row_y));
  t[7] = texel(transpose_times(out, view.forward));
  return t;
}

/// Where on the picture a sphere may be seen.
class Footprints {
 public:
  Footprints(const ViewRays& view, std::vector<std::array<int, 2>>& bands) : view_(view), bands_(bands) {
    bands_.assign(static_cast<std::size_t>((view.height + kBandRows - 1) / kBandRows), {view.width, 0});
  }
  /// The sphere's radius in pixels; infinite, and the whole picture, where it comes close to the eye.
  double add(const PartCamera& camera, const Vec3& center, double radius) {
    const double w = camera.perspective ? dot(camera.depth.n, center) + camera.depth.d : 1;
    const double dw = camera.perspective ? radius * length(camera.depth.n) : 0;
    if (w - dw < 0.05 * w) {
      add_pixels(0, view_.width, 0, view_.height);
      return std::numeric_limits<double>::infinity();
    }
    std::array<double, 4> ends;
    for (std::size_t k = 0; k < 2; ++k) {
      const Plane3& row = camera.rows[k];
      // |(X + δX)/(w + δw) − X/w| for changes of at most radius·|row| and δw.
      const double at = (dot(row.n, center) + row.d) / w,
                   reach = (radius * length(row.n) + std::abs(at) * dw) / (w - dw);
      const int size = k == 0 ? view_.width : view_.height;
      ends[2 * k] = (at - reach + 1) * size / 2;
      ends[2 * k + 1] = (at + reach + 1) * size / 2;
    }
    add_pixels(ends[0] - 2, ends[1] + 2, ends[2] - 2, ends[3] + 2);
    return std::max(ends[1] - ends[0], ends[3] - ends[2]) / 2;
  }

 private:
  void add_pixels(double x0, double x1, double y0, double y1) {
    const auto whole = [](double v, int limit) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(limit)));
    };
    const int left = whole(x0, view_.width), right = whole(x1 + 1, view_.width);
    const int first = whole(y0, view_.height) / kBandRows,
              last = std::min(whole(y1 + 1, view_.height), view_.height - 1) / kBandRows;
    for (int b = first; b <= last; ++b) {
      auto& band = bands_[static_cast<std::size_t>(b)];
      band = {std::min(band[0], left), std::max(band[1], right)};
    }
  }

  const ViewRays& view_;
  std::vector<std::array<int, 2>>& bands_;
};

/// Which sides of a DP can be seen.
enum class Facing { away, towards, unknown };

Facing facing(const DpBounds& dp, const PartCamera& camera) {
  const Vec3 towards = camera.perspective ? camera.eye - dp.center : camera.eye;
  if (dp.dp.planar) return dot(dp.axis, towards) < 0 ? Facing::away : Facing::towards;
  if (dp.sin_cone >= 1) return Facing::unknown;
  const double l = length(towards);
  const double sin_sphere = camera.perspective ? dp.radius / l : 0;
  if (!(sin_sphere < 1)) return Facing::unknown;
  // Turned away if the axis and the direction to the viewer are more than 90° + cone + sphere apart, and
  // towards the viewer if less than 90° − cone − sphere.
  const double cos_cone = std::sqrt(std::max(0.0, 1 - dp.sin_cone * dp.sin_cone)),
               cos_sphere = std::sqrt(1 - sin_sphere * sin_sphere);
  const double cos_sum = cos_cone * cos_sphere - dp.sin_cone * sin_sphere;
  const double sin_sum = dp.sin_cone * cos_sphere + cos_cone * sin_sphere;
  const double along = dot(dp.axis, towards);
  if (cos_sum <= 0 || std::abs(along) <= sin_sum * l) return Facing::unknown;
  return along < 0 ? Facing::away : Facing::towards;
}

bool out_of_view(const DpBounds& dp, const PartCamera& camera) {
  for (const Plane3& side : camera.sides)
    if (dot(side.n, dp.center) + side.d < -dp.radius) return true;
  return camera.perspective &&
         dot(camera.depth.n, dp.center) + camera.depth.d < -dp.radius * length(camera.depth.n);
}

/// Nearest first.
struct Candidate {
  std::uint32_t key;
  DrawItem item;
  SeenDp seen;
};

std::uint32_t sort_key(float depth) {
  // Floats in order as unsigned integers: the sign bit turned for positive ones, all bits for negative ones.
  const auto bits = std::bit_cast<std::uint32_t>(depth);
  return bits & 0x80000000U ? ~bits : bits | 0x80000000U;
}

/// The bound where the DP is nearest to the eye.
double bound_px(const DpBounds& dp, double depth, double scale, const ViewRays& view, const DrawList& list) {
  const double nearest = std::max(depth - scale * dp.radius, list.near_depth);
  return scale * dp.dp.bound / pixel_size(view, nearest);
}

void add_dps(const SceneInstance& instance, std::uint32_t index, const ScenePart& part,
             const PartCamera& camera, const ViewRays& view, Footprints& footprints, DrawList& list,
             std::vector<Candidate>& candidates) {
  const double largest_scale = length(camera.depth.n) * instance.scale_ratio;
  for (std::size_t i = 0; i < part.dps.size(); ++i) {
    const DpBounds& dp = part.dps[i];
    std::uint32_t color = instance.colors.of(dp.dp.face);
    if (is_hidden(color) || out_of_view(dp, camera)) continue;
    if (camera.cut_solid && !is_highlighted(color)) color = (color & 0xffffff) | kSolidColor;
    const Facing side = facing(dp, camera);
    if (camera.cull_turned_away && side == Facing::away) continue;
    const double radius_px = footprints.add(camera, dp.center, dp.radius);
    const double depth = dot(camera.depth.n, dp.center) + camera.depth.d;
    list.bound_px = std::max(list.bound_px, bound_px(dp, depth, largest_scale, view, list));
    candidates.push_back(
        {sort_key(static_cast<float>(depth)),
         {dp.record, index, instance.first_primitive + static_cast<std::uint32_t>(i) + 1, color},
         {&dp, &camera, 0, 2 * radius_px, radius_px / std::max(dp.radius, 1e-300), side == Facing::towards,
          side == Facing::away}});
  }
}

/// Planar tiles, which hide early what lies behind them, before curved ones.
void fill_groups(std::vector<Candidate>& candidates, const TileOptions& options, DrawList& list) {
  Tiles tiles;
  for (Candidate& c : candidates) {
    c.seen.slot = static_cast<std::uint32_t>(list.items.size());
    list.items.push_back(c.item);
    add_tiles(c.seen, options, tiles);
  }
  for (const std::uint32_t curved : {0U, kCurvedTile})
    for (const auto& [kind, texels] : tiles.by_kind) {
      if ((kind & kCurvedTile) != curved || texels.empty()) continue;
      list.groups.push_back({kind, static_cast<std::uint32_t>(list.tiles.size()),
                             static_cast<std::uint32_t>(texels.size()) / tile_texels(kind)});
      list.tiles.insert(list.tiles.end(), texels.begin(), texels.end());
    }
  list.first_edge = static_cast<std::uint32_t>(list.tiles.size());
  list.tiles.insert(list.tiles.end(), tiles.edges.begin(), tiles.edges.end());
}

}  // namespace

std::uint32_t DrawList::primitives() const {
  auto n = static_cast<std::uint32_t>(items.size());
  for (const TriangleRun& run : runs) n += run.triangles;
  return n;
}

void build_draw_list(const Scene::Impl& scene, const ViewRays& view,
                     std::span<const DrawOptions::Section> sections, const TileOptions& options,
                     DrawList& list) {
  list.instances.clear();
  list.items.clear();
  list.groups.clear();
  list.tiles.clear();
  list.runs.clear();
  list.bound_px = 0;
  depth_range(scene, view, list);
  const SidePlanes sides = side_planes(view, sections);
  Footprints footprints(view, list.bands);
  std::vector<Candidate> candidates;
  std::vector<PartCamera> cameras;
  cameras.reserve(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    const ScenePart& part = scene.parts[instance.part];
    const auto index = static_cast<std::uint32_t>(i);
    list.instances.push_back(instance_texels(instance, part, view, list.start_depth));
    if (part.primitives == 0 || !instance.visible) continue;
    const PartCamera& camera = cameras.emplace_back(part_camera(instance, part, view, sides));
    if (part.triangles) {
      list.runs.push_back({index, part.first_triangle, part.triangles,
                           instance.first_primitive + static_cast<std::uint32_t>(part.dps.size()),
                           instance.first_face, instance.colors.whole, !instance.colors.faces.empty(),
                           instance.hidden_faces});
      footprints.add(camera, part.box.center() - part.anchor, part.box.diagonal() / 2);
    }
    if (!part.layer_box.empty())
      footprints.add(camera, part.layer_box.center() - part.anchor, part.layer_box.diagonal() / 2);
    add_dps(instance, index, part, camera, view, footprints, list, candidates);
  }
  // Equal keys keep the model's order, by the primitive's number: the same list whatever the sorting
  // algorithm.
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.key != b.key ? a.key < b.key : a.item.primitive < b.item.primitive;
  });
  fill_groups(candidates, options, list);
}

}  // namespace dupin
