// From a study to its folder of results.
#ifndef DUPIN_APP_STUDY_STUDY_RUN_H
#define DUPIN_APP_STUDY_STUDY_RUN_H

#include <string>
#include <vector>

#include "programs.h"
#include "runner.h"
#include "study.h"

namespace dupin::app {

struct StudyRun {
  RunOptions run;
  bool merge = false;                 ///< measure nothing: join what is there
  std::vector<std::string> journals;  ///< further folders whose rows count
  std::string text;                   ///< of the study, kept with the results
  ProgramRuns programs;               ///< whole processes, after the rows
  bool report = true;                 ///< also make the page
};

/// A line a row, on standard output.
void list_rows(const Study& study);

/// Measures what is left, then writes the tables (not for one shard of several). The exit code.
int run_study(const Study& study, const StudyRun& options);

}  // namespace dupin::app

#endif
