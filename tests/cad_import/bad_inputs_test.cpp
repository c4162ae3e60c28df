#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "files.h"

namespace dupin {
namespace {

using test::sample;

void expect_unreadable(const std::string& path) {
  const auto start = std::chrono::steady_clock::now();
  const Status status = test::import_file(path).status();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(status.code, StatusCode::unreadable) << path << ": " << status.message;
  EXPECT_FALSE(status.message.empty());
  EXPECT_EQ(status.message.find('\n'), std::string::npos) << status.message;
  EXPECT_LT(status.message.size(), 600u) << status.message;
  EXPECT_LT(seconds, 15) << path;
}

std::string noise(std::size_t size) {
  std::mt19937 random(1);
  std::string bytes(size, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

TEST(BadInputs, FilesThatAreNotThereOrNoFiles) {
  expect_unreadable(test::scratch() + "/missing.step");
  expect_unreadable(test::scratch());
  expect_unreadable("/dev/null");
  expect_unreadable("");
}

TEST(BadInputs, EmptyAndNoise) {
  for (const char* extension : {"step", "igs", "brep", "FCStd", "gz", "txt"}) {
    expect_unreadable(test::write_file(std::string("empty.") + extension, ""));
    expect_unreadable(test::write_file(std::string("noise.") + extension, noise(20000)));
  }
}

TEST(BadInputs, NoiseBehindARightBeginning) {
  expect_unreadable(test::write_file("a.step", "ISO-10303-21;\n" + noise(20000)));
  expect_unreadable(test::write_file(
      "b.brep", "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\n" + noise(20000)));
  expect_unreadable(test::write_file("c.brep", "\nOpen CASCADE Topology V4 (c)\n" + noise(20000)));
  expect_unreadable(test::write_file("d.FCStd", "PK\x03\x04" + noise(20000)));
  expect_unreadable(test::write_file("e.step.gz", "\x1f\x8b\x08" + noise(20000)));
}

TEST(BadInputs, ACutStepFileIsRefusedOrReadInPart) {
  const std::string whole = test::read_file(sample("bracket.step"));
  for (const double part : {0.02, 0.3, 0.7, 0.95}) {
    const std::string path = test::write_file(
        "cut.step", whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    const Result<Model> model = test::import_file(path);
    if (!model.ok()) {
      EXPECT_EQ(model.status().code, StatusCode::unreadable) << model.status().message;
      EXPECT_EQ(model.status().message.find('\n'), std::string::npos);
    } else {
      EXPECT_TRUE(check(*model).ok());
    }
  }
}

TEST(BadInputs, ReferencesToNothing) {
  std::string text = test::read_file(sample("bracket.step"));
  // Every second reference to a point now points beyond the file's end.
  std::size_t at = 0;
  for (int i = 0; (at = text.find("VERTEX_POINT('',#", at)) != std::string::npos; ++i, at += 10)
    if (i % 2 == 0) text.replace(at + 17, 1, "99999");
  const Result<Model> model = test::import_file(test::write_file("dangling.step", text));
  if (model.ok())
    EXPECT_TRUE(check(*model).ok());
  else
    EXPECT_EQ(model.status().message.find('\n'), std::string::npos) << model.status().message;

  expect_unreadable(test::write_file(
      "nothing.step",
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
      "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n#1=ADVANCED_FACE('',(#5,#6),#7,.T.);\n"
      "#2=CLOSED_SHELL('',(#1,#9));\n#3=MANIFOLD_SOLID_BREP('',#2);\nENDSEC;\nEND-ISO-10303-21;\n"));
}

TEST(BadInputs, AShapeWithoutFaces) {
  expect_unreadable(test::write_file(
      "point.brep",
      "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 0\nCurve2ds 0\nCurves 0\n"
      "Polygon3D 0\nPolygonOnTriangulations 0\nSurfaces 0\nTriangulations 0\n\nTShapes 1\nVe\n1e-07\n0 0 "
      "0\n0 0\n\n"
      "0101101\n*\n\n+1 0 \n0\n"));
}

TEST(BadInputs, TheExtensionDoesNotMatter) {
  const std::string path = test::write_file("bracket.brep", test::read_file(sample("bracket.step")));
  const Result<Model> model = test::import_file(path);
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->format, "STEP");
}

// Bytes changed at random: whatever the kernel makes of it, the caller gets a valid model or one line.
TEST(BadInputs, RandomDamage) {
  const std::string whole = test::read_file(sample("assembly.step"));
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    std::string text = whole;
    for (int i = 0; i < 1 << (seed % 6); ++i)
      text[random() % text.size()] = static_cast<char>(' ' + random() % 95);
    const Result<Model> model = test::import_file(test::write_file("damaged.step", text));
    if (model.ok())
      EXPECT_TRUE(check(*model).ok());
    else
      EXPECT_EQ(model.status().message.find('\n'), std::string::npos) << model.status().message;
  }
}

}  // namespace
}  // namespace dupin
