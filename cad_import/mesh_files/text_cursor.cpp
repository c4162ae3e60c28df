#include "text_cursor.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace dupin::mesh_files {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// A decimal with few digits is a whole number times or over a power of ten that are both exact doubles, so
/// one operation rounds it correctly (Clinger). None for any other word.
std::optional<double> short_number(const char* at, const char* end) {
  const bool negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+')) ++at;
  std::uint64_t digits = 0;
  int count = 0, point = 0;
  const char* const first = at;
  for (; at < end && is_digit(*at); ++at, ++count)
    digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
  const bool whole = at > first;
  if (at < end && *at == '.')
    for (++at; at < end && is_digit(*at); ++at, ++count, ++point)
      digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
  if (at != end || count == 0 || count > 18 || point > 22 || digits > (1ull << 53)) return std::nullopt;
  if (!whole && point == 0) return std::nullopt;
  const double value = static_cast<double>(digits) / kPowers[point];
  return negative ? -value : value;
}

/// from_chars leaves a number that is too large or too small alone; strtod rounds it.
double out_of_range(std::string_view word) {
  return std::strtod(std::string(word).c_str(), nullptr);
}

}  // namespace

std::optional<double> to_number(std::string_view word) {
  const char *first = word.data(), *last = first + word.size();
  if (const auto value = short_number(first, last)) return value;
  if (first < last && *first == '+' && word.size() > 1 && word[1] != '-') ++first;
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  return error == std::errc::result_out_of_range ? out_of_range(word) : value;
}

std::optional<std::int64_t> to_integer(std::string_view word) {
  const char *first = word.data(), *last = first + word.size();
  if (first < last && *first == '+') ++first;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (end != last || error != std::errc()) return std::nullopt;
  return value;
}

std::string quoted(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text = "'";
  for (const char c : word.substr(0, kMost)) text += c >= 32 && c < 127 ? c : '?';
  return text + (word.size() > kMost ? "…'" : "'");
}

bool TextCursor::skip_blanks() {
  for (;;) {
    while (at_ < end_ && is_blank(*at_)) ++at_;
    if (!continued_lines_ || at_ == end_ || *at_ != '\\') break;
    const char* next = at_ + 1;
    while (next < end_ && *next == '\r') ++next;
    if (next == end_ || *next != '\n') break;
    at_ = next + 1;
    ++line_;
  }
  return at_ < end_ && *at_ != '\n';
}

std::string_view TextCursor::word() {
  if (!skip_blanks()) return {};
  const char* const first = at_;
  while (at_ < end_ && !is_blank(*at_) && *at_ != '\n') ++at_;
  return {first, static_cast<std::size_t>(at_ - first)};
}

std::string_view TextCursor::rest() {
  skip_blanks();
  const char* const first = at_;
  while (at_ < end_ && *at_ != '\n') ++at_;
  const char* last = at_;
  while (last > first && is_blank(last[-1])) --last;
  return {first, static_cast<std::size_t>(last - first)};
}

void TextCursor::next_line() {
  const void* end = at_ < end_ ? std::memchr(at_, '\n', bytes_left()) : nullptr;
  at_ = end ? static_cast<const char*>(end) + 1 : end_;
  if (end) ++line_;
}

std::string_view TextCursor::word_on_any_line(char comment) {
  while (!at_end()) {
    const std::string_view found = word();
    if (!found.empty() && found.front() != comment) return found;
    next_line();
  }
  return {};
}

}  // namespace dupin::mesh_files
