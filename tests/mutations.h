// Damage to files, for tests of their readers.
#ifndef DUPIN_TESTS_MUTATIONS_H
#define DUPIN_TESTS_MUTATIONS_H

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <string_view>

namespace dupin::test {

/// One to four changes: bits, bytes, words that stand for large counts or numbers that are none, pieces
/// left out, doubled or put elsewhere, the end cut off, and in texts other numbers.
inline void mutate(std::string& bytes, std::mt19937& random) {
  static constexpr std::string_view kTexts[] = {
      "0",    "-1", "4294967295", "4294967296", "999999999", "nan", "inf",      "1e999",
      "-0.0", "",   "\n",         "1/2/3",      "\\\n",      "#",   "property", "element face 3"};
  static constexpr std::uint64_t kWords[] = {0,          ~0ull,         0x7fffffff,          0x80000000,
                                             0x7f800000, 0x00010000ull, 0x7ff0000000000000u, 1ull << 40};
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t times = 1 + below(4); times > 0 && !bytes.empty(); --times) {
    const std::size_t at = below(bytes.size()),
                      some = below(std::min<std::size_t>(24, bytes.size() - at)) + 1;
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        if (below(4) == 0) bytes.resize(at);
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), some));
        break;
      case 4:
        bytes.erase(at, some);
        break;
      case 5:
        std::memcpy(bytes.data() + at, &kWords[below(std::size(kWords))], std::min<std::size_t>(some, 8));
        break;
      default: {  // a word of a text
        const std::size_t first = bytes.find_first_of(" \n", at);
        if (first == std::string::npos) break;
        const std::size_t last = std::min(bytes.size(), bytes.find_first_of(" \n", first + 1));
        bytes.replace(first + 1, last - first - 1, kTexts[below(std::size(kTexts))]);
      }
    }
  }
}

}  // namespace dupin::test

#endif
