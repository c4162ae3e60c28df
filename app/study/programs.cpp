#include "programs.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "../output_file.h"
#include "journal.h"
#include "timed_process.h"

namespace dupin::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

constexpr int kPartialPicture = 4;  // dupin's exit code of a picture that lacks something

/// A program, or why it cannot be run.
struct Program {
  std::string name, path, missing;
  bool needs_display = true;
  std::function<Words(const std::string& file, const std::string& picture, int size)> arguments;
};

std::string ending_of(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

/// A Python literal.
std::string python_text(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

/// What FreeCAD opens a file of this kind with.
std::string freecad_open(const std::string& file) {
  const std::string ending = ending_of(file), name = python_text(file);
  if (ending == ".fcstd") return "FreeCAD.openDocument(" + name + ")\n";
  if (ending == ".brep" || ending == ".brp") return "import Part, PartGui; Part.open(" + name + ")\n";
  if (ending == ".obj" || ending == ".ply" || ending == ".stl" || ending == ".off")
    return "import Mesh, MeshGui; Mesh.open(" + name + ")\n";
  return "import ImportGui; ImportGui.open(" + name + ")\n";
}

/// The macro that draws the picture, beside it.
Words freecad_arguments(const std::string& file, const std::string& picture, int size) {
  const std::string macro = picture + ".FCMacro", side = std::to_string(size);
  std::ofstream(macro) << "import FreeCAD, FreeCADGui, os\n"
                       << freecad_open(file) << "view = FreeCADGui.activeDocument().activeView()\n"
                       << "view.viewIsometric()\nview.fitAll()\nview.saveImage(" << python_text(picture) << ", "
                       << side << ", " << side << ", 'White')\nos._exit(0)\n";
  return {macro};
}

std::vector<Program> all_programs(const Display& display) {
  std::error_code error;
  std::vector<Program> list;
  list.push_back({"dupin", fs::read_symlink("/proc/self/exe", error).string(), "", false,
                  [](const std::string& file, const std::string& picture, int size) -> Words {
                    const std::string side = std::to_string(size);
                    return {"render", file, "-o", picture, "--resolution", side + "," + side, "--quiet"};
                  }});
  list.push_back({"F3D", find_program({"f3d"}), "", true,
                  [](const std::string& file, const std::string& picture, int size) -> Words {
                    const std::string side = std::to_string(size);
                    return {file, "--output=" + picture, "--resolution=" + side + "," + side, "--no-background",
                            "--quiet"};
                  }});
  list.push_back({"FreeCAD", find_program({"freecad", "FreeCAD"}), "", true, freecad_arguments});
  for (Program& program : list) {
    if (program.path.empty())
      program.missing = "not installed";
    else if (program.needs_display && display.name().empty())
      program.missing = "there is no display, and no Xvfb";
  }
  return list;
}

/// A folder of its own for pictures, removed with them.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "dupin-programs-XXXXXX").string();
    if (mkdtemp(name.data())) folder_ = name;
  }
  ~Scratch() {
    std::error_code error;
    if (!folder_.empty()) fs::remove_all(folder_, error);
  }
  std::string picture() const { return (folder_ / "picture.png").string(); }

 private:
  fs::path folder_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

class ProgramTable {
 public:
  ProgramTable(Session& session, const ProgramRuns& runs, std::string folder)
      : session_(session), runs_(runs), folder_(std::move(folder)), programs_(all_programs(display_)) {}

  Status run() {
    read_known();
    if (const Status status = file_.open(folder_ + "/programs.jsonl"); !status.ok()) return status;
    for (const Program& program : programs_)
      if (!program.missing.empty()) session_.note(program.name + ": left out: " + program.missing);
    Status status;
    for (const std::string& file : runs_.files) {
      if (session_.limits().time_is_over()) return {StatusCode::cancelled, ""};
      if (status = measure(file); !status.ok()) return status;
    }
    return write_table();
  }

 private:
  std::string key_of(const std::string& file, const Program& program) const {
    std::error_code error;
    return file + "|" + std::to_string(fs::file_size(file, error)) + "|" + program.name + "|" +
           std::to_string(runs_.size) + "|" + std::to_string(runs_.rounds);
  }

  void read_known() {
    std::ifstream in(folder_ + "/programs.jsonl");
    for (std::string text; std::getline(in, text);) {
      Json line = Json::parse(text, nullptr, false);
      if (line.is_object() && line.contains("program") && line.contains("key")) {
        const std::string key = line["key"];
        known_[key] = std::move(line);
      }
    }
  }

  /// All programs on one file: they take turns.
  Status measure(const std::string& file) {
    std::map<std::string, std::vector<TimedProcess>> times;
    const auto wanted = [&](const Program& p) {
      return p.missing.empty() && !known_.count(key_of(file, p)) &&
             (times[p.name].empty() || times[p.name].back().failure.empty());
    };
    for (int round = 0; round < runs_.rounds; ++round)
      for (const Program& program : programs_)
        if (wanted(program)) times[program.name].push_back(run(program, file));
    for (const Program& program : programs_) {
      if (times[program.name].empty()) continue;
      Json line = line_of(file, program, times[program.name]);
      if (const Status status = file_.add(line); !status.ok()) return status;
      session_.note(program.name + ", " + file + ": " + line["seconds"].dump() + " s " +
                    line["status"].get<std::string>());
      known_[key_of(file, program)] = std::move(line);
    }
    return {};
  }

  TimedProcess run(const Program& program, const std::string& file) const {
    const std::string picture = scratch_.picture();
    std::error_code error;
    fs::remove(picture, error);
    ProcessRun process;
    process.command = program.arguments(file, picture, runs_.size);
    process.command.insert(process.command.begin(), program.path);
    process.seconds = runs_.seconds;
    if (program.name == "dupin") process.good.push_back(kPartialPicture);
    if (program.needs_display)
      process.environment = {
          {"DISPLAY", display_.name()}, {"QT_QPA_PLATFORM", "xcb"}, {"QTWEBENGINE_DISABLE_SANDBOX", "1"}};
    TimedProcess result = run_timed(process);
    if (result.failure.empty() && !fs::exists(picture, error)) result.failure = "wrote no picture";
    return result;
  }

  Json line_of(const std::string& file, const Program& program, const std::vector<TimedProcess>& times) const {
    std::vector<double> walls, processors, memory;
    std::string failure;
    for (const TimedProcess& t : times) {
      if (!t.failure.empty()) failure = t.failure;
      walls.push_back(t.seconds);
      processors.push_back(t.processor_seconds);
      memory.push_back(t.peak_megabytes);
    }
    Json line{{"key", key_of(file, program)}, {"file", file}, {"program", program.name}};
    line["status"] = failure.empty() ? "ok" : "no picture: " + failure;
    line["seconds"] = median(walls);
    line["least"] = *std::min_element(walls.begin(), walls.end());
    line["most"] = *std::max_element(walls.begin(), walls.end());
    line["processor seconds"] = median(processors);
    line["peak MB"] = median(memory);
    line["rounds"] = times.size();
    line["machine"] = machine_;
    return line;
  }

  Status write_table() const {
    static constexpr const char* kNumbers[] = {"seconds", "least", "most", "processor seconds", "peak MB", "rounds"};
    std::string text = "file,program,status";
    for (const char* name : kNumbers) text += std::string(",") + name;
    text += "\n";
    for (const std::string& file : runs_.files)
      for (const Program& program : programs_) {
        const auto at = known_.find(key_of(file, program));
        const bool measured = at != known_.end() && program.missing.empty();
        text += csv_cell(fs::path(file).filename().string()) + "," + program.name + "," +
                csv_cell(measured ? at->second["status"].get<std::string>() : "skipped: " + program.missing);
        for (const char* name : kNumbers) text += "," + (measured ? number(at->second[name]) : std::string());
        text += "\n";
      }
    OutputFile out;
    if (const Status status = out.open(folder_ + "/programs.csv"); !status.ok()) return status;
    if (const Status status = out.write(text); !status.ok()) return status;
    return out.commit();
  }

  static std::string number(const Json& value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value.get<double>());
    return text;
  }

  Session& session_;
  const ProgramRuns& runs_;
  std::string folder_;
  Display display_;
  std::vector<Program> programs_;
  Scratch scratch_;
  Json machine_ = machine_facts();
  JournalFile file_;
  std::map<std::string, Json> known_;  ///< lines by key
};

}  // namespace

Status measure_programs(Session& session, const ProgramRuns& runs, const std::string& folder) {
  if (runs.rounds == 0 || runs.files.empty()) return {};
  return ProgramTable(session, runs, folder).run();
}

}  // namespace dupin::app
