// SPDX-License-Identifier: BSD-3-Clause
// Walks a text line by line, and a line word by word.
#pragma once

#include <pcl_bsh/filters/io/field_type.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

namespace pcl_bsh::io {

/// Lines end with \n, \r\n or \r. Words are separated by blanks, tabs and, if asked for, other characters.
class TextCursor {
public:
  /// @param comment the rest of a line from this character on is ignored; 0: none
  explicit TextCursor(std::string_view text, char comment = 0, std::string_view more_separators = {})
  : text_(text),
    comment_(comment),
    more_separators_(more_separators)
  {
  }

  /// Goes to the next line that has a word. False when there is none.
  bool nextLine()
  {
    do {
      if (end_ == text_.size()) return false;
      readLine();
    } while (line_.empty());
    return true;
  }

  /// What is left of the line, from its next word to its last.
  std::string_view line() const noexcept { return line_; }

  /// Takes the next word off the line; empty when none is left.
  std::string_view word() noexcept
  {
    std::size_t length = 0;
    while (length < line_.size() && !separates(line_[length])) ++length;
    const std::string_view taken = line_.substr(0, length);
    line_.remove_prefix(length);
    skipSeparators();
    return taken;
  }

  /// Takes the next word as a number; throws FormatError naming the line.
  template <typename T>
  T number()
  {
    const std::string_view taken = requireWord();
    return naming([&] { return parseNumber<T>(taken); });
  }

  /// Takes the next word as a number of that type of field; throws FormatError naming the line.
  void number(std::uint8_t datatype, std::uint8_t* out)
  {
    const std::string_view taken = requireWord();
    naming([&] { parseNumber(taken, datatype, out); });
  }

  /// @throws FormatError when words are left on the line
  void requireEndOfLine() const
  {
    if (!line_.empty()) fail("has more values than it should, from '" + std::string(line_.substr(0, 40)) + "' on");
  }

  /// Bytes behind this line.
  std::string_view rest() const noexcept { return text_.substr(end_); }

  [[noreturn]] void fail(const std::string& wrong) const
  {
    throw FormatError("line " + std::to_string(line_number_) + " " + wrong);
  }

private:
  bool separates(char c) const noexcept
  {
    return c == ' ' || c == '\t' || (!more_separators_.empty() && more_separators_.find(c) != std::string_view::npos);
  }

  void skipSeparators() noexcept
  {
    while (!line_.empty() && separates(line_.front())) line_.remove_prefix(1);
  }

  void readLine() noexcept
  {
    const std::size_t begin = end_;
    while (end_ < text_.size() && text_[end_] != '\n' && text_[end_] != '\r') ++end_;
    line_ = text_.substr(begin, end_ - begin);
    if (end_ < text_.size()) end_ += text_.substr(end_).starts_with("\r\n") ? 2 : 1;
    ++line_number_;
    if (comment_ != 0) line_ = line_.substr(0, line_.find(comment_));
    skipSeparators();
  }

  std::string_view requireWord()
  {
    const std::string_view taken = word();
    if (taken.empty()) fail("has fewer values than it should");
    return taken;
  }

  template <typename Parse>
  std::invoke_result_t<Parse> naming(Parse&& parse) const
  {
    try {
      return parse();
    }
    catch (const FormatError& error) {
      fail(std::string("is damaged: ") + error.what());
    }
  }

  std::string_view text_;
  char comment_;
  std::string_view more_separators_;
  std::string_view line_;
  std::size_t end_ = 0; ///< where the next line begins
  std::size_t line_number_ = 0;
};

} // namespace pcl_bsh::io
