#include "dps_file.h"

#include <bit>
#include <cstdio>
#include <cstring>

#include "crc32c.h"
#include "dp_codec.h"

namespace dupin {
namespace {

constexpr char kMagic[] = "DUPINDPS", kChunkTag[] = "CHNK", kEndTag[] = "END.";
constexpr std::size_t kHeaderBytes = 36, kChunkHeadBytes = 20 + 10 * 8, kTrailerBytes = 20;
constexpr std::uint16_t kVersion = 1;
/// Points a written chunk has at most: the smaller a chunk's box, the finer its positions.
constexpr std::size_t kChunkPoints = 16384;
/// How far a raw record's directions may be from unit length and from each other's normal planes.
constexpr double kFrameError = 1e-3;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

template <class T>
void put(std::vector<std::uint8_t>& bytes, T value) {
  static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");
  const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), p, p + sizeof value);
}
template <class T>
T get(const std::uint8_t*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}
void put_tag(std::vector<std::uint8_t>& bytes, const char* tag) {
  bytes.insert(bytes.end(), tag, tag + std::strlen(tag));
}
void put_crc(std::vector<std::uint8_t>& bytes, std::size_t from = 0) {
  put(bytes, crc32c(bytes.data() + from, bytes.size() - from));
}

void put_raw(const DifferentialPoint& p, const Vec3& origin, const DpsColors& colors, bool sizes,
             std::vector<std::uint8_t>& bytes) {
  bytes.insert(bytes.end(), colors.diffuse.begin(), colors.diffuse.end());
  bytes.insert(bytes.end(), colors.specular.begin(), colors.specular.end());
  for (const Vec3& v : {p.position - origin, p.u, p.v, p.n()})
    for (int k = 0; k < 3; ++k) put(bytes, static_cast<float>(v[k]));
  put(bytes, static_cast<float>(p.lambda_u));
  put(bytes, static_cast<float>(p.lambda_v));
  if (!sizes) return;
  // 0, 0: from ε and δ.
  put(bytes, p.own_size ? static_cast<float>(p.half_u) : 0.0F);
  put(bytes, p.own_size ? static_cast<float>(p.half_v) : 0.0F);
}

Vec3 get_vector(const std::uint8_t*& at) {
  const float x = get<float>(at), y = get<float>(at), z = get<float>(at);
  return {x, y, z};
}

bool get_raw(const std::uint8_t*& at, const PackedRange& range, const DpsHeader& header, bool sizes,
             DifferentialPoint& p) {
  at += 6;
  p.position = range.box.lo + get_vector(at);
  const Vec3 u = get_vector(at), v = get_vector(at), n = get_vector(at);
  p.lambda_u = get<float>(at);
  p.lambda_v = get<float>(at);
  const auto is_unit = [](const Vec3& d) { return std::abs(dot(d, d) - 1) < kFrameError; };
  if (!is_unit(u) || !is_unit(v) || !(distance(cross(u, v), n) < kFrameError)) return false;
  p.u = normalized(u);
  p.v = cross(normalized(n - p.u * dot(n, p.u)), p.u);
  set_extents(p, header.epsilon, header.delta);
  if (!sizes) return true;
  const float half_u = get<float>(at), half_v = get<float>(at);
  p.own_size = half_u != 0 || half_v != 0;
  if (p.own_size) p.half_u = half_u, p.half_v = half_v;
  return true;
}

bool is_valid(const DifferentialPoint& p) {
  return is_finite(p.position) && std::isfinite(p.lambda_u) &&
         std::abs(p.lambda_v) <= std::abs(p.lambda_u) * (1 + 1e-6) && p.half_u > 0 && p.half_v > 0 &&
         std::isfinite(p.half_u) && std::isfinite(p.half_v);
}

bool is_valid(const PackedRange& r, bool sizes) {
  if (!is_finite(r.box.lo) || !is_finite(r.box.hi) || r.box.empty()) return false;
  const auto ordered = [](double least, double most) {
    return least > 0 && most >= least && std::isfinite(most);
  };
  const bool flat = r.least_curvature == 0 && r.most_curvature == 0,
             none = r.least_size == 0 && r.most_size == 0;
  return (flat || ordered(r.least_curvature, r.most_curvature)) &&
         (sizes ? ordered(r.least_size, r.most_size) : none);
}

}  // namespace

class DpsWriter::Impl {
 public:
  DpsHeader header;
  File file;
  std::uint64_t bytes = 0, points = 0;
  std::uint32_t chunks = 0, chunk_crcs = 0;

  Status write(const std::vector<std::uint8_t>& content) {
    if (std::fwrite(content.data(), 1, content.size(), file.get()) != content.size())
      return {StatusCode::cannot_write, "the disk does not take more"};
    bytes += content.size();
    return {};
  }

  Status write_header() {
    std::vector<std::uint8_t> head;
    put_tag(head, kMagic);
    put(head, kVersion);
    put(head, static_cast<std::uint8_t>(header.encoding));
    put(head, std::uint8_t{0});
    put(head, std::uint32_t{0});
    put(head, header.epsilon);
    put(head, header.delta);
    put_crc(head);
    return write(head);
  }

  Status write_chunk(const DpsColors& colors, std::span<const DifferentialPoint> part) {
    bool sizes = false;
    for (const DifferentialPoint& p : part) sizes |= p.own_size;
    const PackedRange range = packed_range(part.data(), part.size(), sizes);
    std::vector<std::uint8_t> chunk, records;
    for (const DifferentialPoint& p : part) {
      if (header.encoding == DpsEncoding::packed) pack(p, range, records);
      if (header.encoding == DpsEncoding::raw) put_raw(p, range.box.lo, colors, sizes, records);
    }
    put_tag(chunk, kChunkTag);
    put(chunk, static_cast<std::uint32_t>(part.size()));
    put(chunk, static_cast<std::uint32_t>(records.size()));
    chunk.insert(chunk.end(), colors.diffuse.begin(), colors.diffuse.end());
    chunk.insert(chunk.end(), colors.specular.begin(), colors.specular.end());
    put(chunk, static_cast<std::uint8_t>(sizes));
    put(chunk, std::uint8_t{0});
    for (const Vec3& corner : {range.box.lo, range.box.hi})
      for (int k = 0; k < 3; ++k) put(chunk, corner[k]);
    for (const double v : {range.least_curvature, range.most_curvature, range.least_size, range.most_size})
      put(chunk, v);
    chunk.insert(chunk.end(), records.begin(), records.end());
    put_crc(chunk);
    chunk_crcs = crc32c(chunk.data() + chunk.size() - 4, 4, chunk_crcs);
    ++chunks;
    points += part.size();
    return write(chunk);
  }

  Status write_trailer() {
    std::vector<std::uint8_t> end;
    put_tag(end, kEndTag);
    put(end, chunks);
    put(end, points);
    put(end, crc32c(end.data(), end.size(), chunk_crcs));
    return write(end);
  }
};

DpsWriter::DpsWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DpsWriter::DpsWriter(DpsWriter&&) noexcept = default;
DpsWriter& DpsWriter::operator=(DpsWriter&&) noexcept = default;
DpsWriter::~DpsWriter() = default;
std::uint64_t DpsWriter::bytes() const {
  return impl_->bytes;
}

Result<DpsWriter> DpsWriter::create(const std::string& path, const DpsHeader& header) {
  auto impl = std::make_unique<Impl>();
  impl->header = header;
  impl->file.reset(std::fopen(path.c_str(), "wb"));
  if (!impl->file) return {StatusCode::cannot_write, path + ": cannot write"};
  const Status status = impl->write_header();
  if (!status.ok()) return status;
  return DpsWriter(std::move(impl));
}

Status DpsWriter::add(const DpsColors& colors, std::span<const DifferentialPoint> points) {
  for (std::size_t i = 0; i < points.size(); i += kChunkPoints) {
    const Status status =
        impl_->write_chunk(colors, points.subspan(i, std::min(kChunkPoints, points.size() - i)));
    if (!status.ok()) return status;
  }
  return {};
}

Status DpsWriter::finish() {
  const Status status = impl_->write_trailer();
  if (!status.ok()) return status;
  if (std::fclose(impl_->file.release()) != 0)
    return {StatusCode::cannot_write, "the disk does not take more"};
  return {};
}

class DpsReader::Impl {
 public:
  std::string path;
  DpsHeader header;
  File file;
  std::vector<std::uint8_t> buffer;
  std::uint64_t points = 0;
  std::uint32_t chunks = 0, chunk_crcs = 0;
  bool at_end = false;

  Status bad(const std::string& why) const { return {StatusCode::unreadable, path + ": " + why}; }

  /// Appends to the buffer what the file has, at most so many bytes, and says whether it had them all.
  bool read(std::size_t bytes) {
    const std::size_t before = buffer.size();
    buffer.resize(before + bytes);
    const std::size_t got = std::fread(buffer.data() + before, 1, bytes, file.get());
    buffer.resize(before + got);
    return got == bytes;
  }
  bool crc_matches(std::uint32_t start = 0) const {
    const std::uint8_t* at = buffer.data() + buffer.size() - 4;
    return crc32c(buffer.data(), buffer.size() - 4, start) == get<std::uint32_t>(at);
  }

  Status read_header() {
    if (!read(kHeaderBytes) || std::memcmp(buffer.data(), kMagic, 8) != 0)
      return bad("not a file of differential points");
    const std::uint8_t* at = buffer.data() + 8;
    const auto version = get<std::uint16_t>(at);
    const auto encoding = get<std::uint8_t>(at);
    at += 5;
    header.epsilon = get<double>(at);
    header.delta = get<double>(at);
    if (!crc_matches()) return bad("its header is damaged");
    if (version != kVersion) return bad("its version " + std::to_string(version) + " is not known");
    const bool sized = header.epsilon == 0 && header.delta == 0;
    const bool by_limits =
        header.epsilon > 0 && header.epsilon <= 1 && header.delta > 0 && std::isfinite(header.delta);
    if (encoding > 1 || !(sized || by_limits)) return bad("its header is not valid");
    header.encoding = static_cast<DpsEncoding>(encoding);
    return {};
  }

  Status read_chunk(DpsChunk& chunk) {
    if (!read(kChunkHeadBytes - 4)) return bad("it ends within a chunk");
    const std::uint8_t* at = buffer.data() + 4;
    const auto count = get<std::uint32_t>(at);
    const auto bytes = get<std::uint32_t>(at);
    const std::size_t largest = count * (kRawBytes + kRawSizeBytes);
    if (count == 0 || count > kMostChunkPoints || bytes > largest) return bad("a chunk's size is not valid");
    if (!read(bytes + 4)) return bad("it ends within a chunk");
    if (!crc_matches()) return bad("a chunk is damaged");
    chunk_crcs = crc32c(buffer.data() + buffer.size() - 4, 4, chunk_crcs);
    ++chunks;
    points += count;
    return decode(count, buffer.data() + 12, chunk);
  }

  Status decode(std::uint32_t count, const std::uint8_t* at, DpsChunk& chunk) const {
    for (auto* color : {&chunk.colors.diffuse, &chunk.colors.specular})
      for (std::uint8_t& value : *color) value = get<std::uint8_t>(at);
    const auto sizes = get<std::uint8_t>(at);
    ++at;
    PackedRange range;
    for (Vec3* corner : {&range.box.lo, &range.box.hi})
      for (int k = 0; k < 3; ++k) (*corner)[k] = get<double>(at);
    for (double* v : {&range.least_curvature, &range.most_curvature, &range.least_size, &range.most_size})
      *v = get<double>(at);
    if (sizes > 1 || !is_valid(range, sizes)) return bad("a chunk's ranges are not valid");
    const std::uint8_t* end = buffer.data() + buffer.size() - 4;
    const bool raw = header.encoding == DpsEncoding::raw;
    if (raw && static_cast<std::size_t>(end - at) != count * (kRawBytes + sizes * kRawSizeBytes))
      return bad("a chunk's records do not fill it");
    chunk.points.assign(count, {});
    for (DifferentialPoint& p : chunk.points) {
      const bool read = raw ? get_raw(at, range, header, sizes, p)
                            : unpack(at, end, range, header.epsilon, header.delta, p);
      if (!read || !is_valid(p)) return bad("a record is not valid");
    }
    return at == end ? Status{} : bad("a chunk's records do not fill it");
  }

  Status read_trailer() {
    if (!read(kTrailerBytes - 4)) return bad("it ends within its trailer");
    const std::uint8_t* at = buffer.data() + 4;
    const auto all_chunks = get<std::uint32_t>(at);
    const auto all_points = get<std::uint64_t>(at);
    if (!crc_matches(chunk_crcs) || all_chunks != chunks || all_points != points)
      return bad("its chunks are not all there");
    if (std::fgetc(file.get()) != EOF) return bad("something follows its trailer");
    at_end = true;
    return {};
  }
};

DpsReader::DpsReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DpsReader::DpsReader(DpsReader&&) noexcept = default;
DpsReader& DpsReader::operator=(DpsReader&&) noexcept = default;
DpsReader::~DpsReader() = default;
const DpsHeader& DpsReader::header() const {
  return impl_->header;
}

Result<DpsReader> DpsReader::open(const std::string& path) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->file.reset(std::fopen(path.c_str(), "rb"));
  if (!impl->file) return {StatusCode::unreadable, path + ": cannot be opened"};
  const Status status = impl->read_header();
  if (!status.ok()) return status;
  return DpsReader(std::move(impl));
}

Result<bool> DpsReader::next(DpsChunk& chunk) {
  if (impl_->at_end) return false;
  impl_->buffer.clear();
  if (!impl_->read(4)) return impl_->bad("it has no trailer");
  const bool end = std::memcmp(impl_->buffer.data(), kEndTag, 4) == 0;
  if (!end && std::memcmp(impl_->buffer.data(), kChunkTag, 4) != 0)
    return impl_->bad("neither a chunk nor the trailer follows");
  const Status status = end ? impl_->read_trailer() : impl_->read_chunk(chunk);
  if (!status.ok()) return status;
  return !end;
}

Result<DpsContent> read_dps(const std::string& path) {
  auto reader = DpsReader::open(path);
  if (!reader) return reader.status();
  DpsContent content;
  content.header = reader->header();
  DpsChunk chunk;
  while (true) {
    const Result<bool> more = reader->next(chunk);
    if (!more) return more.status();
    if (!*more) return content;
    if (content.groups.empty() || !(content.groups.back().colors == chunk.colors)) {
      content.groups.push_back(std::move(chunk));
      chunk = {};
    } else {
      auto& points = content.groups.back().points;
      points.insert(points.end(), chunk.points.begin(), chunk.points.end());
    }
  }
}

}  // namespace dupin
