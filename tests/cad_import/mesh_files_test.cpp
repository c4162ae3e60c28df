#include "../../cad_import/mesh_files/mesh_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "allocation_watch.h"

namespace dupin::mesh_files {
namespace {

template <class T>
void put(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof raw);
  if (big_endian) std::reverse(raw, raw + sizeof raw);
  bytes.append(raw, sizeof raw);
}

const std::string kObj =
    "# a comment\n"
    "o thing\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0 1 0.5 0\nv 0 1 0\n"
    "vn 0 0 2\nvt 0 0\n"
    "g base\nusemtl red\n"
    "f 1/1/1 2/1/1 3/1/1 4/1/1\n"
    "g top\n"
    "f -4 -3 \\\n -2\n"
    "t crease 2/1/0 0 1 2.5\nt crease 3/2/0 0 1 2 1 2\nt corner 1/1/0 3 10\nt hole 1/0/0 1\n"
    "t interpolateboundary 1/0/0 1\nt creasemethod 0/0/1 chaikin\nt crease 2/1/0 0 77 1\n";

std::string ply_header(const char* format, const char* vertices = "3", const char* faces = "1") {
  return std::string("ply\nformat ") + format + " 1.0\ncomment x\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nproperty float quality\nelement face " +
         faces + "\nproperty list uchar int vertex_indices\nend_header\n";
}

const std::string kPlyText =
    ply_header("ascii") + "0 0 0 255 0 0 1\n1 0 0.5 0 255 0 1\n0 1e0 0 0 0 255 1\n3 0 1 2\n";

std::string ply_binary(bool big) {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian");
  for (int i = 0; i < 3; ++i) {
    put(bytes, i == 1 ? 1.0F : 0.0F, big);
    put(bytes, i == 2 ? 1.0F : 0.0F, big);
    put(bytes, i == 1 ? 0.5 : 0.0, big);
    for (int k = 0; k < 3; ++k) put<std::uint8_t>(bytes, k == i ? 255 : 0);
    put(bytes, 1.0F, big);
  }
  put<std::uint8_t>(bytes, 3);
  for (const std::int32_t v : {0, 1, 2}) put(bytes, v, big);
  return bytes;
}

const std::string kOff = "OFF\n# cage\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 2 1\n";

const std::string kStlText =
    "solid first part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
    "  endloop\n endfacet\nendsolid first part\n"
    "solid other\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1 1 0\n   vertex 0 1 -0\n"
    "  endloop\n endfacet\nendsolid other\n";

std::string stl_binary(std::uint16_t attribute = 0, const std::string& title = "made by hand") {
  std::string header(80, '\0');
  std::copy(title.begin(), title.end(), header.begin());
  put<std::uint32_t>(header, 2);
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, 0}};
  for (const auto& triangle : corners) {
    for (int i = 0; i < 3; ++i) put(header, 0.0F);
    for (const float x : triangle) put(header, x);
    put(header, attribute);
  }
  return header;
}

using ReadFile = std::function<Result<MeshFile>(std::string_view)>;
ReadFile obj() {
  return [](std::string_view b) { return read_obj(b); };
}

PolygonMesh mesh_of(const Result<MeshFile>& file) {
  EXPECT_TRUE(file.ok()) << file.status().message;
  if (!file.ok()) return {};
  EXPECT_TRUE(check(file->mesh).ok()) << check(file->mesh).message;
  return file->mesh;
}

void expect_refused(const Result<MeshFile>& file, const std::string& part) {
  ASSERT_FALSE(file.ok()) << part;
  EXPECT_EQ(file.status().code, StatusCode::unreadable);
  EXPECT_NE(file.status().message.find(part), std::string::npos) << file.status().message;
}

TEST(MeshFiles, ObjKeepsPolygonsGroupsColoursNormalsAndTags) {
  const auto find = [](std::string_view name) {
    return name == "m.mtl" ? std::optional<std::string>("newmtl red\nKd 1 0 0\nd 0.5\n") : std::nullopt;
  };
  const Result<MeshFile> file = read_obj("mtllib m.mtl\n" + kObj, find);
  const PolygonMesh mesh = mesh_of(file);
  ASSERT_EQ(mesh.polygon_count(), 2u);
  EXPECT_EQ(mesh.corner_count(0), 4u);
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2}));
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].name, "thing/base");
  EXPECT_EQ(mesh.groups[0].color, (Color{1, 0, 0, 0.5F}));
  EXPECT_EQ(mesh.polygon_groups, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(mesh.colors[2], (Rgba8{255, 128, 0, 255}));
  EXPECT_EQ(mesh.normals[0], (std::array<float, 3>{0, 0, 1}));
  EXPECT_EQ(mesh.corner_normals[3], 0u);
  EXPECT_EQ(mesh.corner_normals[4], PolygonMesh::kNoNormal);
  ASSERT_EQ(mesh.tags.creases.size(), 3u)
      << "two edges of the chain; the one that refers to nothing is dropped";
  EXPECT_EQ(mesh.tags.creases[2].sharpness, 2);
  EXPECT_EQ(mesh.tags.corners[0].vertex, 3u);
  EXPECT_EQ(mesh.tags.holes, std::vector<std::uint32_t>{1});
  EXPECT_EQ(mesh.tags.boundary, SubdivisionTags::Boundary::edges_and_corners);
  EXPECT_TRUE(mesh.tags.chaikin);
  EXPECT_EQ(file->notes.size(), 2u) << "texture coordinates, and a tag that refers to nothing";
}

TEST(MeshFiles, PlyOfEveryByteOrderSaysTheSame) {
  const PolygonMesh text = mesh_of(read_ply(kPlyText));
  EXPECT_EQ(text.positions[1], (Vec3{1, 0, 0.5}));
  EXPECT_EQ(text.colors[2], (Rgba8{0, 0, 255, 255}));
  EXPECT_TRUE(text.all_triangles());
  for (const bool big : {false, true}) {
    const PolygonMesh binary = mesh_of(read_ply(ply_binary(big)));
    EXPECT_EQ(binary.positions, text.positions);
    EXPECT_EQ(binary.colors, text.colors);
    EXPECT_EQ(binary.corners, text.corners);
  }
}

TEST(MeshFiles, PlyMayHavePointsOnlyOrTriangleStripsOrFacesFirst) {
  const PolygonMesh points = mesh_of(read_ply(
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 2\n1 0 0 0 0 0"));
  EXPECT_EQ(points.polygon_count(), 0u);
  EXPECT_EQ(loose_point_count(points), 2u);
  EXPECT_EQ(points.normals[0], (std::array<float, 3>{0, 0, 1}));
  const PolygonMesh strips = mesh_of(read_ply(
      "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nelement vertex 5\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n"
      "8 0 1 2 3 -1 2 3 4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n"));
  EXPECT_EQ(strips.corners, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4}));
}

TEST(MeshFiles, OffMayHaveColoursOfFacesAndVertices) {
  const PolygonMesh mesh = mesh_of(read_off(kOff));
  EXPECT_EQ(mesh.polygon_count(), 2u);
  EXPECT_EQ(mesh.polygon_colors[0], (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(mesh.corner_count(0), 4u);
  const PolygonMesh colored = mesh_of(
      read_off("CNOFF 3 1 3\n0 0 0 0 0 1 1 0 0 1\n1 0 0 0 0 1 0 1 0 1\n0 1 0 0 0 1 0 0 1 0.5\n3 0 1 2\n"));
  EXPECT_EQ(colored.colors[2], (Rgba8{0, 0, 255, 128}));
  EXPECT_EQ(colored.normals.size(), 3u);
}

TEST(MeshFiles, StlCornersAtOnePlaceAreOneVertex) {
  const PolygonMesh text = mesh_of(read_stl_text(kStlText)), binary = mesh_of(read_stl_binary(stl_binary()));
  EXPECT_EQ(text.positions.size(), 4u);
  EXPECT_EQ(text.corners, binary.corners);
  EXPECT_EQ(text.positions, binary.positions);
  EXPECT_EQ(text.groups[1].name, "other");
  EXPECT_EQ(text.polygon_groups, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(binary.polygon_colors.empty());
}

TEST(MeshFiles, StlColoursOfBothKinds) {
  EXPECT_EQ(mesh_of(read_stl_binary(stl_binary(0x8000 | 31 << 10))).polygon_colors[0],
            (Rgba8{255, 0, 0, 255}));
  const std::string magics = std::string("COLOR=\x10\x20\x30\xff", 10);
  EXPECT_EQ(mesh_of(read_stl_binary(stl_binary(31, magics))).polygon_colors[1], (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(mesh_of(read_stl_binary(stl_binary(0x8000, magics))).polygon_colors[0], (Rgba8{16, 32, 48, 255}));
}

TEST(MeshFiles, WhatIsNotManifoldOrDegenerateStays) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\n";
  for (int i = 0; i < 5; ++i) text += "f 1 2 3\n";  // one edge with five faces
  text += "f 1 2 4\nf 2 2 2\nf 1 1 2\nf 1 2\n";
  const Result<MeshFile> file = read_obj(text);
  EXPECT_EQ(mesh_of(file).polygon_count(), 8u);
  EXPECT_EQ(loose_point_count(file->mesh), 1u);
  EXPECT_EQ(file->notes.size(), 1u) << "the face of two corners";
}

TEST(MeshFiles, RefusalsSayWhere) {
  expect_refused(read_obj("v 0 0 0\nv 1 nan 0\n"), "line 2: a vertex is not finite");
  expect_refused(read_obj("v 0 0 0\nv 1 1e999 0\n"), "line 2: a vertex is not finite");
  expect_refused(read_obj("v 0 0 0\n\nf 1 1 2\n"), "line 3: a polygon refers to vertex 2 of 1");
  expect_refused(read_obj("v 0 0 0\nf 1 1 0\n"), "line 2");
  expect_refused(read_obj("v 0 0 0\nf 1 1 -2\n"), "line 2");
  expect_refused(read_obj("v 0 0 0\nf 1//1 1//1 1//1\n"), "normal 1 of 0");
  expect_refused(read_obj("v 0 0\n"), "line 1: a vertex has too few numbers");
  expect_refused(read_obj("v 0 0 0x\n"), "'0x'");
  expect_refused(read_ply(ply_header("ascii") + "0 0 inf 0 0 0 1\n" + std::string(99, ' ')),
                 "vertex 0 is not finite");
  expect_refused(read_ply(ply_header("ascii") + "0 0 0 0 0 0 1\n0 0 0 0 0 0 1\n0 0 0 0 0 0 1\n3 0 1 3\n"),
                 "line 18: face 0 refers to vertex 3 of 3");
  expect_refused(read_ply(ply_header("ascii") + "0 0 0 0 0 0 1\n"), "the file can hold");
  std::string cut = ply_binary(false);
  cut.resize(cut.size() - 3);
  expect_refused(read_ply(cut), "byte " + std::to_string(ply_binary(false).size() - 12));
  expect_refused(read_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
                 "line 6: a face refers to vertex 3 of 3");
  expect_refused(read_off("4OFF\n1 0 0\n0 0 0 0\n"), "three-dimensional");
  expect_refused(read_stl_text("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n"), "line 4");
  expect_refused(read_stl_text("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n"), "line 5");
  std::string stl = stl_binary();
  EXPECT_FALSE(read_stl_binary(stl.substr(0, stl.size() - 1)).ok());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(stl.data() + 84 + 50 + 24, &nan, 4);
  expect_refused(read_stl_binary(stl), "byte 158");
}

TEST(MeshFiles, PromisesBeyondTheFileAllocateNothing) {
  test::watch_allocations();
  for (const char* count : {"4000000000", "4294967295", "9223372036854775807", "99999999999999999999"}) {
    EXPECT_FALSE(read_ply(ply_header("binary_little_endian", count) + std::string(1000, '\0')).ok());
    EXPECT_FALSE(read_ply(ply_header("binary_little_endian", "3", count) + std::string(1000, '\0')).ok());
    EXPECT_FALSE(read_ply(ply_header("ascii", count) + "0 0 0").ok());
    EXPECT_FALSE(read_off(std::string("OFF\n") + count + " 1 0\n0 0 0\n").ok());
    EXPECT_FALSE(read_off(std::string("OFF\n1 ") + count + " 0\n0 0 0\n").ok());
    EXPECT_FALSE(read_off(std::string("OFF\n1 1 0\n0 0 0\n") + count + " 0 0 0\n").ok());
    EXPECT_FALSE(read_obj(std::string("v 0 0 0\nt crease ") + count + "/1/0 0 1\n").ok());
  }
  std::string stl = stl_binary();
  std::memset(stl.data() + 80, 0xff, 4);
  EXPECT_FALSE(read_stl_binary(stl).ok());
  EXPECT_LT(test::largest_allocation(), 100000u);
}

/// Damages bytes, doubles and drops pieces of a good file, and holds the reader to its promises.
void expect_survives(const char* name, const std::string& good, const ReadFile& read) {
  std::mt19937 random(7);
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  int accepted = 0;
  test::watch_allocations();
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = good;
    for (std::size_t k = 1 + below(4); k > 0; --k) switch (below(5)) {
        case 0:
          bytes[below(bytes.size())] = static_cast<char>(random());
          break;
        case 1:
          bytes[below(bytes.size())] = "0123456789-+.eE \n/#\xff"[below(21)];
          break;
        case 2:
          bytes.resize(1 + below(bytes.size()));
          break;
        case 3: {
          const std::size_t at = below(bytes.size());
          bytes.insert(below(bytes.size()), bytes.substr(at, below(60)));
          break;
        }
        default:
          bytes.erase(below(bytes.size()), below(20));
          if (bytes.empty()) bytes.push_back('x');
      }
    const Result<MeshFile> file = read(bytes);
    if (file.ok()) {
      ++accepted;
      EXPECT_TRUE(check(file->mesh).ok()) << name << " " << trial << ": " << check(file->mesh).message;
    } else {
      EXPECT_EQ(file.status().message.find('\n'), std::string::npos) << name << " " << trial;
      EXPECT_FALSE(file.status().message.empty());
    }
  }
  EXPECT_GT(accepted, 0) << name;
  EXPECT_LT(test::largest_allocation(), 64 * good.size() + 8192) << name;
}

TEST(MeshFiles, MutantsAreRefusedOrValid) {
  expect_survives("obj", kObj, obj());
  expect_survives("ply text", kPlyText, read_ply);
  expect_survives("ply little endian", ply_binary(false), read_ply);
  expect_survives("ply big endian", ply_binary(true), read_ply);
  expect_survives("off", kOff, read_off);
  expect_survives("stl text", kStlText, read_stl_text);
  expect_survives("stl binary", stl_binary(0x8001), read_stl_binary);
}

}  // namespace
}  // namespace dupin::mesh_files
