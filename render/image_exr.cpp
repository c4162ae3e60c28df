// OpenEXR, whose errors are exceptions: none leaves this file.
#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <cstring>
#include <exception>
#include <map>

#include "atomic_file.h"
#include "image.h"

namespace dupin {
namespace {

constexpr const char *kPixelConstant = "dupin.pixelConstant", *kPixelPerDepth = "dupin.pixelPerDepth";

class MemoryStream final : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char* data, int size) override {
    const std::size_t end = position_ + static_cast<std::size_t>(size);
    if (bytes.size() < end) bytes.resize(end);
    std::memcpy(bytes.data() + position_, data, static_cast<std::size_t>(size));
    position_ = end;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  std::vector<char> bytes;

 private:
  std::size_t position_ = 0;
};

bool is_number(const std::string& channel) {
  return channel == "id" || channel == "prim";
}

/// The file's bytes; the format stores channels by name, so their order here does not matter.
std::vector<char> encode(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  if (image.pixel_constant > 0) header.insert(kPixelConstant, Imf::DoubleAttribute(image.pixel_constant));
  if (image.pixel_per_depth > 0) header.insert(kPixelPerDepth, Imf::DoubleAttribute(image.pixel_per_depth));
  Imf::FrameBuffer pixels;
  std::map<std::string, std::vector<unsigned>> numbers;
  const std::size_t row = sizeof(float) * static_cast<std::size_t>(image.width);
  for (const Image::Channel& channel : image.channels) {
    const Imf::PixelType type = is_number(channel.name) ? Imf::UINT : Imf::FLOAT;
    header.channels().insert(channel.name, Imf::Channel(type));
    const char* base = reinterpret_cast<const char*>(channel.values.data());
    if (type == Imf::UINT) {
      std::vector<unsigned>& values = numbers[channel.name];
      for (const float value : channel.values) values.push_back(static_cast<unsigned>(value));
      base = reinterpret_cast<const char*>(values.data());
    }
    pixels.insert(channel.name, Imf::Slice(type, const_cast<char*>(base), sizeof(float), row));
  }
  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(pixels);
    file.writePixels(image.height);
  }
  return std::move(stream.bytes);
}

Image decode(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  Image image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  if (const auto* a = file.header().findTypedAttribute<Imf::DoubleAttribute>(kPixelConstant))
    image.pixel_constant = a->value();
  if (const auto* a = file.header().findTypedAttribute<Imf::DoubleAttribute>(kPixelPerDepth))
    image.pixel_per_depth = a->value();
  Imf::FrameBuffer pixels;
  const auto& channels = file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) image.channels.push_back({c.name(), {}});
  for (Image::Channel& channel : image.channels) {
    channel.values.resize(image.pixels());
    pixels.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
  }
  file.setFrameBuffer(pixels);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

}  // namespace

Status write_exr(const std::string& path, const Image& image) {
  for (const Image::Channel& channel : image.channels)
    if (image.pixels() == 0 || channel.values.size() != image.pixels())
      return {StatusCode::invalid_argument, "the picture to write has no proper size"};
  try {
    return write_file(path, encode(image));
  } catch (const std::exception& problem) {
    return {StatusCode::cannot_write, path + ": " + problem.what()};
  }
}

Result<Image> read_exr(const std::string& path) {
  try {
    return decode(path);
  } catch (const std::exception& problem) {
    return {StatusCode::unreadable, path + ": not a readable EXR file (" + problem.what() + ")"};
  }
}

}  // namespace dupin
