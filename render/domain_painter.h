// Domains by blending and locking, as figure 10 of Reniers & Telea (2006) has it: for comparison.
#ifndef DUPIN_RENDER_DOMAIN_PAINTER_H
#define DUPIN_RENDER_DOMAIN_PAINTER_H

#include "domain_prefixes.h"
#include "domain_records.h"
#include "layer.h"
#include "part_camera.h"

namespace dupin {

class DomainPainter {
 public:
  void clear();
  /// Domains of a placed set, the first of which has the layer's number `number`.
  void add(const DomainPackage& package, const PlacedSet& set, std::uint32_t instance, std::uint32_t number,
           const PartCamera& camera, double scale);
  /// What has been added, into the ids and the depth of the pass and into sums of its own. The program, with
  /// a buffer `order` at `order_unit`, is in use.
  Status draw(const LayerPass& pass, GLuint program, int order_unit);
  /// The sums, for shading.
  void bind(const Gl& gl, int normal_unit, int color_unit) const;

 private:
  Status prepare(const LayerPass& pass);
  struct Entry {
    std::uint32_t number, instance, record, oriented;
  };
  std::vector<PrefixDomain> domains_;
  std::vector<Entry> entries_;
  TexelBuffer order_;
  GlTexture normal_, color_;
  GlFramebuffer framebuffer_;
  int width_ = 0, height_ = 0;
};

}  // namespace dupin

#endif
