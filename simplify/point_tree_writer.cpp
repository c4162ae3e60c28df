#include "point_tree_writer.h"

#include <cstring>

#include "../core/parallel.h"
#include "point_tree_layout.h"

namespace dupin {
namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void append_text(std::string& bytes, const std::string& text) {
  append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.append(text);
}

class Writer {
 public:
  explicit Writer(const PointTreeContent& content) : content_(content) {
    std::size_t blocks = 0;
    for (const std::string& b : *content.blocks) blocks += b.size();
    bytes_.reserve(sizeof(PointTreeHeader) + content.nodes.size_bytes() + content.curvatures.size_bytes() +
                   content.leaf_groups.size_bytes() + blocks + blocks / 1000 + 65536);
    bytes_.resize(sizeof(PointTreeHeader));
  }

  std::string run() {
    put(kNodes, content_.nodes.data(), content_.nodes.size_bytes());
    put(kCurvatures, content_.curvatures.data(), content_.curvatures.size_bytes());
    put_blocks();
    put(kLeafGroups, content_.leaf_groups.data(), content_.leaf_groups.size_bytes());
    const std::string texts = this->texts();
    put(kTexts, texts.data(), texts.size());
    put_pages();
    put_header();
    return std::move(bytes_);
  }

 private:
  void put(PointTreeSection section, const void* data, std::size_t size) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    header_.sections[section] = {bytes_.size(), size};
    if (size > 0) bytes_.append(static_cast<const char*>(data), size);
  }

  void put_blocks() {
    std::vector<BlockEntry> entries;
    std::string packed;
    BlockEntry entry;
    for (std::size_t i = 0; i < content_.blocks->size(); ++i) {
      entries.push_back(entry);
      entry.offset += (*content_.blocks)[i].size();
      const std::uint64_t last = std::min<std::uint64_t>((i + 1) * kBlockLeaves, content_.leaves);
      for (std::uint64_t rank = i * kBlockLeaves; rank < last; ++rank)
        entry.first_triangle += content_.leaf_triangles(rank);
    }
    if (!entries.empty()) entries.push_back(entry);
    put(kBlocks, entries.data(), entries.size() * sizeof(BlockEntry));
    put(kBlockBytes, nullptr, 0);
    for (const std::string& b : *content_.blocks) bytes_.append(b);
    header_.sections[kBlockBytes].size = entry.offset;
  }

  std::string texts() const {
    std::string bytes;
    append_text(bytes, content_.source.name);
    append_text(bytes, content_.source.unit_note);
    for (const MeshGroup& group : *content_.groups) {
      append_text(bytes, group.name);
      append(bytes, static_cast<std::uint8_t>(group.color.has_value()));
      const Color c = group.color.value_or(Color{});
      for (const float x : {c.r, c.g, c.b, c.a}) append(bytes, x);
    }
    return bytes;
  }

  void put_pages() {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    const std::span<const char> paged(bytes_.data() + sizeof(PointTreeHeader),
                                      bytes_.size() - sizeof(PointTreeHeader));
    std::vector<std::uint64_t> sums((paged.size() + kPointTreePage - 1) / kPointTreePage);
    parallel_for(sums.size(), [&](std::size_t i) {
      const std::uint64_t first = i * kPointTreePage;
      sums[i] =
          page_checksum(paged.subspan(first, std::min<std::uint64_t>(kPointTreePage, paged.size() - first)));
    });
    put(kPages, sums.data(), sums.size() * 8);
  }

  void put_header() {
    std::memcpy(header_.magic, kPointTreeMagic, sizeof header_.magic);
    header_.version = kPointTreeVersion;
    header_.kind = static_cast<std::uint32_t>(content_.kind);
    header_.flags = content_.colors ? kColorsFlag : 0;
    header_.groups = static_cast<std::uint32_t>(content_.groups->size());
    header_.leaves = content_.leaves, header_.triangles = content_.triangles;
    for (int k = 0; k < 3; ++k) {
      header_.origin[k] = content_.grid.origin[k];
      header_.box_lo[k] = content_.box.lo[k], header_.box_hi[k] = content_.box.hi[k];
    }
    header_.step = content_.grid.step, header_.scale = content_.source.scale;
    header_.file_bytes = bytes_.size();
    const auto* raw = reinterpret_cast<const char*>(&header_);
    header_.checksum = page_checksum({raw, sizeof header_ - sizeof header_.checksum});
    std::memcpy(bytes_.data(), &header_, sizeof header_);
  }

  const PointTreeContent& content_;
  PointTreeHeader header_{};
  std::string bytes_;
};

}  // namespace

std::string point_tree_bytes(const PointTreeContent& content) {
  return Writer(content).run();
}

}  // namespace dupin
