// Words and numbers of a text, line by line.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_TEXT_CURSOR_H
#define DUPIN_CAD_IMPORT_MESH_FILES_TEXT_CURSOR_H

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "../../core/status.h"

namespace dupin::mesh_files {

/// The number that a word is, all of it; infinite or NaN if it says so or is too large.
std::optional<double> to_number(std::string_view word);
std::optional<std::int64_t> to_integer(std::string_view word);

/// Printable and short, for messages.
std::string quoted(std::string_view word);

class TextCursor {
 public:
  /// `first_line`: the number of the line that the text begins with.
  explicit TextCursor(std::string_view text, std::size_t first_line = 1, bool continued_lines = false)
      : at_(text.data()),
        end_(text.data() + text.size()),
        line_(first_line),
        continued_lines_(continued_lines) {}

  bool at_end() const { return at_ == end_; }
  std::size_t line() const { return line_; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  const char* position() const { return at_; }

  /// The next word of this line; empty at the line's end.
  std::string_view word();
  /// The rest of this line without blanks around it.
  std::string_view rest();
  /// To the beginning of the next line.
  void next_line();
  /// The next word that is neither empty nor in a comment from `comment` on, on this line or a later one.
  std::string_view word_on_any_line(char comment);

  Status failure(std::string_view what) const {
    return {StatusCode::unreadable, "line " + std::to_string(line_) + ": " + std::string(what)};
  }

 private:
  bool skip_blanks();
  const char *at_, *end_;
  std::size_t line_;
  bool continued_lines_;  ///< a backslash at a line's end is a blank
};

}  // namespace dupin::mesh_files

#endif
