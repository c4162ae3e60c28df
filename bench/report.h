// Rows of a benchmark, as a table for people and as JSON lines for programs.
#ifndef DUPIN_BENCH_REPORT_H
#define DUPIN_BENCH_REPORT_H

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dupin::bench {

double median(std::vector<double> values);

/// One line of the table for a row made by `measure` in prepare.cpp; the heading for none.
std::string table_line(const nlohmann::json* row);
/// What the rows come to: medians, and which miss the goals.
void print_summary(const std::vector<nlohmann::json>& rows);

}  // namespace dupin::bench

#endif
