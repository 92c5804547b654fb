// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/lines/column_kinds.h>
#include <pcl_bsh/io/text/number_text.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace pcl_bsh::io {

namespace {

constexpr std::string_view all_digits = "0123456789";

/// The digits of a decimal number without its leading zeros.
std::string digitsThatCount(std::string_view number)
{
  std::string digits;
  for (const char c : number.substr(0, number.find_first_of("eE")))
    if (c >= '0' && c <= '9' && (!digits.empty() || c != '0')) digits += c;
  return digits;
}

bool isWhole(std::string_view word)
{
  const std::string_view digits = word.substr(word.find_first_of("+-") == 0 ? 1 : 0);
  return !digits.empty() && digits.find_first_not_of(all_digits) == std::string_view::npos;
}

/// Whether a word can be kept as text: no number with a decimal comma, and no control characters.
bool isWordOfText(std::string_view word)
{
  const bool comma = word.find(',') != std::string_view::npos;
  if (comma && word.find_first_not_of("0123456789+-.,eE \t") == std::string_view::npos) return false;
  return std::none_of(word.begin(), word.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < ' ' || byte == 127;
  });
}

/// Findings in the words of a column.
struct Shown {
  bool eligible = true;
  bool empty = false, whole = true, held = true, positive = false, negative = false;
  bool fits_signed = true, fits_unsigned = true;
  std::string text;       ///< the first word that is no number
  bool defective = false; ///< a word that is neither a number nor text

  void see(std::string_view word)
  {
    if (word.empty()) {
      empty = true;
      return;
    }
    const std::optional<double> number = numberOf<double>(word);
    if (!number) {
      if (!isWordOfText(word)) defective = true;
      if (text.empty()) text = word.substr(0, 40);
      return;
    }
    if (!isWhole(word)) {
      whole = false;
      held = held && float64Holds(word);
      return;
    }
    constexpr double limit = 9007199254740992.0; // 2^53, up to which float64 has all whole numbers
    if (*number > limit) positive = true;
    if (*number < -limit) negative = true;
    held = held && float64Holds(word);
    fits_signed = fits_signed && numberOf<std::int64_t>(word);
    fits_unsigned = fits_unsigned && numberOf<std::uint64_t>(word);
  }

  bool isBeyond() const { return positive || negative; }
  bool isNumbers() const { return text.empty() && held && !isBeyond(); }
  bool isInteger() const { return text.empty() && isBeyond() && whole && !empty && (fits_signed || fits_unsigned); }
};

} // namespace

bool nextRow(TextCursor& text)
{
  do {
    if (!text.nextLine()) return false;
  } while (text.line().starts_with("//"));
  return true;
}

bool float64Holds(std::string_view word)
{
  const std::optional<double> value = numberOf<double>(word);
  if (!value || !std::isfinite(*value)) return true;
  const auto withoutZerosBehind = [](std::string digits) {
    digits.resize(digits.find_last_not_of('0') + 1);
    return digits;
  };
  const std::string given = digitsThatCount(word), digits = withoutZerosBehind(given);
  constexpr std::size_t always = 15, most = 100;
  if (digits.size() <= always || given.size() > most) return true;
  const auto printed = [&](const std::string& text) { return withoutZerosBehind(digitsThatCount(text)); };
  const int decimals = static_cast<int>(given.size()) - 1;
  return printed(numberText(*value)) == digits ||
         printed(numberText(*value, std::chars_format::scientific, decimals)) == digits;
}

bool isTextField(const pcl::PCLPointField& field)
{
  return field.datatype == pcl::PCLPointField::INT8 && field.count > 1;
}

std::string_view textOf(const pcl::PCLPointField& field, const char* bytes)
{
  const std::string_view all(bytes, field.count);
  const std::string_view text = all.substr(0, all.find('\0'));
  if (text.size() == all.size() || all.find_first_not_of('\0', text.size()) != std::string_view::npos ||
      !isWordOfText(text))
    throw FormatError("field '" + field.name + "' has " + counted(field.count, "value") + " per point",
                      "write a .pcd instead");
  return text;
}

bool canBeColumn(std::string_view word, char separator)
{
  if (separator == ' ' && (word.empty() || word.find(' ') != std::string_view::npos)) return false;
  const char* const never = separator == ',' ? "\"\t" : ",;\"\t";
  if (word.find_first_of(never) != std::string_view::npos || word.starts_with("//")) return false;
  const std::size_t mark = word.find('#');
  if (mark == 0 || word.find(" #") != std::string_view::npos) return false;
  return word.empty() || (word.front() != ' ' && word.back() != ' ');
}

ColumnKinds::ColumnKinds(const TextCursor& rows, bool whole, Fields& values)
{
  std::vector<Shown> shown(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = values[i].name;
    const bool axis = name == "x" || name == "y" || name == "z" || name == "X" || name == "Y" || name == "Z";
    shown[i].eligible = !axis && values[i].count == 1 && values[i].datatype == pcl::PCLPointField::FLOAT64;
  }
  if (std::none_of(shown.begin(), shown.end(), [](const Shown& column) { return column.eligible; })) return;

  constexpr std::size_t most_rows = 1000, most_bytes = std::size_t{48} << 10;
  const std::size_t bytes = rows.line().size() + rows.rest().size();
  TextCursor text = rows;
  bool ended = false;
  for (std::size_t row = 0; row < most_rows && bytes - text.rest().size() <= most_bytes && !ended; ++row) {
    for (Shown& column : shown) {
      const bool empty = text.takeEmptyWord();
      const std::string_view word = empty ? std::string_view() : text.word(); // none where the row ends early
      if (column.eligible && (empty || !word.empty())) column.see(word);
    }
    ended = !nextRow(text);
  }
  if (ended && !whole) throw FormatError("is known in part, and all of its rows tell what they are");

  std::vector<std::size_t> texts;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Shown& column = shown[i];
    if (!column.eligible || column.isNumbers() || column.defective) continue;
    if (column.isInteger()) {
      values[i].datatype = column.fits_signed ? pcl::PCLPointField::INT64 : pcl::PCLPointField::UINT64;
      continue;
    }
    texts.push_back(i);
    remarks.push_back("column '" + values[i].name + "' " +
                      (column.text.empty() ? "has more digits than float64 holds"
                                           : "holds no numbers alone ('" + column.text + "')") +
                      ", and is kept as text");
  }
  if (texts.empty()) return;
  rows_tell = true;
  std::vector<std::size_t> longest(values.size(), 1);
  std::size_t count = 0;
  text = rows;
  do {
    ++count;
    for (std::size_t i = 0; i <= texts.back(); ++i) longest[i] = std::max(longest[i], text.word().size());
  } while (nextRow(text));
  constexpr std::size_t most_growth = 32; // bytes of texts per byte of the file
  std::size_t width = 0;
  for (const std::size_t i : texts) width += longest[i] + 1;
  if (width > most_growth * (bytes + 1) / count) {
    const std::string& name = values[texts.front()].name;
    throw FormatError("column '" + name + "', or another of text, has a word of " + counted(width, "character") +
                          ", much longer than others",
                      "name the columns (--columns), and give it the name _, which is not read");
  }
  for (const std::size_t i : texts) {
    values[i].datatype = pcl::PCLPointField::INT8;
    values[i].count = static_cast<std::uint32_t>(longest[i] + 1);
  }
}

} // namespace pcl_bsh::io
