// dupin sample: differential points of one file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "../simplify/dp_codec.h"
#include "commands.h"
#include "exit_code.h"
#include "load.h"
#include "output_file.h"
#include "point_files.h"
#include "point_options.h"
#include "render_stats.h"
#include "session.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

struct SampleOptions {
  CommonOptions common;
  std::string file, output, stats;
  PointOptions points;
  std::string encode;  ///< empty: packed

  std::string extension() const {
    std::string text = std::filesystem::path(output).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  }
  Status check() const {
    const std::string kind = extension();
    if (kind != ".ply" && kind != ".csv" && kind != ".dps")
      return {StatusCode::invalid_argument, output + ": a file of points ends in .ply, .csv or .dps"};
    if (!encode.empty() && kind != ".dps")
      return {StatusCode::invalid_argument, "--encode goes with a .dps file"};
    return points.check();
  }
};

class SampleJob {
 public:
  explicit SampleJob(const SampleOptions& options) : options_(options), session_(options.common) {}
  int run() {
    for (const auto stage :
         {&SampleJob::reserve_outputs, &SampleJob::load_model, &SampleJob::make, &SampleJob::write}) {
      if (const Status status = (this->*stage)(); !status.ok()) return session_.fail(status);
      if (session_.limits().time_is_over()) return session_.fail({StatusCode::cancelled, ""});
    }
    return finish();
  }

 private:
  Status reserve_outputs() {
    if (const Status status = points_file_.open(options_.output); !status.ok()) return status;
    return options_.stats.empty() ? Status{} : statistics_.open(options_.stats);
  }

  Status load_model() {
    Result<Loaded> loaded = load(session_, {options_.file});
    if (!loaded.ok()) return loaded.status();
    import_seconds_ = loaded->import_seconds;
    model_ = std::move(loaded->model);
    for (const std::string& note : model_.notes) session_.note(note);
    if (face_instance_count(model_) == 0 && model_.skipped.empty())
      return {StatusCode::unreadable, model_.source + ": holds no faces"};
    return {};
  }

  Status make() {
    sampling_ = options_.points.sampling(model_);
    sampling_.progress = session_.progress();
    Result<MadePoints> made = make_points(model_, sampling_, options_.points);
    if (!made.ok()) return made.status();
    made_ = std::move(*made);
    std::vector<std::vector<SkippedFace>> left_out;
    for (const PartPoints& part : made_.scene.parts) left_out.push_back(part.skipped);
    faces_ = report_faces(model_, left_out);
    return {};
  }

  Status write() {
    Stopwatch watch;
    const std::string kind = options_.extension(), &path = points_file_.working_path();
    const DpsEncoding encoding = options_.encode == "raw" ? DpsEncoding::raw : DpsEncoding::packed;
    const Status status = kind == ".csv"   ? write_points_csv(path, model_, made_.scene)
                          : kind == ".ply" ? write_points_ply(path, model_, made_.scene)
                                           : write_points_dps(path, model_, made_.scene, encoding);
    if (!status.ok()) return {status.code, options_.output + ": cannot write"};
    std::error_code failed;
    const auto size = std::filesystem::file_size(path, failed);
    bytes_ = failed ? 0 : size;
    write_seconds_ = watch.lap();
    return options_.stats.empty()
               ? Status{}
               : statistics_.write(
                     statistics().dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }

  nlohmann::ordered_json statistics() const {
    nlohmann::ordered_json json;
    const bool certified = sampling_.method == PointMethod::certified;
    std::size_t written = 0;
    double bound = 0;
    for (const Instance& instance : model_.instances)
      written += made_.scene.parts[instance.part].points.size();
    for (const PartPoints& part : made_.scene.parts)
      for (const DifferentialPoint& p : part.points) bound = std::max(bound, p.bound);
    json["file"] = options_.file;
    json["method"] = kPointMethodNames[static_cast<std::size_t>(sampling_.method)];
    json["epsilon"] = certified ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(sampling_.epsilon);
    json["delta"] = certified ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(sampling_.delta);
    json["faces"] = to_json(faces_);
    json["notes"] = made_.scene.notes;
    json["points"] = {{"before", made_.before}, {"after", made_.scene.count()}, {"written", written}};
    json["bytes"] = {{"file", bytes_},
                     {"raw", made_.scene.count() * kRawBytes},
                     {"packed", made_.scene.count() * kPackedBytes}};
    json["bound"] = bound;
    json["time_s"] = {{"import", import_seconds_},
                      {"sample", made_.sample_seconds},
                      {"simplify", made_.simplify_seconds},
                      {"write", write_seconds_},
                      {"total", session_.limits().elapsed()}};
    json["peak_rss_bytes"] = peak_resident_bytes();
    return json;
  }

  int finish() {
    session_.done();
    for (OutputFile* file : {&points_file_, &statistics_}) {
      if (file == &statistics_ && options_.stats.empty()) continue;
      if (const Status status = file->commit(); !status.ok()) return session_.fail(status);
    }
    for (const SkippedFace& face : faces_.skipped) session_.warn(face.name + ": " + face.reason);
    for (const std::string& note : made_.scene.notes) session_.note(note);
    session_.note(std::to_string(made_.before) + " points" +
                  (options_.points.simplify
                       ? ", " + std::to_string(made_.scene.count()) + " after simplification"
                       : "") +
                  ", " + std::to_string(bytes_) + " bytes");
    return faces_.skipped.empty() ? kDone : kPartial;
  }

  const SampleOptions& options_;
  Session session_;
  OutputFile points_file_, statistics_;
  Model model_;
  PointSamplingOptions sampling_;
  MadePoints made_;
  FaceReport faces_;
  std::uint64_t bytes_ = 0;
  double import_seconds_ = 0, write_seconds_ = 0;
};

int run(const SampleOptions& options) {
  if (const Status status = options.check(); !status.ok()) return fail(status);
  return SampleJob(options).run();
}

}  // namespace

void add_sample_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<SampleOptions>();
  CLI::App* command = app.add_subcommand("sample", "Sample a file's faces into differential points");
  command->add_option("FILE", options->file, "STEP, IGES, BREP, FCStd, OBJ, PLY, STL or OFF")->required();
  command->add_option("-o,--output", options->output, "The points: .ply, .csv or .dps")
      ->required()
      ->type_name("FILE");
  command->add_option("--stats", options->stats, "Write what was done, as JSON")->type_name("FILE.json");
  add_point_options(*command, options->points, true);
  command
      ->add_option("--encode", options->encode, "Of a .dps: packed, 13 bytes a point (default), or raw, 62")
      ->check(CLI::IsMember({"raw", "packed"}))
      ->group("Differential points");
  add_common_options(*command, options->common);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
