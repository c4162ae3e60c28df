// Running the reading process: a child with limits, watched until it has answered, failed, crashed or run out
// of time.
#ifndef DUPIN_CAD_IMPORT_READER_PROCESS_H
#define DUPIN_CAD_IMPORT_READER_PROCESS_H

#include <string>
#include <vector>

#include "../core/progress.h"
#include "../core/status.h"

namespace dupin {

struct ReaderCommand {
  std::string executable;
  std::vector<std::string> arguments;  ///< without the executable's name
  std::string subject;                 ///< what messages are about: the file
  double time_limit_seconds = 0;       ///< wall clock; 0: none
  std::uint64_t answer_limit_bytes = 0;
  Progress progress;
};

/// The bytes of the model frame that the process sent, or why there are none. The process and all that it
/// started are gone when this returns.
Result<std::string> run_reader(const ReaderCommand& command);

/// The reading program's path: `asked` if not empty, else $DUPIN_READER, then beside the running program,
/// then in
/// ../libexec/dupin from there, then in a build tree, then where the library was installed to.
Result<std::string> find_reader(const std::string& asked);

}  // namespace dupin

#endif
