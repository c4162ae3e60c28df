// From a study to its folder of results.
#ifndef DUPIN_APP_STUDY_STUDY_RUN_H
#define DUPIN_APP_STUDY_STUDY_RUN_H

#include <string>
#include <vector>

#include "runner.h"
#include "study.h"

namespace dupin::app {

struct StudyRun {
  RunOptions run;
  bool merge = false;                 ///< measure nothing: join what is there
  std::vector<std::string> journals;  ///< further folders whose rows count
  std::string text;                   ///< of the study, kept with the results
  bool report = true;                 ///< also make the page
};

/// Measures what is left, then writes the tables (not for one shard of several). The exit code.
int run_study(const Study& study, const StudyRun& options);

}  // namespace dupin::app

#endif
