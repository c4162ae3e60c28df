#include "file_kind.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <initializer_list>
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

std::string_view first_word(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == line.npos) return {};
  line.remove_prefix(first);
  return line.substr(0, line.find_first_of(" \t\r"));
}

bool is_any_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Every statement is one of OBJ's, and there is a vertex with numbers (or the head ends among comments and
// names).
bool is_obj(std::string_view text) {
  bool vertex = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == text.npos && vertex) break;  // perhaps cut off
    const std::string_view line = text.substr(0, end), word = first_word(line);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (word.empty() || word.front() == '#') continue;
    if (word == "v")
      vertex = vertex || line.find_first_of("0123456789") != line.npos;
    else if (!is_any_of(word,
                        {"vn", "vt", "vp", "f", "g", "o", "s", "l", "p", "t", "mtllib", "usemtl", "cstype"}))
      return false;
  }
  return vertex;
}

bool is_off(std::string_view text) {
  text = skip_blank(text);
  while (text.starts_with("#")) {
    const std::size_t end = text.find('\n');
    if (end == text.npos) return false;
    text = skip_blank(text.substr(end));
  }
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
  return word.size() <= 8 && word.ends_with("OFF") && word.find_first_not_of("STCN4nOF") == word.npos;
}

// "solid" may also begin a binary file's header; only a text goes on with facets.
bool is_stl_text(std::string_view text) {
  text = skip_blank(text);
  if (!text.starts_with("solid") && !text.starts_with("SOLID")) return false;
  if (text.find('\0') != text.npos) return false;
  return is_any_of(first_word(skip_blank(text.substr(std::min(text.find('\n'), text.size())))),
                   {"facet", "FACET", "endsolid", "ENDSOLID"});
}

bool is_stl_binary(std::string_view head, std::uint64_t file_bytes) {
  if (head.size() < 84) return false;
  std::uint32_t triangles;
  std::memcpy(&triangles, head.data() + 80, 4);
  return file_bytes == 84 + 50ull * triangles;
}

bool has_ending(std::string_view name, std::string_view lower) {
  if (name.ends_with(".gz")) name.remove_suffix(3);
  if (name.size() < lower.size()) return false;
  name.remove_prefix(name.size() - lower.size());
  return std::equal(name.begin(), name.end(), lower.begin(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

// So that a damaged mesh file is refused for what is wrong with it.
FileKind kind_by_name(std::string_view text, std::string_view name) {
  if (has_ending(name, ".obj")) return FileKind::obj;
  if (has_ending(name, ".off")) return FileKind::off;
  if (!has_ending(name, ".stl")) return FileKind::unknown;
  return skip_blank(text).starts_with("solid") && text.find('\0') == text.npos ? FileKind::stl_text
                                                                               : FileKind::stl_binary;
}

}  // namespace

FileKind find_file_kind(std::span<const char> head, std::uint64_t file_bytes, std::string_view name) {
  const std::string_view text(head.data(), head.size());
  if (text.empty()) return FileKind::empty;
  if (text.starts_with("\x1f\x8b")) return FileKind::gzip;
  if (text.starts_with("PK\x03\x04")) return FileKind::zip;
  if (is_step(text)) return FileKind::step;
  if (is_brep_text(text)) return FileKind::brep_text;
  if (is_brep_binary(text)) return FileKind::brep_binary;
  if (is_iges(text)) return FileKind::iges;
  if (text.starts_with("ply\n") || text.starts_with("ply\r") || text.starts_with("ply "))
    return FileKind::ply;
  if (is_off(text)) return FileKind::off;
  if (is_stl_text(text)) return FileKind::stl_text;
  if (is_stl_binary(text, file_bytes == 0 ? head.size() : file_bytes)) return FileKind::stl_binary;
  if (is_obj(text)) return FileKind::obj;
  return kind_by_name(text, name);
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
    case FileKind::obj:
      return "OBJ";
    case FileKind::ply:
      return "PLY";
    case FileKind::stl_text:
    case FileKind::stl_binary:
      return "STL";
    case FileKind::off:
      return "OFF";
    case FileKind::empty:
      return "empty";
    case FileKind::unknown:
      break;
  }
  return "unknown";
}

Result<FileKind> file_kind(const std::string& path, std::string_view name) {
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
  return find_file_kind(head, static_cast<std::uint64_t>(info.st_size), name.empty() ? path : name);
}

}  // namespace dupin
