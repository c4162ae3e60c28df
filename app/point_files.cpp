#include "point_files.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <memory>

namespace dupin::app {
namespace {

constexpr const char* kColumns[] = {"x",  "y",  "z", "nx", "ny",   "nz", "d1x", "d1y",  "d1z",
                                    "k1", "k2", "u", "v",  "face", "hu", "hv",  "bound"};
constexpr std::size_t kFaceColumn = 13;

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Bytes to a file in large pieces; remembers a failure.
class Output {
 public:
  explicit Output(const std::string& path) : file_(std::fopen(path.c_str(), "wb")) {}
  bool ok() const { return file_ != nullptr && !failed_; }
  void add(const char* data, std::size_t bytes) {
    buffer_.append(data, bytes);
    if (buffer_.size() > (1U << 20)) flush();
  }
  Status finish() {
    flush();
    const bool closed = file_ && std::fclose(file_.release()) == 0;
    return closed && !failed_ ? Status{} : Status{StatusCode::cannot_write, ""};
  }

 private:
  void flush() {
    if (!file_ || std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size())
      failed_ = true;
    buffer_.clear();
  }
  std::unique_ptr<std::FILE, Closer> file_;
  std::string buffer_;
  bool failed_ = false;
};

/// Numbers the part's faces that have points, as a scene does.
std::vector<std::uint32_t> face_numbers(const Part& part, const PartPoints& points, std::uint32_t& drawn) {
  std::vector<bool> used(std::max<std::size_t>(face_count(part), 1), false);
  for (const DifferentialPoint& p : points.points) used[p.face] = true;
  std::vector<std::uint32_t> numbers(used.size(), 0);
  drawn = 0;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) numbers[i] = ++drawn;
  return numbers;
}

/// Calls what(placed point, face number) for every placement's points.
void for_each_placed(const Model& model, const PointScene& scene,
                     const std::function<void(const DifferentialPoint&, std::uint32_t)>& what) {
  std::uint32_t first_face = 0;
  for (const Instance& instance : model.instances) {
    const PartPoints& points = scene.parts[instance.part];
    std::uint32_t drawn = 0;
    const std::vector<std::uint32_t> numbers = face_numbers(model.parts[instance.part], points, drawn);
    const bool moved = !(instance.to_world == Affine3{});
    for (const DifferentialPoint& p : points.points)
      what(moved ? placed(p, instance.to_world) : p, first_face + numbers[p.face]);
    first_face += drawn;
  }
}

std::array<double, std::size(kColumns)> row_of(const DifferentialPoint& p, std::uint32_t face) {
  const Vec3 n = p.n();
  return {p.position.x, p.position.y, p.position.z, n.x,        n.y,        static_cast<double>(n.z),
          p.u.x,        p.u.y,        p.u.z,        p.lambda_u, p.lambda_v, p.uv.x,
          p.uv.y,       face + 0.0,   p.half_u,     p.half_v,   p.bound};
}

std::uint64_t placed_count(const Model& model, const PointScene& scene) {
  std::uint64_t count = 0;
  for (const Instance& instance : model.instances) count += scene.parts[instance.part].points.size();
  return count;
}

std::array<std::uint8_t, 3> srgb(const Color& color) {
  const auto byte = [](float linear) {
    const float c = std::clamp(linear, 0.0F, 1.0F);
    return static_cast<std::uint8_t>(
        std::lround(255 * (c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F)));
  };
  return {byte(color.r), byte(color.g), byte(color.b)};
}

/// As a scene colours a face: its own colour, or the instance's, or the part's, or the default.
DpsColors colors_of(const Part& part, const Instance& instance, std::uint32_t face) {
  DpsColors colors;
  const std::size_t group = face - part.faces.size();
  const std::optional<Color> own = face < part.faces.size()              ? part.faces[face].color
                                   : group < part.polygons.groups.size() ? part.polygons.groups[group].color
                                                                         : std::nullopt;
  const std::optional<Color>& color = own ? own : instance.color ? instance.color : part.color;
  if (color) colors.diffuse = srgb(*color);
  return colors;
}

}  // namespace

Status write_points_csv(const std::string& path, const Model& model, const PointScene& scene) {
  Output out(path);
  std::string line;
  for (const char* column : kColumns) {
    if (!line.empty()) line += ',';
    line += column;
  }
  line += '\n';
  out.add(line.data(), line.size());
  for_each_placed(model, scene, [&](const DifferentialPoint& p, std::uint32_t face) {
    char text[17 * 32];
    char* at = text;
    for (const double value : row_of(p, face)) {
      at = std::to_chars(at, text + sizeof text, value).ptr;
      *at++ = ',';
    }
    at[-1] = '\n';
    out.add(text, static_cast<std::size_t>(at - text));
  });
  return out.finish();
}

Status write_points_ply(const std::string& path, const Model& model, const PointScene& scene) {
  Output out(path);
  std::string head = "ply\nformat binary_little_endian 1.0\ncomment differential points\nelement vertex " +
                     std::to_string(placed_count(model, scene)) + "\n";
  for (std::size_t i = 0; i < std::size(kColumns); ++i)
    head += std::string("property ") + (i == kFaceColumn ? "uint " : "double ") + kColumns[i] + "\n";
  head += "end_header\n";
  out.add(head.data(), head.size());
  for_each_placed(model, scene, [&](const DifferentialPoint& p, std::uint32_t face) {
    char bytes[std::size(kColumns) * 8];
    char* at = bytes;
    const auto row = row_of(p, face);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::size_t size = i == kFaceColumn ? sizeof face : sizeof row[i];
      std::memcpy(at, i == kFaceColumn ? static_cast<const void*>(&face) : &row[i], size);
      at += size;
    }
    out.add(bytes, static_cast<std::size_t>(at - bytes));
  });
  return out.finish();
}

Status write_points_dps(const std::string& path, const Model& model, const PointScene& scene,
                        DpsEncoding encoding) {
  Result<DpsWriter> writer = DpsWriter::create(path, {encoding, scene.epsilon, scene.delta});
  if (!writer.ok()) return writer.status();
  // Which faces of which instances have each colour, colours in the order in which they come up first.
  std::vector<std::pair<DpsColors, std::map<std::uint32_t, std::vector<bool>>>> groups;
  for (std::uint32_t i = 0; i < model.instances.size(); ++i) {
    const Instance& instance = model.instances[i];
    const Part& part = model.parts[instance.part];
    const std::size_t faces = std::max<std::size_t>(face_count(part), 1);
    for (std::uint32_t face = 0; face < faces; ++face) {
      const DpsColors colors = colors_of(part, instance, face);
      auto group =
          std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == colors; });
      if (group == groups.end()) group = groups.insert(groups.end(), {colors, {}});
      auto& wanted = group->second[i];
      wanted.resize(faces, false);
      wanted[face] = true;
    }
  }
  for (const auto& [colors, instances] : groups) {
    std::vector<DifferentialPoint> points;
    for (const auto& [i, faces] : instances)
      for (const DifferentialPoint& p : scene.parts[model.instances[i].part].points) {
        if (faces[p.face]) points.push_back(placed(p, model.instances[i].to_world));
        if (points.size() < kMostChunkPoints) continue;
        if (const Status status = writer->add(colors, points); !status.ok()) return status;
        points.clear();
      }
    if (const Status status = writer->add(colors, points); !status.ok()) return status;
  }
  return writer->finish();
}

}  // namespace dupin::app
