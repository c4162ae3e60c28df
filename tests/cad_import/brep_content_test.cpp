#include "../../cad_import/reader/brep_content.h"

#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BinTools.hxx>
#include <TopExp_Explorer.hxx>

#include <chrono>
#include <sstream>

#include "../../cad_import/file_kind.h"

namespace dupin::reader {
namespace {

std::string written(bool binary) {
  std::ostringstream out;
  const TopoDS_Shape shape = BRepPrimAPI_MakeTorus(3, 1).Shape();
  if (binary)
    BinTools::Write(shape, out);
  else
    BRepTools::Write(shape, out);
  return out.str();
}

bool has_face(const TopoDS_Shape& shape) {
  return !shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More();
}

TEST(BrepContent, TextAndBinary) {
  EXPECT_EQ(find_file_kind(written(false)), FileKind::brep_text);
  EXPECT_EQ(find_file_kind(written(true)), FileKind::brep_binary);
  EXPECT_TRUE(has_face(read_brep_content(written(false))));
  EXPECT_TRUE(has_face(read_brep_content(written(true))));
  EXPECT_TRUE(has_face(read_brep_content("DBRep_DrawableShape\n" + written(false))));
}

TEST(BrepContent, NoTruncationHangs) {
  for (const bool binary : {false, true}) {
    const std::string whole = written(binary);
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t n = 0; n + 8 < whole.size(); n += 7)
      EXPECT_FALSE(has_face(read_brep_content(whole.substr(0, n)))) << n;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 30);
  }
}

}  // namespace
}  // namespace dupin::reader
