#include "domain_records.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "../simplify/amg/atlas.h"

namespace dupin {
namespace {

template <class What>
void each_set(const DomainScene& domains, const What& what) {
  std::size_t index = 0;
  for (std::size_t part = 0; part < domains.parts.size(); ++part)
    for (const DomainSet& set : domains.parts[part]) what(part, set, index++);
}

/// Atlases beside each other; rectangles are only moved.
Status place_atlases(const DomainScene& domains, std::uint32_t most, std::vector<AtlasPlace>& places,
                     DomainPictures& pictures) {
  std::vector<DomainPrimitive> rectangles;
  each_set(domains, [&](std::size_t, const DomainSet& set, std::size_t) {
    DomainPrimitive rectangle;
    rectangle.width = std::max(1U, set.atlas.width);
    rectangle.height = std::max(1U, set.atlas.height);
    rectangles.push_back(rectangle);
    pictures.colors = pictures.colors || !set.atlas.color.empty();
    pictures.faces = pictures.faces || !set.atlas.face.empty();
  });
  DomainAtlas all;
  if (!amg::pack(rectangles, most, all))
    return {StatusCode::limit, "the domains' textures are larger than this OpenGL context's"};
  pictures.width = all.width;
  pictures.height = all.height;
  for (const DomainPrimitive& r : rectangles) places.push_back({r.x, r.y});
  return {};
}

class Packer {
 public:
  Packer(const Scene::Impl& scene, DomainPackage& package) : scene_(scene), package_(package) {}

  void allocate() {
    DomainPictures& p = package_.pictures;
    const std::size_t texels = std::size_t(p.width) * p.height;
    if (p.colors) p.color_psi.resize(texels);
    if (!p.colors) p.psi.resize(texels);
    p.normal_height.resize(texels);
    if (p.faces) p.face.resize(texels);
  }

  void add(std::size_t part, const DomainSet& set, const AtlasPlace& place) {
    const ScenePart& scene_part = scene_.parts[part];
    PlacedSet placed;
    placed.first = static_cast<std::uint32_t>(package_.records.size() / (4 * kDomainTexels));
    placed.count = static_cast<std::uint32_t>(set.primitives.size());
    placed.detail = std::max(set.texel, set.deviation_99);
    const auto neighbors = static_cast<std::uint32_t>(package_.neighbors.size());
    for (const std::uint32_t n : set.neighbors) package_.neighbors.push_back(placed.first + n);
    for (const DomainPrimitive& p : set.primitives) {
      add_record(p, scene_part, neighbors, place);
      package_.domains.push_back(
          {p.center - scene_part.anchor, p.n(), set.oriented, neighbors + p.first_neighbor, p.neighbors});
    }
    copy_atlas(set, scene_part, place);
    package_.sets[part].push_back(placed);
  }

 private:
  void add_record(const DomainPrimitive& p, const ScenePart& part, std::uint32_t neighbors,
                  const AtlasPlace& place) {
    const auto put = [&](const Vec3& v, double w) {
      for (const double x : {v.x, v.y, v.z, w}) package_.records.push_back(static_cast<float>(x));
    };
    put(p.center - part.anchor, p.half_u);
    put(p.u, p.half_v);
    put(p.v, p.lo);
    package_.records.push_back(static_cast<float>(p.hi));
    for (const std::uint32_t n : {part.face_numbers[p.face], neighbors + p.first_neighbor, p.neighbors})
      package_.records.push_back(std::bit_cast<float>(n));
    for (const std::uint32_t n : {place.x + p.x, place.y + p.y, p.width, p.height})
      package_.records.push_back(static_cast<float>(n));
  }

  void copy_atlas(const DomainSet& set, const ScenePart& part, const AtlasPlace& place) {
    DomainPictures& to = package_.pictures;
    const DomainAtlas& atlas = set.atlas;
    for (std::uint32_t y = 0; y < atlas.height; ++y)
      for (std::uint32_t x = 0; x < atlas.width; ++x) {
        const std::size_t from = std::size_t(y) * atlas.width + x,
                          at = std::size_t(place.y + y) * to.width + place.x + x;
        to.normal_height[at] = atlas.normal_height[from];
        if (!to.colors) to.psi[at] = atlas.psi[from];
        if (to.colors) {
          const std::uint32_t c = atlas.color.empty() ? 0xffffff : atlas.color[from];
          to.color_psi[at] = {static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(c >> 8),
                              static_cast<std::uint8_t>(c >> 16), atlas.psi[from]};
        }
        if (to.faces) {
          const std::uint32_t face = atlas.face.empty() ? set.faces.front() : atlas.face[from];
          to.face[at] = static_cast<std::uint16_t>(part.face_numbers[face]);
        }
      }
  }

  const Scene::Impl& scene_;
  DomainPackage& package_;
};

}  // namespace

Status pack_domains(const DomainScene& domains, const Scene::Impl& scene, std::uint32_t most,
                    std::size_t most_texels, DomainPackage& package) {
  std::vector<AtlasPlace> places;
  std::size_t primitives = 0;
  each_set(domains,
           [&](std::size_t, const DomainSet& set, std::size_t) { primitives += set.primitives.size(); });
  if (primitives * kDomainTexels > most_texels)
    return {StatusCode::limit, "the domains are more than this OpenGL context's texture buffers can hold"};
  if (Status placed = place_atlases(domains, most, places, package.pictures); !placed.ok()) return placed;
  package.sets.resize(domains.parts.size());
  Packer packer(scene, package);
  packer.allocate();
  each_set(domains, [&](std::size_t part, const DomainSet& set, std::size_t index) {
    packer.add(part, set, places[index]);
  });
  return {};
}

}  // namespace dupin
