#include "measure.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "../../render/metrics.h"
#include "../../simplify/dp_codec.h"
#include "../load.h"
#include "../render_primitive.h"
#include "../stopwatch.h"
#include "agreement.h"
#include "journal.h"
#include "processor_clock.h"
#include "truth.h"

namespace dupin::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kWarmUps = 2;  // frames before any is timed: programs are compiled by the first
constexpr unsigned kErrorOutputs = kColor | kNormal | kDepth;
constexpr std::size_t kTriangleFaceBytes = 4;  // kept for AOVs; no renderer of triangles needs it

/// One row on its way.
struct Case {
  const StudyRow* row = nullptr;
  const Model* model = nullptr;  ///< with the meshes that it needs
  std::unique_ptr<RenderPrimitive> primitive;
  std::unique_ptr<Scene> scene;
  RenderStats stats;
  std::unique_ptr<Loaded> own;  ///< of a file that is prepared already: what was read from it
  std::vector<double> prepares, prepare_cpus, frames, frame_cpus;
  RowResult result;
  bool failed() const { return !result.failure.empty(); }
  void fail(const Status& status) { result.failure = status.message.empty() ? "failed" : status.message; }
};

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::lround(part * last))];
}

Json finite(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

void add_difference(const PictureDifference& d, Json& json) {
  json["covered_px"] = d.covered_b;
  json["reference_covered_px"] = d.covered_a;
  if (d.color) {
    json["rmse"] = d.color->rmse;
    json["rmse_covered"] = d.color->rmse_covered;
    json["psnr"] = finite(d.color->psnr);
    json["ssim"] = d.color->ssim;
    json["flip"] = d.color->flip;
  }
  json["silhouette_px"] = d.silhouette;
  json["outline_p99_px"] = finite(d.outline_px.p99);
  json["outline_max_px"] = finite(d.outline_px.max);
  if (!d.geometry) return;
  json["holes_px"] = d.geometry->holes;
  json["extra_px"] = d.geometry->extra;
  json["depth_p50_px"] = finite(d.geometry->depth_px.p50);
  json["depth_p99_px"] = finite(d.geometry->depth_px.p99);
  json["depth_max_px"] = finite(d.geometry->depth_px.max);
  json["normal_p50_degrees"] = d.geometry->normal_degrees.p50;
  json["normal_p99_degrees"] = d.geometry->normal_degrees.p99;
  json["normal_max_degrees"] = d.geometry->normal_degrees.max;
}

void add_agreement(const Agreement& a, Json& json) {
  json["agreeing_px"] = a.pixels;
  if (a.pixels == 0) return;
  json["agreeing_color_p99"] = a.color_p99;
  json["agreeing_color_max"] = a.color_max;
}

void add_preparation(const Case& c, Json& json) {
  json["faces"] = c.stats.faces.total();
  json["faces_skipped"] = c.stats.faces.skipped.size();
  if (c.stats.error) {
    json["bound"] = c.stats.error->bound;
    json["bound_px"] = c.stats.error->bound_px;
    json["normal_bound_degrees"] = c.stats.error->normal_bound_degrees;
  }
  if (!c.stats.sampled) return;
  json["points_before"] = c.stats.sampled->before;
  json["points"] = c.stats.sampled->after;
  json["packed_bytes"] = c.stats.sampled->after * kPackedBytes;
}

void add_times(const Case& c, Json& json) {
  json["prepare_s"] = quantile(c.prepares, 0.5);
  json["prepare_least_s"] = quantile(c.prepares, 0);
  json["prepare_most_s"] = quantile(c.prepares, 1);
  if (!c.prepare_cpus.empty()) json["prepare_cpu_s"] = quantile(c.prepare_cpus, 0.5);
  if (c.stats.sampled) {
    json["sample_s"] = c.stats.sampled->sample_seconds;
    json["simplify_s"] = c.stats.sampled->simplify_seconds;
  }
  json["upload_s"] = c.stats.times.upload;
  if (c.frames.empty()) return;
  json["frame_ms"] = quantile(c.frames, 0.5);
  json["frame_p10_ms"] = quantile(c.frames, 0.1);
  json["frame_p90_ms"] = quantile(c.frames, 0.9);
  json["frame_cpu_ms"] = quantile(c.frame_cpus, 0.5);
  json["frames"] = c.frames.size();
}

DrawOptions draw_options(const RenderOptions& options) {
  DrawOptions draw;
  draw.outputs = kErrorOutputs;
  const auto shading = std::find(std::begin(kShadingNames), std::end(kShadingNames), options.shading);
  draw.shading = static_cast<Shading>(shading - std::begin(kShadingNames));
  draw.edges = options.edges;
  draw.background.reset();
  if (options.background != "none") draw.background = options.background_color();
  draw.color = options.uniform_color();
  draw.samples = options.sample_count();
  for (const Vec3& position : options.light_positions()) draw.lights.push_back({position});
  return draw;
}

}  // namespace

class Measurer::Impl {
 public:
  Impl(const Study& study, const CommonOptions& common, std::string folder)
      : study_(study), session_(common), folder_(std::move(folder)) {}

  void measure(const std::vector<const StudyRow*>& rows, const MeasureHooks& hooks) {
    std::vector<Case> cases(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      cases[i].row = rows[i];
      cases[i].result.row = rows[i]->index;
    }
    hooks.at(rows.front()->index);
    const Status status = begin(*rows.front());
    each(cases, hooks, [&](Case& c) { return status.ok() ? load(c) : status; });
    for (int i = 0; i < study_.prepares; ++i) each(cases, hooks, [&](Case& c) { return prepare(c, i); });
    if (study_.draw) draw_all(cases, hooks);
    for (Case& c : cases) finish(c, hooks);
  }

  std::string gl_renderer() const { return renderer_ ? renderer_->gl_renderer() : std::string(); }

 private:
  /// A model at one deflection, and what every meshing of it took.
  struct Meshed {
    Loaded loaded;
    std::vector<double> mesh_seconds;
  };

  /// A step of every row that has not failed.
  template <class Step>
  static void each(std::vector<Case>& cases, const MeasureHooks& hooks, const Step& step) {
    for (Case& c : cases) {
      if (c.failed()) continue;
      hooks.at(c.row->index);
      if (const Status status = step(c); !status.ok()) c.fail(status);
    }
  }

  /// The model, and the camera of the rows.
  Status begin(const StudyRow& row) {
    const Result<const Meshed*> model = base(row);
    if (!model.ok()) return model.status();
    const bool has_faces = row.model.kind() == ModelKind::cad || !row.model.of.empty();
    if (!truth_) truth_ = std::make_unique<Truth>((*model)->loaded.model, has_faces);
    const Result<Camera> camera = truth_->camera(row);
    if (!camera.ok()) return camera.status();
    camera_ = *camera;
    const std::string shown =
        row.view.name + " " + std::to_string(row.width) + "x" + std::to_string(row.height);
    if (shown != shown_) references_.clear();
    shown_ = shown;
    return {};
  }

  /// What a row's picture is meant to show.
  Result<const Meshed*> base(const StudyRow& row) {
    if (row.model.kind() != ModelKind::points || !row.model.of.empty()) return meshed(row.model, 0);
    if (const auto at = models_.find(0); at != models_.end()) return &at->second;
    Result<Loaded> loaded = make_primitive(row.render)->load(session_, row.render);
    if (!loaded.ok()) return loaded.status();
    return &models_.emplace(0, Meshed{std::move(*loaded), {}}).first->second;
  }

  Result<const Meshed*> meshed(const StudyModel& model, double deflection) {
    if (const auto at = models_.find(deflection); at != models_.end()) return &at->second;
    Meshed made;
    for (int i = 0; i < (deflection > 0 ? study_.prepares : 1); ++i) {
      Result<Loaded> loaded = app::load(session_, {model.reference_path()}, {deflection});
      if (!loaded.ok()) return loaded.status();
      made.mesh_seconds.push_back(loaded->model.mesh_seconds);
      made.loaded = std::move(*loaded);
    }
    if (face_instance_count(made.loaded.model) == 0 && made.loaded.model.skipped.empty())
      return {StatusCode::unreadable, model.name + ": holds no faces"};
    return &models_.emplace(deflection, std::move(made)).first->second;
  }

  Status load(Case& c) {
    c.primitive = make_primitive(c.row->render);
    describe(c);
    if (c.row->is_prepared()) return {};
    const Result<const Meshed*> model = meshed(c.row->model, c.primitive->deflection(c.row->render));
    if (!model.ok()) return model.status();
    c.model = &(*model)->loaded.model;
    c.result.times["import_s"] = (*model)->loaded.import_seconds;
    return {};
  }

  void describe(Case& c) const {
    c.result.command = "dupin render " + c.row->model.name + " -o picture.png " + camera_arguments(camera_) +
                       (c.row->value_of("samples").empty() ? " --samples 1" : "") +
                       (c.row->value_of("edges").empty() ? " --no-edges " : " ") + c.row->arguments();
  }

  Status prepare(Case& c, int turn) {
    c.primitive = make_primitive(c.row->render);
    if (c.row->is_prepared()) return read_prepared(c);
    Meshed& meshed = models_.at(c.primitive->deflection(c.row->render));
    meshed.loaded.model.mesh_seconds =
        meshed.mesh_seconds[static_cast<std::size_t>(turn) % meshed.mesh_seconds.size()];
    const double before = processor_seconds();
    const Status status =
        c.primitive->prepare({*c.model, camera_, c.row->render, session_.progress()}, c.stats);
    c.prepares.push_back(c.stats.times.prepare);
    // The tessellation runs in another process.
    if (c.primitive->deflection(c.row->render) == 0) c.prepare_cpus.push_back(processor_seconds() - before);
    return status;
  }

  /// Of a file that holds what is drawn, reading is the preparation.
  Status read_prepared(Case& c) {
    const double before = processor_seconds();
    Result<Loaded> loaded = c.primitive->load(session_, c.row->render);
    if (!loaded.ok()) return loaded.status();
    c.own = std::make_unique<Loaded>(std::move(*loaded));
    c.model = &c.own->model;
    const Status status =
        c.primitive->prepare({*c.model, camera_, c.row->render, session_.progress()}, c.stats);
    c.prepares.push_back(c.own->import_seconds + c.stats.times.prepare);
    c.prepare_cpus.push_back(processor_seconds() - before);
    return status;
  }

  Status make_device() {
    if (renderer_) return {};
    auto context = create_context(Device::automatic);
    if (!context.ok()) return context.status();
    auto renderer = Renderer::create((*context)->loader());
    if (!renderer.ok()) return renderer.status();
    context_ = std::move(*context);
    renderer_ = std::move(*renderer);
    return {};
  }

  void draw_all(std::vector<Case>& cases, const MeasureHooks& hooks) {
    each(cases, hooks, [&](Case& c) { return upload(c); });
    for (int i = 0; i < (study_.frames > 0 ? study_.frames + kWarmUps : 0); ++i)
      each(cases, hooks, [&](Case& c) { return time_frame(c, i >= kWarmUps); });
    each(cases, hooks, [&](Case& c) { return judge(c); });
  }

  Status upload(Case& c) {
    if (const Status status = make_device(); !status.ok()) return status;
    Stopwatch watch;
    auto scene = renderer_->upload(*c.model, c.primitive->content());
    if (!scene.ok()) return scene.status();
    c.stats.times.upload = watch.lap();
    c.scene = std::move(*scene);
    const SceneInfo& info = c.scene->info();
    const bool triangles = c.primitive->kind() == "triangles";
    c.result.results["primitives"] = info.primitives;
    c.result.results["bytes"] = info.bytes - (triangles ? kTriangleFaceBytes * info.primitives : 0);
    c.result.results["clips"] = info.clips;
    return {};
  }

  Status time_frame(Case& c, bool counts) {
    DrawOptions draw = draw_options(c.row->render);
    draw.outputs = kScreen;
    const double before = processor_seconds();
    const Result<FrameStats> frame = renderer_->draw_only(*c.scene, camera_, draw);
    if (!frame.ok()) return frame.status();
    if (!counts) return {};
    c.frames.push_back(frame->milliseconds);
    c.frame_cpus.push_back(1e3 * (processor_seconds() - before));
    return {};
  }

  Status judge(Case& c) {
    Result<Frame> frame = renderer_->draw(*c.scene, camera_, draw_options(c.row->render));
    if (!frame.ok()) return frame.status();
    const Image picture = to_image(*frame);
    if (study_.reference == ReferenceKind::none) {
      c.result.results["covered_px"] = frame->stats.covered_pixels;
      return study_.pictures ? keep_picture(c, picture) : Status{};
    }
    const Result<const Reference*> reference = reference_of(*c.row);
    if (!reference.ok()) return reference.status();
    const Result<PictureDifference> difference = compare((*reference)->picture, picture, {});
    if (!difference.ok()) return difference.status();
    add_difference(*difference, c.result.results);
    add_agreement(agreement((*reference)->picture, picture), c.result.results);
    return study_.pictures ? keep_pictures(c, **reference, picture) : Status{};
  }

  struct Reference {
    Image picture;
    std::string file;  ///< in the study's folder; of a study that keeps pictures
  };

  /// Of the rows' camera and the row's looks.
  Result<const Reference*> reference_of(const StudyRow& row) {
    std::string looks;
    for (const auto& [key, value] : row.looks) looks += key + "=" + value + " ";
    if (const auto at = references_.find(looks); at != references_.end()) return &at->second;
    const bool exact = study_.reference == ReferenceKind::exact && truth_->has_exact_faces();
    Result<Image> picture = exact ? truth_->picture(row, camera_) : triangles_picture(row);
    if (!picture.ok()) return picture.status();
    Reference reference{std::move(*picture), ""};
    if (study_.pictures) {
      reference.file = keys_.picture_of(study_, row) + ".reference.png";
      if (const Status status = write(reference.file, to_image8(reference.picture)); !status.ok())
        return status;
    }
    return &references_.emplace(looks, std::move(reference)).first->second;
  }

  Result<Image> triangles_picture(const StudyRow& row) {
    const Result<const Meshed*> model = meshed(row.model, study_.reference_deflection);
    if (!model.ok()) return model.status();
    const auto scene = renderer_->upload((*model)->loaded.model, nullptr);
    if (!scene.ok()) return scene.status();
    const Result<Frame> frame = renderer_->draw(**scene, camera_, draw_options(row.render));
    if (!frame.ok()) return frame.status();
    return to_image(*frame);
  }

  Status write(const std::string& name, const Image8& picture) const {
    const fs::path path = fs::path(folder_) / name;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    return write_png(path.string(), picture);
  }
  Status keep_picture(Case& c, const Image& picture) {
    const std::string name = keys_.picture_of(study_, *c.row) + ".png";
    c.result.pictures["picture"] = name;
    return write(name, to_image8(picture));
  }
  Status keep_pictures(Case& c, const Reference& reference, const Image& picture) {
    if (const Status status = keep_picture(c, picture); !status.ok()) return status;
    const Result<Image8> difference = difference_picture(reference.picture, picture, {});
    if (!difference.ok()) return difference.status();
    const std::string name = keys_.picture_of(study_, *c.row) + ".difference.png";
    c.result.pictures["difference"] = name;
    c.result.pictures["reference"] = reference.file;
    return write(name, *difference);
  }

  static void finish(Case& c, const MeasureHooks& hooks) {
    if (c.failed()) {
      c.result.results = Json::object();
      c.result.times = Json::object();
    } else {
      add_preparation(c, c.result.results);
      add_times(c, c.result.times);
    }
    hooks.done(std::move(c.result));
  }

  const Study& study_;
  Session session_;
  std::string folder_;
  RowKeys keys_;
  std::map<double, Meshed> models_;  ///< by deflection; std::map, so that they stay where they are
  std::unique_ptr<Truth> truth_;
  Camera camera_;
  std::string shown_;                            ///< the view and size that the references are of
  std::map<std::string, Reference> references_;  ///< by looks
  std::unique_ptr<Context> context_;
  std::unique_ptr<Renderer> renderer_;
};

Measurer::Measurer(const Study& study, const CommonOptions& common, std::string folder)
    : impl_(std::make_unique<Impl>(study, common, std::move(folder))) {}
Measurer::~Measurer() = default;
void Measurer::measure(const std::vector<const StudyRow*>& rows, const MeasureHooks& hooks) {
  impl_->measure(rows, hooks);
}
std::string Measurer::gl_renderer() const {
  return impl_->gl_renderer();
}

}  // namespace dupin::app
