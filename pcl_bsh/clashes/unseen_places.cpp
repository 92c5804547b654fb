// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/unseen_places.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/hierarchy/record_corners.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace pcl_bsh {
namespace {

/// Calls visit(pose, corners) for each record that is unseen there, with its corners as placed.
template <class Visit>
void eachUnseen(const UnseenAlong& along, const Visit& visit)
{
  for (std::size_t k = 0; k < along.unseen.size(); ++k) {
    for (std::size_t i = 0; i < along.unseen[k].size(); ++i) {
      if (!along.unseen[k][i]) continue;
      Corners corners = cornersOf(along.model, static_cast<std::uint32_t>(i));
      for (std::uint32_t c = 0; c < corners.count; ++c) {
        const Eigen::Vector3d at = along.poses[k] * Eigen::Vector3d(corners.at[c].data());
        corners.at[c] = {at.x() + 0.0, at.y() + 0.0, at.z() + 0.0};
      }
      visit(k, corners);
    }
  }
}

/// Cells of a grid, joined.
class Cells {
public:
  explicit Cells(double edge) : edge_(edge) {}

  std::uint32_t at(const Point3& place)
  {
    Key key;
    for (std::size_t k = 0; k < 3; ++k) key[k] = std::floor(place[k] / edge_);
    const auto [found, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(parent_.size()));
    if (fresh) parent_.push_back(found->second);
    return found->second;
  }

  void join(std::uint32_t a, std::uint32_t b)
  {
    a = rootOf(a);
    b = rootOf(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  void joinNeighbors()
  {
    for (const auto& [key, number] : numbers_) {
      for (int n = 0; n < 13; ++n) { // the other thirteen come from the other side
        const auto found = numbers_.find({key[0] + n / 9 - 1, key[1] + n / 3 % 3 - 1, key[2] + n % 3 - 1});
        if (found != numbers_.end()) join(number, found->second);
      }
    }
  }

  std::uint32_t rootOf(std::uint32_t cell)
  {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }

  std::size_t size() const { return parent_.size(); }

private:
  using Key = std::array<double, 3>;
  double edge_;
  std::map<Key, std::uint32_t> numbers_;
  std::vector<std::uint32_t> parent_;
};

} // namespace

std::vector<Clash> findUnseenPlaces(const UnseenAlong& along, double cluster_distance)
{
  if (!(std::isfinite(cluster_distance) && cluster_distance > 0.0)) {
    throw InvalidInput(Input::cluster_distance, "cluster distance", plainText(cluster_distance),
                       "give a finite length > 0")
        .withValue(cluster_distance);
  }
  Cells cells(std::exp2(std::ceil(std::log2(cluster_distance))));
  eachUnseen(along, [&](std::size_t, const Corners& corners) {
    const std::uint32_t first = cells.at(corners.at[0]);
    for (std::uint32_t c = 1; c < corners.count; ++c) cells.join(first, cells.at(corners.at[c]));
  });
  cells.joinNeighbors();

  std::vector<Clash> places;
  std::vector<std::size_t> at_pose; // of each place, unseen records of the pose that is counted
  std::vector<std::uint32_t> place_of(cells.size(), kNothing);
  const auto countPose = [&](std::size_t pose) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (at_pose[i] > places[i].points) {
        places[i].points = at_pose[i];
        places[i].closest_pose = static_cast<std::int32_t>(pose);
      }
      at_pose[i] = 0;
    }
  };
  std::size_t pose = 0;
  eachUnseen(along, [&](std::size_t k, const Corners& corners) {
    if (k != pose) countPose(pose);
    pose = k;
    std::uint32_t& number = place_of[cells.rootOf(cells.at(corners.at[0]))];
    if (number == kNothing) {
      number = static_cast<std::uint32_t>(places.size());
      Clash place;
      place.status = ClashStatus::unseen;
      place.low = place.high = corners.at[0];
      place.distance = std::numeric_limits<double>::quiet_NaN();
      place.first_pose = static_cast<std::int32_t>(k);
      places.push_back(std::move(place));
      at_pose.push_back(0);
    }
    ++at_pose[number];
    Extent box{places[number].low, places[number].high};
    for (std::uint32_t c = 0; c < corners.count; ++c) box.add({corners.at[c], corners.at[c]});
    places[number].low = box.low;
    places[number].high = box.high;
  });
  countPose(pose);
  nameUnseenPlaces(places, cluster_distance);
  return places;
}

void tellUnseen(FormerPlaces& former, const UnseenAlong& along)
{
  eachUnseen(along, [&](std::size_t, const Corners& corners) {
    Extent box{corners.at[0], corners.at[0]};
    for (std::uint32_t c = 1; c < corners.count; ++c) box.add({corners.at[c], corners.at[c]});
    former.unsee(box);
  });
}

} // namespace pcl_bsh
