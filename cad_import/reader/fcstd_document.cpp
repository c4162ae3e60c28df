#include "fcstd_document.h"

#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include <unordered_map>

namespace dupin::reader {
namespace {

double srgb_to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Affine3 to_affine(const pugi::xml_node& p) {
  const Vec3 t{p.attribute("Px").as_double(), p.attribute("Py").as_double(), p.attribute("Pz").as_double()};
  double x = p.attribute("Q0").as_double(), y = p.attribute("Q1").as_double(),
         z = p.attribute("Q2").as_double(), w = p.attribute("Q3").as_double(1);
  const double n = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(n > 0)) return {{}, t};
  x /= n, y /= n, z /= n, w /= n;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
           {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
           {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}},
          t};
}

void add_links(const pugi::xml_node& node, std::vector<std::string>& names) {
  for (const pugi::xml_node& child : node.children()) {
    const std::string_view tag = child.name();
    if (tag == "Link" || tag == "XLink") {
      // LinkSub entries name the object in "obj", plain ones in "value" or "name".
      for (const char* attribute : {"value", "obj", "name"})
        if (const std::string_view name = child.attribute(attribute).as_string(); !name.empty()) {
          names.emplace_back(name);
          break;
        }
    } else if (tag == "LinkSub") {
      names.emplace_back(child.attribute("value").as_string());
    }
    add_links(child, names);
  }
}

void read_link_property(const std::string_view name, const pugi::xml_node& property, FcObject& object) {
  if (name == "LinkedObject") {
    const pugi::xml_node link = property.first_child();
    const char* target = link.attribute("name").as_string();
    object.linked = *target ? target : link.attribute("value").as_string();
    object.link_to_other_file = *link.attribute("file").as_string() != 0;
  } else if (name == "LinkTransform") {
    object.link_keeps_placement = property.child("Bool").attribute("value").as_bool();
  } else if (name == "ElementCount") {
    object.link_elements = property.child("Integer").attribute("value").as_int();
  } else if (name == "ScaleVector") {
    const pugi::xml_node v = property.child("PropertyVector");
    object.link_scale = {v.attribute("valueX").as_double(1), v.attribute("valueY").as_double(1),
                         v.attribute("valueZ").as_double(1)};
  }
}

void read_property(const pugi::xml_node& property, FcObject& object) {
  const std::string_view name = property.attribute("name").as_string();
  if (name == "Shape")
    object.shape_file = property.child("Part").attribute("file").as_string();
  else if (name == "Label")
    object.label = property.child("String").attribute("value").as_string();
  else if (name == "Visibility")
    object.visible = property.child("Bool").attribute("value").as_bool(true);
  else if (name == "Placement" && property.child("PropertyPlacement")) {
    object.has_placement = true;
    object.placement = to_affine(property.child("PropertyPlacement"));
  } else if (name == "Group")
    add_links(property, object.group);
  else if (object.type.starts_with("App::Link"))
    read_link_property(name, property, object);
  else if (std::string_view(property.attribute("type").as_string()).find("Link") != std::string_view::npos)
    add_links(property, object.inputs);
}

void read_view_property(const pugi::xml_node& property, FcObject& object) {
  const std::string_view name = property.attribute("name").as_string();
  if (name == "Visibility")
    object.visible = property.child("Bool").attribute("value").as_bool(true);
  else if (name == "ShapeColor")
    object.color = unpack_color(property.child("PropertyColor").attribute("value").as_uint());
  else if (name == "DiffuseColor")
    object.face_colors_file = property.child("ColorList").attribute("file").as_string();
  else if (name == "Transparency")
    object.transparency = property.child("Integer").attribute("value").as_int() / 100.0;
  else if (name == "ShapeMaterial" && !object.color) {
    const pugi::xml_node material = property.child("PropertyMaterial");
    if (material.attribute("diffuseColor"))
      object.color = unpack_color(material.attribute("diffuseColor").as_uint());
  }
}

}  // namespace

Color unpack_color(std::uint32_t packed) {
  const auto channel = [&](int shift) {
    return static_cast<float>(srgb_to_linear((packed >> shift & 255) / 255.0));
  };
  return {channel(24), channel(16), channel(8), 1};
}

std::vector<Color> parse_colors(const std::string& bytes) {
  std::vector<Color> colors;
  std::uint32_t count = 0;
  if (bytes.size() < sizeof count) return colors;
  std::memcpy(&count, bytes.data(), sizeof count);
  if (count > bytes.size() / sizeof count - 1) return colors;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t packed;
    std::memcpy(&packed, bytes.data() + sizeof packed * (i + 1), sizeof packed);
    colors.push_back(unpack_color(packed));
  }
  return colors;
}

Result<FcDocument> parse_fcstd(const std::string& document, const std::string& view) {
  pugi::xml_document xml;
  if (!xml.load_buffer(document.data(), document.size()))
    return {StatusCode::unreadable, "the FCStd file's Document.xml is damaged"};
  FcDocument result;
  std::unordered_map<std::string, std::size_t> index;
  for (const pugi::xml_node& o : xml.child("Document").child("Objects").children("Object")) {
    index.emplace(o.attribute("name").as_string(), result.objects.size());
    result.objects.push_back({o.attribute("name").as_string(), o.attribute("type").as_string()});
  }
  for (const pugi::xml_node& o : xml.child("Document").child("ObjectData").children("Object")) {
    const auto at = index.find(o.attribute("name").as_string());
    if (at == index.end()) continue;
    for (const pugi::xml_node& p : o.child("Properties").children("Property"))
      read_property(p, result.objects[at->second]);
  }
  pugi::xml_document gui;
  if (view.empty() || !gui.load_buffer(view.data(), view.size())) return result;
  result.has_view = true;
  for (const pugi::xml_node& v : gui.child("Document").child("ViewProviderData").children("ViewProvider")) {
    const auto at = index.find(v.attribute("name").as_string());
    if (at == index.end()) continue;
    for (const pugi::xml_node& p : v.child("Properties").children("Property"))
      read_view_property(p, result.objects[at->second]);
  }
  return result;
}

}  // namespace dupin::reader
