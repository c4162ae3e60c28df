// Where a point tree's bytes lie: in memory, or in a mapped file.
#ifndef DUPIN_SIMPLIFY_POINT_TREE_BYTES_H
#define DUPIN_SIMPLIFY_POINT_TREE_BYTES_H

#include <string>

#include "point_tree.h"

namespace dupin {

class PointTree::Bytes {
 public:
  virtual ~Bytes() = default;
  virtual std::span<const char> all() const = 0;
  /// They were made by this process: there is nothing to check.
  virtual bool trusted() const = 0;
};

class OwnedBytes : public PointTree::Bytes {
 public:
  explicit OwnedBytes(std::string bytes, bool trusted) : bytes_(std::move(bytes)), trusted_(trusted) {}
  std::span<const char> all() const override { return bytes_; }
  bool trusted() const override { return trusted_; }

 private:
  std::string bytes_;
  bool trusted_;
};

}  // namespace dupin

#endif
