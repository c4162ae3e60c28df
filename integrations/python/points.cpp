#include "points.h"

#include <cstddef>

#include "../../core/parallel.h"

namespace dupin::python {

static_assert(offsetof(DifferentialPoint, lambda_v) ==
              offsetof(DifferentialPoint, lambda_u) + sizeof(double));
static_assert(offsetof(DifferentialPoint, half_v) == offsetof(DifferentialPoint, half_u) + sizeof(double));
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Vec2) == 2 * sizeof(double));

namespace {

constexpr auto kStride = static_cast<py::ssize_t>(sizeof(DifferentialPoint));
constexpr auto kDouble = static_cast<py::ssize_t>(sizeof(double));
constexpr std::size_t kGrain = 4096;

bool is_identity(const Affine3& t) {
  return t == Affine3{};
}

}  // namespace

Points::Points(const Model& model, PointScene scene) : notes_(std::move(scene.notes)) {
  for (const PartPoints& part : scene.parts)
    for (const SkippedFace& face : part.skipped) skipped_.emplace_back(face.name, face.reason);
  if (model.instances.size() == 1 && is_identity(model.instances[0].to_world)) {
    *points_ = std::move(scene.parts[model.instances[0].part].points);
    ends_ = {points_->size()};
    return;
  }
  std::size_t total = 0;
  for (const Instance& instance : model.instances)
    ends_.push_back(total += scene.parts[instance.part].points.size());
  points_->resize(total);
  std::size_t first = 0;
  for (std::size_t i = 0; i < model.instances.size(); ++i) {
    const List& own = scene.parts[model.instances[i].part].points;
    parallel_for(
        own.size(),
        [&](std::size_t k) { (*points_)[first + k] = placed(own[k], model.instances[i].to_world); }, kGrain);
    first = ends_[i];
  }
}

py::array_t<double> Points::vectors(Vec3 DifferentialPoint::*member) const {
  const auto count = static_cast<py::ssize_t>(size());
  const double* data = count ? &((*points_)[0].*member).x : nullptr;
  return view_of<double>(points_, data, {count, 3}, {kStride, kDouble});
}

py::array_t<double> Points::pairs(double DifferentialPoint::*first) const {
  const auto count = static_cast<py::ssize_t>(size());
  const double* data = count ? &((*points_)[0].*first) : nullptr;
  return view_of<double>(points_, data, {count, 2}, {kStride, kDouble});
}

py::array_t<double> Points::uv() const {
  const auto count = static_cast<py::ssize_t>(size());
  const double* data = count ? &(*points_)[0].uv.x : nullptr;
  return view_of<double>(points_, data, {count, 2}, {kStride, kDouble});
}

py::array_t<double> Points::bounds() const {
  const auto count = static_cast<py::ssize_t>(size());
  return view_of<double>(points_, count ? &(*points_)[0].bound : nullptr, {count}, {kStride});
}

py::array_t<std::uint32_t> Points::faces() const {
  const auto count = static_cast<py::ssize_t>(size());
  return view_of<std::uint32_t>(points_, count ? &(*points_)[0].face : nullptr, {count}, {kStride});
}

py::array_t<double> Points::normals() const {
  auto values = std::make_shared<std::unique_ptr<double[]>>(new double[3 * size()]);
  double* const out = values->get();
  {
    const py::gil_scoped_release release;
    parallel_for(
        size(),
        [&](std::size_t i) {
          const Vec3 n = (*points_)[i].n();
          out[3 * i] = n.x, out[3 * i + 1] = n.y, out[3 * i + 2] = n.z;
        },
        kGrain);
  }
  return view_of<double>(values, out, {static_cast<py::ssize_t>(size()), 3});
}

py::array_t<std::uint32_t> Points::instances() const {
  std::vector<std::uint32_t> numbers(size());
  std::size_t first = 0;
  for (std::size_t i = 0; i < ends_.size(); first = ends_[i++])
    std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(first),
              numbers.begin() + static_cast<std::ptrdiff_t>(ends_[i]), static_cast<std::uint32_t>(i));
  const auto count = static_cast<py::ssize_t>(size());
  return array_of(std::move(numbers), {count});
}

}  // namespace dupin::python
