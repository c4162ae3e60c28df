#include "import_shapes.h"

#include <filesystem>

#include "../file_kind.h"
#include "convert.h"

namespace dupin::reader {

Result<SourceDocument> read_document(const ImportRequest& request, const Stage& stage) {
  const Result<FileKind> kind = file_kind(request.path);
  if (!kind.ok()) return kind.status();
  switch (*kind) {
    case FileKind::step: return read_step(request.path, stage);
    case FileKind::brep_text: return read_brep(request.path, false, request.read, stage);
    case FileKind::brep_binary: return read_brep(request.path, true, request.read, stage);
    case FileKind::empty: return {StatusCode::unreadable, "the file is empty"};
    default: break;
  }
  return {StatusCode::unreadable, "not a STEP, IGES, BREP or FCStd file"};
}

Result<Model> import_shapes(const ImportRequest& request, const Stage& stage) {
  Result<SourceDocument> document = read_document(request, stage);
  if (!document.ok()) return document.status();
  Model model = convert(*document, request.mesh, stage);
  model.source = std::filesystem::path(request.path).filename().string();
  if (model.instances.empty() && model.skipped.empty())
    return {StatusCode::unreadable, "the file holds no faces"};
  return model;
}

}  // namespace dupin::reader
