// The C interface to models that a host makes in memory.
#include "c_handles.h"
#include "complete_model.h"

namespace dupin::c {
namespace {

template <class V>
V vector(const double* v);
template <>
Vec3 vector<Vec3>(const double* v) {
  return vec3(v);
}
template <>
Vec2 vector<Vec2>(const double* v) {
  return {v[0], v[1]};
}

template <class V>
std::vector<V> vectors(const double* values, std::size_t count) {
  constexpr std::size_t kStride = sizeof(V) / sizeof(double);
  std::vector<V> list(count);
  for (std::size_t i = 0; i < count; ++i) list[i] = vector<V>(values + kStride * i);
  return list;
}

std::vector<double> numbers(const double* values, std::size_t count) {
  return values ? std::vector<double>(values, values + count) : std::vector<double>{};
}

Status wrong(const char* what) {
  return {StatusCode::invalid_argument, what};
}

template <class V>
Status convert(const dupin_curve* given, CurveOf<V>& curve) {
  const dupin_curve c = sized(given);
  const V origin = vector<V>(c.origin), x = vector<V>(c.x), y = vector<V>(c.y);
  switch (c.kind) {
    case DUPIN_LINE:
      curve.geometry = LineOf<V>{origin, x};
      return {};
    case DUPIN_CIRCLE:
      curve.geometry = CircleOf<V>{origin, x, y, c.a};
      return {};
    case DUPIN_ELLIPSE:
      curve.geometry = EllipseOf<V>{origin, x, y, c.a, c.b};
      return {};
    case DUPIN_BSPLINE_CURVE:
      if (!c.poles || !c.knots) return wrong("a spline curve needs poles and knots");
      curve.geometry =
          BsplineOf<V>{c.degree, numbers(c.knots, c.knot_count), vectors<V>(c.poles, c.pole_count),
                       numbers(c.weights, c.pole_count), c.periodic != 0};
      return {};
  }
  return wrong("there is no such kind of curve");
}

Status convert_spline(const dupin_surface& s, Surface& surface) {
  if (!s.poles || !s.knots_u || !s.knots_v) return wrong("a spline surface needs poles and knots");
  if (s.count_u > 1'000'000 || s.count_v > 1'000'000) return wrong("a spline surface has too many poles");
  const std::size_t count = s.count_u * s.count_v;
  BsplineSurface spline;
  spline.degree_u = s.degree_u, spline.degree_v = s.degree_v;
  spline.knots_u = numbers(s.knots_u, s.knot_count_u), spline.knots_v = numbers(s.knots_v, s.knot_count_v);
  spline.count_u = static_cast<int>(s.count_u), spline.count_v = static_cast<int>(s.count_v);
  spline.poles = vectors<Vec3>(s.poles, count);
  spline.weights = numbers(s.weights, count);
  spline.periodic_u = s.periodic_u != 0, spline.periodic_v = s.periodic_v != 0;
  surface.geometry = std::move(spline);
  return {};
}

Status convert_swept(const dupin_surface& s, Surface& surface) {
  if (!s.profile) return wrong("a swept surface needs a profile");
  Curve3 profile;
  if (Status status = convert(s.profile, profile); !status.ok()) return status;
  if (s.kind == DUPIN_REVOLUTION)
    surface.geometry = Revolution{vec3(s.origin), vec3(s.z), std::move(profile)};
  else
    surface.geometry = Extrusion{std::move(profile), vec3(s.z)};
  return {};
}

Status convert(const dupin_surface* given, Surface& surface) {
  const dupin_surface s = sized(given);
  Frame3 frame{vec3(s.origin), vec3(s.x), {}, vec3(s.z)};
  frame.y = cross(frame.z, frame.x);
  switch (s.kind) {
    case DUPIN_PLANE:
      surface.geometry = Plane{frame};
      return {};
    case DUPIN_CYLINDER:
      surface.geometry = Cylinder{frame, s.a};
      return {};
    case DUPIN_CONE:
      surface.geometry = Cone{frame, s.a, s.b};
      return {};
    case DUPIN_SPHERE:
      surface.geometry = Sphere{frame, s.a};
      return {};
    case DUPIN_TORUS:
      surface.geometry = Torus{frame, s.a, s.b};
      return {};
    case DUPIN_BSPLINE_SURFACE:
      return convert_spline(s, surface);
    case DUPIN_REVOLUTION:
    case DUPIN_EXTRUSION:
      return convert_swept(s, surface);
  }
  return wrong("there is no such kind of surface");
}

template <class T>
std::uint32_t add(std::vector<T>& list, T item, std::uint32_t* number) {
  list.push_back(std::move(item));
  const auto last = static_cast<std::uint32_t>(list.size() - 1);
  if (number) *number = last;
  return last;
}

/// Runs `work` with the builder's part.
template <class Work>
dupin_status with_part(dupin_builder* builder, std::uint32_t part, Work&& work) {
  return guarded([&]() -> Status {
    if (!builder) return missing("builder");
    if (part >= builder->model.parts.size()) return wrong("the builder has no such part");
    return work(builder->model.parts[part]);
  });
}

}  // namespace
}  // namespace dupin::c

using namespace dupin;
using namespace dupin::c;

dupin_status dupin_builder_create(const char* source, dupin_builder** builder) {
  return guarded([&]() -> Status {
    if (!builder) return missing("builder");
    auto made = std::make_unique<dupin_builder>();
    made->model.source = text(source);
    made->model.format = "memory";
    made->model.unit_note = "mm";
    *builder = made.release();
    return {};
  });
}
void dupin_builder_free(dupin_builder* builder) {
  delete builder;
}

dupin_status dupin_builder_add_part(dupin_builder* builder, const char* name, const float* rgba, int closed,
                                    uint32_t* part) {
  return guarded([&]() -> Status {
    if (!builder) return missing("builder");
    Part made;
    made.name = text(name);
    made.color = color(rgba);
    made.closed = closed != 0;
    add(builder->model.parts, std::move(made), part);
    return {};
  });
}

dupin_status dupin_builder_add_surface(dupin_builder* builder, uint32_t part, const dupin_surface* surface,
                                       uint32_t* number) {
  return with_part(builder, part, [&](Part& to) -> Status {
    if (!surface) return missing("surface");
    Surface made;
    if (Status status = convert(surface, made); !status.ok()) return status;
    add(to.surfaces, std::move(made), number);
    return {};
  });
}

dupin_status dupin_builder_add_edge(dupin_builder* builder, uint32_t part, const dupin_curve* curve,
                                    double t0, double t1, double tolerance, int smooth, uint32_t* number) {
  return with_part(builder, part, [&](Part& to) -> Status {
    Edge edge;
    if (curve) {
      edge.curve.emplace();
      if (Status status = convert(curve, *edge.curve); !status.ok()) return status;
    }
    edge.t0 = t0, edge.t1 = t1, edge.tolerance = tolerance, edge.smooth = smooth != 0;
    add(to.edges, std::move(edge), number);
    return {};
  });
}

dupin_status dupin_builder_add_face(dupin_builder* builder, uint32_t part, const dupin_face* given,
                                    uint32_t* number) {
  return with_part(builder, part, [&](Part& to) -> Status {
    if (!given) return missing("face");
    const dupin_face own = sized(given);
    Face face;
    face.surface = own.surface;
    face.reversed = own.reversed != 0;
    face.uv_box = {{own.uv_box[0], own.uv_box[1]}, {own.uv_box[2], own.uv_box[3]}};
    face.tolerance = own.tolerance;
    face.color = color(own.rgba);
    face.name = text(own.name);
    add(to.faces, std::move(face), number);
    return {};
  });
}

dupin_status dupin_builder_add_trim(dupin_builder* builder, uint32_t part, uint32_t face,
                                    const dupin_trim* given) {
  return with_part(builder, part, [&](Part& to) -> Status {
    if (!given) return missing("trim");
    if (face >= to.faces.size()) return wrong("the part has no such face");
    dupin_trim own = sized(given);
    if (own.edge >= to.edges.size()) return wrong("the part has no such edge");
    Trim trim;
    trim.edge = own.edge;
    trim.reversed = own.reversed != 0, trim.seam = own.seam != 0;
    trim.degenerate = !to.edges[own.edge].curve;
    if (Status status = convert(&own.curve, trim.pcurve); !status.ok()) return status;
    auto& loops = to.faces[face].loops;
    if (loops.empty() || own.new_loop) loops.emplace_back();
    loops.back().push_back(std::move(trim));
    return {};
  });
}

dupin_status dupin_builder_add_mesh(dupin_builder* builder, uint32_t part, const double* vertices,
                                    size_t vertex_count, const uint32_t* triangles, size_t triangle_count) {
  return with_part(builder, part, [&](Part& to) -> Status {
    if (!vertices || !triangles) return missing(vertices ? "triangles" : "vertices");
    PolygonMesh mesh;
    mesh.positions = vectors<Vec3>(vertices, vertex_count);
    mesh.corners.assign(triangles, triangles + 3 * triangle_count);
    if (Status status = check(mesh); !status.ok()) return wrong(status.message.c_str());
    to.polygons = std::move(mesh);
    return {};
  });
}

dupin_status dupin_builder_add_instance(dupin_builder* builder, uint32_t part, const double* matrix,
                                        const char* name, uint32_t* number) {
  return with_part(builder, part, [&](Part&) -> Status {
    Instance instance;
    instance.part = part;
    instance.to_world = affine(matrix);
    instance.name = text(name);
    add(builder->model.instances, std::move(instance), number);
    return {};
  });
}

dupin_status dupin_builder_finish(dupin_builder* builder, dupin_model** model) {
  return guarded([&]() -> Status {
    if (!builder || !model) return missing(builder ? "model" : "builder");
    auto made = std::make_shared<Model>(std::move(builder->model));
    builder->model = {};
    if (Status status = complete(*made); !status.ok()) return status;
    *model = new dupin_model{std::move(made)};
    return {};
  });
}
