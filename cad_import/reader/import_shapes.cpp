#include "import_shapes.h"

#include <filesystem>

#include "../file_kind.h"
#include "convert.h"
#include "unpack.h"

namespace dupin::reader {

namespace {

Result<SourceDocument> read_kind(FileKind kind, const std::string& path, const ReadOptions& options,
                                 const Stage& stage) {
  switch (kind) {
    case FileKind::step:
      return read_step(path, stage);
    case FileKind::iges:
      return read_iges(path, stage);
    case FileKind::brep_text:
    case FileKind::brep_binary:
      return read_brep(path, options, stage);
    case FileKind::zip:
      return read_fcstd(path, stage);
    case FileKind::empty:
      return {StatusCode::unreadable, "the file is empty"};
    default:
      return {StatusCode::unreadable, "not a STEP, IGES, BREP or FCStd file"};
  }
}

}  // namespace

Result<SourceDocument> read_document(const ImportRequest& request, const Stage& stage) {
  const Result<FileKind> kind = file_kind(request.path);
  if (!kind.ok()) return kind.status();
  if (*kind != FileKind::gzip) return read_kind(*kind, request.path, request.read, stage);
  stage("unpacking", 0);
  const Result<MemoryFile> unpacked = unpack_gzip(request.path);
  if (!unpacked.ok()) return unpacked.status();
  const Result<FileKind> inner = file_kind(unpacked->path());
  if (!inner.ok()) return inner.status();
  return read_kind(*inner, unpacked->path(), request.read, stage);
}

Result<Model> import_shapes(const ImportRequest& request, const Stage& stage) {
  Result<SourceDocument> document = read_document(request, stage);
  if (!document.ok()) return document.status();
  Model model = convert(*document, request.mesh, stage);
  model.source = std::filesystem::path(request.path).filename().string();
  if (model.instances.empty() && model.skipped.empty())
    return {StatusCode::unreadable, model.notes.empty() ? "the file holds no faces"
                                                        : "the file holds no faces: " + model.notes.front()};
  return model;
}

}  // namespace dupin::reader
