// `.dps` files of differential points, written and read piece by piece.
//
// Everything is little-endian. A file is a header, chunks, and a trailer; no byte is outside of a checksum.
//
//   header    8 "DUPINDPS" | u16 version, 1 | u8 encoding: 0 raw, 1 packed | u8 0 | u32 0 | f64 ε | f64 δ |
//             u32 CRC-32C of what stands before it                                                       = 36
//             bytes
//   chunk     4 "CHNK" | u32 points, 1 … 65536 | u32 bytes of records | u8 × 3 diffuse colour | u8 × 3
//   specular
//             colour (sRGB) | u8 sizes: 1 stored, 0 not | u8 0 |
//             f64 × 3 box lo | f64 × 3 box hi | f64 least, f64 most |λu| | f64 least, f64 most half-extent |
//             the records (dp_codec.h) | u32 CRC-32C of the chunk before it
//   trailer   4 "END." | u32 chunks | u64 points | u32 CRC-32C of the chunks' checksums and of the trailer
//   before it
//
// Raw positions are floats relative to box lo. Points of one colour stand together: their colour is the
// chunk's, as the paper groups them, also in raw records, which repeat it.
#ifndef DUPIN_SIMPLIFY_DPS_FILE_H
#define DUPIN_SIMPLIFY_DPS_FILE_H

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "../core/status.h"
#include "../sampling/differential_point.h"

namespace dupin {

enum class DpsEncoding : std::uint8_t { raw, packed };
inline constexpr std::size_t kMostChunkPoints = 65536;

struct DpsHeader {
  DpsEncoding encoding = DpsEncoding::packed;
  double epsilon = 0, delta = 0;  ///< 0 if every rectangle has a size of its own
};
/// sRGB; the diffuse one unless said otherwise is what scenes give faces without a colour.
struct DpsColors {
  std::array<std::uint8_t, 3> diffuse{196, 199, 203}, specular{89, 89, 89};
  friend bool operator==(const DpsColors&, const DpsColors&) = default;
};

/// Writes as points come; memory for one chunk. `cannot_write` with the reason where the disk fails.
class DpsWriter {
 public:
  static Result<DpsWriter> create(const std::string& path, const DpsHeader& header);
  DpsWriter(DpsWriter&&) noexcept;
  DpsWriter& operator=(DpsWriter&&) noexcept;
  ~DpsWriter();
  /// Points of a colour; sizes are stored where any point of a chunk has one of its own.
  Status add(const DpsColors& colors, std::span<const DifferentialPoint> points);
  /// Writes the trailer and closes the file; without it the file is not valid.
  Status finish();
  std::uint64_t bytes() const;

 private:
  class Impl;
  explicit DpsWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct DpsChunk {
  DpsColors colors;
  std::vector<DifferentialPoint> points;  ///< face 0, uv 0; bound as for points of ε and δ
};

/// Reads chunk after chunk; memory for one. Every index, size and number is checked: a damaged file is
/// `unreadable`, with what is wrong, at the latest where its last chunk has been read.
class DpsReader {
 public:
  static Result<DpsReader> open(const std::string& path);
  DpsReader(DpsReader&&) noexcept;
  DpsReader& operator=(DpsReader&&) noexcept;
  ~DpsReader();
  const DpsHeader& header() const;
  /// False at the end, after which the whole file has been verified.
  Result<bool> next(DpsChunk& chunk);

 private:
  class Impl;
  explicit DpsReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A whole file: points by colour, neighbouring chunks of one colour as one.
struct DpsContent {
  DpsHeader header;
  std::vector<DpsChunk> groups;
};
Result<DpsContent> read_dps(const std::string& path);

}  // namespace dupin

#endif
