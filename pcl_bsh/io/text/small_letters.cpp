// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <cctype>

namespace pcl_bsh::io {

std::string inSmallLetters(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string extensionOf(const std::filesystem::path& file)
{
  return inSmallLetters(file.extension().string());
}

} // namespace pcl_bsh::io
