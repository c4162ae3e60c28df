// Batches of everything that a profile sweeps: about an axis (cylinder, cone, sphere, torus, revolution) or
// along a line (plane, extrusion). What a rotation or translation does not change, curvatures above all, is
// computed once for a parameter of the profile, in axes that go with it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../core/parallel.h"
#include "batch_families.h"
#include "shape_operator.h"

namespace dupin {
namespace {

using kernels::SweptJob;

constexpr std::size_t kSamplesATask = 8192;
/// Profiles no farther from a plane through the axis than this part of their size are in it.
constexpr double kInPlane = 1e-13;
/// Closer to the axis than this part of the profile's distance from the axis' origin, the radius is rounding
/// alone.
constexpr double kOnAxis = 1e-14;

/// One parameter of the profile: derivatives, and the principal frame, in the sweep's axes.
struct Station {
  Vec3 d[4];
  Curvature k;
};

/// Sweeps in one form: the axes that the stations' components are along.
struct Sweep {
  bool turned = true;
  bool profile_is_u = false;
  Vec3 origin, x, y, z;  ///< turned: of the axis; else the origin of the profile and space's axes
  Vec3 direction;        ///< not turned
};

/// An umbilic's direction depends on where it is turned to: none here, the kernel finds it.
void leave_direction(Curvature& k) {
  if (k.kind == Curvature::Kind::umbilic) k.d1 = k.d2 = {};
}

/// Curvature in closed form of a profile (ρ, 0, z) turned about z. `handed`: −1 for left-handed axes.
Curvature turned_curvature(const Vec3* d, double handed, double around, double along) {
  Curvature k;
  const double speed = std::hypot(d[1].x, d[1].z), side = d[0].x >= 0 ? 1 : -1;
  k.n = Vec3{d[1].z, 0, -d[1].x} * (side * handed / speed);
  const double k_around = around * handed, k_along = along * handed;
  if (std::abs(k_around - k_along) <= 1e-12 * std::abs(0.5 * (k_around + k_along))) {
    k.k1 = k.k2 = 0.5 * (k_around + k_along);
    k.kind = Curvature::Kind::umbilic;
  } else if (std::abs(k_around) >= std::abs(k_along)) {
    k.k1 = k_around, k.k2 = k_along;
    k.d1 = {0, 1, 0};
  } else {
    k.k1 = k_along, k.k2 = k_around;
    k.d1 = Vec3{d[1].x, 0, d[1].z} / speed;
  }
  k.d2 = cross(k.n, k.d1) * handed;
  if (k_around == 0 && k_along == 0) k.kind = Curvature::Kind::umbilic;
  return k;
}

double handedness(const Frame3& f) {
  return dot(cross(f.x, f.y), f.z) >= 0 ? 1 : -1;
}

class Profile {
 public:
  virtual ~Profile() = default;
  /// order 0 … 3. A station left to the careful has Kind 255.
  virtual Station at(double t, int order, bool from_left) const = 0;
  const Sweep& sweep() const { return sweep_; }

 protected:
  static Curvature careful() {
    Curvature k;
    k.kind = static_cast<Curvature::Kind>(kernels::kCareful);
    return k;
  }
  Sweep sweep_;
};

class AnalyticProfile : public Profile {
 public:
  explicit AnalyticProfile(const Surface& surface) {
    std::visit([this](const auto& s) { set(s); }, surface.geometry);
  }
  Station at(double v, int order, bool) const override {
    Station s;
    if (straight_) {
      s.d[0] = {radius_ + v * rho_rate_, 0, v * z_rate_};
      s.d[1] = {rho_rate_, 0, z_rate_};
      if (!(std::abs(s.d[0].x) > kOnAxis * (radius_ + std::abs(v)))) return s.k = careful(), s;
      s.k = turned_curvature(s.d, handed_, -z_rate_ / std::abs(s.d[0].x), 0);
    } else {
      const TrigJet trig(v, 3);
      for (int j = 0; j < 4; ++j) s.d[j] = {minor_ * trig.c[j], 0, minor_ * trig.s[j]};
      s.d[0].x += radius_;
      const bool sphere = radius_ == 0;
      if (!sphere && !(std::abs(s.d[0].x) > kOnAxis * (radius_ + minor_))) return s.k = careful(), s;
      const double around = sphere ? -1 / minor_ : -trig.c[0] / std::abs(s.d[0].x), along = -1 / minor_;
      s.k = turned_curvature(s.d, handed_, around, s.d[0].x >= 0 ? along : -along);
      if (sphere && !(std::abs(s.d[0].x) > 1e-15 * minor_)) s.k.kind = Curvature::Kind::singular_limit;
    }
    for (int j = order + 1; j < 4; ++j) s.d[j] = {};
    leave_direction(s.k);
    if (s.k.kind == Curvature::Kind::singular_limit) s.k.d1 = s.k.d2 = {};
    return s;
  }

 private:
  void place(const Frame3& f) {
    sweep_ = {true, false, f.origin, f.x, f.y, f.z, {}};
    handed_ = handedness(f);
  }
  void set(const Cylinder& c) { place(c.frame), radius_ = c.radius, straight_ = true, z_rate_ = 1; }
  void set(const Cone& c) {
    place(c.frame), radius_ = c.radius, straight_ = true;
    rho_rate_ = std::sin(c.half_angle), z_rate_ = std::cos(c.half_angle);
  }
  void set(const Sphere& s) { place(s.frame), minor_ = s.radius; }
  void set(const Torus& t) { place(t.frame), radius_ = t.major, minor_ = t.minor; }
  template <class Other>
  void set(const Other&) {}

  bool straight_ = false;
  double radius_ = 0, minor_ = 0, rho_rate_ = 0, z_rate_ = 0, handed_ = 1;
};

/// The vectors that span a curve, as seen from a point: it lies in a plane with that point if they do.
std::vector<Vec3> span_of(const Curve3& curve, const Vec3& from) {
  struct Visitor {
    Vec3 from;
    std::vector<Vec3> operator()(const LineOf<Vec3>& l) const { return {l.origin - from, l.direction}; }
    std::vector<Vec3> operator()(const CircleOf<Vec3>& c) const {
      return {c.center - from, c.x * c.radius, c.y * c.radius};
    }
    std::vector<Vec3> operator()(const EllipseOf<Vec3>& e) const {
      return {e.center - from, e.x * e.major, e.y * e.minor};
    }
    std::vector<Vec3> operator()(const ParabolaOf<Vec3>& p) const { return {p.vertex - from, p.x, p.y}; }
    std::vector<Vec3> operator()(const HyperbolaOf<Vec3>& h) const {
      return {h.center - from, h.x * h.major, h.y * h.minor};
    }
    std::vector<Vec3> operator()(const Bspline3& s) const {
      std::vector<Vec3> out;
      for (const Vec3& pole : s.poles) out.push_back(pole - from);
      return out;
    }
    std::vector<Vec3> operator()(const OffsetCurveOf<Vec3>&) const { return {}; }
  };
  return std::visit(Visitor{from}, curve.geometry);
}

class TurnedProfile : public Profile {
 public:
  explicit TurnedProfile(const Revolution& r) : profile_(r.profile) {
    sweep_.origin = r.axis_origin;
    sweep_.z = r.axis_direction;
    const std::vector<Vec3> vectors = span_of(r.profile, r.axis_origin);
    Vec3 widest;
    double size = 0;
    for (const Vec3& d : vectors) {
      const Vec3 across = d - sweep_.z * dot(sweep_.z, d);
      if (length(across) > length(widest)) widest = across;
      size = std::max(size, length(d));
    }
    sweep_.x = length(widest) > 0 ? normalized(widest) : any_perpendicular(sweep_.z);
    sweep_.y = cross(sweep_.z, sweep_.x);
    in_plane_ = !vectors.empty();
    for (const Vec3& d : vectors) in_plane_ = in_plane_ && std::abs(dot(sweep_.y, d)) <= kInPlane * size;
  }
  Station at(double v, int order, bool from_left) const override {
    Vec3 d[4];
    evaluate_into(profile_, v, 3, d, from_left);
    d[0] -= sweep_.origin;
    const double size = length(d[0]);
    Station s;
    for (int j = 0; j < 4; ++j)
      s.d[j] = {dot(sweep_.x, d[j]), in_plane_ ? 0.0 : dot(sweep_.y, d[j]), dot(sweep_.z, d[j])};
    s.k = in_plane_ ? plane_curvature(s.d, size) : space_curvature(s.d, size);
    for (int j = order + 1; j < 4; ++j) s.d[j] = {};
    leave_direction(s.k);
    return s;
  }

 private:
  static Curvature plane_curvature(const Vec3* d, double size) {
    const double speed = std::hypot(d[1].x, d[1].z), rho = std::abs(d[0].x), side = d[0].x >= 0 ? 1 : -1;
    if (!(rho > kOnAxis * size) || !(speed > 0)) return careful();
    const double bend = d[2].x * d[1].z - d[2].z * d[1].x;
    return turned_curvature(d, 1, -d[1].z / (speed * rho), side * bend / (speed * speed * speed));
  }
  static Curvature space_curvature(const Vec3* d, double size) {
    if (!(std::hypot(d[0].x, d[0].y) > kOnAxis * size)) return careful();
    SurfaceJet jet;
    jet.pu = {-d[0].y, d[0].x, 0};
    jet.pv = d[1];
    jet.puu = {-d[0].x, -d[0].y, 0};
    jet.puv = {-d[1].y, d[1].x, 0};
    jet.pvv = d[2];
    const Curvature k = principal_curvature(jet);
    return k.kind == Curvature::Kind::undefined ? careful() : k;
  }
  const Curve3& profile_;
  bool in_plane_ = false;
};

class MovedProfile : public Profile {
 public:
  MovedProfile(const Curve3& profile, const Vec3& direction) : profile_(profile) {
    sweep_.turned = false;
    sweep_.profile_is_u = true;
    sweep_.x = {1, 0, 0}, sweep_.y = {0, 1, 0}, sweep_.z = {0, 0, 1};
    sweep_.direction = direction;
  }
  Station at(double u, int order, bool from_left) const override {
    Station s;
    evaluate_into(profile_, u, 3, s.d, from_left);
    const Vec3& direction = sweep_.direction;
    const Vec3 normal = cross(s.d[1], direction),
               across = cross(direction, normal);  // Su less its part along
    const double l = length(normal);
    if (!(l > 1e-12 * length(s.d[1]))) {
      s.k = careful();
    } else {
      s.k.n = normal / l;
      s.k.k1 = dot(s.d[2], s.k.n) / (l * l);
      const bool flat = std::abs(s.k.k1) <= 1e-15 * length(s.d[2]) / (l * l);
      if (flat)
        s.k.kind = Curvature::Kind::umbilic, s.k.k1 = 0;
      else
        s.k.d1 = normalized(across), s.k.d2 = cross(s.k.n, s.k.d1);
    }
    for (int j = order + 1; j < 4; ++j) s.d[j] = {};
    return s;
  }

 private:
  const Curve3& profile_;
};

/// Stations as the arrays that the kernel reads.
class Stations {
 public:
  Stations(const Profile& profile, std::span<const double> t, int order, bool from_left) {
    for (auto* arrays : {&values_}) arrays->resize(kArrays * t.size());
    kinds_.resize(t.size());
    count_ = t.size();
    for (std::size_t i = 0; i < count_; ++i) set(i, profile.at(t[i], order, from_left));
  }
  void point_to(std::size_t i, std::size_t stride, SweptJob& job) const {
    for (std::size_t c = 0; c < 12; ++c) job.profile[c] = &values_[c * count_ + i];
    for (std::size_t c = 0; c < 9; ++c) job.frame[c] = &values_[(12 + c) * count_ + i];
    for (std::size_t c = 0; c < 2; ++c) job.k[c] = &values_[(21 + c) * count_ + i];
    job.kind = &kinds_[i];
    job.profile_stride = stride;
  }

 private:
  static constexpr std::size_t kArrays = 23;
  void set(std::size_t i, const Station& s) {
    const Vec3* const vectors[] = {&s.d[0], &s.d[1], &s.d[2], &s.d[3], &s.k.n, &s.k.d1, &s.k.d2};
    for (std::size_t a = 0; a < 7; ++a)
      for (int c = 0; c < 3; ++c)
        values_[(3 * a + static_cast<std::size_t>(c)) * count_ + i] = (*vectors[a])[c];
    values_[21 * count_ + i] = s.k.k1;
    values_[22 * count_ + i] = s.k.k2;
    kinds_[i] = static_cast<std::uint8_t>(s.k.kind);
  }
  std::size_t count_ = 0;
  std::vector<double> values_;
  std::vector<std::uint8_t> kinds_;
};

struct Angles {
  std::vector<double> cosine, sine;
  explicit Angles(std::span<const double> u) : cosine(u.size()), sine(u.size()) {
    for (std::size_t i = 0; i < u.size(); ++i) cosine[i] = std::cos(u[i]), sine[i] = std::sin(u[i]);
  }
};

class SweptFamily : public BatchFamily {
 public:
  explicit SweptFamily(const Surface& surface) : surface_(surface) {
    const auto& geometry = surface.geometry;
    if (const auto* plane = std::get_if<Plane>(&geometry)) {
      line_ = {LineOf<Vec3>{plane->frame.origin, plane->frame.x}};
      profile_ = std::make_unique<MovedProfile>(line_, plane->frame.y);
    } else if (const auto* extrusion = std::get_if<Extrusion>(&geometry)) {
      profile_ = std::make_unique<MovedProfile>(extrusion->profile, extrusion->direction);
    } else if (const auto* revolution = std::get_if<Revolution>(&geometry)) {
      profile_ = std::make_unique<TurnedProfile>(*revolution);
    } else {
      profile_ = std::make_unique<AnalyticProfile>(surface);
    }
  }

  void grid(const Batch& batch) const override {
    const bool of_u = profile_->sweep().profile_is_u;
    const std::span<const double> along = of_u ? batch.u : batch.v;
    const Stations stations(*profile_, along, batch.wanted.order, from_left(batch));
    const Angles angles(of_u ? std::span<const double>{} : batch.u);
    const std::size_t columns = batch.v.size();
    if (columns == 0) return;
    parallel_for(
        batch.u.size(),
        [&](std::size_t i) {
          SweptJob job = empty_job(batch, i * columns, columns);
          if (of_u) {
            stations.point_to(i, 0, job);
            job.length = batch.v.data(), job.sweep_stride = 1;
          } else {
            stations.point_to(0, 1, job);
            job.cosine = &angles.cosine[i], job.sine = &angles.sine[i], job.sweep_stride = 0;
          }
          kernels::swept(job, batch.scalar);
          repair(batch, job, [&](std::size_t j) { return Vec2{batch.u[i], batch.v[j]}; });
        },
        std::max<std::size_t>(1, kSamplesATask / columns));
  }

  void scattered(const Batch& batch) const override {
    const bool of_u = profile_->sweep().profile_is_u;
    const std::size_t tasks = (batch.u.size() + kSamplesATask - 1) / kSamplesATask;
    parallel_for(tasks, [&](std::size_t task) {
      const std::size_t first = task * kSamplesATask, count = std::min(kSamplesATask, batch.u.size() - first);
      const auto u = batch.u.subspan(first, count), v = batch.v.subspan(first, count);
      const Stations stations(*profile_, of_u ? u : v, batch.wanted.order, from_left(batch));
      const Angles angles(of_u ? std::span<const double>{} : u);
      SweptJob job = empty_job(batch, first, count);
      stations.point_to(0, 1, job);
      job.sweep_stride = 1;
      job.cosine = angles.cosine.data(), job.sine = angles.sine.data();
      job.length = v.data();
      kernels::swept(job, batch.scalar);
      repair(batch, job, [&](std::size_t i) { return Vec2{u[i], v[i]}; });
    });
  }

 private:
  bool from_left(const Batch& batch) const {
    return profile_->sweep().profile_is_u ? batch.sides.u_from_left : batch.sides.v_from_left;
  }
  SweptJob empty_job(const Batch& batch, std::size_t first, std::size_t count) const {
    const Sweep& sweep = profile_->sweep();
    SweptJob job;
    job.turned = sweep.turned;
    job.origin = sweep.origin, job.x = sweep.x, job.y = sweep.y, job.z = sweep.z;
    job.direction = sweep.direction;
    job.count = count;
    job.wanted = batch.wanted;
    job.out = &batch.out;
    job.first = first;
    return job;
  }
  template <class At>
  void repair(const Batch& batch, const SweptJob& job, const At& at) const {
    if (!batch.out.kind) return;
    for (std::size_t i = 0; i < job.count; ++i) {
      if (batch.out.kind[job.first + i] != kernels::kCareful) continue;
      const Vec2 uv = at(i);
      const SurfaceJet jet = evaluate(surface_, uv.x, uv.y, batch.wanted.order, batch.sides);
      store(jet, careful_curvature(surface_, uv.x, uv.y), batch.wanted, batch.out_at(job.first + i));
    }
  }

  const Surface& surface_;
  Curve3 line_;
  std::unique_ptr<Profile> profile_;
};

}  // namespace

std::unique_ptr<BatchFamily> make_swept_family(const Surface& surface) {
  return std::make_unique<SweptFamily>(surface);
}

}  // namespace dupin
