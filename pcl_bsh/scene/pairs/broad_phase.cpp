// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/pairs/broad_phase.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

void BroadPhase::reset(double edge, const PairRules& rules)
{
  *this = BroadPhase();
  edge_ = edge;
  rules_ = &rules;
}

BroadPhase::Range BroadPhase::rangeOf(const Box3& box) const
{
  // Voxels beyond the last that 20 bits can number are one with it: objects there share more than they must.
  const auto number = [this](double x) {
    return static_cast<std::int64_t>(std::clamp(std::floor(x / edge_), -0x1p19, 0x1p19));
  };
  Range range;
  for (int k = 0; k < 3; ++k) {
    range.low[static_cast<std::size_t>(k)] = number(box.low[k]);
    range.high[static_cast<std::size_t>(k)] = number(box.high[k]);
  }
  return range;
}

BroadPhase::Key BroadPhase::keyOf(std::int64_t x, std::int64_t y, std::int64_t z)
{
  const auto bits = [](std::int64_t number) { return static_cast<Key>(number + (1 << 20)); };
  return bits(x) << 42 | bits(y) << 21 | bits(z);
}

double BroadPhase::countOf(const Range& range)
{
  double count = 1.0;
  for (std::size_t k = 0; k < 3; ++k) count *= static_cast<double>(range.high[k] - range.low[k] + 1);
  return count;
}

double BroadPhase::voxelsOf(const Box3& box) const
{
  return box.empty() || !std::isfinite(edge_) ? 0.0 : countOf(rangeOf(box));
}

void BroadPhase::voxelsOf(const std::vector<Range>& ranges, std::vector<Key>& voxels) const
{
  voxels.clear();
  for (const Range& range : ranges) {
    if (countOf(range) + static_cast<double>(voxels.size()) > 8 * kMostVoxels) {
      voxels.assign(1, kEverywhere);
      return;
    }
    for (std::int64_t x = range.low[0]; x <= range.high[0]; ++x)
      for (std::int64_t y = range.low[1]; y <= range.high[1]; ++y)
        for (std::int64_t z = range.low[2]; z <= range.high[2]; ++z) voxels.push_back(keyOf(x, y, z));
  }
  if (ranges.size() > 1) {
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  }
  if (static_cast<double>(voxels.size()) > kMostVoxels) voxels.assign(1, kEverywhere);
}

void BroadPhase::place(ObjectId object, const std::vector<Box3>& boxes, BroadPhaseCost& cost)
{
  if (places_.size() <= object) {
    places_.resize(object + 1);
    placed_.resize(object + 1, 0);
  }
  if (placed_[object] == 0) {
    placed_[object] = 1;
    for (const ObjectId other : everywhere_) share(object, other);
  }
  Place& place = places_[object];
  ranges_.clear();
  if (!std::isfinite(edge_)) {
    new_voxels_.assign(1, kEverywhere);
    if (place.voxels == new_voxels_) return;
  }
  else {
    for (const Box3& box : boxes)
      if (!box.empty()) ranges_.push_back(rangeOf(box));
    if (ranges_ == place.ranges && !place.voxels.empty()) return;
    voxelsOf(ranges_, new_voxels_);
  }
  place.ranges = ranges_;

  // Both lists ascend: the object leaves voxels that only the old one has, and enters voxels that only the new one has.
  std::size_t o = 0, n = 0;
  const std::vector<Key>& old = place.voxels;
  while (o < old.size() || n < new_voxels_.size()) {
    if (n == new_voxels_.size() || (o < old.size() && old[o] < new_voxels_[n])) {
      leave(object, old[o++]);
      ++cost.voxels_left;
    }
    else if (o == old.size() || new_voxels_[n] < old[o]) {
      enter(object, new_voxels_[n++]);
      ++cost.voxels_entered;
    }
    else {
      ++o;
      ++n;
    }
  }
  place.voxels.swap(new_voxels_);
}

void BroadPhase::enter(ObjectId object, Key voxel)
{
  if (voxel == kEverywhere) {
    for (ObjectId other = 0; other < placed_.size(); ++other)
      if (placed_[other] && other != object) share(object, other);
    everywhere_.push_back(object);
    return;
  }
  std::vector<ObjectId>& here = voxels_[voxel];
  for (const ObjectId other : here) share(object, other);
  here.push_back(object);
}

void BroadPhase::leave(ObjectId object, Key voxel)
{
  if (voxel == kEverywhere) {
    everywhere_.erase(std::find(everywhere_.begin(), everywhere_.end(), object));
    for (ObjectId other = 0; other < placed_.size(); ++other)
      if (placed_[other] && other != object) part(object, other);
    return;
  }
  const auto found = voxels_.find(voxel);
  std::vector<ObjectId>& here = found->second;
  *std::find(here.begin(), here.end(), object) = here.back();
  here.pop_back();
  for (const ObjectId other : here) part(object, other);
  if (here.empty()) voxels_.erase(found);
}

void BroadPhase::share(ObjectId a, ObjectId b)
{
  const std::uint64_t key = pairKey(a, b);
  const auto found = pairs_.find(key);
  if (found != pairs_.end()) {
    ++found->second->shared;
    return;
  }
  const std::optional<double> clearance = rules_->clearanceOf(a, b);
  if (!clearance) return;
  if (unused_.empty()) unused_.push_back(&pool_.emplace_back());
  BroadPair* pair = unused_.back();
  unused_.pop_back();
  *pair = {std::min(a, b), std::max(a, b), *clearance, 1, {}};
  pairs_.emplace(key, pair);
  places_[a].pairs.push_back(pair);
  places_[b].pairs.push_back(pair);
  is_sorted_ = false;
}

void BroadPhase::part(ObjectId a, ObjectId b)
{
  const auto found = pairs_.find(pairKey(a, b));
  if (found == pairs_.end() || --found->second->shared > 0) return;
  BroadPair* pair = found->second;
  for (const ObjectId object : {a, b}) {
    std::vector<BroadPair*>& list = places_[object].pairs;
    *std::find(list.begin(), list.end(), pair) = list.back();
    list.pop_back();
  }
  parted_.push_back(pair);
  pairs_.erase(found);
  is_sorted_ = false;
}

void BroadPhase::dropParted()
{
  unused_.insert(unused_.end(), parted_.begin(), parted_.end());
  parted_.clear();
}

const std::vector<BroadPair*>& BroadPhase::pairs()
{
  if (is_sorted_) return sorted_;
  sorted_.clear();
  for (const auto& entry : pairs_) sorted_.push_back(entry.second);
  std::sort(sorted_.begin(), sorted_.end(),
            [](const BroadPair* l, const BroadPair* r) { return pairKey(l->a, l->b) < pairKey(r->a, r->b); });
  is_sorted_ = true;
  return sorted_;
}

void BroadPhase::around(const Box3& box, std::vector<ObjectId>& objects) const
{
  objects.clear();
  if (box.empty()) return;
  if (voxelsOf(box) > static_cast<double>(placed_.size()) || !std::isfinite(edge_)) {
    for (ObjectId other = 0; other < placed_.size(); ++other)
      if (placed_[other]) objects.push_back(other);
    return;
  }
  const Range range = rangeOf(box);
  objects = everywhere_;
  for (std::int64_t x = range.low[0]; x <= range.high[0]; ++x)
    for (std::int64_t y = range.low[1]; y <= range.high[1]; ++y)
      for (std::int64_t z = range.low[2]; z <= range.high[2]; ++z) {
        const auto found = voxels_.find(keyOf(x, y, z));
        if (found != voxels_.end()) objects.insert(objects.end(), found->second.begin(), found->second.end());
      }
  std::sort(objects.begin(), objects.end());
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
}

void BroadPhase::forget(ObjectId object)
{
  for (BroadPair* pair : places_[object].pairs) {
    const bool near = pair->memory.near; // as the list of near pairs has it
    pair->memory = PairMemory();
    pair->memory.near = near;
  }
}

} // namespace pcl_bsh
