// The tables of a study, from its journal.
#include "../output_file.h"
#include "journal.h"

namespace dupin::app {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const Json& numbers, const std::string& name) {
  const auto at = numbers.find(name);
  if (at == numbers.end() || at->is_null()) return {};
  return at->is_string() ? csv_cell(at->get<std::string>()) : at->dump();
}

class Table {
 public:
  Table(const Study& study, bool timed) : study_(study), timed_(timed) {
    text_ = "row,model,view,width,height";
    for (const std::string& key : study.keys) text_ += "," + csv_cell(key);
    text_ += ",status";
    for (const std::string& name : result_columns()) text_ += "," + name;
    if (timed) {
      for (const std::string& name : time_columns()) text_ += "," + name;
      text_ += ",version,commit,cpu,cores,gl_renderer";
    }
    text_ += "\n";
  }

  void add(const StudyRow& row, const Json& line) {
    text_ += std::to_string(row.index) + "," + csv_cell(row.model.name) + "," + csv_cell(row.view.name) +
             "," + std::to_string(row.width) + "," + std::to_string(row.height);
    for (const std::string& key : study_.keys) text_ += "," + csv_cell(row.value_of(key));
    text_ += "," + csv_cell(line["status"].get<std::string>());
    for (const std::string& name : result_columns()) text_ += "," + cell(line["results"], name);
    if (timed_) {
      for (const std::string& name : time_columns()) text_ += "," + cell(line["times"], name);
      for (const char* name : {"version", "commit", "cpu", "cores", "gl_renderer"})
        text_ += "," + cell(line["machine"], name);
    }
    text_ += "\n";
  }

  Status write(const std::string& path) const {
    OutputFile file;
    if (const Status status = file.open(path); !status.ok()) return status;
    if (const Status status = file.write(text_); !status.ok()) return status;
    return file.commit();
  }

 private:
  const Study& study_;
  bool timed_;
  std::string text_;
};

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

Status write_tables(const Study& study, const std::vector<const Json*>& lines, const std::string& folder) {
  for (const bool timed : {false, true}) {
    Table table(study, timed);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (lines[i]) table.add(study.rows[i], *lines[i]);
    const Status status = table.write(folder + (timed ? "/timed.csv" : "/results.csv"));
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace dupin::app
