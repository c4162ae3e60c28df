#include "prepared_model.h"

#include <algorithm>

#include "../sampling/sampler.h"
#include "../simplify/point_tree.h"

namespace dupin {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

Status make_trees(const Model& model, const Progress& progress, std::vector<PartTree>& trees) {
  for (const Part& part : model.parts) {
    PartTree& tree = trees.emplace_back();
    tree.first_face = static_cast<std::uint32_t>(part.faces.size());
    if (part.polygons.empty()) continue;
    PointTreeOptions options;
    options.progress = progress;
    auto built = build_point_tree(part.polygons, options);
    if (!built) return built.status();
    tree.tree = std::move(*built);
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<const PreparedModel>> prepare(std::shared_ptr<const Model> model,
                                                     const PrepareOptions& options) {
  if (!model) return {StatusCode::invalid_argument, "there is no model to prepare"};
  if (!(options.tolerance >= 0) || !(options.normal_tolerance > 0) || !(options.tolerance_px > 0))
    return {StatusCode::invalid_argument, "tolerances must be positive"};
  auto prepared = std::make_shared<PreparedModel>();
  const double diagonal = bounding_box(*model).diagonal();
  prepared->tolerance = options.tolerance > 0 ? options.tolerance : kDefaultTolerance * diagonal;
  SamplingOptions sampling;
  // A model without an extent (a single point, nothing) has nothing to be sampled either.
  sampling.tolerance = prepared->tolerance > 0 ? prepared->tolerance : 1;
  sampling.normal_tolerance = options.normal_tolerance;
  sampling.camera = options.camera;
  sampling.tolerance_px = options.tolerance_px;
  sampling.progress = options.progress;
  if (!report(options.progress, "prepare", 0)) return {StatusCode::cancelled, "preparing was stopped"};
  auto dps = sample_quadric_dps(*model, sampling);
  if (!dps) return dps.status();
  prepared->dps = std::move(*dps);
  if (const Status status = make_trees(*model, options.progress, prepared->trees); !status.ok())
    return status;
  prepared->model = std::move(model);
  if (!report(options.progress, "prepare", 1)) return {StatusCode::cancelled, "preparing was stopped"};
  return std::shared_ptr<const PreparedModel>(std::move(prepared));
}

PreparedModel joined(const std::vector<std::shared_ptr<const PreparedModel>>& models) {
  PreparedModel all;
  auto model = std::make_shared<Model>();
  for (const auto& one : models) {
    const auto first = static_cast<std::uint32_t>(model->parts.size());
    for (Instance instance : one->model->instances) {
      instance.part += first;
      model->instances.push_back(std::move(instance));
    }
    append(model->parts, one->model->parts);
    append(model->skipped, one->model->skipped);
    append(all.dps.parts, one->dps.parts);
    append(all.trees, one->trees);
    all.dps.bound = std::max(all.dps.bound, one->dps.bound);
    all.dps.normal_bound = std::max(all.dps.normal_bound, one->dps.normal_bound);
    all.tolerance = all.tolerance > 0 ? std::min(all.tolerance, one->tolerance) : one->tolerance;
  }
  all.model = std::move(model);
  return all;
}

}  // namespace dupin
