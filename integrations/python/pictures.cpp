#include "pictures.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "../../app/view.h"
#include "../../host/prepared_model.h"
#include "../../render/image.h"
#include "../../render/metrics.h"
#include "picture_thread.h"

namespace dupin::python {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr const char* kOutputNames[] = {"color",     "normal", "depth",     "position", "curvature",
                                        "direction", "face",   "primitive", "uv",       "screen"};

/// The keyword's value, or `otherwise`; it is gone from `keywords` then.
template <class T>
T take(py::dict& keywords, const char* name, T otherwise) {
  if (!keywords.contains(name)) return otherwise;
  T value = py::cast<T>(keywords[name]);
  keywords.attr("pop")(name);
  return value;
}

std::optional<Color> color_from(const py::object& value) {
  if (value.is_none()) return {};
  const auto numbers = py::cast<std::vector<float>>(value);
  if (numbers.size() != 3 && numbers.size() != 4)
    throw py::value_error("a color is three or four numbers, linear light from 0 to 1");
  return Color{numbers[0], numbers[1], numbers[2], numbers.size() == 4 ? numbers[3] : 1.0F};
}

std::vector<std::vector<double>> rows(const py::object& value, std::size_t width, const char* what) {
  auto list = py::cast<std::vector<std::vector<double>>>(value);
  for (const auto& row : list)
    if (row.size() != width) throw py::value_error(what);
  return list;
}

Shading shading_from(const std::string& name) {
  const auto* found = std::find(std::begin(kShadingNames), std::end(kShadingNames), name);
  if (found == std::end(kShadingNames)) throw py::value_error("there is no shading '" + name + "'");
  return static_cast<Shading>(found - std::begin(kShadingNames));
}

unsigned outputs_from(const std::vector<std::string>& names) {
  unsigned outputs = 0;
  for (const std::string& name : names) {
    const auto* found = std::find(std::begin(kOutputNames), std::end(kOutputNames), name);
    if (found == std::end(kOutputNames)) throw py::value_error("there is no output '" + name + "'");
    outputs |= 1U << (found - std::begin(kOutputNames));
  }
  return outputs;
}

Camera take_camera(py::dict& keywords, const Model& model) {
  app::ViewOptions view;
  const auto size = take(keywords, "size", std::vector<int>{1024, 1024});
  if (size.size() != 2 || size[0] < 1 || size[1] < 1) throw py::value_error("size is (width, height)");
  view.resolution = size;
  view.view = take(keywords, "view", std::string("iso"));
  for (auto [name, to] : {std::pair{"eye", &view.eye}, {"target", &view.target}, {"up", &view.up}}) {
    *to = take(keywords, name, std::vector<double>{});
    if (!to->empty() && to->size() != 3) throw py::value_error(std::string(name) + " is three numbers");
  }
  view.fov_degrees = take(keywords, "fov", 30.0);
  view.orthographic = take(keywords, "orthographic", false);
  view.height = take(keywords, "height", 0.0);
  return value_of(app::make_camera(view, model));
}

void put(py::dict& out, const Frame& frame, const char* name, std::vector<float> values,
         py::ssize_t channels) {
  if (values.empty()) return;
  std::vector<py::ssize_t> shape{frame.height, frame.width};
  if (channels > 1) shape.push_back(channels);
  out[name] = array_of(std::move(values), std::move(shape));
}

py::dict to_arrays(Frame frame) {
  py::dict out;
  const std::vector<py::ssize_t> shape{frame.height, frame.width};
  put(out, frame, "color", std::move(frame.color), 4);
  put(out, frame, "normal", std::move(frame.normal), 3);
  put(out, frame, "depth", std::move(frame.depth), 1);
  put(out, frame, "position", std::move(frame.position), 3);
  put(out, frame, "curvature", std::move(frame.curvature), 2);
  put(out, frame, "direction", std::move(frame.direction), 3);
  put(out, frame, "uv", std::move(frame.uv), 2);
  if (!frame.face.empty()) out["face"] = array_of(std::move(frame.face), shape);
  if (!frame.primitive.empty()) out["primitive"] = array_of(std::move(frame.primitive), shape);
  if (!frame.screen.empty()) out["screen"] = array_of(std::move(frame.screen), {shape[0], shape[1], 4});
  return out;
}

struct PictureOrder {
  Camera camera;
  DrawOptions options;
  PrepareOptions prepare;
};

Result<Frame> draw(const std::shared_ptr<const Model>& model, const PictureOrder& order) {
  auto prepared = prepare(model, order.prepare);
  if (!prepared) return prepared.status();
  Result<Frame> frame{StatusCode::no_device, ""};
  const Status status = on_picture_thread([&](Renderer& renderer) -> Status {
    SceneContent content{&(*prepared)->dps, {}};
    TreeLayers trees((*prepared)->trees, {});
    const auto& own = (*prepared)->trees;
    if (std::any_of(own.begin(), own.end(), [](const PartTree& t) { return t.tree != nullptr; }))
      content.layers.push_back(trees.layer());
    auto scene = renderer.upload(*model, content);
    if (!scene) return scene.status();
    frame = renderer.draw(**scene, order.camera, order.options);
    return frame.status();
  });
  if (!status.ok()) return status;
  return frame;
}

/// A picture as numbers: an array of bytes (sRGB) or of floats (linear), or a file's name.
Image image_from(const py::object& value) {
  if (py::isinstance<py::str>(value)) return value_of(read_image(py::cast<std::string>(value)));
  const bool bytes = py::isinstance<py::array_t<std::uint8_t>>(value);
  const auto array = py::cast<py::array_t<float, py::array::c_style | py::array::forcecast>>(value);
  if (array.ndim() != 3 || (array.shape(2) != 3 && array.shape(2) != 4))
    throw py::value_error("a picture is an array of height x width x 3 or 4, or a file's name");
  const auto height = static_cast<int>(array.shape(0)), width = static_cast<int>(array.shape(1)),
             channels = static_cast<int>(array.shape(2));
  if (bytes) {
    Image8 image{width, height, channels, {}};
    image.values.assign(array.data(), array.data() + array.size());
    return to_image(image);
  }
  Image image;
  image.width = width, image.height = height;
  for (int c = 0; c < channels; ++c) {
    auto& values = image.channel(std::string(1, "RGBA"[c])).values;
    values.resize(image.pixels());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = array.data()[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
  }
  return image;
}

py::dict quantiles(const Distribution& d) {
  py::dict out;
  out["count"] = d.count, out["mean"] = d.mean, out["p50"] = d.p50, out["p90"] = d.p90, out["p99"] = d.p99;
  out["p999"] = d.p999, out["max"] = d.max;
  return out;
}

}  // namespace

DrawOptions take_draw_options(py::dict& keywords) {
  DrawOptions options;
  options.shading = shading_from(take(keywords, "shading", std::string("lit")));
  options.edges = take(keywords, "edges", true);
  options.edge_width_px = take(keywords, "edge_width", options.edge_width_px);
  options.samples = take(keywords, "samples", 1);
  options.color = color_from(take(keywords, "color", py::object(py::none())));
  options.background = color_from(take(keywords, "background", py::object(py::none())));
  options.curvature_scale = take(keywords, "curvature_scale", 0.0);
  for (const auto& row : rows(take(keywords, "lights", py::object(py::list())), 3, "a light is its position"))
    options.lights.push_back({{row[0], row[1], row[2]}, {}});
  for (const auto& row : rows(take(keywords, "sections", py::object(py::list())), 4,
                              "a section is four numbers: only a x + b y + c z + d >= 0 is drawn"))
    options.sections.push_back({{row[0], row[1], row[2]}, row[3]});
  return options;
}

void expect_none_left(const py::dict& keywords, const char* function) {
  for (const auto& item : keywords)
    throw py::type_error(std::string(function) + "() got an unexpected keyword argument '" +
                         py::cast<std::string>(item.first) + "'");
}

py::dict render(const std::shared_ptr<const Model>& model, const py::kwargs& given) {
  py::dict keywords;
  for (const auto& item : given) keywords[item.first] = item.second;
  PictureOrder order;
  if (!keywords.contains("samples")) keywords["samples"] = 4;
  if (!keywords.contains("background")) keywords["background"] = py::make_tuple(1, 1, 1, 1);
  order.camera = take_camera(keywords, *model);
  order.options = take_draw_options(keywords);
  order.options.outputs = outputs_from(take(keywords, "outputs", std::vector<std::string>{"screen"}));
  order.options.exact_model = model.get();
  order.prepare.camera = order.camera;
  order.prepare.tolerance = std::max(1e-300, bounding_box(*model).diagonal());  // only the picture counts
  order.prepare.tolerance_px = take(keywords, "tolerance_px", 0.5);
  order.prepare.normal_tolerance = take(keywords, "normal_tolerance", 0.25) * kRadians;
  order.prepare.progress = progress_of(take(keywords, "progress", py::object(py::none())));
  expect_none_left(keywords, "render");
  auto frame = [&] {
    const py::gil_scoped_release release;
    return draw(model, order);
  }();
  if (PyErr_Occurred()) throw py::error_already_set();
  return to_arrays(value_of(std::move(frame)));
}

py::dict compare_pictures(const py::object& a, const py::object& b, double fov) {
  const Image first = image_from(a), second = image_from(b);
  const auto difference = [&] {
    const py::gil_scoped_release release;
    return compare(first, second, CompareOptions{fov});
  }();
  const PictureDifference d = value_of(difference);
  py::dict out;
  out["width"] = d.width, out["height"] = d.height;
  if (d.color) {
    out["rmse"] = d.color->rmse, out["rmse_covered"] = d.color->rmse_covered, out["psnr"] = d.color->psnr;
    out["ssim"] = d.color->ssim, out["flip"] = d.color->flip;
  }
  out["covered_px"] = py::make_tuple(d.covered_a, d.covered_b);
  out["silhouette_px"] = d.silhouette;
  out["outline_px"] = quantiles(d.outline_px);
  if (d.geometry) {
    out["interior_px"] = d.geometry->interior, out["holes_px"] = d.geometry->holes;
    out["extra_px"] = d.geometry->extra;
    out["depth_px"] = quantiles(d.geometry->depth_px);
    out["normal_degrees"] = quantiles(d.geometry->normal_degrees);
  }
  return out;
}

}  // namespace dupin::python
