// What has been measured so far: JSON lines, one a row, added as rows are finished. A run that was ended goes
// on from there.
#ifndef DUPIN_APP_STUDY_JOURNAL_H
#define DUPIN_APP_STUDY_JOURNAL_H

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure.h"
#include "study.h"

namespace dupin::app {

/// What a row is, in one string: its model's bytes, camera, options and reference. Rows with the same key
/// have the same results.
class RowKeys {
 public:
  std::string of(const Study& study, const StudyRow& row);
  /// What its pictures are called in the study's folder, without their endings: the same wherever the row
  /// stands.
  std::string picture_of(const Study& study, const StudyRow& row);

 private:
  const std::string& digest_text(const std::string& path);
  std::map<std::string, std::string> digests_;  ///< by path
};

/// The machine and the build, for every row's line.
nlohmann::ordered_json machine_facts();

/// One line of a journal.
nlohmann::ordered_json journal_line(const Study& study, const StudyRow& row, const std::string& key,
                                    const RowResult& result, const nlohmann::ordered_json& machine);

/// Finished lines by key; of a row that failed and was tried again, the one that did not. Lines that are no
/// JSON (the last of a run that was ended) are left out.
class Journal {
 public:
  /// Adds what a journal holds; a missing file holds nothing.
  void read(const std::string& path);
  /// Every journal in a folder.
  void read_folder(const std::string& folder);
  /// Null where the row has not been measured.
  const nlohmann::ordered_json* find(const std::string& key) const;
  void add(const std::string& key, nlohmann::ordered_json line) { lines_[key] = std::move(line); }

 private:
  std::map<std::string, nlohmann::ordered_json> lines_;
};

/// The end of a journal's file that lines are added to. One process at a time has it.
class JournalFile {
 public:
  ~JournalFile();
  Status open(const std::string& path);
  /// On the disk when it returns.
  Status add(const nlohmann::ordered_json& line);

 private:
  std::string path_;
  int file_ = -1;
};

std::string journal_name(int shard, int shards);

/// Text as a cell of a CSV.
std::string csv_cell(const std::string& text);
/// results.csv: what is the same run after run, one line a row, failures with their reason. timed.csv: the
/// same with the seconds, the commit and the machine. Written whole.
Status write_tables(const Study& study, const std::vector<const nlohmann::ordered_json*>& lines,
                    const std::string& folder);

}  // namespace dupin::app

#endif
