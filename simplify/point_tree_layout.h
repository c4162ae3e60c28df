// The bytes of a point tree: a header, then sections, then a checksum for each page of everything behind the
// header.
#ifndef DUPIN_SIMPLIFY_POINT_TREE_LAYOUT_H
#define DUPIN_SIMPLIFY_POINT_TREE_LAYOUT_H

#include <bit>
#include <cstdint>
#include <span>

namespace dupin {

static_assert(std::endian::native == std::endian::little,
              "the format is little-endian and mapped as it lies");

inline constexpr char kPointTreeMagic[8] = {'D', 'U', 'P', 'I', 'N', 'D', 'P', 'T'};
inline constexpr std::uint32_t kPointTreeVersion = 1;
inline constexpr std::uint64_t kPointTreePage = 65536;

/// A run of bytes from the beginning of the file.
struct ByteRange {
  std::uint64_t offset = 0, size = 0;
};

enum PointTreeSection : unsigned {
  kNodes,       ///< EncodedNode each
  kCurvatures,  ///< of interior nodes, 4 bytes each; may be empty
  kBlocks,      ///< BlockEntry each, and one more for the end; may be empty
  kBlockBytes,
  kLeafGroups,  ///< 4 bytes a leaf by rank; empty: all 0
  kTexts,       ///< name, unit note, then each group's name and colour
  kPages,       ///< the pages' checksums
  kSections
};

struct BlockEntry {
  std::uint64_t offset = 0;  ///< in kBlockBytes
  std::uint64_t first_triangle = 0;
};

struct PointTreeHeader {
  char magic[8];
  std::uint32_t version, kind;
  std::uint32_t flags, groups;
  std::uint64_t leaves, triangles;
  double origin[3], step, box_lo[3], box_hi[3], scale;
  ByteRange sections[kSections];
  std::uint64_t file_bytes;
  std::uint64_t checksum;  ///< of the header before it
};
static_assert(sizeof(PointTreeHeader) % 8 == 0);
inline constexpr std::uint32_t kColorsFlag = 1;

/// Not cryptographic.
std::uint64_t page_checksum(std::span<const char> bytes);

}  // namespace dupin

#endif
