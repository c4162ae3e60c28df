// One reader a file format, each giving a SourceDocument. They may throw OCCT's exceptions.
#ifndef DUPIN_CAD_IMPORT_READER_READ_FILES_H
#define DUPIN_CAD_IMPORT_READER_READ_FILES_H

#include <string>

#include "../../core/status.h"
#include "source_document.h"

namespace dupin::reader {

struct ReadOptions {
  std::string assumed_unit = "mm";  ///< for files that have none
};

Result<SourceDocument> read_step(const std::string& path, const Stage& stage);
Result<SourceDocument> read_iges(const std::string& path, const Stage& stage);
Result<SourceDocument> read_fcstd(const std::string& path, const Stage& stage);
Result<SourceDocument> read_brep(const std::string& path, const ReadOptions& options, const Stage& stage);

}  // namespace dupin::reader

#endif
