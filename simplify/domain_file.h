// `.dom` files of domains: what decomposing and texturing took seconds for, in a few bytes a texel.
//
// Little-endian:  8 "DUPINDOM" | u32 version, 1 | u64 key | u32 parts | the parts | u32 CRC-32C of all before
// it
//   part  u32 sets | the sets
//   set   f64 texel, deviation_rms, deviation_99 | u64 points | u8 oriented | u32 width, height of the atlas
//   |
//         u32 primitives, neighbors, faces | the primitives (f64 × 3 center, f32 × 3 u, v, f64 half_u,
//         half_v, lo, hi, u32 face, first_neighbor, neighbors, x, y, width, height) | u32 neighbors | u32
//         faces | textures, each u32 bytes (0: none) and a zlib stream: Ψ; normals and heights; colors; faces
//         — channel by channel, each byte less the one before it in its row
#ifndef DUPIN_SIMPLIFY_DOMAIN_FILE_H
#define DUPIN_SIMPLIFY_DOMAIN_FILE_H

#include <string>
#include <string_view>

#include "domain_primitives.h"

namespace dupin {

/// `key`: tells what the domains are of, for whoever reads them.
std::string write_domains(const DomainScene& scene, std::uint64_t key);

struct DomainFile {
  DomainScene scene;  ///< every set passes check()
  std::uint64_t key = 0;
};
/// unreadable: not such a file, of another version, or damaged. limit: larger than kMostAtlas texels a set.
Result<DomainFile> read_domains(std::string_view bytes);
inline constexpr std::uint64_t kMostAtlas = std::uint64_t{1} << 28;

}  // namespace dupin

#endif
