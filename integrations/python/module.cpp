// The Python module `dupin`. What it has is described in dupin.pyi, and by help(dupin).
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>

#include "../../core/parallel.h"
#include "../../host/complete_model.h"
#include "../../host/host_scene.h"
#include "../../host/load_job.h"
#include "../../host/memory_file.h"
#include "../../sampling/point_sampler.h"
#include "current_context.h"
#include "pictures.h"
#include "points.h"

namespace dupin::python {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr const char* kCodeNames[] = {"ok",    "invalid_argument", "unreadable",   "partial",
                                      "limit", "no_device",        "cannot_write", "cancelled"};
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using ModelPointer = std::shared_ptr<const Model>;

py::object& error_class() {
  static auto* const error = new py::object;
  return *error;
}

py::array_t<double> vector(const Vec3& v) {
  return array_of(std::vector<double>{v.x, v.y, v.z}, {3});
}
py::object box_array(const Box3& b) {
  if (b.empty()) return py::none();
  return array_of(std::vector<double>{b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y, b.hi.z}, {2, 3});
}

/// 4 × 4, as NumPy has matrices: rows first. None: the identity.
std::array<double, 16> columns_of(const py::object& matrix) {
  const auto m = py::cast<Numbers>(matrix);
  if (m.ndim() != 2 || m.shape(0) != 4 || m.shape(1) != 4) throw py::value_error("a matrix is 4 x 4");
  std::array<double, 16> columns;
  for (py::ssize_t r = 0; r < 4; ++r)
    for (py::ssize_t c = 0; c < 4; ++c) columns[static_cast<std::size_t>(4 * c + r)] = m.at(r, c);
  return columns;
}
Affine3 affine_of(const py::object& matrix) {
  if (matrix.is_none()) return {};
  const auto m = columns_of(matrix);
  return {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
}
std::optional<Color> color_of(const py::object& color) {
  if (color.is_none()) return {};
  const auto c = py::cast<std::vector<float>>(color);
  if (c.size() != 3 && c.size() != 4) throw py::value_error("a color is three or four numbers");
  return Color{c[0], c[1], c[2], c.size() == 4 ? c[3] : 1.0F};
}

// ---- models

ImportOptions import_options(double time_limit, std::uint64_t memory_limit, const std::string& units,
                             const py::object& progress) {
  ImportOptions options;
  options.time_limit_seconds = time_limit;
  options.memory_limit_bytes = memory_limit;
  options.assumed_unit = units;
  options.progress = progress_of(progress);
  return options;
}

ModelPointer load(const std::string& path, const ImportOptions& options) {
  auto model = [&] {
    const py::gil_scoped_release release;
    return import_cad(path, options);
  }();
  if (PyErr_Occurred()) throw py::error_already_set();
  return std::make_shared<Model>(value_of(std::move(model)));
}

py::dict info(const Model& model) {
  py::dict out;
  py::dict kinds;
  std::size_t skipped = 0;
  for (const Instance& instance : model.instances) {
    const Part& part = model.parts[instance.part];
    for (const Face& face : part.faces) {
      const std::string kind(kind_name(part.surfaces[face.surface]));
      kinds[kind.c_str()] = py::cast<int>(kinds.contains(kind) ? kinds[kind.c_str()] : py::int_(0)) + 1;
    }
  }
  py::list left_out;
  for (const SkippedFace& face : model.skipped) {
    skipped += face.count;
    left_out.append(py::make_tuple(face.name, face.reason, face.count));
  }
  out["source"] = model.source, out["format"] = model.format, out["unit"] = model.unit_note;
  out["parts"] = model.parts.size(), out["instances"] = model.instances.size();
  out["faces"] = face_instance_count(model), out["kinds"] = kinds;
  out["skipped"] = left_out, out["notes"] = model.notes;
  out["box"] = box_array(bounding_box(model));
  return out;
}

std::vector<std::pair<std::string, std::string>> instance_names(const Model& model) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const Instance& instance : model.instances)
    names.emplace_back(instance.name, model.parts[instance.part].name);
  return names;
}

Points sample(const ModelPointer& model, const std::string& method, int grid, double spacing, double epsilon,
              double delta, double border, double tolerance, const py::object& progress) {
  PointSamplingOptions options;
  const auto* found = std::find(std::begin(kPointMethodNames), std::end(kPointMethodNames), method);
  if (found == std::end(kPointMethodNames)) throw py::value_error("there is no method '" + method + "'");
  options.method = static_cast<PointMethod>(found - std::begin(kPointMethodNames));
  const double diagonal = bounding_box(*model).diagonal();
  options.grid = grid, options.spacing = spacing, options.epsilon = epsilon;
  options.delta = delta > 0 ? delta : 0.02 * diagonal;
  options.mesh.delta = delta;
  options.border = border;
  options.tolerance = tolerance > 0 ? tolerance : 1e-4 * diagonal;
  options.progress = progress_of(progress);
  auto points = [&]() -> Result<Points> {
    const py::gil_scoped_release release;
    auto scene = sample_points(*model, options);
    if (!scene) return scene.status();
    return Points(*model, std::move(*scene));
  }();
  if (PyErr_Occurred()) throw py::error_already_set();
  return value_of(std::move(points));
}

PrepareOptions prepare_options(double tolerance, double normal_tolerance, const py::object& progress) {
  PrepareOptions options;
  options.tolerance = tolerance;
  options.normal_tolerance = normal_tolerance * kRadians;
  options.progress = progress_of(progress);
  return options;
}

std::shared_ptr<PreparedModel> unconst(std::shared_ptr<const PreparedModel> prepared) {
  // pybind11 holds no pointers to const; nothing in Python changes what it points to.
  return std::const_pointer_cast<PreparedModel>(std::move(prepared));
}

std::shared_ptr<PreparedModel> prepare_model(const ModelPointer& model, double tolerance,
                                             double normal_tolerance, const py::object& progress) {
  const PrepareOptions options = prepare_options(tolerance, normal_tolerance, progress);
  auto prepared = [&] {
    const py::gil_scoped_release release;
    return prepare(model, options);
  }();
  if (PyErr_Occurred()) throw py::error_already_set();
  return unconst(value_of(std::move(prepared)));
}

// ---- scenes

HostView view_of_host(const py::object& view, const py::object& projection,
                      const std::array<int, 4>& viewport) {
  return {columns_of(view), columns_of(projection), viewport};
}

std::unique_ptr<HostScene> make_scene(const py::object& lookup) {
  GetProcAddress get = current_proc_address();
  if (!lookup.is_none())
    get = [lookup](const char* name) {
      return reinterpret_cast<void*>(py::cast<std::uintptr_t>(lookup(name)));
    };
  if (!get) raise({StatusCode::no_device, "no OpenGL context is current on this thread"});
  return value_of(HostScene::create(get));
}

py::dict draw(HostScene& scene, const py::object& view, const py::object& projection,
              const std::array<int, 4>& viewport, const py::kwargs& given) {
  py::dict keywords;
  for (const auto& item : given) keywords[item.first] = item.second;
  const DrawOptions options = take_draw_options(keywords);
  expect_none_left(keywords, "draw");
  FrameStats stats;
  check_status(scene.draw(view_of_host(view, projection, viewport), options, &stats));
  py::dict out;
  out["primitives"] = stats.primitives, out["bound_px"] = stats.bound_px;
  out["milliseconds"] = stats.milliseconds;
  return out;
}

py::object pick(HostScene& scene, const py::object& view, const py::object& projection,
                const std::array<int, 4>& viewport, int x, int y) {
  const auto hit = value_of(scene.pick(view_of_host(view, projection, viewport), x, y));
  if (!hit) return py::none();
  py::dict out;
  out["object"] = hit->target.object, out["instance"] = hit->target.instance, out["face"] = hit->target.face;
  out["part"] = hit->part, out["surface"] = hit->surface, out["radius"] = hit->radius;
  out["point"] = vector(hit->point), out["normal"] = vector(hit->normal), out["depth"] = hit->depth;
  out["k1"] = hit->k1, out["k2"] = hit->k2, out["direction"] = vector(hit->direction);
  out["uv"] = py::make_tuple(hit->uv.x, hit->uv.y);
  out["edge"] = hit->edge;
  return out;
}

void bind_models(py::module_& m) {
  py::class_<Model, std::shared_ptr<Model>>(m, "Model",
                                            "What a CAD or mesh file holds: exact faces, never changed.")
      .def_property_readonly(
          "source", [](const Model& model) { return model.source; }, "The file's name.")
      .def_property_readonly(
          "format", [](const Model& model) { return model.format; }, "\"STEP\", …")
      .def_property_readonly("unit", [](const Model& model) { return model.unit_note; })
      .def_property_readonly(
          "box", [](const Model& model) { return box_array(bounding_box(model)); },
          "Least and largest corner, 2 x 3; None for an empty model.")
      .def_property_readonly("instances", &instance_names, "Name of each placement, and of its part.")
      .def("info", &info, "Counts, kinds of faces, box, what could not be read or was repaired.")
      .def("sample", &sample, py::kw_only(), py::arg("method") = "uniform", py::arg("grid") = 0,
           py::arg("spacing") = 0.0, py::arg("epsilon") = 0.012, py::arg("delta") = 0.0,
           py::arg("border") = 0.0, py::arg("tolerance") = 0.0, py::arg("progress") = py::none(),
           "Differential points of every face, as `dupin sample` makes them.")
      .def("prepare", &prepare_model, py::kw_only(), py::arg("tolerance") = 0.0,
           py::arg("normal_tolerance") = 0.25, py::arg("progress") = py::none(),
           "What a Scene draws: certified within `tolerance` model units and `normal_tolerance` degrees.")
      .def(
          "render", [](const std::shared_ptr<Model>& model, const py::kwargs& k) { return render(model, k); },
          "A picture as a dict of arrays, row 0 on top; see dupin.pyi for the keywords.");
  py::class_<Points>(m, "Points", "Arrays of differential points; views of one memory, not copies.")
      .def("__len__", &Points::size)
      .def_property_readonly("positions", &Points::positions, "n x 3, model space")
      .def_property_readonly("normals", &Points::normals, "n x 3, unit, outward")
      .def_property_readonly("directions", &Points::directions, "n x 3, of the first curvature, unit")
      .def_property_readonly(
          "curvatures", &Points::curvatures,
          "n x 2, larger first by size; positive where the surface bends towards the normal")
      .def_property_readonly("half_extents", &Points::half_extents, "n x 2, of the rectangles")
      .def_property_readonly("uv", &Points::uv, "n x 2, the surfaces' parameters")
      .def_property_readonly("bounds", &Points::bounds, "n")
      .def_property_readonly("faces", &Points::faces, "n, index of the face in its part")
      .def_property_readonly("instances", &Points::instances, "n, index of the placement")
      .def_property_readonly("notes", &Points::notes)
      .def_property_readonly("skipped", &Points::skipped, "Name and reason of each face without a point.");
  py::class_<PreparedModel, std::shared_ptr<PreparedModel>>(m, "Prepared", "A model ready to be drawn.")
      .def_property_readonly("model",
                             [](const PreparedModel& p) { return std::const_pointer_cast<Model>(p.model); })
      .def_property_readonly("tolerance", [](const PreparedModel& p) { return p.tolerance; })
      .def_property_readonly("primitives", [](const PreparedModel& p) { return p.dps.count(); });
}

void bind_jobs(py::module_& m) {
  py::class_<LoadJob>(m, "Job", "Reads and prepares a file on a thread of its own.")
      .def(py::init([](const std::string& path, double tolerance, const std::string& units) {
             ImportOptions import;
             import.assumed_unit = units;
             PrepareOptions prepare;
             prepare.tolerance = tolerance;
             return LoadJob::start(path, import, prepare);
           }),
           py::arg("path"), py::kw_only(), py::arg("tolerance") = 0.0, py::arg("units") = "mm")
      .def_property_readonly("done", &LoadJob::done)
      .def_property_readonly("fraction", &LoadJob::fraction, "Of the stage, 0 … 1.")
      .def_property_readonly("stage", &LoadJob::stage)
      .def("cancel", &LoadJob::cancel)
      .def(
          "result",
          [](const LoadJob& job) {
            auto made = [&] {
              const py::gil_scoped_release release;
              return job.result();
            }();
            return unconst(value_of(std::move(made)));
          },
          "Waits for it.");
}

void bind_scenes(py::module_& m) {
  constexpr std::uint32_t kWhole = Scene::kWhole;
  py::class_<HostScene>(m, "Scene", "Models in the OpenGL context that is current where it is made and used.")
      .def(py::init(&make_scene), py::arg("get_proc_address") = py::none())
      .def(
          "add",
          [](HostScene& s, const std::shared_ptr<PreparedModel>& p, const py::object& matrix) {
            return value_of(s.add(p, affine_of(matrix)));
          },
          py::arg("prepared"), py::arg("matrix") = py::none(), "The object's number.")
      .def("replace", [](HostScene& s, ObjectId id,
                         const std::shared_ptr<PreparedModel>& p) { check_status(s.replace(id, p)); })
      .def("remove", [](HostScene& s, ObjectId id) { check_status(s.remove(id)); })
      .def("place", [](HostScene& s, ObjectId id,
                       const py::object& matrix) { check_status(s.place(id, affine_of(matrix))); })
      .def(
          "set_visible",
          [](HostScene& s, ObjectId id, bool on, std::uint32_t instance, std::uint32_t face) {
            check_status(s.set_visible({id, instance, face}, on));
          },
          py::arg("object"), py::arg("visible"), py::arg("instance") = kWhole, py::arg("face") = kWhole)
      .def(
          "set_color",
          [](HostScene& s, ObjectId id, const py::object& c, std::uint32_t instance, std::uint32_t face) {
            check_status(s.set_color({id, instance, face}, color_of(c)));
          },
          py::arg("object"), py::arg("color"), py::arg("instance") = kWhole, py::arg("face") = kWhole)
      .def(
          "set_highlight",
          [](HostScene& s, ObjectId id, const py::object& c, std::uint32_t instance, std::uint32_t face) {
            check_status(s.set_highlight({id, instance, face}, color_of(c)));
          },
          py::arg("object"), py::arg("color"), py::arg("instance") = kWhole, py::arg("face") = kWhole)
      .def_property_readonly("box", [](const HostScene& s) { return box_array(s.box()); })
      .def_property_readonly("objects", &HostScene::objects)
      .def_property_readonly("gl_renderer", &HostScene::gl_renderer)
      .def("draw", &draw, py::arg("view"), py::arg("projection"), py::arg("viewport"),
           "Into the current framebuffer, against its depth buffer. Matrices as NumPy's, rows first.")
      .def("pick", &pick, py::arg("view"), py::arg("projection"), py::arg("viewport"), py::arg("x"),
           py::arg("y"))
      .def(
          "refine",
          [](HostScene& s, const py::object& view, const py::object& projection,
             const std::array<int, 4>& viewport, double tolerance_px) {
            check_status(s.refine(view_of_host(view, projection, viewport), tolerance_px));
          },
          py::arg("view"), py::arg("projection"), py::arg("viewport"), py::arg("tolerance_px") = 0.5)
      .def_property_readonly("refining", &HostScene::refining);
}

}  // namespace

void raise(const Status& status) {
  py::object error = error_class()(status.message);
  error.attr("code") = kCodeNames[static_cast<std::size_t>(status.code)];
  PyErr_SetObject(error_class().ptr(), error.ptr());
  throw py::error_already_set();
}

Progress progress_of(const py::object& callback) {
  if (callback.is_none()) return {};
  // Kept, and let go, with the interpreter's lock held.
  const std::shared_ptr<py::object> kept(new py::object(callback), [](py::object* object) {
    const py::gil_scoped_acquire acquire;
    delete object;
  });
  const auto failure = std::make_shared<std::atomic<bool>>(false);
  return [kept, failure](std::string_view stage, double fraction) {
    if (*failure) return false;
    const py::gil_scoped_acquire acquire;
    try {
      const py::object answer = (*kept)(std::string(stage), fraction);
      return answer.is_none() || py::cast<bool>(answer);
    } catch (py::error_already_set& error) {
      *failure = true;
      error.discard_as_unraisable("dupin: progress");
      return false;
    }
  };
}

}  // namespace dupin::python

PYBIND11_MODULE(dupin, m) {
  using namespace dupin;
  using namespace dupin::python;
  m.doc() = "CAD models from their exact surfaces, without tessellating them: arrays, pictures, OpenGL.";
  m.attr("__version__") = DUPIN_VERSION;
  error_class() = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
      "dupin.Error", "Why something could not be done; `code` is the kind of reason.", PyExc_RuntimeError,
      nullptr));
  m.attr("Error") = error_class();
  bind_models(m);
  bind_jobs(m);
  bind_scenes(m);
  m.def(
      "load",
      [](const std::string& path, double time_limit, std::uint64_t memory_limit, const std::string& units,
         const py::object& progress) {
        return std::const_pointer_cast<Model>(
            load(path, import_options(time_limit, memory_limit, units, progress)));
      },
      py::arg("path"), py::kw_only(), py::arg("time_limit") = 0.0, py::arg("memory_limit") = 0,
      py::arg("units") = "mm", py::arg("progress") = py::none(),
      "Reads STEP, IGES, BREP, FCStd, OBJ, PLY, STL or OFF, in a process of its own.");
  m.def(
      "load_bytes",
      [](const py::bytes& bytes, const std::string& units) {
        const std::string_view view = bytes;
        const MemoryFile file(view.data(), view.size());
        if (!file.whole()) raise({StatusCode::limit, "no file in memory could be made of the bytes"});
        return std::const_pointer_cast<Model>(load(file.path(), import_options(0, 0, units, py::none())));
      },
      py::arg("bytes"), py::kw_only(), py::arg("units") = "mm", "The same of a file's bytes.");
  m.def("compare", &compare_pictures, py::arg("a"), py::arg("b"), py::arg("fov") = 30.0,
        "How much two pictures differ: arrays of bytes (sRGB) or floats (linear), or files.");
  m.def("set_threads", &set_thread_limit, py::arg("threads"), "Threads to use at once; 0: one a core.");
}
