// Which cells of a grid over a face's parameter box the face touches.
#ifndef DUPIN_CAD_IMPORT_READER_REGION_GRID_H
#define DUPIN_CAD_IMPORT_READER_REGION_GRID_H

#include <vector>

#include "../../nurbs/model.h"

namespace dupin::reader {

class RegionGrid {
 public:
  RegionGrid(const Part& part, const Face& face, int cells_u, int cells_v);
  bool touches(int i, int j) const { return touched_[static_cast<std::size_t>(j) * cells_u_ + i] != 0; }
  int cells_u() const { return cells_u_; }
  int cells_v() const { return cells_v_; }
  /// The corner of cells at (i, j), 0 … cells.
  Vec2 corner(int i, int j) const {
    return {box_.lo.x + box_.size().x * i / cells_u_, box_.lo.y + box_.size().y * j / cells_v_};
  }

 private:
  void mark_line(Vec2 a, Vec2 b);
  void fill();

  Box2 box_;
  int cells_u_, cells_v_;
  std::vector<char> touched_;
  std::vector<std::vector<double>>
      crossings_;  ///< per row, where the loops cross the line through the cells' centres
};

}  // namespace dupin::reader

#endif
