#include "import_mesh.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "../mesh_files/mesh_file.h"
#include "units.h"

namespace dupin::reader {
namespace {

constexpr std::uintmax_t kMostMaterialBytes = 16 << 20;

/// A file's bytes, mapped into memory while this lives.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat info {};
    if (fd >= 0 && ::fstat(fd, &info) == 0 && info.st_size > 0) {
      size_ = static_cast<std::size_t>(info.st_size);
      void* const at = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd, 0);
      if (at != MAP_FAILED) data_ = static_cast<const char*>(at);
    }
    if (fd >= 0) ::close(fd);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile() {
    if (data_) ::munmap(const_cast<char*>(data_), size_);
  }
  bool ok() const { return data_; }
  std::string_view bytes() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

/// A file beside the mesh, or below: a mesh has no business anywhere else.
std::optional<std::string> neighbour(const std::filesystem::path& mesh, std::string_view name) {
  std::string relative(name);
  std::replace(relative.begin(), relative.end(), '\\', '/');
  const std::filesystem::path wanted = std::filesystem::path(relative).lexically_normal();
  if (wanted.empty() || wanted.is_absolute() || *wanted.begin() == "..") return std::nullopt;
  const std::filesystem::path path = mesh.parent_path() / wanted;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) ||
      std::filesystem::file_size(path, error) > kMostMaterialBytes || error)
    return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

Result<mesh_files::MeshFile> read(const MeshRequest& request, std::string_view bytes) {
  switch (request.kind) {
    case FileKind::obj:
      return mesh_files::read_obj(bytes,
                                  [&](std::string_view name) { return neighbour(request.named_path, name); });
    case FileKind::ply:
      return mesh_files::read_ply(bytes);
    case FileKind::stl_text:
      return mesh_files::read_stl_text(bytes);
    case FileKind::stl_binary:
      return mesh_files::read_stl_binary(bytes);
    default:
      return mesh_files::read_off(bytes);
  }
}

}  // namespace

Result<Model> import_mesh(const MeshRequest& request, const Stage& stage) {
  stage("reading", 0);
  const MappedFile file(request.path);
  if (!file.ok()) return {StatusCode::unreadable, "the file cannot be read"};
  Result<mesh_files::MeshFile> mesh = read(request, file.bytes());
  if (!mesh.ok()) return mesh.status();
  if (mesh->mesh.empty()) return {StatusCode::unreadable, "the file holds no vertices"};
  Model model;
  const std::filesystem::path name(request.named_path);
  model.source = name.filename().string();
  model.format = mesh->format;
  model.unit_note = "no unit in the file; taken as " + request.assumed_unit;
  model.notes = std::move(mesh->notes);
  Part& part = model.parts.emplace_back();
  part.name = name.stem().string();
  part.polygons = std::move(mesh->mesh);
  part.box = bounding_box(part.polygons);
  Instance& instance = model.instances.emplace_back();
  const double scale = millimetres(request.assumed_unit);
  instance.to_world.linear = {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
  return model;
}

}  // namespace dupin::reader
