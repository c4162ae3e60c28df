#include "study_table.h"

#include <gtest/gtest.h>

#include <sstream>

#include "command.h"

namespace dupin::test {

std::vector<Row> table(const std::string& path) {
  std::istringstream lines(read_file(path));
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line, cell; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> values;
    while (std::getline(cells, cell, ',')) values.push_back(cell);
    if (names.empty()) {
      names = values;
      continue;
    }
    values.resize(names.size());
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
  }
  return rows;
}

double number(const Row& row, const std::string& name) {
  const auto at = row.find(name);
  if (at == row.end() || at->second.empty()) {
    ADD_FAILURE() << "no " << name;
    return 0;
  }
  return std::stod(at->second);
}

}  // namespace dupin::test
