#include "model_stream.h"

#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

namespace dupin {
namespace {

static_assert(std::endian::native == std::endian::little,
              "both ends run on one machine; only its order is used");

constexpr char kMagic[8] = {'D', 'U', 'P', 'I', 'N', 'M', 'D', 'L'};

// ---- writing
// -------------------------------------------------------------------------------------------------

class Writer {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void pod(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void boolean(bool value) { pod<std::uint8_t>(value ? 1 : 0); }
  void count(std::size_t n) { pod<std::uint64_t>(n); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void pods(const std::vector<T>& values) {
    count(values.size());
    if (!values.empty())
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(const std::string& value) {
    count(value.size());
    bytes_.append(value);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

template <class T, class F>
void write_list(Writer& out, const std::vector<T>& list, F&& item) {
  out.count(list.size());
  for (const T& x : list) item(x);
}

void write(Writer& out, const std::optional<Color>& color) {
  out.boolean(color.has_value());
  if (color) out.pod(*color);
}

template <class V>
void write(Writer& out, const CurveOf<V>& curve);

template <class V>
void write_geometry(Writer& out, const BsplineOf<V>& c) {
  out.pod<std::int32_t>(c.degree);
  out.pods(c.knots);
  out.pods(c.poles);
  out.pods(c.weights);
  out.boolean(c.periodic);
}
template <class V>
void write_geometry(Writer& out, const OffsetCurveOf<V>& c) {
  write(out, *c.base);
  out.pod(c.distance);
  out.pod(c.reference);
}
template <class T>
requires std::is_trivially_copyable_v<T>
void write_geometry(Writer& out, const T& c) {
  out.pod(c);
}

template <class V>
void write(Writer& out, const CurveOf<V>& curve) {
  out.pod<std::uint8_t>(static_cast<std::uint8_t>(curve.geometry.index()));
  std::visit([&](const auto& c) { write_geometry(out, c); }, curve.geometry);
}

void write(Writer& out, const Surface& surface);

void write_geometry(Writer& out, const BsplineSurface& s) {
  out.pod<std::int32_t>(s.degree_u);
  out.pod<std::int32_t>(s.degree_v);
  out.pods(s.knots_u);
  out.pods(s.knots_v);
  out.pod<std::int32_t>(s.count_u);
  out.pod<std::int32_t>(s.count_v);
  out.pods(s.poles);
  out.pods(s.weights);
  out.boolean(s.periodic_u);
  out.boolean(s.periodic_v);
}
void write_geometry(Writer& out, const Revolution& s) {
  out.pod(s.axis_origin);
  out.pod(s.axis_direction);
  write(out, s.profile);
}
void write_geometry(Writer& out, const Extrusion& s) {
  write(out, s.profile);
  out.pod(s.direction);
}
void write_geometry(Writer& out, const OffsetSurface& s) {
  write(out, *s.base);
  out.pod(s.distance);
}

void write(Writer& out, const Surface& surface) {
  out.pod<std::uint8_t>(static_cast<std::uint8_t>(surface.geometry.index()));
  std::visit([&](const auto& s) { write_geometry(out, s); }, surface.geometry);
}

void write(Writer& out, const Edge& edge) {
  out.boolean(edge.curve.has_value());
  if (edge.curve) write(out, *edge.curve);
  out.pod(edge.t0);
  out.pod(edge.t1);
  out.pod(edge.tolerance);
  out.boolean(edge.smooth);
}

void write(Writer& out, const Trim& trim) {
  out.pod(trim.edge);
  out.boolean(trim.reversed);
  out.boolean(trim.seam);
  out.boolean(trim.degenerate);
  write(out, trim.pcurve);
}

void write(Writer& out, const Face& face) {
  out.pod(face.surface);
  out.boolean(face.reversed);
  write_list(out, face.loops,
             [&](const Loop& loop) { write_list(out, loop, [&](const Trim& t) { write(out, t); }); });
  out.pod(face.uv_box);
  out.pod(face.tolerance);
  write(out, face.color);
  out.text(face.name);
}

void write(Writer& out, const TriangleMesh& mesh) {
  out.pods(mesh.positions);
  out.pods(mesh.normals);
  out.pods(mesh.triangles);
  out.pods(mesh.faces);
  out.pod(mesh.origin);
}

void write(Writer& out, const PolygonMesh& mesh) {
  out.pods(mesh.positions);
  out.pods(mesh.corners);
  out.pods(mesh.starts);
  out.pods(mesh.normals);
  out.pods(mesh.corner_normals);
  out.pods(mesh.colors);
  out.pods(mesh.polygon_colors);
  write_list(out, mesh.groups, [&](const MeshGroup& g) {
    out.text(g.name);
    write(out, g.color);
  });
  out.pods(mesh.polygon_groups);
  out.pods(mesh.tags.creases);
  out.pods(mesh.tags.corners);
  out.pods(mesh.tags.holes);
  out.pod(mesh.tags.boundary);
  out.boolean(mesh.tags.chaikin);
  out.boolean(mesh.tags.smooth_triangles);
}

void write(Writer& out, const Part& part) {
  out.text(part.name);
  write(out, part.color);
  write_list(out, part.surfaces, [&](const Surface& s) { write(out, s); });
  write_list(out, part.edges, [&](const Edge& e) { write(out, e); });
  write_list(out, part.faces, [&](const Face& f) { write(out, f); });
  out.boolean(part.closed);
  write(out, part.polygons);
  out.pod(part.box);
  write(out, part.mesh);
}

void write(Writer& out, const Instance& instance) {
  out.pod(instance.part);
  out.pod(instance.to_world);
  write(out, instance.color);
  out.text(instance.name);
}

// ---- reading
// -------------------------------------------------------------------------------------------------

// After the first failure every read returns a zero and no list grows, so the recursion unwinds by itself.
class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : left_(bytes) {}
  bool failed() const { return failed_; }
  bool at_end() const { return left_.empty(); }
  void fail() { failed_ = true, left_ = {}; }

  template <class T>
  requires std::is_trivially_copyable_v<T> T pod() {
    T value{};
    if (left_.size() < sizeof value) return fail(), value;
    std::memcpy(&value, left_.data(), sizeof value);
    left_ = left_.subspan(sizeof value);
    return value;
  }
  bool boolean() {
    const auto value = pod<std::uint8_t>();
    if (value > 1) fail();
    return value == 1;
  }
  /// A count of items that take at least `item_bytes` each in the stream.
  std::size_t count(std::size_t item_bytes) {
    const auto n = pod<std::uint64_t>();
    if (n > left_.size() / item_bytes) return fail(), 0;
    return static_cast<std::size_t>(n);
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void pods(std::vector<T>& values) {
    const std::size_t n = count(sizeof(T));
    values.resize(n);
    if (n > 0) std::memcpy(values.data(), left_.data(), n * sizeof(T));
    left_ = left_.subspan(n * sizeof(T));
  }
  void text(std::string& value) {
    const std::size_t n = count(1);
    value.assign(left_.data(), n);
    left_ = left_.subspan(n);
  }

 private:
  std::span<const char> left_;
  bool failed_ = false;
};

// The least an item takes in the stream is below its size in memory for small items, so lists grow as they
// are read.
template <class T, class F>
void read_list(Reader& in, std::vector<T>& list, std::size_t item_bytes, F&& item) {
  const std::size_t n = in.count(item_bytes);
  list.reserve(std::min<std::size_t>(n, 4096));
  for (std::size_t i = 0; i < n && !in.failed(); ++i) item(list.emplace_back());
}

void read(Reader& in, std::optional<Color>& color) {
  if (in.boolean()) color = in.pod<Color>();
}

template <class V>
void read(Reader& in, CurveOf<V>& curve, int nesting);

template <class V>
void read_geometry(Reader& in, BsplineOf<V>& c, int) {
  c.degree = in.pod<std::int32_t>();
  in.pods(c.knots);
  in.pods(c.poles);
  in.pods(c.weights);
  c.periodic = in.boolean();
}
template <class V>
void read_geometry(Reader& in, OffsetCurveOf<V>& c, int nesting) {
  auto base = std::make_shared<CurveOf<V>>();
  read(in, *base, nesting + 1);
  c.base = std::move(base);
  c.distance = in.pod<double>();
  c.reference = in.pod<Vec3>();
}
template <class T>
requires std::is_trivially_copyable_v<T>
void read_geometry(Reader& in, T& c, int) {
  c = in.pod<T>();
}

// Reads the alternative of `variant` that has the index `kind`.
template <class Variant, std::size_t I = 0>
void read_alternative(Reader& in, Variant& variant, std::size_t kind, int nesting) {
  if constexpr (I < std::variant_size_v<Variant>) {
    if (kind == I) return read_geometry(in, variant.template emplace<I>(), nesting);
    return read_alternative<Variant, I + 1>(in, variant, kind, nesting);
  } else {
    in.fail();
  }
}

template <class V>
void read(Reader& in, CurveOf<V>& curve, int nesting) {
  if (nesting > kModelStreamMaxNesting) return in.fail();
  read_alternative(in, curve.geometry, in.pod<std::uint8_t>(), nesting);
}

void read(Reader& in, Surface& surface, int nesting);

void read_geometry(Reader& in, BsplineSurface& s, int) {
  s.degree_u = in.pod<std::int32_t>();
  s.degree_v = in.pod<std::int32_t>();
  in.pods(s.knots_u);
  in.pods(s.knots_v);
  s.count_u = in.pod<std::int32_t>();
  s.count_v = in.pod<std::int32_t>();
  in.pods(s.poles);
  in.pods(s.weights);
  s.periodic_u = in.boolean();
  s.periodic_v = in.boolean();
}
void read_geometry(Reader& in, Revolution& s, int nesting) {
  s.axis_origin = in.pod<Vec3>();
  s.axis_direction = in.pod<Vec3>();
  read(in, s.profile, nesting + 1);
}
void read_geometry(Reader& in, Extrusion& s, int nesting) {
  read(in, s.profile, nesting + 1);
  s.direction = in.pod<Vec3>();
}
void read_geometry(Reader& in, OffsetSurface& s, int nesting) {
  auto base = std::make_shared<Surface>();
  read(in, *base, nesting + 1);
  s.base = std::move(base);
  s.distance = in.pod<double>();
}

void read(Reader& in, Surface& surface, int nesting) {
  if (nesting > kModelStreamMaxNesting) return in.fail();
  read_alternative(in, surface.geometry, in.pod<std::uint8_t>(), nesting);
}

void read(Reader& in, Edge& edge) {
  if (in.boolean()) read(in, edge.curve.emplace(), 0);
  edge.t0 = in.pod<double>();
  edge.t1 = in.pod<double>();
  edge.tolerance = in.pod<double>();
  edge.smooth = in.boolean();
}

void read(Reader& in, Trim& trim) {
  trim.edge = in.pod<std::uint32_t>();
  trim.reversed = in.boolean();
  trim.seam = in.boolean();
  trim.degenerate = in.boolean();
  read(in, trim.pcurve, 0);
}

void read(Reader& in, Face& face) {
  face.surface = in.pod<std::uint32_t>();
  face.reversed = in.boolean();
  read_list(in, face.loops, 8, [&](Loop& loop) { read_list(in, loop, 8, [&](Trim& t) { read(in, t); }); });
  face.uv_box = in.pod<Box2>();
  face.tolerance = in.pod<double>();
  read(in, face.color);
  in.text(face.name);
}

void read(Reader& in, TriangleMesh& mesh) {
  in.pods(mesh.positions);
  in.pods(mesh.normals);
  in.pods(mesh.triangles);
  in.pods(mesh.faces);
  mesh.origin = in.pod<Vec3>();
}

void read(Reader& in, SubdivisionTags& tags) {
  in.pods(tags.creases);
  in.pods(tags.corners);
  in.pods(tags.holes);
  const auto boundary = in.pod<std::uint8_t>();
  if (boundary > static_cast<std::uint8_t>(SubdivisionTags::Boundary::edges)) return in.fail();
  tags.boundary = static_cast<SubdivisionTags::Boundary>(boundary);
  tags.chaikin = in.boolean();
  tags.smooth_triangles = in.boolean();
}

void read(Reader& in, PolygonMesh& mesh) {
  in.pods(mesh.positions);
  in.pods(mesh.corners);
  in.pods(mesh.starts);
  in.pods(mesh.normals);
  in.pods(mesh.corner_normals);
  in.pods(mesh.colors);
  in.pods(mesh.polygon_colors);
  read_list(in, mesh.groups, 9, [&](MeshGroup& g) {
    in.text(g.name);
    read(in, g.color);
  });
  in.pods(mesh.polygon_groups);
  read(in, mesh.tags);
}

void read(Reader& in, Part& part) {
  in.text(part.name);
  read(in, part.color);
  read_list(in, part.surfaces, 16, [&](Surface& s) { read(in, s, 0); });
  read_list(in, part.edges, 16, [&](Edge& e) { read(in, e); });
  read_list(in, part.faces, 16, [&](Face& f) { read(in, f); });
  part.closed = in.boolean();
  read(in, part.polygons);
  part.box = in.pod<Box3>();
  read(in, part.mesh);
}

void read(Reader& in, Instance& instance) {
  instance.part = in.pod<std::uint32_t>();
  instance.to_world = in.pod<Affine3>();
  read(in, instance.color);
  in.text(instance.name);
}

Status damaged(const char* what) {
  return {StatusCode::unreadable, std::string("the reader's answer is damaged: ") + what};
}

Status check_header(std::span<const char> bytes) {
  if (bytes.size() < kModelStreamHeaderBytes) return damaged("it is too short");
  if (std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    return damaged("it does not begin as a model does");
  std::uint64_t version, length, checksum;
  std::memcpy(&version, bytes.data() + 8, 8);
  std::memcpy(&length, bytes.data() + 16, 8);
  std::memcpy(&checksum, bytes.data() + 24, 8);
  if (version != kModelStreamVersion) return damaged("it is of another version");
  if (length != bytes.size() - kModelStreamHeaderBytes) return damaged("its length is wrong");
  if (checksum != stream_checksum(bytes.subspan(kModelStreamHeaderBytes)))
    return damaged("its checksum is wrong");
  return {};
}

}  // namespace

std::uint64_t stream_checksum(std::span<const char> payload) {
  std::uint64_t h = 0x9e3779b97f4a7c15u ^ payload.size();
  const auto mix = [&h](std::uint64_t word) {
    h = (h ^ word) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  };
  std::size_t i = 0;
  for (; i + 8 <= payload.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, payload.data() + i, 8);
    mix(word);
  }
  std::uint64_t tail = 0;
  if (i < payload.size()) std::memcpy(&tail, payload.data() + i, payload.size() - i);
  mix(tail);
  return h;
}

std::string write_model(const Model& model) {
  Writer out;
  out.text(model.source);
  out.text(model.format);
  out.text(model.unit_note);
  write_list(out, model.parts, [&](const Part& p) { write(out, p); });
  write_list(out, model.instances, [&](const Instance& i) { write(out, i); });
  write_list(out, model.skipped, [&](const SkippedFace& s) {
    out.text(s.name);
    out.text(s.reason);
    out.pod(s.count);
  });
  write_list(out, model.notes, [&](const std::string& n) { out.text(n); });
  out.pod(model.mesh_seconds);
  const std::string payload = out.take();

  Writer header;
  header.pod(kMagic);
  header.pod<std::uint64_t>(kModelStreamVersion);
  header.pod<std::uint64_t>(payload.size());
  header.pod<std::uint64_t>(stream_checksum(payload));
  return header.take() + payload;
}

Result<Model> read_model(std::span<const char> bytes) {
  if (Status header = check_header(bytes); !header.ok()) return header;
  Reader in(bytes.subspan(kModelStreamHeaderBytes));
  Model model;
  in.text(model.source);
  in.text(model.format);
  in.text(model.unit_note);
  read_list(in, model.parts, 64, [&](Part& p) { read(in, p); });
  read_list(in, model.instances, 64, [&](Instance& i) { read(in, i); });
  read_list(in, model.skipped, 16, [&](SkippedFace& s) {
    in.text(s.name);
    in.text(s.reason);
    s.count = in.pod<std::uint32_t>();
  });
  read_list(in, model.notes, 8, [&](std::string& n) { in.text(n); });
  model.mesh_seconds = in.pod<double>();
  if (in.failed()) return damaged("a list or value runs past its end");
  if (!in.at_end()) return damaged("bytes are left over");
  if (Status valid = check(model); !valid.ok()) return damaged(valid.message.c_str());
  return model;
}

}  // namespace dupin
