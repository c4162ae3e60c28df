// What the reading process says to its caller: a sequence of frames through a pipe.
//
// A frame is a header and a payload. Stages and failures are small; the model's payload is a model stream
// (model_stream.h). The last frame is the model or the failure.
#ifndef DUPIN_CAD_IMPORT_READER_PROTOCOL_H
#define DUPIN_CAD_IMPORT_READER_PROTOCOL_H

#include <cstdint>
#include <span>
#include <string_view>

#include "../core/status.h"

namespace dupin {

inline constexpr std::uint32_t kFrameMagic = 0x31525044;  // "DPR1"
inline constexpr int kReaderPipe = 3;  ///< the reading process finds the pipe's end under this number
inline constexpr std::size_t kMaxTextFrameBytes = 65536;

enum class FrameKind : std::uint32_t {
  stage = 1,    ///< double fraction, then the stage's name
  failure = 2,  ///< uint32 StatusCode, then the message
  model = 3,    ///< a model stream
};

struct FrameHeader {
  std::uint32_t magic = kFrameMagic;
  FrameKind kind{};
  std::uint64_t length = 0;
};

/// Writes all of it, or says that the other end is gone.
bool write_all(int fd, std::span<const char> bytes);
bool send_stage(int fd, std::string_view stage, double fraction);
bool send_failure(int fd, const Status& status);
bool send_model(int fd, std::span<const char> stream);

}  // namespace dupin

#endif
