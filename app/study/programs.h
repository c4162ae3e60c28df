// Whole processes, from the file to the picture: this command beside the programs that a user would run instead.
#ifndef DUPIN_APP_STUDY_PROGRAMS_H
#define DUPIN_APP_STUDY_PROGRAMS_H

#include <string>
#include <vector>

#include "../session.h"

namespace dupin::app {

struct ProgramRuns {
  std::vector<std::string> files;
  int rounds = 0;           ///< the programs take turns so many times on each file; 0: none is run
  int size = 1024;          ///< pictures are size × size
  double seconds = 120;     ///< a process that takes longer is ended
};

/// Runs `dupin render`, F3D and FreeCAD (off-screen; where there is no display, under an Xvfb of its own) where
/// they are installed, and writes FOLDER/programs.csv: a row a file and program, medians of the rounds, or why
/// there is no picture. Files that FOLDER/programs.jsonl has are not measured again.
Status measure_programs(Session& session, const ProgramRuns& runs, const std::string& folder);

}  // namespace dupin::app

#endif
