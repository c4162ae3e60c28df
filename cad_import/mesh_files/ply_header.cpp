#include "ply_header.h"

#include <array>
#include <optional>
#include <utility>

#include "text_cursor.h"

namespace dupin::mesh_files {
namespace {

constexpr std::size_t kMostProperties = 1000, kMostElements = 100;

std::optional<PlyType> to_type(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{
      {{"char", PlyType::int8},
       {"int8", PlyType::int8},
       {"uchar", PlyType::uint8},
       {"uint8", PlyType::uint8},
       {"short", PlyType::int16},
       {"int16", PlyType::int16},
       {"ushort", PlyType::uint16},
       {"uint16", PlyType::uint16},
       {"int", PlyType::int32},
       {"int32", PlyType::int32},
       {"uint", PlyType::uint32},
       {"uint32", PlyType::uint32},
       {"float", PlyType::float32},
       {"float32", PlyType::float32},
       {"double", PlyType::float64},
       {"float64", PlyType::float64}}};
  for (const auto& [name, type] : kTypes)
    if (word == name) return type;
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : bytes_(bytes), text_(bytes) {}

  Result<PlyHeader> run() {
    if (text_.word() != "ply") return text_.failure("a PLY file begins with 'ply'");
    for (text_.next_line(); !text_.at_end(); text_.next_line()) {
      const std::string_view key = text_.word();
      if (key == "end_header") return finish();
      if (key.empty() || key == "comment" || key == "obj_info") continue;
      const Status status = key == "format"     ? format()
                            : key == "element"  ? element()
                            : key == "property" ? property()
                                                : text_.failure("the header has " + quoted(key));
      if (!status.ok()) return status;
    }
    return {StatusCode::unreadable, "the PLY header does not end"};
  }

 private:
  Result<PlyHeader> finish() {
    if (!seen_format_) return {StatusCode::unreadable, "the PLY header does not say its format"};
    text_.next_line();
    header_.bytes = static_cast<std::size_t>(text_.position() - bytes_.data());
    header_.lines = text_.line() - 1;
    return std::move(header_);
  }

  Status format() {
    const std::string_view word = text_.word();
    if (word == "ascii")
      header_.format = PlyHeader::Format::text;
    else if (word == "binary_little_endian")
      header_.format = PlyHeader::Format::little_endian;
    else if (word == "binary_big_endian")
      header_.format = PlyHeader::Format::big_endian;
    else
      return text_.failure("the format is " + quoted(word));
    seen_format_ = true;
    return {};
  }

  Status element() {
    PlyElement element;
    element.name = std::string(text_.word());
    const auto count = to_integer(text_.word());
    if (element.name.empty() || !count || *count < 0) return text_.failure("an element has no name or count");
    element.count = static_cast<std::uint64_t>(*count);
    if (header_.elements.size() == kMostElements) return text_.failure("the header has too many elements");
    header_.elements.push_back(std::move(element));
    return {};
  }

  Status property() {
    if (header_.elements.empty()) return text_.failure("a property belongs to no element");
    PlyProperty property;
    std::string_view word = text_.word();
    property.list = word == "list";
    if (property.list) {
      const auto count_type = to_type(text_.word());
      if (!count_type || is_float(*count_type))
        return text_.failure("a list's count is of no whole-number type");
      property.count_type = *count_type;
      word = text_.word();
    }
    const auto type = to_type(word);
    if (!type) return text_.failure("a property is of the type " + quoted(word));
    property.type = *type;
    property.name = std::string(text_.word());
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    if (property.name.empty()) return text_.failure("a property has no name");
    if (properties.size() == kMostProperties) return text_.failure("an element has too many properties");
    properties.push_back(std::move(property));
    return {};
  }

  std::string_view bytes_;
  TextCursor text_;
  PlyHeader header_;
  bool seen_format_ = false;
};

}  // namespace

std::size_t PlyElement::least_bytes(bool text) const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += text ? 2 : byte_size(p.list ? p.count_type : p.type);
  return bytes;
}

Result<PlyHeader> read_ply_header(std::string_view bytes) {
  return HeaderReader(bytes).run();
}

}  // namespace dupin::mesh_files
