// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/meshes/left_out.h>

#include <algorithm>

namespace pcl_bsh::io {

void LeftOuts::add(std::string_view one, std::string_view many, bool joins, std::uint64_t count)
{
  if (count == 0) return;
  joins_ = joins_ || joins;
  const auto known = std::find_if(kinds_.begin(), kinds_.end(), [&](const LeftOut& kind) { return kind.one == one; });
  constexpr std::size_t most = 8; // kinds that are named: a file may make up any number
  if (known != kinds_.end())
    known->count += count;
  else if (kinds_.size() < most)
    kinds_.push_back({std::string(one), std::string(many), count});
  else
    others_ += count;
}

std::string LeftOuts::text() const
{
  std::vector<std::string> parts;
  for (const LeftOut& kind : kinds_) parts.push_back(counted(kind.count, kind.one, kind.many));
  if (others_ > 0) parts.push_back(counted(others_, "thing of other kinds", "things of other kinds"));
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

std::string LeftOuts::remark() const
{
  const bool one = kinds_.size() == 1 && kinds_[0].count == 1;
  return "its " + text() + (one ? " is" : " are") + " not compared";
}

std::string LeftOuts::refusal() const
{
  return "holds " + text() + " and no faces: nothing but its corners would be compared";
}

} // namespace pcl_bsh::io
