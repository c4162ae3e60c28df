// Pictures in memory and in files: PNG for looking at, OpenEXR for numbers.
#ifndef DUPIN_RENDER_IMAGE_H
#define DUPIN_RENDER_IMAGE_H

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "../core/status.h"
#include "renderer.h"

namespace dupin {

/// Named channels of one size, a float a pixel; row 0 is the top. Colors ("R", "G", "B", "A") are linear
/// light, premultiplied by A.
struct Image {
  struct Channel {
    std::string name;
    std::vector<float> values;
  };
  int width = 0, height = 0;
  std::vector<Channel> channels;
  /// The edge of a pixel in model units at depth Z is pixel_constant + pixel_per_depth · Z; both 0 where that
  /// is not known.
  double pixel_constant = 0, pixel_per_depth = 0;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  const Channel* find(std::string_view name) const;
  /// The channel of that name, added (all 0) if there is none.
  Channel& channel(std::string_view name);
};

/// What a frame holds, as the channels of an EXR: R G B A; N.X N.Y N.Z; Z; P.X P.Y P.Z; k1 k2; d1.X d1.Y
/// d1.Z; id; prim; u v.
Image to_image(const Frame& frame);

/// 8 bits a channel, as PNG has them: sRGB, straight alpha. 3 or 4 channels, or 1 (gray).
struct Image8 {
  int width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> values;
};
/// What Output::kScreen asked for; without alpha where every pixel is opaque.
Image8 screen_image(const Frame& frame);
/// R, G, B and A encoded for a screen; without alpha where every pixel is opaque. Missing color channels are
/// 0, a missing A is 1.
Image8 to_image8(const Image& image);
/// Linear and premultiplied; a gray picture becomes R = G = B.
Image to_image(const Image8& image);

// Writing goes to a temporary file beside the target, which then takes its name: a failure leaves nothing
// behind. Targets that are no regular files (/dev/null, a pipe) are written directly. cannot_write where it
// fails; unreadable where a file is no such picture. The same picture gives the same bytes.
Status write_png(const std::string& path, const Image8& image);
Result<Image8> read_png(const std::string& path);
/// 32-bit floats; channels named "id" or "prim" as 32-bit unsigned integers.
Status write_exr(const std::string& path, const Image& image);
/// All channels, whatever their type, as floats.
Result<Image> read_exr(const std::string& path);
/// PNG or EXR, by the file's first bytes.
Result<Image> read_image(const std::string& path);

}  // namespace dupin

#endif
