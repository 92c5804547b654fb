// SPDX-License-Identifier: BSD-3-Clause
// Red, green and blue, coded by the differences of their bytes: of RGB12 version 2, RGB14 and RGBNIR14.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/arithmetic_decoder.h>

#include <vector>

namespace pcl_bsh::io::laz {

class ColourModels {
public:
  /// @param last three channels of 16 bits, which become the next ones
  void read(ArithmeticDecoder& in, char* last);

private:
  SymbolModel changed_{128};
  std::vector<SymbolModel> differences_ = std::vector<SymbolModel>(6, SymbolModel(256)); ///< lower, upper; r, g, b
};

} // namespace pcl_bsh::io::laz
