// Reading members of a zip file, with a limit on what they unpack to.
#ifndef DUPIN_CAD_IMPORT_READER_ZIP_ARCHIVE_H
#define DUPIN_CAD_IMPORT_READER_ZIP_ARCHIVE_H

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

struct zip;

namespace dupin::reader {

class ZipArchive {
 public:
  /// Null if the file is no zip archive.
  static std::unique_ptr<ZipArchive> open(const std::string& path);
  ~ZipArchive();
  /// The member's content; none if there is no such member, it is damaged, or all members read so far unpack
  /// to more than kMaxUnpackedBytes.
  std::optional<std::string> read(const std::string& member);

 private:
  explicit ZipArchive(zip* archive) : archive_(archive) {}
  zip* archive_;
  std::uint64_t unpacked_ = 0;
};

}  // namespace dupin::reader

#endif
