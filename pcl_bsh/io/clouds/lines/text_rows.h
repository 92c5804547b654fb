// SPDX-License-Identifier: BSD-3-Clause
// A cloud that grows by a record per line of text.
#pragma once

#include <pcl_bsh/io/clouds/lines/column_kinds.h>
#include <pcl_bsh/io/clouds/lines/field_text.h>
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcl_bsh::io {

/// A value of a line, as layOutForPcl() takes it.
inline pcl::PCLPointField textValue(std::string name, std::uint8_t datatype = pcl::PCLPointField::FLOAT64)
{
  pcl::PCLPointField value;
  value.name = std::move(name);
  value.datatype = datatype;
  value.count = 1;
  return value;
}

inline bool isByte(double number)
{
  return number >= 0 && number <= 255 && std::trunc(number) == number;
}

/// Whether the word says a whole number from 0 to 255, also as 52.0 or 5.2e1: its notation says nothing of its type.
inline bool isByte(std::string_view word)
{
  const std::optional<double> number = numberOf<double>(word);
  return number && isByte(*number);
}

/// Collects records from the values of lines. It begins without a point.
class TextRows {
public:
  explicit TextRows(Fields values) : values_(std::move(values)), offsets_(layOutForPcl(values_, cloud_))
  {
    cloud_.height = 1;
    for (const pcl::PCLPointField& field : cloud_.fields)
      if (field.name == "x" || field.name == "y" || field.name == "z") coordinates_.insert(field.offset);
  }

  std::size_t size() const { return cloud_.data.size() / cloud_.point_step; }
  void reserve(std::size_t points) { cloud_.data.reserve(points * cloud_.point_step); }
  /// Reserves room for as many rows as a text has lines, and for no more rows than the text can hold.
  void reserveLines(std::string_view text)
  {
    const std::size_t most = text.size() / (2 * values_.size()) + 1; // a digit and a separator each
    reserve(std::min(most, static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1));
  }
  void add() { cloud_.data.resize(cloud_.data.size() + cloud_.point_step); }

  /// Where value i of a record is.
  std::uint8_t* at(std::size_t record, std::size_t i)
  {
    return cloud_.data.data() + record * cloud_.point_step + offsets_[i];
  }

  /// Takes values i from `first` to `last` (exclusive) of that record from the line. An empty word between separators
  /// is NaN; a coordinate must not be empty. A value of count 0 may be any word.
  void take(TextCursor& text, std::size_t record, std::size_t first, std::size_t last)
  {
    for (std::size_t i = first; i < last; ++i) {
      if (isSkipped(i)) {
        text.word();
        continue;
      }
      if (values_[i].datatype == pcl::PCLPointField::FLOAT64 && !isCoordinate(i) && text.takeEmptyWord()) {
        put(record, i, std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      if (isTextField(values_[i]) && text.takeEmptyWord()) continue;
      text.parseWord([&](std::string_view word) {
        if (isTextField(values_[i])) return putText(record, i, word);
        const bool byte = values_[i].datatype == pcl::PCLPointField::UINT8;
        if (byte && isByte(word)) return put(record, i, parseNumber<double>(word));
        parseNumber(word, values_[i].datatype, at(record, i));
      });
    }
  }

  /// Whether doubles hold all values of a row: no value is a text or a 64-bit integer.
  bool takesDoubles() const
  {
    return std::none_of(values_.begin(), values_.end(), [](const pcl::PCLPointField& value) {
      return isTextField(value) || value.datatype == pcl::PCLPointField::INT64 ||
             value.datatype == pcl::PCLPointField::UINT64;
    });
  }

  /// Adds a record of these values. @return false, and nothing has happened, if one cannot be of its type
  bool add(std::span<const double> numbers)
  {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const bool byte = values_[i].datatype == pcl::PCLPointField::UINT8 && !isSkipped(i);
      if (byte && !isByte(numbers[i])) return false;
    }
    const std::size_t record = size();
    add();
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (!isSkipped(i)) put(record, i, numbers[i]);
    return true;
  }

  /// Sets value i of a record, which its type can hold.
  void put(std::size_t record, std::size_t i, double number)
  {
    withFieldType(values_[i].datatype, [&](auto zero) {
      const auto value = static_cast<decltype(zero)>(number);
      std::memcpy(at(record, i), &value, sizeof value);
    });
  }

  /// The cloud, once all records are there. @throws FormatError beyond max_points
  pcl::PCLPointCloud2 finished() &&
  {
    requirePoints(size());
    cloud_.width = static_cast<std::uint32_t>(size());
    cloud_.row_step = cloud_.width * cloud_.point_step;
    return std::move(cloud_);
  }

private:
  /// Sets a value that is a text. The bytes behind it stay zero, the last one at least.
  void putText(std::size_t record, std::size_t i, std::string_view word)
  {
    std::memcpy(at(record, i), word.data(), std::min<std::size_t>(word.size(), values_[i].count - 1));
  }

  bool isSkipped(std::size_t i) const { return values_[i].count == 0; }

  bool isCoordinate(std::size_t i) const { return coordinates_.count(offsets_[i]) > 0; }

  pcl::PCLPointCloud2 cloud_;
  Fields values_;
  std::vector<std::uint32_t> offsets_;
  std::set<std::uint32_t> coordinates_; ///< their offsets
};

} // namespace pcl_bsh::io
