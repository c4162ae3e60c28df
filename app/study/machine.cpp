// What a row was measured on, and by what.
#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "build_facts.h"
#include "journal.h"

namespace dupin::app {
namespace {

/// The value of the first line "NAME : VALUE" of a file in /proc.
std::string proc_value(const char* path, const std::string& name) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(name, 0) != 0) continue;
    const std::size_t at = line.find_first_not_of(" \t", line.find(':') + 1);
    return at == std::string::npos ? std::string() : line.substr(at);
  }
  return {};
}

}  // namespace

nlohmann::ordered_json machine_facts() {
  utsname system{};
  uname(&system);
  return {{"version", kVersion},
          {"commit", kCommit},
          {"compiler", kCompiler},
          {"cpu", proc_value("/proc/cpuinfo", "model name")},
          {"cores", std::thread::hardware_concurrency()},
          {"memory", proc_value("/proc/meminfo", "MemTotal")},
          {"system", std::string(system.sysname) + " " + system.release + " " + system.machine}};
}

}  // namespace dupin::app
