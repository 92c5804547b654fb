// SPDX-License-Identifier: BSD-3-Clause
// Walks a text line by line, and a line word by word.
#pragma once

#include <pcl_bsh/io/text/number_line.h>
#include <pcl_bsh/io/text/parse_number.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace pcl_bsh::io {

/// The separator of a line's values: a semicolon, else a comma, else a tab, where it has one; else blanks (' '). Tabs
/// beside blanks are blanks.
inline char separatorOf(std::string_view line)
{
  const auto separates = [line](char separator, bool within_quotes) {
    bool quoted = false;
    return std::any_of(line.begin(), line.end(), [&](char c) {
      if (c == '"') quoted = !quoted;
      return c == separator && (within_quotes || !quoted);
    });
  };
  for (const bool within_quotes : {false, true}) // a lone quote is a character as others are
    for (const char separator : {';', ','})
      if (separates(separator, within_quotes)) return separator;
  const bool blank = line.substr(0, line.find_last_not_of(" \t") + 1).find(' ') != std::string_view::npos;
  return !blank && line.find('\t') != std::string_view::npos ? '\t' : ' ';
}

inline constexpr std::string_view utf8_mark = "\xef\xbb\xbf";

/// Whether a text begins with the mark of UTF-16, in either byte order.
inline bool isUtf16(std::string_view text)
{
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}

/// Lines end with \n, \r\n or \r. Words are separated by blanks and tabs, unless separateBy() says otherwise. A mark of
/// UTF-8 at the beginning is skipped.
class TextCursor {
public:
  /// Whether a backslash at the end of a line joins the next line to it, as a blank would. One that no line follows is
  /// a word.
  enum class Lines : bool { single, continued };

  /// @param comment the rest of a line is ignored from this character on, where it begins the line or a blank or a tab
  ///   stands before it. Within a word, as in 1.#QNAN, it is a character of the word. 0: none
  /// @throws FormatError when the text is marked as UTF-16
  explicit TextCursor(std::string_view text, char comment = 0, Lines lines = Lines::single)
  : text_(text),
    comment_(comment),
    continued_(lines == Lines::continued)
  {
    if (text.starts_with(utf8_mark)) text_.remove_prefix(utf8_mark.size());
    if (isUtf16(text)) throw FormatError("is UTF-16 text", "save it as UTF-8");
  }

  /// From now on exactly one such character separates words, and blanks around a word do not count. Two in a row have
  /// an empty word between them; one at the end of a line has no word behind it. Quotes around a word do not count, and
  /// neither do separators within: "x,y". ' ': any number of blanks and tabs.
  void separateBy(char separator) noexcept { separator_ = separator; }

  /// Goes to the next line that has a word. False at the end of the text.
  bool nextLine()
  {
    do {
      if (end_ == text_.size()) return false;
      readLine();
    } while (line_.empty());
    return true;
  }

  /// Takes the next line as a whole, if it is that many numbers and nothing else. Otherwise nothing has happened, and
  /// nextLine() and its words tell what is there.
  bool nextNumbers(std::span<double> values)
  {
    const std::size_t bytes = readNumberLine(text_.substr(end_), separator_, values);
    if (bytes == 0) return false;
    end_ += bytes;
    line_number_ += std::exchange(lines_joined_, 0) + 1;
    line_ = {};
    ends_with_separator_ = false;
    return true;
  }

  /// The rest of the line, from its next word to its last.
  std::string_view line() const noexcept { return line_; }

  /// Takes the next word off the line; empty when none is left.
  std::string_view word() noexcept
  {
    if (separator_ != ' ') return wordBeforeSeparator();
    std::size_t length = 0;
    while (length < line_.size() && !separates(line_, length)) ++length;
    const std::string_view taken = line_.substr(0, length);
    line_.remove_prefix(length);
    skipBlanks();
    return taken;
  }

  /// Takes the next word if it is empty: a separator stands in its place, or the line ends behind the last separator.
  /// @return whether it did
  bool takeEmptyWord() noexcept
  {
    if (line_.empty()) return std::exchange(ends_with_separator_, false);
    TextCursor behind = *this;
    if (separator_ == ' ' || !behind.word().empty()) return false;
    *this = behind;
    return true;
  }

  /// Takes the next word off the line, and returns the result of `parse`.
  /// @throws FormatError naming the line when it has no more words, or when `parse` throws one
  template <typename Parse>
  std::invoke_result_t<Parse, std::string_view> parseWord(Parse&& parse)
  {
    const std::string_view taken = requireWord();
    return naming([&] { return parse(taken); });
  }

  /// Takes the next word as a number; throws FormatError naming the line.
  template <typename T>
  T number()
  {
    return parseWord([](std::string_view word) { return parseNumber<T>(word); });
  }

  /// @throws FormatError when words are left on the line
  void requireEndOfLine() const
  {
    if (!line_.empty()) fail("has more values than it should, from '" + std::string(line_.substr(0, 40)) + "' on");
  }

  /// Bytes behind this line.
  std::string_view rest() const noexcept { return text_.substr(end_); }

  [[noreturn]] void fail(const std::string& wrong) const { throw FormatError(named(wrong)); }
  [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const
  {
    throw FormatError(named(wrong), remedy);
  }

  /// Returns the result of `parse`; a FormatError of it names this line.
  template <typename Parse>
  std::invoke_result_t<Parse> naming(Parse&& parse) const
  {
    try {
      return parse();
    }
    catch (const FormatError& error) {
      fail(std::string("is damaged: ") + error.what(), error.remedy());
    }
  }

private:
  static constexpr bool isBlank(char c) noexcept { return c == ' ' || c == '\t'; }

  std::string named(const std::string& wrong) const { return "line " + std::to_string(line_number_) + " " + wrong; }

  /// Whether a character of the line is a blank, or belongs to the join of two lines: a backslash, and the end of line
  /// behind it.
  bool separates(std::string_view line, std::size_t at) const noexcept
  {
    if (isBlank(line[at])) return true;
    if (!continued_) return false;
    const auto ends = [&](std::size_t i) { return i < line.size() && (line[i] == '\n' || line[i] == '\r'); };
    return ends(at) || (line[at] == '\\' && ends(std::min(line.find_first_not_of(" \t", at + 1), line.size())));
  }

  /// Skips blanks at the beginning of the line, and tabs unless they separate words.
  void skipBlanks() noexcept
  {
    while (!line_.empty() && separates(line_, 0) && (line_.front() != separator_ || separator_ == ' ')) {
      line_.remove_prefix(1);
    }
  }

  std::string_view wordBeforeSeparator() noexcept
  {
    const std::size_t length = std::min(line_.find(separator_, quotesEnd()), line_.size());
    const std::string_view taken = line_.substr(0, length);
    ends_with_separator_ = length + 1 == line_.size();
    line_.remove_prefix(std::min(length + 1, line_.size()));
    skipBlanks();
    return withoutQuotes(taken.substr(0, taken.find_last_not_of(" \t") + 1));
  }

  /// The place behind the quote that closes a quoted word at the beginning of the line. 0 where the line begins with no
  /// quote, or no quote closes it.
  std::size_t quotesEnd() const noexcept
  {
    if (!line_.starts_with('"')) return 0;
    for (std::size_t at = line_.find('"', 1); at != std::string_view::npos; at = line_.find('"', at + 1)) {
      const std::size_t next = line_.find_first_not_of(" \t", at + 1);
      if (line_.substr(at + 1).starts_with(separator_) || next == std::string_view::npos || line_[next] == separator_)
        return at + 1;
    }
    return 0;
  }

  static std::string_view withoutQuotes(std::string_view word) noexcept
  {
    const bool quoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
    return quoted ? word.substr(1, word.size() - 2) : word;
  }

  std::size_t commentAt(std::string_view line) const noexcept
  {
    std::size_t at = line.find(comment_);
    while (at != std::string_view::npos && at > 0 && !isBlank(line[at - 1])) at = line.find(comment_, at + 1);
    return at;
  }

  /// The next line of the text, without its end and a comment.
  std::string_view takeLine() noexcept
  {
    const std::size_t begin = end_;
    while (end_ < text_.size() && text_[end_] != '\n' && text_[end_] != '\r') ++end_;
    const std::string_view line = text_.substr(begin, end_ - begin);
    if (end_ < text_.size()) end_ += text_.substr(end_).starts_with("\r\n") ? 2 : 1;
    return comment_ != 0 ? line.substr(0, commentAt(line)) : line;
  }

  /// The line without the blanks and tabs at its end.
  static std::string_view withoutBlanksBehind(std::string_view line) noexcept
  {
    return line.substr(0, line.find_last_not_of(" \t") + 1);
  }

  /// Whether the line that was taken last ends with a backslash, which joins the next to it. No comment stands behind
  /// it.
  bool goesOn() const noexcept
  {
    if (!continued_ || !line_.ends_with('\\')) return false;
    const auto* const behind = line_.data() + line_.size();
    const auto rest = static_cast<std::size_t>(text_.data() + end_ - behind);
    return std::string_view(behind, rest).find_first_not_of(" \t\r\n") == std::string_view::npos;
  }

  void readLine() noexcept
  {
    line_number_ += lines_joined_ + 1;
    lines_joined_ = 0;
    ends_with_separator_ = false;
    line_ = withoutBlanksBehind(takeLine());
    while (goesOn() && end_ < text_.size()) {
      const std::string_view next = withoutBlanksBehind(takeLine());
      ++lines_joined_;
      line_ = {line_.data(), static_cast<std::size_t>(next.data() + next.size() - line_.data())};
    }
    skipBlanks();
  }

  std::string_view requireWord()
  {
    const bool ended = line_.empty();
    const std::string_view taken = word();
    if (taken.empty()) fail(ended ? "has fewer values than it should" : "has an empty value");
    return taken;
  }

  std::string_view text_;
  char comment_;
  bool continued_;
  char separator_ = ' ';
  std::string_view line_;
  bool ends_with_separator_ = false; ///< the word taken last is followed by nothing but a separator
  std::size_t end_ = 0;              ///< where the next line begins
  std::size_t line_number_ = 0;      ///< of the line; of joined lines, of the first
  std::size_t lines_joined_ = 0;     ///< how many lines are joined to that one
};

} // namespace pcl_bsh::io
