#include "import_shapes.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "../file_kind.h"
#include "convert.h"
#include "import_mesh.h"
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
      return {StatusCode::unreadable, "not a " + std::string(kSupportedKinds) + " file"};
  }
}

/// Where the file's content is to be read, and what it is.
struct Content {
  std::optional<MemoryFile> unpacked;
  std::string path;
  FileKind kind{};
};

Result<Content> find_content(const ImportRequest& request, const Stage& stage) {
  Content content{std::nullopt, request.path};
  Result<FileKind> kind = file_kind(request.path);
  if (kind.ok() && *kind == FileKind::gzip) {
    stage("unpacking", 0);
    Result<MemoryFile> unpacked = unpack_gzip(request.path);
    if (!unpacked.ok()) return unpacked.status();
    content.unpacked.emplace(std::move(*unpacked));
    content.path = content.unpacked->path();
    kind = file_kind(content.path, request.path);
  }
  if (!kind.ok()) return kind.status();
  content.kind = *kind;
  return content;
}

}  // namespace

Result<SourceDocument> read_document(const ImportRequest& request, const Stage& stage) {
  const Result<Content> content = find_content(request, stage);
  if (!content.ok()) return content.status();
  return read_kind(content->kind, content->path, request.read, stage);
}

Result<Model> import_shapes(const ImportRequest& request, const Stage& stage) {
  const Result<Content> content = find_content(request, stage);
  if (!content.ok()) return content.status();
  if (is_mesh(content->kind))
    return import_mesh({content->kind, content->path, request.path, request.read.assumed_unit}, stage);
  const Result<SourceDocument> document = read_kind(content->kind, content->path, request.read, stage);
  if (!document.ok()) return document.status();
  Model model = convert(*document, request.mesh, stage);
  model.source = std::filesystem::path(request.path).filename().string();
  if (model.instances.empty() && model.skipped.empty())
    return {StatusCode::unreadable, model.notes.empty() ? "the file holds no faces"
                                                        : "the file holds no faces: " + model.notes.front()};
  return model;
}

}  // namespace dupin::reader
