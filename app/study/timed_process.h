// One process, timed from its start to its end.
#ifndef DUPIN_APP_STUDY_TIMED_PROCESS_H
#define DUPIN_APP_STUDY_TIMED_PROCESS_H

#include <string>
#include <utility>
#include <vector>

namespace dupin::app {

struct TimedProcess {
  double seconds = 0, processor_seconds = 0;  ///< its own children counted
  double peak_megabytes = 0;                  ///< of the largest of its processes
  std::string failure;                        ///< "": it ended with one of the exit codes that are good
};

struct ProcessRun {
  std::vector<std::string> command;                               ///< the program's path first
  std::vector<std::pair<std::string, std::string>> environment;   ///< set besides this process's own
  std::vector<int> good{0};                                       ///< exit codes
  double seconds = 120;                                           ///< then it is ended, with its children
};

/// What it writes is thrown away.
TimedProcess run_timed(const ProcessRun& run);

/// The path of a program that PATH has; "" where it has none of the names.
std::string find_program(const std::vector<std::string>& names);

/// A display for programs that need one: DISPLAY's, or an Xvfb that is ended with this.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  /// ":5"; "" where there is none and no Xvfb.
  const std::string& name() const { return name_; }

 private:
  void start();
  void stop();
  std::string name_;
  int server_ = -1, said_ = -1;
};

}  // namespace dupin::app

#endif
