// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/depths/queried_part.h>

#include <unordered_map>
#include <utility>

namespace pcl_bsh {

QueriedPart::QueriedPart(const SphereHierarchy& thing, std::vector<std::uint32_t> records)
: records_(std::move(records))
{
  const PointsView& view = thing.view();
  const auto places = [&] { return viewOf(places_.empty() ? nullptr : places_.front().data(), places_.size()); };
  PointsView own;
  if (view.triangles) {
    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (const std::uint32_t record : records_) {
      Triangle corners = view.triangles->cornersOf(record);
      for (std::uint32_t& corner : corners) {
        const auto [at, is_new] = numbers.try_emplace(corner, static_cast<std::uint32_t>(places_.size()));
        if (is_new) places_.push_back(view.triangles->vertices.point(corner));
        corner = at->second;
      }
      corners_.push_back(corners);
    }
    triangles_ = {places(), corners_.empty() ? nullptr : corners_.front().data(), corners_.size()};
    own = viewOf(triangles_);
  }
  else {
    for (const std::uint32_t record : records_) {
      places_.push_back(view.point(record));
      if (view.areBalls()) radii_.push_back(view.radii[record]);
    }
    own = places();
    if (view.areBalls()) own.radii = radii_.data();
  }
  own.uncertainty = view.uncertainty;
  if (view.uncertainties) {
    for (const std::uint32_t record : records_) uncertainties_.push_back(view.uncertainties[record]);
    own.uncertainties = uncertainties_.data();
  }
  hierarchy_.emplace(own);
  queried_.emplace(*hierarchy_);
}

std::vector<Point3> QueriedPart::placesOf(std::uint32_t record) const
{
  if (!queried_->isSurface()) return {places_[record]};
  const Triangle& t = corners_[record];
  return {places_[t[0]], places_[t[1]], places_[t[2]]};
}

} // namespace pcl_bsh
