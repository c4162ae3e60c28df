#include "mesh_block.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "point_node.h"

namespace dupin {
namespace {

constexpr std::size_t kHeaderBytes = 20;
constexpr std::uint32_t kNormalWord = 2 * kNormalBits, kColorWord = 24, kCodeWord = 4, kNoEdge = 15;

int bits_for(std::uint32_t largest) {
  return static_cast<int>(std::bit_width(largest));
}

class BitWriter {
 public:
  explicit BitWriter(std::string& bytes) : bytes_(bytes) {}
  void put(std::uint32_t value, int bits) {
    held_ |= std::uint64_t{value} << count_;
    count_ += bits;
    while (count_ >= 8) flush();
  }
  void end() {
    while (count_ > 0) flush();
  }

 private:
  void flush() {
    bytes_.push_back(static_cast<char>(held_ & 0xff));
    held_ >>= 8;
    count_ -= 8;
  }
  std::string& bytes_;
  std::uint64_t held_ = 0;
  int count_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const char> bytes) : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}
  std::uint32_t get(int bits) {
    while (count_ < bits) {
      if (at_ + 4 <= end_) {
        std::uint32_t word;
        std::memcpy(&word, at_, 4);
        held_ |= std::uint64_t{word} << count_;
        at_ += 4, count_ += 32;
      } else if (at_ < end_) {
        held_ |= std::uint64_t{static_cast<unsigned char>(*at_++)} << count_;
        count_ += 8;
      } else {
        failed_ = true;
        return 0;
      }
    }
    const auto value = static_cast<std::uint32_t>(held_ & ((std::uint64_t{1} << bits) - 1));
    held_ >>= bits;
    count_ -= bits;
    return value;
  }
  bool failed() const { return failed_; }

 private:
  const char *at_, *end_;
  std::uint64_t held_ = 0;
  int count_ = 0;
  bool failed_ = false;
};

/// The edge of the leaf's earlier triangles that `t` lies on the other side of, and t's vertex that is not on
/// it.
struct Joint {
  std::uint32_t code = kNoEdge;
  std::uint16_t vertex = 0;
};
Joint joint_of(std::span<const std::array<std::uint16_t, 3>> earlier, const std::array<std::uint16_t, 3>& t) {
  for (std::uint32_t j = 0; j < earlier.size(); ++j)
    for (std::uint32_t k = 0; k < 3; ++k)
      for (std::uint32_t e = 0; e < 3; ++e)
        if (earlier[j][k] == t[(e + 1) % 3] && earlier[j][(k + 1) % 3] == t[e])
          return {3 * j + k, t[(e + 2) % 3]};
  return {};
}

std::uint32_t hash(const BlockVertex& v) {
  std::uint64_t h = v.position[0] | std::uint64_t{v.position[1]} << 21 | std::uint64_t{v.position[2]} << 42;
  h = (h ^ (std::uint64_t{v.normal} << 40)) * 0xff51afd7ed558ccdu;
  h ^= (h >> 32) ^ (v.color[0] | std::uint32_t{v.color[1]} << 8 | std::uint32_t{v.color[2]} << 16);
  return static_cast<std::uint32_t>(h * 0x9e3779b97f4a7c15u >> 40);
}

void put_word(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>(value >> 8 * i & 0xff));
}

std::uint32_t word_at(std::span<const char> bytes, std::size_t at) {
  std::uint32_t word;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

}  // namespace

std::uint16_t BlockBuilder::vertex(const BlockVertex& v) {
  std::size_t at = hash(v) & (table_.size() - 1);
  while (table_[at] != kFree && !(block_.vertices[table_[at]] == v)) at = (at + 1) & (table_.size() - 1);
  if (table_[at] == kFree) {
    table_[at] = static_cast<std::uint16_t>(block_.vertices.size());
    block_.vertices.push_back(v);
  }
  return table_[at];
}

void BlockBuilder::add_leaf(std::span<const std::array<BlockVertex, 3>> triangles) {
  std::vector<std::array<std::uint16_t, 3>> waiting;
  for (const auto& t : triangles) waiting.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
  const auto first = static_cast<std::ptrdiff_t>(block_.triangles.size());
  while (!waiting.empty()) {
    // One that goes on from those before it costs least.
    const std::span earlier(block_.triangles.begin() + first, block_.triangles.end());
    std::size_t next = 0;
    Joint joint;
    for (std::size_t i = 0; i < waiting.size() && joint.code == kNoEdge; ++i)
      if (joint = joint_of(earlier, waiting[i]); joint.code != kNoEdge) next = i;
    // Its corners in the order in which they will be decoded: later ones refer to its edges.
    std::array<std::uint16_t, 3> triangle = waiting[next];
    if (joint.code != kNoEdge) {
      const auto& before = earlier[joint.code / 3];
      triangle = {before[(joint.code + 1) % 3], before[joint.code % 3], joint.vertex};
    }
    block_.triangles.push_back(triangle);
    waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(next));
  }
  block_.leaf_starts.push_back(static_cast<std::uint16_t>(block_.triangles.size()));
}

std::string BlockBuilder::bytes() const {
  std::array<std::uint32_t, 3> lo, hi{};
  lo.fill(block_.vertices.empty() ? 0 : kLargestGridCoordinate);
  for (const BlockVertex& v : block_.vertices)
    for (std::size_t k = 0; k < 3; ++k)
      lo[k] = std::min(lo[k], v.position[k]), hi[k] = std::max(hi[k], v.position[k]);
  std::string bytes;
  for (std::size_t k = 0; k < 3; ++k) bytes.push_back(static_cast<char>(bits_for(hi[k] - lo[k])));
  bytes.push_back(colors_ ? 1 : 0);
  put_word(bytes, static_cast<std::uint32_t>(block_.vertices.size()), 2);
  put_word(bytes, static_cast<std::uint32_t>(block_.triangles.size()), 2);
  for (std::size_t k = 0; k < 3; ++k) put_word(bytes, lo[k], 4);
  BitWriter out(bytes);
  for (const BlockVertex& v : block_.vertices) {
    for (std::size_t k = 0; k < 3; ++k) out.put(v.position[k] - lo[k], bits_for(hi[k] - lo[k]));
    out.put(v.normal, kNormalWord);
    if (colors_)
      out.put(v.color[0] | std::uint32_t{v.color[1]} << 8 | std::uint32_t{v.color[2]} << 16, kColorWord);
  }
  const int index_bits =
      block_.vertices.empty() ? 0 : bits_for(static_cast<std::uint32_t>(block_.vertices.size() - 1));
  for (std::size_t leaf = 0; leaf + 1 < block_.leaf_starts.size(); ++leaf)
    for (std::size_t t = block_.leaf_starts[leaf]; t < block_.leaf_starts[leaf + 1]; ++t) {
      const std::span earlier(block_.triangles.begin() + block_.leaf_starts[leaf],
                              t - block_.leaf_starts[leaf]);
      const Joint joint = joint_of(earlier, block_.triangles[t]);
      if (!earlier.empty()) out.put(joint.code, kCodeWord);
      if (joint.code != kNoEdge)
        out.put(joint.vertex, index_bits);
      else
        for (const std::uint16_t v : block_.triangles[t]) out.put(v, index_bits);
    }
  out.end();
  return bytes;
}

bool decode_block(std::span<const char> bytes, std::span<const std::uint8_t> leaf_triangles, MeshBlock& out) {
  out.vertices.clear(), out.triangles.clear(), out.leaf_starts.assign(1, 0);
  if (bytes.size() < kHeaderBytes || leaf_triangles.size() > kBlockLeaves) return false;
  const int widths[3] = {bytes[0], bytes[1], bytes[2]};
  const bool colors = bytes[3] == 1;
  const std::uint32_t counts = word_at(bytes, 4), vertices = counts & 0xffff, triangles = counts >> 16;
  std::uint32_t lo[3];
  for (std::size_t k = 0; k < 3; ++k) {
    lo[k] = word_at(bytes, 8 + 4 * k);
    if (widths[k] < 0 || widths[k] > kGridBits || lo[k] > kLargestGridCoordinate) return false;
  }
  std::size_t sum = 0;
  for (const std::uint8_t n : leaf_triangles) sum += n;
  if (sum != triangles || (triangles > 0 && vertices == 0)) return false;

  BitReader in(bytes.subspan(kHeaderBytes));
  out.vertices.resize(vertices);
  for (BlockVertex& v : out.vertices) {
    for (std::size_t k = 0; k < 3; ++k)
      v.position[k] = std::min(kLargestGridCoordinate, lo[k] + in.get(widths[k]));
    v.normal = in.get(kNormalWord);
    const std::uint32_t c = colors ? in.get(kColorWord) : 0xffffff;
    v.color = {static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(c >> 8),
               static_cast<std::uint8_t>(c >> 16), 255};
  }
  const int index_bits = vertices == 0 ? 0 : bits_for(vertices - 1);
  out.triangles.reserve(triangles);
  for (const std::uint8_t count : leaf_triangles) {
    const std::size_t first = out.triangles.size();
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t code = t == 0 ? kNoEdge : in.get(kCodeWord);
      std::array<std::uint16_t, 3> v;
      if (code == kNoEdge) {
        for (std::uint16_t& i : v) i = static_cast<std::uint16_t>(in.get(index_bits));
      } else {
        if (code / 3 >= t) return false;
        const auto& before = out.triangles[first + code / 3];
        v = {before[(code + 1) % 3], before[code % 3], static_cast<std::uint16_t>(in.get(index_bits))};
      }
      for (const std::uint16_t i : v)
        if (i >= vertices) return false;
      out.triangles.push_back(v);
    }
    out.leaf_starts.push_back(static_cast<std::uint16_t>(out.triangles.size()));
  }
  return !in.failed();
}

}  // namespace dupin
