// Processor time, which other work on the machine changes less than the wall's.
#ifndef DUPIN_APP_STUDY_PROCESSOR_CLOCK_H
#define DUPIN_APP_STUDY_PROCESSOR_CLOCK_H

#include <ctime>

namespace dupin::app {

/// Of all threads of this process, the software renderer's among them; a GPU's time is not in it.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace dupin::app

#endif
