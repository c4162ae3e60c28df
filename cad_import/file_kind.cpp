#include "file_kind.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace dupin {
namespace {

std::string_view skip_blank(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == text.npos ? std::string_view{} : text.substr(first);
}

// Part 21 begins "ISO-10303-21;", after white space or comments.
bool is_step(std::string_view text) {
  text = skip_blank(text);
  while (text.starts_with("/*")) {
    const std::size_t end = text.find("*/");
    if (end == text.npos) return false;
    text = skip_blank(text.substr(end + 2));
  }
  return text.starts_with("ISO-10303-21");
}

// Fixed-form IGES: lines of 80 columns whose 73rd is the section's letter, S first, followed by a sequence
// number.
bool is_iges(std::string_view text) {
  bool seen_global = false;
  for (int line = 0; line < 40 && !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view row = text.substr(0, end);
    if (row.size() < 73) return false;
    const char section = row[72];
    if (section != 'S' && section != 'G' && section != 'D' && section != 'P') return false;
    for (const char c : row.substr(73))
      if (c != ' ' && c != '\r' && (c < '0' || c > '9')) return false;
    if (line == 0 && section != 'S') return false;
    if (section == 'G') seen_global = true;
    if (end == text.npos || section == 'D') break;
    text.remove_prefix(end + 1);
  }
  return seen_global;
}

bool is_brep_text(std::string_view text) {
  text = skip_blank(text);
  return text.starts_with("DBRep_DrawableShape") || text.starts_with("CASCADE Topology V");
}

bool is_brep_binary(std::string_view text) {
  const std::string_view begin = text.substr(0, 64);
  return begin.find("Open CASCADE Topology V") != begin.npos && !begin.starts_with("DBRep");
}

}  // namespace

FileKind find_file_kind(std::span<const char> head) {
  const std::string_view text(head.data(), head.size());
  if (text.empty()) return FileKind::empty;
  if (text.starts_with("\x1f\x8b")) return FileKind::gzip;
  if (text.starts_with("PK\x03\x04")) return FileKind::zip;
  if (is_step(text)) return FileKind::step;
  if (is_brep_text(text)) return FileKind::brep_text;
  if (is_brep_binary(text)) return FileKind::brep_binary;
  if (is_iges(text)) return FileKind::iges;
  return FileKind::unknown;
}

std::string_view kind_name(FileKind kind) {
  switch (kind) {
    case FileKind::step:
      return "STEP";
    case FileKind::iges:
      return "IGES";
    case FileKind::brep_text:
    case FileKind::brep_binary:
      return "BREP";
    case FileKind::zip:
      return "FCStd";
    case FileKind::gzip:
      return "gzip";
    case FileKind::empty:
      return "empty";
    case FileKind::unknown:
      break;
  }
  return "unknown";
}

Result<FileKind> file_kind(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) {
    if (errno == ENOENT) return {StatusCode::unreadable, path + ": no such file"};
    return {StatusCode::unreadable, path + ": " + std::strerror(errno)};
  }
  if (S_ISDIR(info.st_mode)) return {StatusCode::unreadable, path + ": is a folder, not a file"};
  if (!S_ISREG(info.st_mode)) return {StatusCode::unreadable, path + ": is not a regular file"};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
  if (!file) return {StatusCode::unreadable, path + ": " + std::strerror(errno)};
  std::vector<char> head(kFileHeadBytes);
  head.resize(std::fread(head.data(), 1, head.size(), file.get()));
  if (std::ferror(file.get())) return {StatusCode::unreadable, path + ": cannot be read"};
  return find_file_kind(head);
}

}  // namespace dupin
