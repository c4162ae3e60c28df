// FreeCAD documents as written here, member by member.
#include <gtest/gtest.h>
#include <zip.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>

#include <map>
#include <sstream>

#include "../../cad_import/reader/fcstd_document.h"
#include "../../cad_import/reader/import_shapes.h"
#include "files.h"

namespace dupin::reader {
namespace {

const Stage kQuiet = [](const char*, double) {};

std::string brep(const TopoDS_Shape& shape) {
  std::ostringstream out;
  BRepTools::Write(shape, out);
  return out.str();
}

std::string archive(const std::string& name, const std::map<std::string, std::string>& members) {
  const std::string path = test::scratch() + "/" + name;
  int error = 0;
  zip_t* file = ::zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  for (const auto& [member, content] : members)
    ::zip_file_add(file, member.c_str(), ::zip_source_buffer(file, content.data(), content.size(), 0), 0);
  ::zip_close(file);
  return path;
}

std::string placement(double x, double y, double z) {
  std::ostringstream out;
  out << "<Property name=\"Placement\" type=\"App::PropertyPlacement\"><PropertyPlacement Px=\"" << x
      << "\" Py=\"" << y << "\" Pz=\"" << z << "\" Q0=\"0\" Q1=\"0\" Q2=\"0\" Q3=\"1\"/></Property>";
  return out.str();
}
std::string shape_property(const std::string& file) {
  return "<Property name=\"Shape\" type=\"Part::PropertyPartShape\"><Part file=\"" + file + "\"/></Property>";
}

struct Object {
  std::string type, name, properties;
};

std::string document(const std::vector<Object>& objects) {
  std::string list, data;
  for (const Object& o : objects) {
    list += "<Object type=\"" + o.type + "\" name=\"" + o.name + "\"/>";
    data += "<Object name=\"" + o.name + "\"><Properties>" + o.properties + "</Properties></Object>";
  }
  return "<?xml version='1.0' encoding='utf-8'?><Document SchemaVersion=\"4\"><Objects>" + list +
         "</Objects><ObjectData>" + data + "</ObjectData></Document>";
}

std::string view(const std::map<std::string, std::string>& providers) {
  std::string data;
  for (const auto& [name, properties] : providers)
    data += "<ViewProvider name=\"" + name + "\"><Properties>" + properties + "</Properties></ViewProvider>";
  return "<Document><ViewProviderData>" + data + "</ViewProviderData></Document>";
}
const std::string kShown =
    "<Property name=\"Visibility\" type=\"App::PropertyBool\"><Bool value=\"true\"/></Property>";
const std::string kHidden =
    "<Property name=\"Visibility\" type=\"App::PropertyBool\"><Bool value=\"false\"/></Property>";

Result<Model> import(const std::string& path) {
  ImportRequest request;
  request.path = path;
  return import_shapes(request, kQuiet);
}

const TopoDS_Shape& box() {
  static const TopoDS_Shape kBox = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  return kBox;
}

TEST(Fcstd, PlacementsOfContainersAddUp) {
  gp_Trsf own;
  own.SetTranslation(gp_Vec(1, 0, 0));
  const std::string group =
      "<Property name=\"Group\" type=\"App::PropertyLinkList\"><LinkList count=\"1\"><Link "
      "value=\"Box\"/></LinkList></Property>";
  // Once with the object's placement in the shape as well, as FreeCAD writes it, once without.
  for (const TopoDS_Shape& shape : {box().Moved(own), box()}) {
    const auto model = import(archive(
        "places.FCStd",
        {{"Document.xml", document({{"App::Part", "Part", group + placement(10, 0, 0)},
                                    {"Part::Box", "Box", shape_property("s.brp") + placement(1, 0, 0)}})},
         {"GuiDocument.xml", view({{"Part", kShown}, {"Box", kShown}})},
         {"s.brp", brep(shape)}}));
    ASSERT_TRUE(model.ok()) << model.status().message;
    EXPECT_NEAR(bounding_box(*model).lo.x, 11, 1e-6);
  }
}

TEST(Fcstd, AHiddenContainerHidesWhatIsInIt) {
  const std::string group =
      "<Property name=\"Group\" type=\"App::PropertyLinkList\"><LinkList count=\"1\"><Link "
      "value=\"Box\"/></LinkList></Property>";
  const std::map<std::string, std::string> members = {
      {"Document.xml", document({{"App::Part", "Part", group + placement(0, 0, 0)},
                                 {"Part::Box", "Box", shape_property("s.brp")},
                                 {"Part::Box", "Other", shape_property("s.brp") + placement(5, 0, 0)}})},
      {"GuiDocument.xml", view({{"Part", kHidden}, {"Box", kShown}, {"Other", kShown}})},
      {"s.brp", brep(box())}};
  const auto model = import(archive("hidden.FCStd", members));
  ASSERT_TRUE(model.ok()) << model.status().message;
  ASSERT_EQ(model->instances.size(), 1u);
  EXPECT_EQ(model->instances[0].name, "Other");
}

TEST(Fcstd, WithoutAViewWhatNothingElseUsesIsShown) {
  const std::string uses =
      "<Property name=\"Base\" type=\"App::PropertyLink\"><Link value=\"Box\"/></Property>";
  const auto model = import(archive(
      "headless.FCStd", {{"Document.xml", document({{"Part::Box", "Box", shape_property("s.brp")},
                                                    {"Part::Cut", "Cut", shape_property("s.brp") + uses}})},
                         {"s.brp", brep(box())}}));
  ASSERT_TRUE(model.ok()) << model.status().message;
  ASSERT_EQ(model->instances.size(), 1u);
  EXPECT_EQ(model->instances[0].name, "Cut");
}

TEST(Fcstd, ALinkShowsItsObjectElsewhere) {
  const std::string link =
      "<Property name=\"LinkedObject\" type=\"App::PropertyXLink\"><XLink file=\"\" "
      "name=\"Box\"/></Property>";
  const auto model = import(
      archive("link.FCStd",
              {{"Document.xml", document({{"Part::Box", "Box", shape_property("s.brp") + placement(1, 0, 0)},
                                          {"App::Link", "Link", link + placement(7, 0, 0)}})},
               {"GuiDocument.xml", view({{"Box", kShown}, {"Link", kShown}})},
               {"s.brp", brep(box())}}));
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->instances.size(), 2u);
  EXPECT_NEAR(bounding_box(*model).hi.x, 8, 1e-6);
}

TEST(Fcstd, WhatIsDamagedIsNamedAndTheRestIsRead) {
  const auto model = import(archive(
      "partly.FCStd", {{"Document.xml", document({{"Part::Box", "Good", shape_property("s.brp")},
                                                  {"Part::Box", "Bad", shape_property("t.brp")},
                                                  {"Part::Box", "Gone", shape_property("u.brp")}})},
                       {"GuiDocument.xml", view({{"Good", kShown}, {"Bad", kShown}, {"Gone", kShown}})},
                       {"s.brp", brep(box())},
                       {"t.brp", "CASCADE Topology V1, (c) Matra-Datavision\nLocations x"}}));
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->instances.size(), 1u);
  ASSERT_EQ(model->skipped.size(), 2u);
  EXPECT_EQ(model->skipped[0].name, "Bad");
  EXPECT_EQ(model->skipped[1].name, "Gone");
}

TEST(Fcstd, AnyOtherZipFileIsRefused) {
  EXPECT_FALSE(import(archive("other.zip", {{"readme.txt", "hello"}})).ok());
  EXPECT_FALSE(import(archive("broken.FCStd", {{"Document.xml", "<Document><Objects>"}})).ok());
}

TEST(Fcstd, ColourListsAreNotBelieved) {
  EXPECT_TRUE(parse_colors("").empty());
  EXPECT_TRUE(parse_colors(std::string("\xff\xff\xff\xff\0\0\0\0", 8)).empty());
  const std::vector<Color> colors = parse_colors(std::string("\x01\0\0\0\x00\x00\x80\xff", 8));
  ASSERT_EQ(colors.size(), 1u);
  EXPECT_EQ(colors[0].r, 1);
  EXPECT_NEAR(colors[0].g, 0.2159, 1e-4);
  EXPECT_EQ(colors[0].b, 0);
}

}  // namespace
}  // namespace dupin::reader
