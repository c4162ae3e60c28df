// The tables that studies leave.
#ifndef DUPIN_TESTS_APP_STUDY_TABLE_H
#define DUPIN_TESTS_APP_STUDY_TABLE_H

#include <map>
#include <string>
#include <vector>

namespace dupin::test {

using Row = std::map<std::string, std::string>;

/// Rows by the names of the columns. No cell may hold a comma.
std::vector<Row> table(const std::string& path);
/// A failure of the test, and 0, where there is no such number.
double number(const Row& row, const std::string& name);

}  // namespace dupin::test

#endif
