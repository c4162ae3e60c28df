// dupin bench: every primitive over its quality knob, on a corpus. It is a study, which it writes for itself.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "../exit_code.h"
#include "../render_primitive.h"
#include "commands.h"
#include "study_run.h"

namespace dupin::app {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
  StudyRun run;
  std::string reference = "exact";
  std::vector<std::string> corpus;
  std::vector<int> sizes{512, 1024};
  std::vector<std::string> primitives;
  int frames = 15, prepares = 3;
  std::size_t models = 0;
  int programs = 3;
  bool pictures = false, list = false;
};

/// A primitive over its knob. Where two options make one knob their values go together.
struct Knob {
  const char* primitive;
  std::vector<const char*> steps;
};
const std::vector<Knob>& knobs() {
  static const std::vector<Knob> list{
      {"quadric",
       {"tolerance = 4\nnormal-tolerance = 8", "tolerance = 2\nnormal-tolerance = 2",
        "tolerance = 1\nnormal-tolerance = 1", "tolerance = 0.5\nnormal-tolerance = 0.25",
        "tolerance = 0.1\nnormal-tolerance = 0.05"}},
      {"triangles", {"deflection = [1e-2, 1e-3, 1e-4, 1e-5]"}},
      {"dp", {"epsilon = [0.05, 0.012, 0.003]"}},  // no method: rectangles stand out over borders by a pixel
      {"square", {"method = \"uniform\"\ngrid = [4, 12, 36]"}},
      {"rectangle", {"method = \"uniform\"\ngrid = [4, 12, 36]"}},
      {"ellipse", {"method = \"uniform\"\ngrid = [4, 12, 36]"}},
      {"pop", {"deflection = [1e-3, 1e-4]\nsplat-size = [1, 3]"}},
      {"qsplat", {"deflection = [1e-3, 1e-4]\nsplat-size = [1, 3]"}},
      {"amg", {"tolerance = [0.5, 2, 8]"}},
  };
  return list;
}

bool in_this_version(const std::string& primitive) {
  for (const PrimitiveKind& kind : primitive_kinds())
    for (const std::string_view name : kind.names)
      if (name == primitive) return true;
  return false;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// `most` of the files, evenly spread over their order; 0: all.
std::vector<std::string> chosen_files(const std::vector<std::string>& files, std::size_t most) {
  if (most == 0 || most >= files.size()) return files;
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(files[i * files.size() / most]);
  return chosen;
}

std::string study_text(const BenchOptions& options, const std::vector<std::string>& files) {
  std::string text = "title = \"dupin bench\"\nreference = " + quoted(options.reference) +
                     "\nframes = " + std::to_string(options.frames) +
                     "\nprepares = " + std::to_string(options.prepares) +
                     "\npictures = " + (options.pictures ? "true" : "false") + "\nsizes = [";
  for (const int size : options.sizes) text += std::to_string(size) + ", ";
  text +=
      "]\nviews = [{ name = \"whole\" }, { name = \"close\", zoom = 8 }, { name = \"far\", zoom = 0.25 "
      "}]\nmodels = [\n";
  for (const std::string& file : files) text += "  " + quoted(file) + ",\n";
  text += "]\n";
  for (const Knob& knob : knobs()) {
    const bool wanted =
        options.primitives.empty() ||
        std::count(options.primitives.begin(), options.primitives.end(), std::string(knob.primitive));
    if (!wanted || !in_this_version(knob.primitive)) continue;
    for (const char* step : knob.steps)
      text += "\n[[sweep]]\nprimitive = " + quoted(knob.primitive) + "\ncolor = \"#9aa3ad\"\n" + step +
              (*step ? "\n" : "");
  }
  return text;
}

int run(BenchOptions options) {
  if (options.corpus.empty())
    if (const char* data = std::getenv("DUPIN_DATA")) options.corpus.emplace_back(data);
  if (options.corpus.empty())
    return fail(
        {StatusCode::invalid_argument, "no corpus: --corpus FOLDER, or DUPIN_DATA in the environment"});
  std::vector<std::string> all;
  std::error_code error;
  for (const std::string& path : options.corpus) {
    const fs::path corpus = fs::absolute(path, error);
    if (!fs::exists(corpus, error)) return fail({StatusCode::invalid_argument, path + ": is not there"});
    const bool folder = fs::is_directory(corpus, error);
    const auto found = folder ? model_files(corpus.string()) : std::vector<std::string>{corpus.string()};
    if (found.empty()) return fail({StatusCode::unreadable, path + ": holds no models"});
    all.insert(all.end(), found.begin(), found.end());
  }
  const std::vector<std::string> files = chosen_files(all, options.models);
  options.run.text = study_text(options, files);
  const Result<Study> study = parse_study(options.run.text, "bench", "");
  if (!study.ok()) return fail(study.status());
  if (options.list) return list_rows(*study), kDone;
  if (options.run.run.folder.empty())
    return fail({StatusCode::invalid_argument, "-o FOLDER is missing; see dupin bench --help"});
  options.run.programs.files = files;
  options.run.programs.rounds = options.programs;
  options.run.programs.size = *std::max_element(options.sizes.begin(), options.sizes.end());
  return run_study(*study, options.run);
}

}  // namespace

void add_bench_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* command =
      app.add_subcommand("bench", "Measure every primitive's time, bytes and error on a corpus");
  command->add_option("--corpus", options->corpus, "Folders of models, or models (default: $DUPIN_DATA)")
      ->delimiter(',')
      ->type_name("FOLDER,...");
  command
      ->add_option("-o,--output", options->run.run.folder,
                   "The folder of results; a run that was ended goes on there")
      ->type_name("FOLDER");
  command->add_option("--models", options->models, "So many models, spread over the corpus (default: all)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  command->add_option("--sizes", options->sizes, "Pictures are SIZE x SIZE")
      ->delimiter(',')
      ->check(CLI::Range(1, 16384))
      ->type_name("SIZE,...")
      ->capture_default_str();
  std::vector<std::string> names;
  for (const Knob& knob : knobs()) names.emplace_back(knob.primitive);
  command->add_option("--primitives", options->primitives, "These alone")
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->type_name("NAME,...");
  command->add_option("--reference", options->reference, "exact: the ray caster; or triangles:DEFLECTION")
      ->capture_default_str();
  command->add_option("--frames", options->frames, "Timed frames of each row, in turn")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--prepares", options->prepares, "Timed preparations of each row, in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--programs", options->programs,
                   "Rounds of whole processes, from the file to the picture: dupin, F3D, FreeCAD; 0: none")
      ->check(CLI::Range(0, 1000))
      ->type_name("ROUNDS")
      ->capture_default_str();
  command->add_flag("--list", options->list, "Measure nothing; list the rows");
  command->add_flag("--pictures", options->pictures, "Keep the pictures, with difference pictures");
  command->add_flag("!--no-report", options->run.report, "No report.html");
  add_common_options(*command, options->run.run.common);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
