// Runs what is left of a study: every model in a process of its own, so that a crash, a hang or a lack of
// memory costs one row.
#ifndef DUPIN_APP_STUDY_RUNNER_H
#define DUPIN_APP_STUDY_RUNNER_H

#include <string>

#include "journal.h"
#include "study.h"

namespace dupin::app {

struct RunOptions {
  CommonOptions common;
  std::string folder;
  int shard = 1, shards = 1;
};

/// Measures the rows of the shard that the folder's journals do not have, or have as failed.
Status run_rows(const Study& study, const RunOptions& options, Journal& journal);

/// "3 min 20 s"
std::string duration_text(double seconds);

}  // namespace dupin::app

#endif
