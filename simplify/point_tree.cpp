#include "point_tree.h"

#include <atomic>
#include <cmath>
#include <cstring>

#include "point_tree_bytes.h"
#include "point_tree_layout.h"

namespace dupin {
namespace {

Status damaged(const std::string& what) {
  return {StatusCode::unreadable, "the point tree is damaged: " + what};
}

constexpr std::uint64_t kMostLeaves = std::uint64_t{1} << 29;
/// What builders make lies below: places on the grid, and boxes of whole models, stay numbers.
constexpr double kLargestLength = 1e101;

/// Texts as a length and that many bytes.
class TextReader {
 public:
  explicit TextReader(std::span<const char> bytes) : left_(bytes) {}
  bool text(std::string& out) {
    std::uint32_t size;
    if (!value(size) || size > left_.size()) return false;
    out.assign(left_.data(), size);
    left_ = left_.subspan(size);
    return true;
  }
  template <class T>
  bool value(T& out) {
    if (left_.size() < sizeof out) return false;
    std::memcpy(&out, left_.data(), sizeof out);
    left_ = left_.subspan(sizeof out);
    return true;
  }

 private:
  std::span<const char> left_;
};

bool read_group(TextReader& in, MeshGroup& group) {
  std::uint8_t colored;
  float c[4];
  if (!in.text(group.name) || !in.value(colored) || !in.value(c)) return false;
  if (colored) group.color = Color{c[0], c[1], c[2], c[3]};
  return true;
}

bool bounded(const double* values, int count) {
  for (int i = 0; i < count; ++i)
    if (!(std::abs(values[i]) <= kLargestLength)) return false;
  return true;
}

/// The sections that a header promises lie in the file, one behind the other, and have the sizes that the
/// counts ask for.
Status check_sections(const PointTreeHeader& h, const TreeShape& shape) {
  std::uint64_t end = sizeof(PointTreeHeader);
  for (const ByteRange& s : h.sections) {
    if (s.offset % 8 != 0 || s.offset < end || s.offset > h.file_bytes || s.size > h.file_bytes - s.offset)
      return damaged("a section lies outside of the file");
    end = s.offset + s.size;
  }
  const auto size = [&](PointTreeSection s) { return h.sections[s].size; };
  const std::uint64_t blocks = (h.leaves + kBlockLeaves - 1) / kBlockLeaves;
  const bool pop = h.kind == static_cast<std::uint32_t>(PointTreeKind::pop);
  const std::uint64_t paged = h.sections[kPages].offset - sizeof(PointTreeHeader);
  if (size(kNodes) != shape.nodes() * sizeof(EncodedNode) ||
      (size(kCurvatures) != 0 && size(kCurvatures) != 4 * shape.interior()) ||
      size(kBlocks) != (pop ? (blocks + 1) * sizeof(BlockEntry) : 0) ||
      (size(kLeafGroups) != 0 && size(kLeafGroups) != 4 * h.leaves) ||
      size(kPages) != 8 * ((paged + kPointTreePage - 1) / kPointTreePage))
    return damaged("a section has a wrong size");
  return {};
}

}  // namespace

struct PointTree::Sections {
  std::span<const char> section[kSections];
  std::span<const char> paged;  ///< what pages are counted from
  bool trusted = false;
  /// 0: not looked at yet; 1: good; 2: damaged.
  mutable std::vector<std::atomic<std::uint8_t>> pages;
  mutable std::atomic<std::uint64_t> damaged_page{~std::uint64_t{0}};
  mutable std::atomic<std::uint64_t> damaged_block{~std::uint64_t{0}};

  BlockEntry block(std::size_t i) const {
    BlockEntry entry;
    std::memcpy(&entry, section[kBlocks].data() + i * sizeof entry, sizeof entry);
    return entry;
  }
};

std::uint64_t page_checksum(std::span<const char> bytes) {
  // Four lanes, so that a page takes a few microseconds.
  std::uint64_t h[4] = {0x9e3779b97f4a7c15u, 0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu, bytes.size()};
  std::size_t i = 0;
  for (; i + 32 <= bytes.size(); i += 32)
    for (std::size_t k = 0; k < 4; ++k) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + i + 8 * k, 8);
      h[k] = (h[k] ^ word) * 0xff51afd7ed558ccdu;
      h[k] ^= h[k] >> 32;
    }
  for (; i < bytes.size(); ++i) h[0] = (h[0] ^ static_cast<unsigned char>(bytes[i])) * 0xff51afd7ed558ccdu;
  for (std::size_t k = 1; k < 4; ++k) h[0] = ((h[0] ^ (h[0] >> 29)) + h[k]) * 0xc4ceb9fe1a85ec53u;
  return h[0] ^ h[0] >> 32;
}

PointTree::~PointTree() = default;

Result<std::shared_ptr<const PointTree>> PointTree::from_bytes(std::shared_ptr<const Bytes> bytes) {
  std::shared_ptr<PointTree> tree(new PointTree);
  tree->bytes_ = std::move(bytes);
  if (Status status = tree->read_header(); !status.ok()) return status;
  return std::shared_ptr<const PointTree>(std::move(tree));
}

Status PointTree::read_header() {
  const std::span<const char> all = bytes_->all();
  PointTreeHeader h;
  if (all.size() < sizeof h) return damaged("it is too short");
  std::memcpy(&h, all.data(), sizeof h);
  if (std::memcmp(h.magic, kPointTreeMagic, sizeof h.magic) != 0)
    return damaged("it does not begin as one does");
  if (h.version != kPointTreeVersion)
    return {StatusCode::unreadable, "the point tree is of version " + std::to_string(h.version) + ", not " +
                                        std::to_string(kPointTreeVersion)};
  if (h.checksum != page_checksum(all.first(sizeof h - sizeof h.checksum)))
    return damaged("its header's checksum is wrong");
  if (h.file_bytes != all.size()) return damaged("its length is wrong");
  if (h.kind > 1 || h.leaves == 0 || h.leaves > kMostLeaves || h.triangles > kMostLeafTriangles * h.leaves ||
      !bounded(h.origin, 3) || !bounded(h.box_lo, 3) || !bounded(h.box_hi, 3) || !(h.step > 0) ||
      !bounded(&h.step, 1) || !(h.scale > 0) || !bounded(&h.scale, 1))
    return damaged("its header's numbers are out of range");
  shape_ = TreeShape(h.leaves);
  if (Status status = check_sections(h, shape_); !status.ok()) return status;

  sections_ = std::make_unique<Sections>();
  for (unsigned s = 0; s < kSections; ++s)
    sections_->section[s] = all.subspan(h.sections[s].offset, h.sections[s].size);
  sections_->paged = all.subspan(sizeof h, h.sections[kPages].offset - sizeof h);
  sections_->trusted = bytes_->trusted();
  sections_->pages = std::vector<std::atomic<std::uint8_t>>(h.sections[kPages].size / 8);

  info_.kind = static_cast<PointTreeKind>(h.kind);
  info_.colors = h.flags & kColorsFlag;
  info_.nodes = shape_.nodes(), info_.leaves = h.leaves, info_.triangles = h.triangles;
  info_.grid = {{h.origin[0], h.origin[1], h.origin[2]}, h.step};
  info_.box = {{h.box_lo[0], h.box_lo[1], h.box_lo[2]}, {h.box_hi[0], h.box_hi[1], h.box_hi[2]}};
  info_.position_error = 0.5 * h.step;
  info_.source.scale = h.scale;

  const ByteRange texts = h.sections[kTexts];
  if (!page_is_good(texts.offset, texts.size)) return damaged("its texts' checksum is wrong");
  TextReader in(sections_->section[kTexts]);
  if (!in.text(info_.source.name) || !in.text(info_.source.unit_note))
    return damaged("its texts are cut off");
  for (std::uint32_t i = 0; i < h.groups; ++i)
    if (MeshGroup group; read_group(in, group))
      groups_.push_back(std::move(group));
    else
      return damaged("its groups are cut off");
  return {};
}

/// `first` counts from the beginning of the file.
bool PointTree::page_is_good(std::uint64_t first, std::uint64_t bytes) const {
  if (sections_->trusted || bytes == 0) return true;
  first -= sizeof(PointTreeHeader);
  bool good = true;
  for (std::uint64_t page = first / kPointTreePage; page * kPointTreePage < first + bytes; ++page) {
    std::atomic<std::uint8_t>& state = sections_->pages[page];
    std::uint8_t known = state.load(std::memory_order_relaxed);
    if (known == 0) {
      const std::uint64_t begin = page * kPointTreePage;
      const std::uint64_t size = std::min<std::uint64_t>(kPointTreePage, sections_->paged.size() - begin);
      std::uint64_t expected;
      std::memcpy(&expected, sections_->section[kPages].data() + 8 * page, 8);
      known = page_checksum(sections_->paged.subspan(begin, size)) == expected ? 1 : 2;
      state.store(known, std::memory_order_relaxed);
      if (known == 2) sections_->damaged_page.store(page, std::memory_order_relaxed);
    }
    good = good && known == 1;
  }
  return good;
}

std::size_t PointTree::byte_count() const {
  return bytes_->all().size();
}
std::span<const char> PointTree::bytes() const {
  return bytes_->all();
}

std::span<const EncodedNode> PointTree::nodes(std::uint64_t first, std::uint64_t count) const {
  const std::span<const char> bytes =
      sections_->section[kNodes].subspan(first * sizeof(EncodedNode), count * sizeof(EncodedNode));
  if (!sections_->trusted &&
      !page_is_good(static_cast<std::uint64_t>(bytes.data() - bytes_->all().data()), bytes.size()))
    return {};
  return {reinterpret_cast<const EncodedNode*>(bytes.data()), count};
}

const EncodedNode* PointTree::trusted_nodes() const {
  return sections_->trusted ? reinterpret_cast<const EncodedNode*>(sections_->section[kNodes].data())
                            : nullptr;
}

void PointTree::copy_nodes(std::span<const std::uint32_t> indices, EncodedNode* nodes) const {
  if (const EncodedNode* const all = trusted_nodes()) {
    for (const std::uint32_t index : indices) *nodes++ = all[index];
    return;
  }
  for (const std::uint32_t index : indices) {
    const auto node = this->nodes(index, 1);
    *nodes++ = node.empty() ? EncodedNode{} : node[0];
  }
}

std::uint32_t PointTree::curvature(std::uint64_t node) const {
  const std::span<const char> all = sections_->section[kCurvatures];
  if (4 * node + 4 > all.size()) return 0;
  const char* at = all.data() + 4 * node;
  if (!page_is_good(static_cast<std::uint64_t>(at - bytes_->all().data()), 4)) return 0;
  std::uint32_t bits;
  std::memcpy(&bits, at, 4);
  return bits;
}

std::uint32_t PointTree::leaf_group(std::uint64_t rank) const {
  const std::span<const char> all = sections_->section[kLeafGroups];
  if (4 * rank + 4 > all.size()) return 0;
  const char* at = all.data() + 4 * rank;
  if (!page_is_good(static_cast<std::uint64_t>(at - bytes_->all().data()), 4)) return 0;
  std::uint32_t group;
  std::memcpy(&group, at, 4);
  return group < groups_.size() ? group : 0;
}

std::uint64_t PointTree::first_triangle(std::size_t block) const {
  return info_.kind == PointTreeKind::pop ? sections_->block(block).first_triangle : 0;
}

bool PointTree::block(std::size_t block, MeshBlock& out) const {
  const auto fail = [&] {
    sections_->damaged_block.store(block, std::memory_order_relaxed);
    return false;
  };
  const std::span<const char> entries = sections_->section[kBlocks], bytes = sections_->section[kBlockBytes];
  if (info_.kind != PointTreeKind::pop || block >= block_count()) return false;
  const char* const all = bytes_->all().data();
  if (!page_is_good(static_cast<std::uint64_t>(entries.data() - all) + block * sizeof(BlockEntry),
                    2 * sizeof(BlockEntry)))
    return fail();
  const BlockEntry here = sections_->block(block), next = sections_->block(block + 1);
  if (next.offset < here.offset || next.offset > bytes.size()) return fail();
  const std::span<const char> packed = bytes.subspan(here.offset, next.offset - here.offset);
  if (!page_is_good(static_cast<std::uint64_t>(packed.data() - all), packed.size())) return fail();

  std::uint8_t counts[kBlockLeaves];
  const std::uint64_t first = block * kBlockLeaves,
                      last = std::min<std::uint64_t>(first + kBlockLeaves, info_.leaves);
  for (std::uint64_t rank = first; rank < last; ++rank) {
    const auto leaf = nodes(shape_.leaf_node(rank), 1);
    if (leaf.empty()) return fail();
    counts[rank - first] = static_cast<std::uint8_t>(node_triangles(leaf[0]));
  }
  if (!decode_block(packed, {counts, last - first}, out) ||
      here.first_triangle + out.triangles.size() != next.first_triangle)
    return fail();
  return true;
}

Status PointTree::damage() const {
  const std::uint64_t page = sections_->damaged_page.load(), block = sections_->damaged_block.load();
  if (page != ~std::uint64_t{0})
    return damaged("the checksum of the page at byte " +
                   std::to_string(sizeof(PointTreeHeader) + page * kPointTreePage) + " is wrong");
  if (block != ~std::uint64_t{0})
    return damaged("block " + std::to_string(block) + " does not hold what it promises");
  return {};
}

Status PointTree::verify() const {
  for (std::uint64_t at = 0; at < sections_->paged.size(); at += kPointTreePage)
    if (!page_is_good(sizeof(PointTreeHeader) + at, 1)) return damage();
  MeshBlock block;
  for (std::size_t i = 0; info_.kind == PointTreeKind::pop && i < block_count(); ++i)
    if (!this->block(i, block)) return damage();
  return {};
}

bool is_point_tree(std::span<const char> head) {
  return head.size() >= sizeof kPointTreeMagic &&
         std::memcmp(head.data(), kPointTreeMagic, sizeof kPointTreeMagic) == 0;
}

}  // namespace dupin
