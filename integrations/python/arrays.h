// C++ memory as NumPy arrays that keep it alive: nothing is copied.
#ifndef DUPIN_INTEGRATIONS_PYTHON_ARRAYS_H
#define DUPIN_INTEGRATIONS_PYTHON_ARRAYS_H

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <vector>

#include "../../core/progress.h"
#include "../../core/status.h"

namespace dupin::python {

namespace py = pybind11;

/// Throws dupin.Error with the status's message and the name of its code.
[[noreturn]] void raise(const Status& status);
template <class T>
T value_of(Result<T> result) {
  if (!result) raise(result.status());
  return std::move(*result);
}
inline void check_status(const Status& status) {
  if (!status.ok()) raise(status);
}

/// What Python code is called with how far work has come; False stops it. None: not called.
Progress progress_of(const py::object& callback);

/// An array over memory that `owner` keeps.
template <class T, class Owner>
py::array_t<T> view_of(const std::shared_ptr<Owner>& owner, const T* data, std::vector<py::ssize_t> shape,
                       std::vector<py::ssize_t> strides = {}) {
  auto* kept = new std::shared_ptr<Owner>(owner);
  const py::capsule base(kept, [](void* p) { delete static_cast<std::shared_ptr<Owner>*>(p); });
  if (strides.empty()) return py::array_t<T>(std::move(shape), data, base);
  return py::array_t<T>(std::move(shape), std::move(strides), data, base);
}

/// A vector's values as an array, which takes them over.
template <class T>
py::array_t<T> array_of(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto owner = std::make_shared<std::vector<T>>(std::move(values));
  return view_of<T>(owner, owner->data(), std::move(shape));
}

}  // namespace dupin::python

#endif
