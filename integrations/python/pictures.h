// Rendering models into arrays, comparing pictures, and the options that drawing has in Python.
#ifndef DUPIN_INTEGRATIONS_PYTHON_PICTURES_H
#define DUPIN_INTEGRATIONS_PYTHON_PICTURES_H

#include "../../nurbs/model.h"
#include "../../render/renderer.h"
#include "arrays.h"

namespace dupin::python {

/// The keyword arguments that every way to draw has: shading, edges, edge_width, samples, color, background,
/// lights, sections, curvature_scale. Takes them out of `keywords`.
DrawOptions take_draw_options(py::dict& keywords);
/// TypeError if any keyword is left.
void expect_none_left(const py::dict& keywords, const char* function);

py::dict render(const std::shared_ptr<const Model>& model, const py::kwargs& keywords);
py::dict compare_pictures(const py::object& a, const py::object& b, double fov);

}  // namespace dupin::python

#endif
