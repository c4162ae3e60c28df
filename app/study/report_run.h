// The page of a study's folder, made by the program dupin-report (app/study/report).
#ifndef DUPIN_APP_STUDY_REPORT_RUN_H
#define DUPIN_APP_STUDY_REPORT_RUN_H

#include <string>

namespace dupin::app {

/// Writes FOLDER/report.html. "" where it is there; else one line that says why it could not be made.
std::string make_report(const std::string& folder);

}  // namespace dupin::app

#endif
