#include <cstdio>
#include <memory>

#include "brep_content.h"
#include "read_files.h"
#include "units.h"

namespace dupin::reader {
namespace {

std::string content_of(const std::string& path) {
  std::string content;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
  if (!file) return content;
  char buffer[1 << 16];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, file.get())) > 0;) content.append(buffer, n);
  return content;
}

}  // namespace

Result<SourceDocument> read_brep(const std::string& path, const ReadOptions& options, const Stage& stage) {
  stage("reading", 0);
  SourceItem item;
  item.shape = read_brep_content(content_of(path));
  if (item.shape.IsNull()) return {StatusCode::unreadable, "the BREP file is damaged or holds no shape"};
  SourceDocument document{"BREP", "no unit in the file; taken as " + options.assumed_unit};
  const double scale = millimetres(options.assumed_unit);
  item.placement.linear = {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
  document.items.push_back(std::move(item));
  return document;
}

}  // namespace dupin::reader
