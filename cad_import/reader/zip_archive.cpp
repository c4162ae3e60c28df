#include "zip_archive.h"

#include <zip.h>

#include "unpack.h"

namespace dupin::reader {

std::unique_ptr<ZipArchive> ZipArchive::open(const std::string& path) {
  int error = 0;
  zip* archive = ::zip_open(path.c_str(), ZIP_RDONLY, &error);
  return std::unique_ptr<ZipArchive>(archive ? new ZipArchive(archive) : nullptr);
}

ZipArchive::~ZipArchive() {
  ::zip_discard(archive_);
}

std::optional<std::string> ZipArchive::read(const std::string& member) {
  zip_file_t* file = ::zip_fopen(archive_, member.c_str(), 0);
  if (!file) return std::nullopt;
  // The directory's sizes are claims; what counts is what comes out.
  std::string content;
  char buffer[65536];
  zip_int64_t n = 0;
  while ((n = ::zip_fread(file, buffer, sizeof buffer)) > 0) {
    unpacked_ += static_cast<std::uint64_t>(n);
    if (unpacked_ > kMaxUnpackedBytes) break;
    content.append(buffer, static_cast<std::size_t>(n));
  }
  ::zip_fclose(file);
  return n == 0 ? std::optional(std::move(content)) : std::nullopt;
}

}  // namespace dupin::reader
