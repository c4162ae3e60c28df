// dupin render: one picture of one or more files.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "../render/image.h"
#include "commands.h"
#include "exit_code.h"
#include "load.h"
#include "output_file.h"
#include "render_primitive.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

/// The work of one command, stage by stage; each fills its part of the statistics.
class RenderJob {
 public:
  explicit RenderJob(const RenderOptions& options)
      : options_(options), session_(options.common), primitive_(make_primitive(options)) {}
  int run();

 private:
  Status reserve_outputs();
  Status load_model();
  void note_loose_points();
  Status prepare();
  Status draw();
  Status write();
  unsigned outputs() const;
  DrawOptions draw_options() const;
  void list_skipped_faces();
  int finish();

  const RenderOptions& options_;
  Session session_;
  std::unique_ptr<RenderPrimitive> primitive_;
  OutputFile picture_, statistics_;
  Model model_;
  Camera camera_;
  Frame frame_;
  RenderStats stats_;
};

Status RenderJob::reserve_outputs() {
  if (const Status status = picture_.open(options_.output); !status.ok()) return status;
  return options_.stats.empty() ? Status{} : statistics_.open(options_.stats);
}

Status RenderJob::load_model() {
  Result<Loaded> loaded = primitive_->load(session_, options_);
  if (!loaded.ok()) return loaded.status();
  stats_.times.import = loaded->import_seconds;
  model_ = std::move(loaded->model);
  if (!options_.subdivision.empty()) {
    Stopwatch watch;
    if (Status status = subdivide(session_, model_, options_.subdivision, primitive_->deflection(options_));
        !status.ok())
      return status;
    stats_.times.import += watch.lap();
  }
  if (face_instance_count(model_) == 0 && model_.skipped.empty())
    return {StatusCode::unreadable, model_.source + ": holds no faces"};
  note_loose_points();
  for (const std::string& note : model_.notes) session_.note(note);
  const Result<Camera> camera = make_camera(options_.view, model_);
  if (!camera.ok()) return camera.status();
  camera_ = *camera;
  return {};
}

/// Meshes draw what their polygons use; only a file of points alone is drawn as points.
void RenderJob::note_loose_points() {
  std::size_t loose = 0;
  for (const Part& part : model_.parts)
    if (part.polygons.polygon_count() > 0) loose += loose_point_count(part.polygons);
  if (loose > 0) session_.note(std::to_string(loose) + " vertices that no polygon uses are not drawn");
}

Status RenderJob::prepare() {
  return primitive_->prepare({model_, camera_, options_, session_.progress()}, stats_);
}

unsigned RenderJob::outputs() const {
  if (!options_.exr()) return kScreen;
  static constexpr std::pair<const char*, Output> kNames[] = {
      {"color", kColor},       {"normal", kNormal},       {"depth", kDepth},
      {"position", kPosition}, {"curvature", kCurvature}, {"direction", kDirection},
      {"face", kFace},         {"primitive", kPrimitive}, {"uv", kUv}};
  if (options_.aovs.empty()) return kColor | kNormal | kDepth;
  unsigned outputs = 0;
  for (const auto& [name, output] : kNames)
    if (std::count(options_.aovs.begin(), options_.aovs.end(), name)) outputs |= output;
  return outputs;
}

DrawOptions RenderJob::draw_options() const {
  DrawOptions draw;
  draw.outputs = outputs();
  const auto shading = std::find(std::begin(kShadingNames), std::end(kShadingNames), options_.shading);
  // What else it can be stands in colors that a kind of primitive has.
  if (shading != std::end(kShadingNames))
    draw.shading = static_cast<Shading>(shading - std::begin(kShadingNames));
  draw.edges = options_.edges;
  draw.background.reset();
  if (options_.background != "none") draw.background = options_.background_color();
  draw.color = options_.uniform_color();
  draw.samples = options_.sample_count();
  draw.exact_model = &model_;
  for (const Vec3& position : options_.light_positions()) draw.lights.push_back({position});
  const std::vector<double>& s = options_.sections;
  for (std::size_t i = 0; i + 3 < s.size(); i += 4)
    draw.sections.push_back({{s[i], s[i + 1], s[i + 2]}, s[i + 3]});
  return draw;
}

Status RenderJob::draw() {
  Stopwatch watch;
  const Device device = options_.device == "egl"      ? Device::egl
                        : options_.device == "osmesa" ? Device::osmesa
                                                      : Device::automatic;
  const auto context = create_context(device);
  if (!context.ok()) return context.status();
  const auto renderer = Renderer::create((*context)->loader());
  if (!renderer.ok()) return renderer.status();
  stats_.times.context = watch.lap();
  stats_.device = (*context)->name();
  stats_.gl_renderer = (*renderer)->gl_renderer();

  const auto scene = (*renderer)->upload(model_, primitive_->content());
  if (!scene.ok()) return scene.status();
  stats_.times.upload = watch.lap();
  stats_.primitives = (*scene)->info().primitives;
  stats_.bytes = (*scene)->info().bytes;
  stats_.clips = (*scene)->info().clips;

  const DrawOptions draw = draw_options();
  std::vector<double> frames;
  for (int i = 0; i < options_.repeat; ++i) {
    if (!report(session_.progress(), "drawing", double(i) / options_.repeat))
      return {StatusCode::cancelled, ""};
    // Every frame but the last is for timing alone.
    if (i + 1 < options_.repeat) {
      const Result<FrameStats> timed = (*renderer)->draw_only(**scene, camera_, draw);
      if (!timed.ok()) return timed.status();
      frames.push_back(timed->milliseconds / 1e3);
      continue;
    }
    Result<Frame> frame = (*renderer)->draw(**scene, camera_, draw);
    if (!frame.ok()) return frame.status();
    frames.push_back(frame->stats.milliseconds / 1e3);
    frame_ = std::move(*frame);
  }
  stats_.times.first_frame = frames.front();
  std::nth_element(frames.begin(), frames.begin() + frames.size() / 2, frames.end());
  stats_.times.frame_median = frames[frames.size() / 2];
  stats_.width = frame_.width;
  stats_.height = frame_.height;
  stats_.covered_pixels = frame_.stats.covered_pixels;
  primitive_->report_drawn(stats_);
  return {};
}

Status RenderJob::write() {
  Stopwatch watch;
  const Status status = options_.exr() ? write_exr(picture_.working_path(), to_image(frame_))
                                       : write_png(picture_.working_path(), screen_image(frame_));
  if (!status.ok()) return {status.code, options_.output + ": cannot write"};
  stats_.times.write = watch.lap();
  stats_.times.total = session_.limits().elapsed();
  if (options_.stats.empty()) return {};
  stats_.files = options_.files;
  stats_.primitive = primitive_->kind();
  return statistics_.write(to_json(stats_).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                           "\n");
}

void RenderJob::list_skipped_faces() {
  for (const SkippedFace& face : stats_.faces.skipped)
    session_.warn("not drawn: " + face.name + ": " + face.reason);
  if (const std::size_t n = stats_.faces.skipped.size(); n > 0)
    session_.warn(std::to_string(n) + " of " + std::to_string(stats_.faces.total()) + " faces were left out");
}

int RenderJob::finish() {
  for (OutputFile* output : {&picture_, &statistics_})
    if (const Status status = output->commit(); !status.ok()) return session_.fail(status);
  session_.done();
  list_skipped_faces();
  session_.note(std::to_string(stats_.primitives) + " primitives (" + primitive_->kind() + ")" + " for " +
                std::to_string(stats_.faces.drawn) + " faces, " + std::to_string(stats_.bytes / 1024) +
                " KiB, " + std::to_string(stats_.covered_pixels) + " pixels, on " + stats_.gl_renderer);
  session_.note(describe(stats_.times));
  return stats_.faces.skipped.empty() ? kDone : kPartial;
}

int RenderJob::run() {
  for (const auto stage : {&RenderJob::reserve_outputs, &RenderJob::load_model, &RenderJob::prepare,
                           &RenderJob::draw, &RenderJob::write}) {
    if (const Status status = (this->*stage)(); !status.ok()) return session_.fail(status);
    if (session_.limits().time_is_over()) return session_.fail({StatusCode::cancelled, ""});
  }
  return finish();
}

int run(const RenderOptions& options) {
  if (const Status status = options.check(); !status.ok()) return fail(status);
  return RenderJob(options).run();
}

}  // namespace

void add_render_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Draw CAD files into a picture");
  add_render_options(*command, *options);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
