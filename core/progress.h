// Telling a person how far long work has come, and letting them stop it.
#ifndef DUPIN_CORE_PROGRESS_H
#define DUPIN_CORE_PROGRESS_H

#include <functional>
#include <string_view>

namespace dupin {

/// Called with the stage's name and the part of it that is done, 0 … 1; may come from any thread.
/// Returning false asks the work to stop: it then returns StatusCode::cancelled.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

inline bool report(const Progress& progress, std::string_view stage, double fraction) {
  return !progress || progress(stage, fraction);
}

}  // namespace dupin

#endif
