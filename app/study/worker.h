// The process that measures rows, and what it says to the one that started it: a JSON line each.
#ifndef DUPIN_APP_STUDY_WORKER_H
#define DUPIN_APP_STUDY_WORKER_H

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "measure.h"
#include "study.h"

namespace dupin::app {

class Worker {
 public:
  /// Begins to measure the rows, which are of one model.
  Worker(const Study& study, const CommonOptions& common, const std::string& folder,
         const std::vector<const StudyRow*>& rows);
  /// Ends the process if it still runs.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  struct Message {
    bool done = false;  ///< else `row` is what is being worked on
    RowResult result;
    std::size_t row = 0;
    std::string gl_renderer;
  };
  /// The next message; none once the process has ended, or has said nothing for so long.
  std::optional<Message> next(double seconds);
  /// Why there was no message: "" where the process ended as it should.
  std::string end();

 private:
  bool read_more(double seconds);
  pid_t process_ = -1;
  int pipe_ = -1;
  bool late_ = false;
  std::string text_;
};

}  // namespace dupin::app

#endif
