#include "files.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../../cad_import/cad_import.h"

namespace dupin::test {
namespace fs = std::filesystem;

std::string sample(const std::string& name) {
  return std::string(DUPIN_SAMPLES) + "/" + name;
}

std::string data(const std::string& name) {
  const char* folder = std::getenv("DUPIN_DATA");
  const std::string path = std::string(folder ? folder : DUPIN_DATA_DEFAULT) + "/" + name;
  return fs::exists(path) ? path : "";
}

const std::string& scratch() {
  struct Folder {
    std::string path = (fs::temp_directory_path() / ("dupin-test-" + std::to_string(::getpid()))).string();
    Folder() { fs::create_directories(path); }
    ~Folder() {
      std::error_code error;
      fs::remove_all(path, error);
    }
  };
  static const Folder folder;
  return folder.path;
}

std::string write_file(const std::string& name, std::string_view content) {
  const std::string path = scratch() + "/" + name;
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

std::string read_file(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

Result<Model> import_file(const std::string& path) {
  ImportOptions options;
  options.time_limit_seconds = 60;
  return import_cad(path, options);
}

}  // namespace dupin::test
