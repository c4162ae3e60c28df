// Domain sets as the GPU holds them: records in a texture buffer, and all atlases in one picture.
#ifndef DUPIN_RENDER_DOMAIN_RECORDS_H
#define DUPIN_RENDER_DOMAIN_RECORDS_H

#include <cstdint>
#include <vector>

#include "../simplify/domain_primitives.h"
#include "scene.h"

namespace dupin {

/// Texels (RGBA32F) of a record:  center, half u | u, half v | v, lo | hi, face, first neighbor, neighbors |
/// atlas x, y, width, height.  The center is relative to the part's anchor; the three numbers are bits.
inline constexpr std::size_t kDomainTexels = 5;

/// A set within the buffers.
struct PlacedSet {
  std::uint32_t first = 0, count = 0;  ///< records
  double detail = 0;                   ///< the largest of its errors and texels, in the part's units
};

/// What the CPU keeps of a record.
struct PlacedDomain {
  Vec3 center, normal;  ///< relative to the part's anchor
  bool oriented = true;
  std::uint32_t first_neighbor = 0, neighbors = 0;
};

/// Where a set's atlas lies in the picture.
struct AtlasPlace {
  std::uint32_t x = 0, y = 0;
};

struct DomainPictures {
  std::uint32_t width = 0, height = 0;
  bool colors = false, faces = false;
  std::vector<std::array<std::uint8_t, 4>> color_psi;  ///< with colors
  std::vector<std::uint8_t> psi;                       ///< without
  std::vector<std::array<std::uint8_t, 4>> normal_height;
  std::vector<std::uint16_t> face;  ///< number of the face among its part's drawn ones
};

struct DomainPackage {
  std::vector<float> records;
  std::vector<std::uint32_t> neighbors;      ///< indices of records
  std::vector<PlacedDomain> domains;         ///< one a record
  std::vector<std::vector<PlacedSet>> sets;  ///< per part, the coarsest first
  DomainPictures pictures;
};

/// limit: the atlases do not fit into a picture of `most` × `most`, or the records into `most_texels`.
Status pack_domains(const DomainScene& domains, const Scene::Impl& scene, std::uint32_t most,
                    std::size_t most_texels, DomainPackage& package);

}  // namespace dupin

#endif
