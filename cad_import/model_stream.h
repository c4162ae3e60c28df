// A Model as bytes, for the hand-over between the reading process and its caller.
//
// The bytes come from a process that may have been corrupted by a damaged file, so nothing in them is
// believed: a header carries version, length and checksum; every count is compared with the bytes that are
// left before anything is allocated; nesting is bounded; what was read must pass `check(model)`. The layout
// is private to one version of the library on one machine: it is no file format.
#ifndef DUPIN_CAD_IMPORT_MODEL_STREAM_H
#define DUPIN_CAD_IMPORT_MODEL_STREAM_H

#include <cstdint>
#include <span>
#include <string>

#include "../core/status.h"
#include "../nurbs/model.h"

namespace dupin {

inline constexpr std::uint32_t kModelStreamVersion = 2;
/// Magic, version, length of the payload, checksum of the payload.
inline constexpr std::size_t kModelStreamHeaderBytes = 32;
/// Offsets of offsets of … that are still read.
inline constexpr int kModelStreamMaxNesting = 8;

std::string write_model(const Model& model);

/// The model, or `unreadable` with the first thing that is wrong. Never allocates more than a small multiple
/// of bytes.size().
Result<Model> read_model(std::span<const char> bytes);

/// The header's checksum of a payload; not cryptographic.
std::uint64_t stream_checksum(std::span<const char> payload);

}  // namespace dupin

#endif
