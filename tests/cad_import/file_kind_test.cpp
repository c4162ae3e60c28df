#include "../../cad_import/file_kind.h"

#include <gtest/gtest.h>

#include "files.h"

namespace dupin {
namespace {

FileKind kind_of(std::string_view text) {
  return find_file_kind(text);
}

std::string iges_line(std::string_view text, char section, int number) {
  std::string line(text);
  line.resize(72, ' ');
  char tail[16];
  std::snprintf(tail, sizeof tail, "%c%7d\n", section, number);
  return line + tail;
}

TEST(FileKind, EveryKindIsKnownByItsContent) {
  EXPECT_EQ(kind_of("ISO-10303-21;\nHEADER;"), FileKind::step);
  EXPECT_EQ(kind_of("\xef\xbb\xbf \n/* a comment */ ISO-10303-21;"), FileKind::step);
  EXPECT_EQ(kind_of(iges_line("from somewhere", 'S', 1) + iges_line("1H,,1H;,", 'G', 1)), FileKind::iges);
  EXPECT_EQ(kind_of("DBRep_DrawableShape\n\nCASCADE Topology V1"), FileKind::brep_text);
  EXPECT_EQ(kind_of("\nCASCADE Topology V3, (c) Open Cascade"), FileKind::brep_text);
  EXPECT_EQ(kind_of("\nOpen CASCADE Topology V4 (c)\n"), FileKind::brep_binary);
  EXPECT_EQ(kind_of(std::string_view("PK\x03\x04rest", 8)), FileKind::zip);
  EXPECT_EQ(kind_of("\x1f\x8b\x08"), FileKind::gzip);
  EXPECT_EQ(kind_of("ply\nformat ascii 1.0\n"), FileKind::ply);
  EXPECT_EQ(kind_of("# made by hand\nCOFF\n8 6 12\n"), FileKind::off);
  EXPECT_EQ(kind_of("solid cube\nfacet normal 0 0 1"), FileKind::stl_text);
  EXPECT_EQ(kind_of("solid \n\n  facet normal 0 0 1"), FileKind::stl_text);
  EXPECT_EQ(kind_of("# Blender\nmtllib a.mtl\no Cube\nv 1 -1 .5\n"), FileKind::obj);
}

TEST(FileKind, ABinaryStlFileIsKnownByItsSizeAlone) {
  std::string bytes = "solid that is none";
  bytes.resize(84 + 50 * 3, '\0');
  bytes[80] = 3;
  EXPECT_EQ(kind_of(bytes), FileKind::stl_binary);
  EXPECT_EQ(find_file_kind(bytes, 84 + 50 * 3), FileKind::stl_binary);
  EXPECT_EQ(find_file_kind(bytes, 84 + 50 * 4), FileKind::unknown);
  EXPECT_EQ(find_file_kind(bytes, 84 + 50 * 4, "cut.STL.gz"), FileKind::stl_binary);
}

TEST(FileKind, TheNameIsAskedOnlyWhereTheContentSaysNothing) {
  EXPECT_EQ(find_file_kind(std::string_view("garbage"), 7, "a.obj"), FileKind::obj);
  EXPECT_EQ(find_file_kind(std::string_view("ISO-10303-21;"), 13, "a.obj"), FileKind::step);
  EXPECT_EQ(find_file_kind(std::string_view("garbage"), 7, "a.step"), FileKind::unknown);
}

TEST(FileKind, AnythingElseIsUnknown) {
  EXPECT_EQ(kind_of(""), FileKind::empty);
  EXPECT_EQ(kind_of("solid ground\nis what it stands on"), FileKind::unknown);
  EXPECT_EQ(kind_of("# only a comment\n"), FileKind::unknown);
  EXPECT_EQ(kind_of("ISO-9660"), FileKind::unknown);
  EXPECT_EQ(kind_of("/* a comment that does not end ISO-10303-21;"), FileKind::unknown);
  EXPECT_EQ(kind_of(std::string(200, 'S')), FileKind::unknown);
  EXPECT_EQ(kind_of(std::string_view("\0\0\0\0", 4)), FileKind::unknown);
}

TEST(FileKind, FilesThatCannotBeReadSayWhy) {
  const auto missing = file_kind(test::scratch() + "/not-there.step");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.status().code, StatusCode::unreadable);
  EXPECT_NE(missing.status().message.find("no such file"), std::string::npos);
  EXPECT_FALSE(file_kind(test::scratch()).ok());
  EXPECT_FALSE(file_kind("/dev/zero").ok());
}

}  // namespace
}  // namespace dupin
