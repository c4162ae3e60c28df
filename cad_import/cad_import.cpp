#include "cad_import.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "../core/parallel.h"
#include "../nurbs/recognize.h"
#include "file_kind.h"
#include "model_stream.h"
#include "reader_process.h"

namespace dupin {
namespace {

std::uint64_t physical_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size)
                               : 8ull << 30;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

Status check_options(const ImportOptions& options) {
  static constexpr std::array kUnits{"mm", "cm", "m", "inch", "ft", "um"};
  if (std::find(kUnits.begin(), kUnits.end(), options.assumed_unit) == kUnits.end())
    return {StatusCode::invalid_argument,
            "unknown unit '" + options.assumed_unit + "': mm, cm, m, inch, ft, um"};
  if (!(options.time_limit_seconds >= 0)) return {StatusCode::invalid_argument, "the time limit is negative"};
  if (!(options.mesh_deflection >= 0 && options.mesh_deflection < 1))
    return {StatusCode::invalid_argument, "the mesh deflection must lie in [0, 1)"};
  if (!(options.mesh_angle_radians > 0 && options.mesh_angle_radians < 3.15))
    return {StatusCode::invalid_argument, "the mesh angle must lie in (0, pi)"};
  return {};
}

Status check_kind(const std::string& path) {
  const Result<FileKind> kind = file_kind(path);
  if (!kind.ok()) return kind.status();
  if (*kind == FileKind::empty) return {StatusCode::unreadable, path + ": the file is empty"};
  if (*kind == FileKind::unknown)
    return {StatusCode::unreadable, path + ": not a " + std::string(kSupportedKinds) + " file"};
  return {};
}

ReaderCommand make_command(const std::string& path, const ImportOptions& options, std::string reader) {
  // An unlimited reader could take the machine down with it; most of the memory is limit enough for real
  // files.
  const std::uint64_t memory =
      options.memory_limit_bytes > 0 ? options.memory_limit_bytes : physical_memory() / 10 * 9;
  ReaderCommand command;
  command.executable = std::move(reader);
  command.arguments = {"--parent",  std::to_string(::getpid()),
                       "--memory",  std::to_string(memory),
                       "--seconds", number(options.time_limit_seconds),
                       "--threads", std::to_string(thread_limit()),
                       "--unit",    options.assumed_unit,
                       "--mesh",    number(options.mesh_deflection),
                       "--angle",   number(options.mesh_angle_radians),
                       "--",        path};
  command.subject = path;
  command.time_limit_seconds = options.time_limit_seconds;
  command.answer_limit_bytes = memory;
  command.progress = options.progress;
  return command;
}

}  // namespace

Result<Model> import_cad(const std::string& path, const ImportOptions& options) {
  if (Status valid = check_options(options); !valid.ok()) return valid;
  if (Status readable = check_kind(path); !readable.ok()) return readable;
  Result<std::string> reader = find_reader(options.reader);
  if (!reader.ok()) return reader.status();
  const Result<std::string> answer = run_reader(make_command(path, options, *reader));
  if (!answer.ok()) return answer.status();
  Result<Model> model = read_model(*answer);
  if (!model.ok()) return {StatusCode::unreadable, path + ": " + model.status().message};
  // Splines that are something simpler are drawn as that; what the file says stays in the Model.
  recognize_faces(*model);
  return model;
}

}  // namespace dupin
