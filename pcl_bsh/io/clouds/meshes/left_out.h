// SPDX-License-Identifier: BSD-3-Clause
// Elements of mesh files beside points and faces: lines, edges, free-form surfaces. They are counted, not compared.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// One kind of such elements.
struct LeftOut {
  std::string one, many;   ///< nouns: "line (l)", "lines (l)"
  std::uint64_t count = 0; ///< at least 1
};

class LeftOuts {
public:
  /// @param joins whether it joins vertices, so that these alone say less than the file
  void add(std::string_view one, std::string_view many, bool joins, std::uint64_t count = 1);

  bool empty() const { return kinds_.empty(); }
  bool joinVertices() const { return joins_; } ///< whether one of the kinds does

  /// "2 lines (l), 1 free-form surface (surf) and 3 points of no face".
  std::string text() const;

  /// One sentence for users: these are not compared.
  std::string remark() const;

  /// Why a file without faces is no shape: nothing but its corners would be compared. To be followed by give_corners.
  std::string refusal() const;

private:
  std::vector<LeftOut> kinds_;
  bool joins_ = false;
  std::uint64_t others_ = 0; ///< elements of further kinds
};

inline constexpr auto give_corners =
    "give --vertices-only (`vertices_only`) to compare its corners alone, or save it with faces";

} // namespace pcl_bsh::io
