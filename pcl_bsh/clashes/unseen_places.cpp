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

/// Unseen parts of a record at a pose, as placed.
struct UnseenRecord {
  std::size_t pose;
  bool in_shadow;              ///< some of it
  std::vector<Corners> places; ///< a point; a triangle, or boxes about its parts by two of their corners
  std::vector<bool> shadow;    ///< of each
};

Corners ends(const UnseenPart& part)
{
  Corners corners = Corners::of(part.low);
  corners.at[1] = part.high;
  corners.count = 2;
  return corners;
}

/// Calls visit(record) for each record that is unseen at a pose.
template <class Visit>
void eachUnseen(const UnseenAlong& along, const Visit& visit)
{
  static const UnseenKinds none;
  for (std::size_t k = 0; k < along.unseen.size(); ++k) {
    const UnseenKinds& kinds = along.kinds && k < along.kinds->size() ? (*along.kinds)[k] : none;
    auto part = kinds.parts.begin();
    for (std::size_t i = 0; i < along.unseen[k].size(); ++i) {
      if (!along.unseen[k][i]) continue;
      UnseenRecord record{k, kinds.in_shadow.empty() || kinds.in_shadow[i], {}, {}};
      while (part != kinds.parts.end() && part->record < i) ++part;
      for (; part != kinds.parts.end() && part->record == i; ++part) {
        record.places.push_back(ends(*part));
        record.shadow.push_back(part->in_shadow);
      }
      if (record.places.empty()) {
        Corners corners = cornersOf(along.model, static_cast<std::uint32_t>(i));
        for (std::uint32_t c = 0; c < corners.count; ++c) {
          const Eigen::Vector3d at = along.poses[k] * Eigen::Vector3d(corners.at[c].data());
          corners.at[c] = {at.x() + 0.0, at.y() + 0.0, at.z() + 0.0};
        }
        record.places = {corners};
        record.shadow = {record.in_shadow};
      }
      visit(record);
    }
  }
}

Extent boxOf(const Corners& corners)
{
  Extent box{corners.at[0], corners.at[0]};
  for (std::uint32_t c = 1; c < corners.count; ++c) box.add({corners.at[c], corners.at[c]});
  return box;
}

bool touch(const Extent& a, const Extent& b)
{
  for (std::size_t k = 0; k < 3; ++k)
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  return true;
}

/// Cells of a grid, joined into sets (union-find).
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
  eachUnseen(along, [&](const UnseenRecord& record) {
    std::vector<Extent> boxes;
    for (const Corners& corners : record.places) {
      const std::uint32_t first = cells.at(corners.at[0]);
      for (std::uint32_t c = 1; c < corners.count; ++c) cells.join(first, cells.at(corners.at[c]));
      boxes.push_back(boxOf(corners));
      for (std::size_t i = 0; i + 1 < boxes.size(); ++i)
        if (touch(boxes[i], boxes.back())) cells.join(first, cells.at(record.places[i].at[0]));
    }
  });
  cells.joinNeighbors();

  std::vector<Clash> places;
  struct AtPose {                                     // of each place, unseen records of the pose that is counted
    std::size_t records = 0, in_shadow = 0, last = 0; ///< the last one's number, from 1
  };
  std::vector<AtPose> at_pose;
  std::vector<std::uint32_t> place_of(cells.size(), kNothing);
  const auto countPose = [&](std::size_t pose) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (at_pose[i].records > places[i].points) {
        places[i].points = at_pose[i].records;
        places[i].points_in_shadow = at_pose[i].in_shadow;
        places[i].closest_pose = static_cast<std::int32_t>(pose);
      }
      at_pose[i] = {};
    }
  };
  std::size_t pose = 0, number_of_record = 0;
  eachUnseen(along, [&](const UnseenRecord& record) {
    if (record.pose != pose) countPose(pose);
    pose = record.pose;
    ++number_of_record;
    for (const bool in_shadow : {true, false}) { // a record with both counts as in shadow
      for (std::size_t p = 0; p < record.places.size(); ++p) {
        if (record.shadow[p] != in_shadow) continue;
        const Corners& corners = record.places[p];
        std::uint32_t& number = place_of[cells.rootOf(cells.at(corners.at[0]))];
        const Extent box = boxOf(corners);
        if (number == kNothing) {
          number = static_cast<std::uint32_t>(places.size());
          Clash place;
          place.status = ClashStatus::unseen;
          place.low = box.low;
          place.high = box.high;
          place.distance = std::numeric_limits<double>::quiet_NaN();
          place.first_pose = static_cast<std::int32_t>(pose);
          places.push_back(std::move(place));
          at_pose.emplace_back();
        }
        AtPose& counted = at_pose[number];
        if (counted.last != number_of_record) {
          counted.last = number_of_record;
          ++counted.records;
          counted.in_shadow += in_shadow ? 1 : 0;
        }
        Extent all{places[number].low, places[number].high};
        all.add(box);
        places[number].low = all.low;
        places[number].high = all.high;
      }
    }
  });
  countPose(pose);
  nameUnseenPlaces(places, cluster_distance);
  return places;
}

void tellUnseen(FormerPlaces& former, const UnseenAlong& along)
{
  eachUnseen(along, [&](const UnseenRecord& record) {
    for (std::size_t p = 0; p < record.places.size(); ++p)
      if (record.shadow[p]) former.unsee(boxOf(record.places[p]));
  });
}

} // namespace pcl_bsh
