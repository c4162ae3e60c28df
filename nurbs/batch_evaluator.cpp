#include "batch_evaluator.h"

#include <algorithm>

#include "../core/parallel.h"
#include "batch_families.h"

namespace dupin {

using kernels::Outputs;
using kernels::Wanted;

Outputs Batch::out_at(std::size_t sample) const {
  Outputs at = out;
  for (double*& channel : at.at)
    if (channel) channel += sample;
  if (at.kind) at.kind += sample;
  return at;
}

namespace {

void put(const Outputs& out, int channel, const Vec3& value) {
  for (int c = 0; c < 3; ++c)
    if (out.at[channel + c]) *out.at[channel + c] = value[c];
}
void put(const Outputs& out, int channel, double value) {
  if (out.at[channel]) *out.at[channel] = value;
}

class SingleFamily : public BatchFamily {
 public:
  explicit SingleFamily(const Surface& surface) : surface_(surface) {}
  void grid(const Batch& batch) const override {
    parallel_for(batch.u.size(), [&](std::size_t i) {
      for (std::size_t j = 0; j < batch.v.size(); ++j)
        sample(batch, batch.u[i], batch.v[j], i * batch.v.size() + j);
    });
  }
  void scattered(const Batch& batch) const override {
    parallel_for(
        batch.u.size(), [&](std::size_t i) { sample(batch, batch.u[i], batch.v[i], i); }, 256);
  }

 private:
  void sample(const Batch& batch, double u, double v, std::size_t to) const {
    const bool needs_curvature = batch.wanted.normal || batch.wanted.curvature;
    const int order = needs_curvature ? std::max(batch.wanted.order, 2) : batch.wanted.order;
    const SurfaceJet jet = evaluate(surface_, u, v, order, batch.sides);
    Curvature k;
    if (needs_curvature) {
      const bool sided = batch.sides.u_from_left || batch.sides.v_from_left;
      k = sided ? principal_curvature(jet) : careful_curvature(surface_, u, v);
    }
    store(jet, k, batch.wanted, batch.out_at(to));
  }
  const Surface& surface_;
};

Wanted wanted(Compute compute, int max_order) {
  Wanted w;
  if (has(compute, Compute::first_derivatives)) w.order = 1;
  if (has(compute, Compute::normals)) w.order = 1, w.normal = true;
  w.curvature = has(compute, Compute::curvatures | Compute::directions | Compute::mean_and_gauss);
  if (w.curvature || has(compute, Compute::second_derivatives)) w.order = 2;
  if (has(compute, Compute::third_derivatives)) w.order = 3;
  w.order = std::min(w.order, max_order);
  return w;
}

/// Hands out equally long arrays of one piece of memory: aligned to the widest lanes, and an odd number of
/// cache lines apart, so that samples of several arrays do not compete for the same place in the cache.
class Arrays {
 public:
  Arrays(std::size_t arrays, std::size_t count, std::vector<double>& memory) : count_(count) {
    constexpr std::size_t kLine = 8;
    stride_ = ((count + kLine - 1) / kLine | 1) * kLine;
    const std::size_t needed = arrays * stride_ + kLine;
    if (memory.size() < needed) {
      memory.clear();
      memory.resize(needed);
    }
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data()) / sizeof(double);
    next_ = memory.data() + (kLine - address % kLine) % kLine;
  }
  std::span<const double> take(int channel, Outputs& out) {
    out.at[static_cast<std::size_t>(channel)] = next_;
    const std::span<const double> values(next_, count_);
    next_ += stride_;
    return values;
  }

 private:
  std::size_t count_, stride_;
  double* next_;
};

/// The arrays of a SurfaceSamples, and the channels that they stand for.
struct Fields {
  struct Vectors {
    Compute what;
    int order, channel;
    Vec3Array* array;
  };
  struct Numbers {
    Compute what;
    int channel;
    std::span<const double>* array;
  };
  std::vector<Vectors> vectors;
  std::vector<Numbers> numbers;

  explicit Fields(SurfaceSamples& s) {
    Vec3Array* const jets[] = {&s.p,   &s.pu,   &s.pv,   &s.puu,  &s.puv,
                               &s.pvv, &s.puuu, &s.puuv, &s.puvv, &s.pvvv};
    for (int order = 0; order <= 3; ++order)
      for (int j = 0; j <= order; ++j) {
        const int m = jet_index(order - j, j);
        vectors.push_back({static_cast<Compute>(1u << order), order, kernels::kJet + 3 * m, jets[m]});
      }
    vectors.push_back({Compute::normals, 1, kernels::kNormal, &s.n});
    vectors.push_back({Compute::directions, 2, kernels::kDirection1, &s.d1});
    vectors.push_back({Compute::directions, 2, kernels::kDirection2, &s.d2});
    numbers = {{Compute::curvatures, kernels::kK1, &s.k1},
               {Compute::curvatures, kernels::kK2, &s.k2},
               {Compute::mean_and_gauss, kernels::kMean, &s.mean},
               {Compute::mean_and_gauss, kernels::kGauss, &s.gauss}};
  }
};

Outputs prepare(Compute compute, int max_order, std::size_t count, SurfaceSamples& samples,
                std::vector<double>& memory) {
  Outputs out;
  const Fields fields(samples);
  const auto wanted_vectors = [&](const Fields::Vectors& f) {
    return has(compute, f.what) && f.order <= max_order;
  };
  std::size_t arrays = 0;
  for (const auto& f : fields.vectors) arrays += wanted_vectors(f) ? 3 : 0;
  for (const auto& f : fields.numbers) arrays += has(compute, f.what) ? 1 : 0;
  Arrays next(arrays, count, memory);
  for (const auto& f : fields.vectors) {
    *f.array = {};
    if (!wanted_vectors(f)) continue;
    f.array->x = next.take(f.channel, out);
    f.array->y = next.take(f.channel + 1, out);
    f.array->z = next.take(f.channel + 2, out);
  }
  for (const auto& f : fields.numbers)
    *f.array = has(compute, f.what) ? next.take(f.channel, out) : std::span<const double>{};
  samples.count = count;
  return out;
}

Vec2 middle_of(const Surface& surface, double u, double v) {
  const Box2 box = domain(surface);
  const auto middle = [](double lo, double hi, double at) {
    return std::isfinite(lo) && std::isfinite(hi) ? 0.5 * (lo + hi) : at < 1 ? at + 1 : at - 1;
  };
  return {middle(box.lo.x, box.hi.x, u), middle(box.lo.y, box.hi.y, v)};
}

}  // namespace

void store(const SurfaceJet& jet, const Curvature& k, const Wanted& wanted, const Outputs& out) {
  const Vec3* jets = &jet.p;
  for (int m = 0; m < jet_size(wanted.order); ++m) put(out, kernels::kJet + 3 * m, jets[m]);
  put(out, kernels::kNormal, k.n);
  put(out, kernels::kDirection1, k.d1);
  put(out, kernels::kDirection2, k.d2);
  put(out, kernels::kK1, k.k1);
  put(out, kernels::kK2, k.k2);
  put(out, kernels::kMean, 0.5 * (k.k1 + k.k2));
  put(out, kernels::kGauss, k.k1 * k.k2);
  if (out.kind) *out.kind = static_cast<std::uint8_t>(k.kind);
}

Curvature careful_curvature(const Surface& surface, double u, double v) {
  return principal_curvature(surface, u, v, middle_of(surface, u, v));
}

std::unique_ptr<BatchFamily> make_single_family(const Surface& surface) {
  return std::make_unique<SingleFamily>(surface);
}

class BatchEvaluator::Impl {
 public:
  Impl(Surface surface, int max_order)
      : surface_(std::move(surface)), max_order_(std::clamp(max_order, 2, 3)) {
    if (const auto* spline = std::get_if<BsplineSurface>(&surface_.geometry))
      family_ = make_spline_family(*spline, surface_, max_order_);
    else if (std::holds_alternative<OffsetSurface>(surface_.geometry))
      family_ = make_single_family(surface_);
    else
      family_ = make_swept_family(surface_);
  }
  const Surface& surface() const { return surface_; }

  int max_order() const { return max_order_; }
  const BatchFamily& family() const { return *family_; }

 private:
  const Surface surface_;
  const int max_order_;
  std::unique_ptr<BatchFamily> family_;
};

Result<BatchEvaluator> BatchEvaluator::make(Surface surface, int max_order) {
  if (Status status = check(surface); !status.ok()) return status;
  return BatchEvaluator(std::make_unique<Impl>(std::move(surface), max_order));
}
BatchEvaluator::BatchEvaluator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BatchEvaluator::BatchEvaluator(BatchEvaluator&&) noexcept = default;
BatchEvaluator& BatchEvaluator::operator=(BatchEvaluator&&) noexcept = default;
BatchEvaluator::~BatchEvaluator() = default;

void BatchEvaluator::run(std::span<const double> u, std::span<const double> v, std::size_t count, bool grid,
                         const BatchOptions& options, SurfaceSamples& out) const {
  static_assert(sizeof(Curvature::Kind) == sizeof(std::uint8_t));
  const int max_order = impl_->max_order();
  Batch batch{u, v, wanted(options.compute, max_order), options.sides, options.scalar, {}};
  batch.out = prepare(options.compute, max_order, count, out, out.values_);
  const bool kinds = batch.wanted.normal || batch.wanted.curvature;
  if (kinds && out.kinds_.size() < count) out.kinds_.resize(count);
  out.kind =
      kinds ? std::span<const Curvature::Kind>(out.kinds_).first(count) : std::span<const Curvature::Kind>{};
  if (kinds) batch.out.kind = reinterpret_cast<std::uint8_t*>(out.kinds_.data());
  if (count == 0) return;
  if (grid)
    impl_->family().grid(batch);
  else
    impl_->family().scattered(batch);
}

void BatchEvaluator::grid(std::span<const double> u, std::span<const double> v, const BatchOptions& options,
                          SurfaceSamples& out) const {
  run(u, v, u.size() * v.size(), true, options, out);
}

void BatchEvaluator::scattered(std::span<const double> u, std::span<const double> v,
                               const BatchOptions& options, SurfaceSamples& out) const {
  const std::size_t count = std::min(u.size(), v.size());
  run(u.first(count), v.first(count), count, false, options, out);
}

const Surface& BatchEvaluator::surface() const {
  return impl_->surface();
}

const char* batch_instruction_set() {
  return kernels::instruction_set();
}

}  // namespace dupin
