#include "points.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace dupin::testing {

std::vector<DifferentialPoint> random_points(std::size_t count, unsigned seed, bool own_sizes) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::normal_distribution<double> normal;
  std::vector<DifferentialPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    DifferentialPoint p;
    p.position = {100 + 20 * unit(random), -3 * unit(random), 1e-3 * unit(random)};
    p.u = normalized({normal(random), normal(random), normal(random)});
    const Vec3 e = any_perpendicular(p.u);
    const double angle = 3.14159 * unit(random);
    p.v = e * std::cos(angle) + cross(p.u, e) * std::sin(angle);
    if (i % 7 != 0) p.lambda_u = std::copysign(std::pow(10.0, 3 * unit(random)), unit(random));
    p.lambda_v = p.lambda_u * (i % 5 == 0 ? 0 : i % 5 == 1 ? 1 : unit(random));
    set_extents(p, kEpsilon, kDelta);
    if (own_sizes && i % 3 == 0) {
      p.own_size = true;
      p.half_u *= 1 + std::abs(unit(random));
      p.half_v *= 2 + unit(random);
    }
    points.push_back(p);
  }
  return points;
}

std::string scratch_file(const std::string& name) {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("dupin-simplify-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
  };
  static const Folder folder;
  return (folder.path / name).string();
}

std::vector<unsigned char> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::vector<unsigned char>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace dupin::testing
