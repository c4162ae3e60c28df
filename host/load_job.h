// Reading and preparing a model on a thread of its own, while the host goes on.
//
//   auto job = LoadJob::start("part.step", {}, {});
//   … each frame: show job->fraction(); if (job->done()) auto prepared = job->result();
#ifndef DUPIN_HOST_LOAD_JOB_H
#define DUPIN_HOST_LOAD_JOB_H

#include <functional>
#include <memory>
#include <string>

#include "../cad_import/cad_import.h"
#include "prepared_model.h"

namespace dupin {

/// Every member may be called from any thread, but the destructor while another member runs.
class LoadJob {
 public:
  /// Reads a file and prepares what is in it. `progress` of both options is called too, if given; `finished`
  /// on the job's thread, once done() holds.
  static std::unique_ptr<LoadJob> start(const std::string& path, ImportOptions import, PrepareOptions prepare,
                                        std::function<void()> finished = {});
  /// Prepares a model that the host has made or read.
  static std::unique_ptr<LoadJob> start(std::shared_ptr<const Model> model, PrepareOptions prepare,
                                        std::function<void()> finished = {});
  /// Cancels, and waits.
  ~LoadJob();

  /// Of the stage that runs now, 0 … 1.
  double fraction() const;
  /// What is being done, for a person.
  std::string stage() const;
  /// Asks it to stop; it does within a few milliseconds, with StatusCode::cancelled.
  void cancel();
  bool done() const;
  /// At most so long; whether it is done.
  bool wait(double seconds) const;
  /// Waits.
  Result<std::shared_ptr<const PreparedModel>> result() const;

 private:
  class Impl;
  explicit LoadJob(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dupin

#endif
