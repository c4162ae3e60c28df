#include "journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace dupin::app {
namespace {

constexpr std::chrono::seconds kLockWait{2};

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// FNV-1a, byte after byte.
class Digest {
 public:
  void add(const char* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      hash_ = (hash_ ^ static_cast<unsigned char>(bytes[i])) * 1099511628211ULL;
  }
  std::string text() const {
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

/// A model that has changed is another model.
std::string digest_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  Digest digest;
  std::vector<char> buffer(1 << 16);
  do {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    digest.add(buffer.data(), static_cast<std::size_t>(in.gcount()));
  } while (in);
  return digest.text();
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double v : values) text += Json(v).dump() + ",";
  return text;
}

std::string reference_name(const Study& study) {
  if (study.reference == ReferenceKind::exact) return "exact";
  if (study.reference == ReferenceKind::none) return "none";
  return "triangles:" + Json(study.reference_deflection).dump();
}

}  // namespace

const std::string& RowKeys::digest_text(const std::string& path) {
  std::string& digest = digests_[path];
  if (digest.empty()) digest = digest_of(path);
  return digest;
}

std::string RowKeys::of(const Study& study, const StudyRow& row) {
  const std::string digest =
      digest_text(row.model.path) + (row.model.of.empty() ? "" : " of " + digest_text(row.model.of));
  const ViewOptions& camera = row.view.camera;
  std::string key = row.model.name + "|" + digest + "|" + camera.view + "," + Json(row.view.zoom).dump() +
                    "," + Json(camera.fov_degrees).dump() + "," + (camera.orthographic ? "o" : "p") + "," +
                    numbers(camera.eye) + ";" + numbers(camera.target) + ";" + numbers(camera.up) + "|" +
                    std::to_string(row.width) + "x" + std::to_string(row.height) + "|" + row.arguments() +
                    "|" + reference_name(study) + (study.draw ? "" : "|not drawn") +
                    (study.pictures ? "|pictures" : "");
  // A study that times frames needs rows with times, however many.
  if (study.draw && study.frames > 0) key += "|timed";
  return key;
}

std::string RowKeys::picture_of(const Study& study, const StudyRow& row) {
  const std::string key = of(study, row);
  Digest digest;
  digest.add(key.data(), key.size());
  return "pictures/" + digest.text();
}

Json journal_line(const Study& study, const StudyRow& row, const std::string& key, const RowResult& result,
                  const Json& machine) {
  Json line{{"key", key},
            {"study", study.title},
            {"row", row.index},
            {"model", row.model.name},
            {"view", row.view.name},
            {"width", row.width},
            {"height", row.height},
            {"reference", reference_name(study)}};
  line["options"] = Json::object();
  for (const auto& [name, value] : row.options) line["options"][name] = value;
  line["status"] = result.failure.empty() ? "ok" : result.failure;
  line["results"] = result.results;
  line["times"] = result.times;
  if (!result.pictures.empty()) line["pictures"] = result.pictures;
  line["command"] = result.command;
  line["machine"] = machine;
  return line;
}

void Journal::read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  for (std::string text; std::getline(in, text);) {
    Json line = Json::parse(text, nullptr, false);
    if (!line.is_object() || !line.contains("key") || !line["key"].is_string() || !line.contains("results") ||
        !line.contains("times") || !line.contains("status"))
      continue;
    const std::string key = line["key"];
    const auto known = lines_.find(key);
    if (known == lines_.end() || known->second["status"] != "ok" || line["status"] == "ok")
      lines_.insert_or_assign(key, std::move(line));
  }
}

void Journal::read_folder(const std::string& folder) {
  std::vector<std::string> journals;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".jsonl") journals.push_back(entry.path().string());
  std::sort(journals.begin(), journals.end());
  for (const std::string& path : journals) read(path);
}

const Json* Journal::find(const std::string& key) const {
  const auto at = lines_.find(key);
  return at == lines_.end() ? nullptr : &at->second;
}

JournalFile::~JournalFile() {
  if (file_ >= 0) close(file_);
}

Status JournalFile::open(const std::string& path) {
  path_ = path;
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) return {StatusCode::cannot_write, path + ": " + std::strerror(errno)};
  // A worker of a run that was killed shares that run's lock for the moment until it is ended too.
  const auto until = std::chrono::steady_clock::now() + kLockWait;
  while (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (std::chrono::steady_clock::now() > until)
      return {StatusCode::cannot_write, path + ": another run of the study is writing it"};
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  // A run that was ended may have left half a line.
  const off_t size = lseek(file_, 0, SEEK_END);
  char last = '\n';
  if (size > 0 && pread(file_, &last, 1, size - 1) == 1 && last != '\n' && write(file_, "\n", 1) != 1)
    return {StatusCode::cannot_write, path + ": cannot write"};
  return {};
}

Status JournalFile::add(const Json& line) {
  const std::string text = text_of(line) + "\n";
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(file_, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return {StatusCode::cannot_write, path_ + ": " + std::strerror(errno)};
    at += static_cast<std::size_t>(n);
  }
  fdatasync(file_);
  return {};
}

std::string journal_name(int shard, int shards) {
  return shards == 1 ? "rows.jsonl"
                     : "rows." + std::to_string(shard) + "-of-" + std::to_string(shards) + ".jsonl";
}

}  // namespace dupin::app
