// Files that the tests read: the shipped samples, and real models where $DUPIN_DATA has them.
#ifndef DUPIN_TESTS_CAD_IMPORT_FILES_H
#define DUPIN_TESTS_CAD_IMPORT_FILES_H

#include <string>
#include <string_view>

#include "../../core/status.h"
#include "../../nurbs/model.h"

namespace dupin::test {

std::string sample(const std::string& name);
/// Empty where there is no such file.
std::string data(const std::string& name);

/// A folder of this process's own that is removed at its end.
const std::string& scratch();
std::string write_file(const std::string& name, std::string_view content);
std::string read_file(const std::string& path);

/// import_cad with default options and a time limit of a minute.
Result<Model> import_file(const std::string& path);

}  // namespace dupin::test

#define DUPIN_NEED_DATA(variable, name)                   \
  const std::string variable = ::dupin::test::data(name); \
  if (variable.empty()) GTEST_SKIP() << "no " << name << " in $DUPIN_DATA"

#endif
