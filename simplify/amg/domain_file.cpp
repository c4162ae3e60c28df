#include "../domain_file.h"

#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "../crc32c.h"

namespace dupin {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");
constexpr std::string_view kMagic = "DUPINDOM";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kPrimitiveBytes = 3 * 8 + 6 * 4 + 4 * 8 + 7 * 4;

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Channel by channel, so that what is alike stands together.
template <class T>
void put_texture(std::string& bytes, const std::vector<T>& texels, std::uint32_t width) {
  if (texels.empty()) return put(bytes, std::uint32_t{0});
  const auto* from = reinterpret_cast<const std::uint8_t*>(texels.data());
  std::vector<std::uint8_t> plain;
  for (std::size_t c = 0; c < sizeof(T); ++c)
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const std::uint8_t before = i % width == 0 ? 0 : from[(i - 1) * sizeof(T) + c];
      plain.push_back(static_cast<std::uint8_t>(from[i * sizeof(T) + c] - before));
    }
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, plain.data(), static_cast<uLong>(plain.size()),
            9);
  put(bytes, static_cast<std::uint32_t>(size));
  bytes.append(packed, 0, size);
}

void put_vector(std::string& bytes, const Vec3& v, bool as_float) {
  for (int k = 0; k < 3; ++k) as_float ? put(bytes, static_cast<float>(v[k])) : put(bytes, v[k]);
}

void put_primitive(std::string& bytes, const DomainPrimitive& p) {
  put_vector(bytes, p.center, false);
  put_vector(bytes, p.u, true);
  put_vector(bytes, p.v, true);
  for (const double x : {p.half_u, p.half_v, p.lo, p.hi}) put(bytes, x);
  for (const std::uint32_t x : {p.face, p.first_neighbor, p.neighbors, p.x, p.y, p.width, p.height})
    put(bytes, x);
}

void put_set(std::string& bytes, const DomainSet& set) {
  for (const double x : {set.texel, set.deviation_rms, set.deviation_99}) put(bytes, x);
  put(bytes, static_cast<std::uint64_t>(set.points));
  put(bytes, static_cast<std::uint8_t>(set.oriented));
  for (const std::size_t x : {std::size_t(set.atlas.width), std::size_t(set.atlas.height),
                              set.primitives.size(), set.neighbors.size(), set.faces.size()})
    put(bytes, static_cast<std::uint32_t>(x));
  for (const DomainPrimitive& p : set.primitives) put_primitive(bytes, p);
  for (const std::uint32_t n : set.neighbors) put(bytes, n);
  for (const std::uint32_t f : set.faces) put(bytes, f);
  put_texture(bytes, set.atlas.psi, set.atlas.width);
  put_texture(bytes, set.atlas.normal_height, set.atlas.width);
  put_texture(bytes, set.atlas.color, set.atlas.width);
  put_texture(bytes, set.atlas.face, set.atlas.width);
}

/// Reads, and remembers whether there was too little.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && bytes_.empty(); }
  void fail() { ok_ = false; }

  template <class T>
  T get() {
    T value{};
    const std::string_view from = take(sizeof value);
    if (ok_) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) ok_ = false;
    if (!ok_) return {};
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  /// How many things of a size, no more than there are bytes for.
  std::size_t count(std::size_t each) {
    const auto n = get<std::uint32_t>();
    if (n > bytes_.size() / each) ok_ = false;
    return ok_ ? n : 0;
  }
  Vec3 vector(bool as_float) {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = as_float ? static_cast<double>(get<float>()) : get<double>();
    return v;
  }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

template <class T>
void get_texture(Reader& in, std::uint32_t width, std::uint32_t height, std::vector<T>& texels) {
  const std::string_view packed = in.take(in.get<std::uint32_t>());
  if (!in.ok() || packed.empty()) return;
  const std::size_t count = std::size_t(width) * height;
  // zlib cannot pack a thousand bytes into less than one.
  if (count * sizeof(T) / 1100 > packed.size()) return in.fail();
  std::vector<std::uint8_t> plain(count * sizeof(T));
  uLongf size = static_cast<uLongf>(plain.size());
  if (uncompress(plain.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                 static_cast<uLong>(packed.size())) != Z_OK ||
      size != plain.size())
    return in.fail();
  texels.resize(count);
  auto* to = reinterpret_cast<std::uint8_t*>(texels.data());
  for (std::size_t c = 0; c < sizeof(T); ++c)
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t before = i % width == 0 ? 0 : to[(i - 1) * sizeof(T) + c];
      to[i * sizeof(T) + c] = static_cast<std::uint8_t>(plain[c * count + i] + before);
    }
}

DomainPrimitive get_primitive(Reader& in) {
  DomainPrimitive p;
  p.center = in.vector(false);
  p.u = in.vector(true);
  p.v = in.vector(true);
  for (double* x : {&p.half_u, &p.half_v, &p.lo, &p.hi}) *x = in.get<double>();
  for (std::uint32_t* x : {&p.face, &p.first_neighbor, &p.neighbors, &p.x, &p.y, &p.width, &p.height})
    *x = in.get<std::uint32_t>();
  return p;
}

Status get_set(Reader& in, DomainSet& set) {
  for (double* x : {&set.texel, &set.deviation_rms, &set.deviation_99}) *x = in.get<double>();
  set.points = in.get<std::uint64_t>();
  set.oriented = in.get<std::uint8_t>() != 0;
  set.atlas.width = in.get<std::uint32_t>();
  set.atlas.height = in.get<std::uint32_t>();
  if (std::uint64_t(set.atlas.width) * set.atlas.height > kMostAtlas)
    return {StatusCode::limit, "textures of domains that are larger than any drawn"};
  const std::size_t primitives = in.count(kPrimitiveBytes), neighbors = in.count(4), faces = in.count(4);
  for (std::size_t i = 0; i < primitives && in.ok(); ++i) set.primitives.push_back(get_primitive(in));
  for (std::size_t i = 0; i < neighbors && in.ok(); ++i) set.neighbors.push_back(in.get<std::uint32_t>());
  for (std::size_t i = 0; i < faces && in.ok(); ++i) set.faces.push_back(in.get<std::uint32_t>());
  get_texture(in, set.atlas.width, set.atlas.height, set.atlas.psi);
  get_texture(in, set.atlas.width, set.atlas.height, set.atlas.normal_height);
  get_texture(in, set.atlas.width, set.atlas.height, set.atlas.color);
  get_texture(in, set.atlas.width, set.atlas.height, set.atlas.face);
  if (!in.ok() || !(set.texel >= 0) || !(set.deviation_rms >= 0) || !(set.deviation_99 >= 0))
    return {StatusCode::unreadable, "the file of domains is damaged"};
  if (Status good = check(set); !good.ok())
    return {StatusCode::unreadable, "the file of domains has " + good.message};
  return {};
}

}  // namespace

std::string write_domains(const DomainScene& scene, std::uint64_t key) {
  std::string bytes(kMagic);
  put(bytes, kVersion);
  put(bytes, key);
  put(bytes, static_cast<std::uint32_t>(scene.parts.size()));
  for (const auto& levels : scene.parts) {
    put(bytes, static_cast<std::uint32_t>(levels.size()));
    for (const DomainSet& set : levels) put_set(bytes, set);
  }
  put(bytes, crc32c(bytes.data(), bytes.size()));
  return bytes;
}

Result<DomainFile> read_domains(std::string_view bytes) {
  const Status damaged{StatusCode::unreadable, "the file of domains is damaged"};
  if (bytes.substr(0, kMagic.size()) != kMagic) return {StatusCode::unreadable, "this is no file of domains"};
  if (bytes.size() < kMagic.size() + 20) return damaged;
  Reader crc(bytes.substr(bytes.size() - 4));
  bytes.remove_suffix(4);
  if (crc.get<std::uint32_t>() != crc32c(bytes.data(), bytes.size())) return damaged;
  Reader in(bytes.substr(kMagic.size()));
  if (in.get<std::uint32_t>() != kVersion)
    return {StatusCode::unreadable, "a file of domains of another version"};
  DomainFile file;
  file.key = in.get<std::uint64_t>();
  const std::size_t parts = in.count(4);
  for (std::size_t i = 0; i < parts && in.ok(); ++i) {
    auto& levels = file.scene.parts.emplace_back();
    levels.resize(in.count(kPrimitiveBytes / 2));
    for (DomainSet& set : levels)
      if (Status got = get_set(in, set); !got.ok()) return got;
  }
  if (!in.at_end()) return damaged;
  return file;
}

}  // namespace dupin
