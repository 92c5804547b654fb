// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/question/uncertainty.h>

#include <string>
#include <vector>

namespace pcl_bsh {

/// Bytes of a field's number; 0 for an unknown type.
std::size_t bytesOf(const RecordField& field);

/// The numbers of a field, one a record.
class RecordNumbers {
public:
  /// The texts of an error about a field that is missing.
  struct Purpose {
    Input code;
    const char* of;     ///< such as "of its points' sigmas"
    const char* remedy; ///< before the names of the fields there are
  };

  /// @param cloud its name in errors. @throws InvalidInput for a field that is missing, holds more than one number a
  ///   record, or reaches beyond it
  RecordNumbers(const PointsView& view, const std::vector<RecordField>& fields, const std::string& name,
                const std::string& cloud, const Purpose& purpose);

  /// Returns the number of a record; NaN for an unknown type.
  double operator[](std::size_t record) const { return value_(first_ + stride_ * record); }

private:
  const unsigned char* first_;
  std::size_t stride_;
  double (*value_)(const unsigned char*);
};

} // namespace pcl_bsh
