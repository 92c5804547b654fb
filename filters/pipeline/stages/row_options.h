// SPDX-License-Identifier: BSD-3-Clause
// An option that is a list of objects, each with options of its own: members of a struct.
//
//   rowsOption<Profile>("profiles", "the outlines", {rowOption(&Profile::file, "file", "the outline")}, profilesOf);
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pcl_bsh::pipeline {

/// An option of a row that becomes a T.
template <typename T>
struct RowOption {
  Option option;
  std::function<void(T&, const Value&)> set; ///< none where the reader of the row's file obeys it

  RowOption required() &&
  {
    option.required = true;
    return std::move(*this);
  }
  RowOption length(bool above_zero = false) && ///< in metres, at least 0
  {
    option.unit = "m";
    option.least = 0;
    option.above_least = above_zero;
    return std::move(*this);
  }
};

template <typename T, typename M>
RowOption<T> rowOption(M T::*member, const char* name, const char* doc)
{
  RowOption<T> row;
  row.option.name = name;
  row.option.doc = doc;
  row.option.kind = OptionType<M>::kind;
  row.option.nullable = true;
  row.set = [member](T& made, const Value& value) { made.*member = OptionType<M>::from(value); };
  return row;
}

/// @param rows returns the rows of a stage. @param of_rows the options of a row
template <typename T>
Option rowsOption(const char* name, const char* doc, std::vector<RowOption<T>> of_rows,
                  std::function<std::vector<T>&(Stage&)> rows)
{
  Option option;
  option.name = name;
  option.doc = doc;
  option.kind = Kind::rows;
  for (const RowOption<T>& row : of_rows) option.of_rows.push_back(row.option);
  option.set = [rows = std::move(rows), of_rows = std::move(of_rows)](Stage& stage, const Value& value) {
    std::vector<T>& all = rows(stage);
    all.clear();
    for (const Row& row : std::get<std::vector<Row>>(value)) {
      all.emplace_back();
      for (std::size_t i = 0; i < row.values.size(); ++i)
        if (of_rows[i].set && !std::holds_alternative<std::monostate>(row.values[i]))
          of_rows[i].set(all.back(), row.values[i]);
    }
  };
  option.get = [](const Stage&) { return Value(std::vector<Row>()); };
  return option;
}

} // namespace pcl_bsh::pipeline
