#include "study_run.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "../exit_code.h"
#include "../output_file.h"
#include "report_run.h"

namespace dupin::app {
namespace {

namespace fs = std::filesystem;

Status make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error))
    return {StatusCode::cannot_write, folder + ": cannot be made: " + error.message()};
  return {};
}

Status keep_text(const StudyRun& options) {
  OutputFile file;
  if (const Status status = file.open(options.run.folder + "/study.toml"); !status.ok()) return status;
  if (const Status status = file.write(options.text); !status.ok()) return status;
  return file.commit();
}

/// Lines of the rows; null where one is missing.
std::vector<const nlohmann::ordered_json*> lines_of(const Study& study, const Journal& journal) {
  RowKeys keys;
  std::vector<const nlohmann::ordered_json*> lines;
  for (const StudyRow& row : study.rows) lines.push_back(journal.find(keys.of(study, row)));
  return lines;
}

}  // namespace

void list_rows(const Study& study) {
  for (const StudyRow& row : study.rows)
    std::printf("%zu\t%s\t%s\t%dx%d\t%s\n", row.index, row.model.name.c_str(), row.view.name.c_str(),
                row.width, row.height, row.arguments().c_str());
}

int run_study(const Study& study, const StudyRun& options) {
  Session session(options.run.common);
  if (const Status status = make_folder(options.run.folder); !status.ok()) return session.fail(status);
  Journal journal;
  journal.read_folder(options.run.folder);
  for (const std::string& folder : options.journals) journal.read_folder(folder);
  if (const Status status = keep_text(options); !status.ok()) return session.fail(status);
  if (!options.merge)
    if (const Status status = run_rows(study, options.run, journal); !status.ok())
      return session.fail(status);
  if (options.run.shards > 1) return kDone;

  const auto lines = lines_of(study, journal);
  std::size_t missing = 0, failed = 0;
  for (const auto* line : lines) {
    missing += !line;
    failed += line && (*line)["status"] != "ok";
  }
  if (missing > 0)
    return session.fail({StatusCode::partial, std::to_string(missing) + " of " +
                                                  std::to_string(lines.size()) +
                                                  " rows have not been measured; nothing was joined"});
  if (const Status status = write_tables(study, lines, options.run.folder); !status.ok())
    return session.fail(status);
  if (failed > 0)
    session.warn(std::to_string(failed) + " of " + std::to_string(lines.size()) +
                 " rows failed; results.csv says why");
  session.note(std::to_string(lines.size()) + " rows in " + options.run.folder +
               "/results.csv and timed.csv");
  if (const Status status = measure_programs(session, options.programs, options.run.folder); !status.ok())
    return session.fail(status);
  if (options.report)
    if (const std::string why = make_report(options.run.folder); !why.empty())
      session.note("no report.html: " + why);
  return failed > 0 ? kPartial : kDone;
}

}  // namespace dupin::app
