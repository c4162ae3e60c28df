#include "runner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "../stopwatch.h"
#include "worker.h"

namespace dupin::app {
namespace {

class Runner {
 public:
  Runner(const Study& study, const RunOptions& options, Journal& journal)
      : study_(study),
        options_(options),
        journal_(journal),
        session_(options.common),
        machine_(machine_facts()) {}

  Status run() {
    const Status status = file_.open(options_.folder + "/" + journal_name(options_.shard, options_.shards));
    if (!status.ok()) return status;
    plan();
    const std::size_t all = pending_.size();
    if (finished_ > 0) session_.note(std::to_string(finished_) + " rows are there already");
    for (std::size_t i = 0; i < all && failure_.ok();) {
      std::size_t end = i + 1;
      while (end < all && pending_[end]->model.id() == pending_[i]->model.id()) ++end;
      measure_model({pending_.begin() + static_cast<std::ptrdiff_t>(i),
                     pending_.begin() + static_cast<std::ptrdiff_t>(end)});
      i = end;
    }
    session_.done();
    return failure_;
  }

 private:
  void plan() {
    const auto [first, last] = shard_range(study_.rows.size(), options_.shard, options_.shards);
    std::set<std::string> planned;
    for (std::size_t i = first; i < last; ++i) {
      const std::string key = keys_.of(study_, study_.rows[i]);
      const auto* line = journal_.find(key);
      if (line && (*line)["status"] == "ok")
        ++finished_;
      else if (planned.insert(key).second)
        pending_.push_back(&study_.rows[i]);
    }
    // The rows of a model stay together, and of a model those of a picture: in the order in which they first
    // come.
    for (const StudyRow* row : pending_) place_of(*row);
    std::stable_sort(pending_.begin(), pending_.end(),
                     [this](const StudyRow* a, const StudyRow* b) { return place_of(*a) < place_of(*b); });
  }
  std::pair<std::size_t, std::size_t> place_of(const StudyRow& row) {
    const std::size_t model = places_.emplace(row.model.id(), places_.size()).first->second;
    const std::string picture = row.model.id() + "\n" + row.view.name + "\n" + std::to_string(row.width) +
                                "x" + std::to_string(row.height);
    return {model, places_.emplace(picture, places_.size()).first->second};
  }

  /// Starts another process after one that died, without the row that it died of.
  void measure_model(std::vector<const StudyRow*> rows) {
    while (!rows.empty() && failure_.ok()) {
      Worker worker(study_, options_.common, options_.folder, rows);
      std::size_t at = rows.front()->index;
      while (const auto message = worker.next(study_.row_seconds)) {
        at = message->row;
        // Asked only here: rows that took turns are finished together, and none of them is to be lost.
        if (!message->done && over()) return;
        if (!message->done) continue;
        finish(message->result, message->gl_renderer);
        remove(rows, message->row);
      }
      const std::string why = worker.end();
      if (rows.empty()) return;
      RowResult failed;
      failed.row = at;
      failed.failure = why.empty() ? "was not measured" : why;
      finish(failed, "");
      remove(rows, at);
    }
  }
  static void remove(std::vector<const StudyRow*>& rows, std::size_t index) {
    const auto at =
        std::find_if(rows.begin(), rows.end(), [&](const StudyRow* r) { return r->index == index; });
    // Never the same rows again: an end without a word is put down to the first.
    rows.erase(at == rows.end() ? rows.begin() : at);
  }

  bool over() {
    if (session_.limits().time_is_over()) failure_ = {StatusCode::cancelled, ""};
    return !failure_.ok();
  }

  void finish(const RowResult& result, const std::string& gl_renderer) {
    const StudyRow& row = study_.rows[result.row];
    nlohmann::ordered_json machine = machine_;
    machine["gl_renderer"] = gl_renderer;
    const std::string key = keys_.of(study_, row);
    nlohmann::ordered_json line = journal_line(study_, row, key, result, machine);
    if (const Status status = file_.add(line); !status.ok()) failure_ = status;
    journal_.add(key, std::move(line));
    ++measured_;
    if (!result.failure.empty())
      session_.warn("row " + std::to_string(row.index) + " (" + row.model.name + "): " + result.failure);
    report_progress(row);
  }

  void report_progress(const StudyRow& row) {
    const std::size_t left = pending_.size() - measured_;
    elapsed_ += watch_.lap();
    const double to_go = elapsed_ / static_cast<double>(measured_) * static_cast<double>(left);
    const std::string text = "row " + std::to_string(finished_ + measured_) + " of " +
                             std::to_string(finished_ + pending_.size()) + ", " + duration_text(to_go) +
                             " left";
    session_.progress()(
        text, static_cast<double>(finished_ + measured_) / static_cast<double>(finished_ + pending_.size()));
    session_.note(text + ": " + row.model.name + " " + row.view.name + " " + row.arguments());
  }

  const Study& study_;
  const RunOptions& options_;
  Journal& journal_;
  Session session_;
  nlohmann::ordered_json machine_;
  JournalFile file_;
  RowKeys keys_;
  std::vector<const StudyRow*> pending_;
  std::map<std::string, std::size_t> places_;
  std::size_t finished_ = 0, measured_ = 0;
  Stopwatch watch_;
  double elapsed_ = 0;
  Status failure_;
};

}  // namespace

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(std::lround(seconds));
  char text[48];
  if (s < 60)
    std::snprintf(text, sizeof text, "%ld s", s);
  else if (s < 3600)
    std::snprintf(text, sizeof text, "%ld min %ld s", s / 60, s % 60);
  else
    std::snprintf(text, sizeof text, "%ld h %ld min", s / 3600, s / 60 % 60);
  return text;
}

Status run_rows(const Study& study, const RunOptions& options, Journal& journal) {
  return Runner(study, options, journal).run();
}

}  // namespace dupin::app
