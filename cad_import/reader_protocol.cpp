#include "reader_protocol.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace dupin {
namespace {

bool send(int fd, FrameKind kind, std::span<const char> payload) {
  const FrameHeader header{kFrameMagic, kind, payload.size()};
  return write_all(fd, {reinterpret_cast<const char*>(&header), sizeof header}) && write_all(fd, payload);
}

template <class T>
std::string number_and_text(T number, std::string_view text) {
  std::string payload(reinterpret_cast<const char*>(&number), sizeof number);
  payload.append(text.substr(0, kMaxTextFrameBytes - sizeof number));
  return payload;
}

}  // namespace

bool write_all(int fd, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

bool send_stage(int fd, std::string_view stage, double fraction) {
  return send(fd, FrameKind::stage, number_and_text(fraction, stage));
}

bool send_failure(int fd, const Status& status) {
  return send(fd, FrameKind::failure,
              number_and_text(static_cast<std::uint32_t>(status.code), status.message));
}

bool send_model(int fd, std::span<const char> stream) {
  return send(fd, FrameKind::model, stream);
}

}  // namespace dupin
