// PNG through libpng, whose errors jump: every function that libpng may jump out of keeps to plain data.
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <memory>

#include "atomic_file.h"
#include "image.h"

namespace dupin {
namespace {

constexpr int kLargestSide = 1 << 20;

void append(png_structp png, png_bytep data, png_size_t size) {
  auto* bytes = static_cast<std::vector<char>*>(png_get_io_ptr(png));
  bytes->insert(bytes->end(), data, data + size);
}
void ignore(png_structp) {}
void quiet(png_structp, png_const_charp) {}
[[noreturn]] void leave(png_structp png, png_const_charp) {
  png_longjmp(png, 1);
}

bool encode(const Image8& image, std::vector<char>& bytes) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, quiet);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &bytes, append, ignore);
  const int kind = image.channels == 4   ? PNG_COLOR_TYPE_RGB_ALPHA
                   : image.channels == 3 ? PNG_COLOR_TYPE_RGB
                                         : PNG_COLOR_TYPE_GRAY;
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               kind, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, 4);
  png_write_info(png, info);
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  for (int y = 0; y < image.height; ++y)
    png_write_row(png, image.values.data() + row * static_cast<std::size_t>(y));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

/// The picture's size, so that its memory can be made before the next function, out of which libpng may jump
/// again.
bool read_header(png_structp png, png_infop info, std::FILE* file, Image8& image) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_init_io(png, file);
  png_set_user_limits(png, kLargestSide, kLargestSide);
  png_read_info(png, info);
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  image.width = static_cast<int>(png_get_image_width(png, info));
  image.height = static_cast<int>(png_get_image_height(png, info));
  image.channels = png_get_channels(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

/// Gray with alpha, which nothing else here has, as R = G = B.
void widen_gray_alpha(Image8& image) {
  std::vector<std::uint8_t> wide(image.values.size() * 2);
  for (std::size_t i = 0; i < image.values.size() / 2; ++i) {
    wide[4 * i] = wide[4 * i + 1] = wide[4 * i + 2] = image.values[2 * i];
    wide[4 * i + 3] = image.values[2 * i + 1];
  }
  image.values = std::move(wide);
  image.channels = 4;
}

}  // namespace

Status write_png(const std::string& path, const Image8& image) {
  const std::size_t expected = static_cast<std::size_t>(image.width) *
                               static_cast<std::size_t>(image.height) *
                               static_cast<std::size_t>(image.channels);
  if (image.width < 1 || image.height < 1 || image.values.size() != expected || image.channels == 2 ||
      image.channels > 4)
    return {StatusCode::invalid_argument, "the picture to write has no proper size"};
  std::vector<char> bytes;
  if (!encode(image, bytes))
    return {StatusCode::cannot_write, path + ": the picture cannot be encoded as PNG"};
  return write_file(path, bytes);
}

Result<Image8> read_png(const std::string& path) {
  const auto close = [](std::FILE* f) { std::fclose(f); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (!file) return {StatusCode::unreadable, path + ": cannot be read"};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, quiet);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Image8 image;
  bool ok = info && read_header(png, info, file.get(), image);
  if (ok) {
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    image.values.resize(row * static_cast<std::size_t>(image.height));
    std::vector<png_bytep> rows;
    for (int y = 0; y < image.height; ++y)
      rows.push_back(image.values.data() + row * static_cast<std::size_t>(y));
    ok = read_rows(png, rows.data());
  }
  png_destroy_read_struct(&png, &info, nullptr);
  if (!ok) return {StatusCode::unreadable, path + ": not a readable PNG file"};
  if (image.channels == 2) widen_gray_alpha(image);
  return image;
}

}  // namespace dupin
