// The differential points of a model as arrays.
#ifndef DUPIN_INTEGRATIONS_PYTHON_POINTS_H
#define DUPIN_INTEGRATIONS_PYTHON_POINTS_H

#include "../../sampling/differential_point.h"
#include "arrays.h"

namespace dupin::python {

/// Every placement's points, one after the other, in model space.
class Points {
 public:
  Points(const Model& model, PointScene scene);
  std::size_t size() const { return points_->size(); }

  py::array_t<double> positions() const { return vectors(&DifferentialPoint::position); }
  py::array_t<double> directions() const { return vectors(&DifferentialPoint::u); }
  py::array_t<double> normals() const;
  py::array_t<double> curvatures() const { return pairs(&DifferentialPoint::lambda_u); }
  py::array_t<double> half_extents() const { return pairs(&DifferentialPoint::half_u); }
  py::array_t<double> uv() const;
  py::array_t<double> bounds() const;
  py::array_t<std::uint32_t> faces() const;
  py::array_t<std::uint32_t> instances() const;
  const std::vector<std::string>& notes() const { return notes_; }
  /// The name and the reason of each face without a point.
  const std::vector<std::pair<std::string, std::string>>& skipped() const { return skipped_; }

 private:
  using List = std::vector<DifferentialPoint>;
  py::array_t<double> vectors(Vec3 DifferentialPoint::*member) const;
  /// Two doubles that lie one behind the other.
  py::array_t<double> pairs(double DifferentialPoint::*first) const;

  std::shared_ptr<List> points_ = std::make_shared<List>();
  std::vector<std::size_t> ends_;  ///< of each instance's points
  std::vector<std::string> notes_;
  std::vector<std::pair<std::string, std::string>> skipped_;
};

}  // namespace dupin::python

#endif
