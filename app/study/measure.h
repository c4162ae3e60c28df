// Measuring rows of a study, in this process: what they have in common is done once, and what is timed takes
// turns.
#ifndef DUPIN_APP_STUDY_MEASURE_H
#define DUPIN_APP_STUDY_MEASURE_H

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study.h"

namespace dupin::app {

/// What a row came to. `results` are the same run after run; `times` are this run's.
struct RowResult {
  std::size_t row = 0;
  std::string failure;  ///< empty: none
  nlohmann::ordered_json results, times;
  nlohmann::ordered_json pictures;  ///< names of files in the study's folder
  std::string command;              ///< `dupin render …`, which draws the row's picture
};

/// Names of the numbers in a row's `results` and `times`, in the tables' order.
const std::vector<std::string>& result_columns();
const std::vector<std::string>& time_columns();

struct MeasureHooks {
  /// Called before anything that a row alone is responsible for: a crash after it is that row's.
  std::function<void(std::size_t row)> at;
  std::function<void(RowResult)> done;
};

/// Rows of one model. Its files, meshes and references are kept while this lives.
class Measurer {
 public:
  /// `folder` is where pictures go.
  Measurer(const Study& study, const CommonOptions& common, std::string folder);
  ~Measurer();
  /// Rows of one model, view and size, all ready at once so that they take turns: every round times one frame
  /// of each.
  void measure(const std::vector<const StudyRow*>& rows, const MeasureHooks& hooks);
  /// Of the context, once anything has been drawn.
  std::string gl_renderer() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Rows that `Measurer::measure` may have at once.
inline constexpr std::size_t kMostAtOnce = 32;

}  // namespace dupin::app

#endif
