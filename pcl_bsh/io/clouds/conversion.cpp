// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/conversion.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>

#include <algorithm>
#include <cstring>

namespace pcl_bsh::io {

Conversion::Conversion(CloudFacts& facts, const ReadSettings& settings, const Eigen::AlignedBox3d& box)
: length_fields_(settings.length_fields)
{
  facts.coordinate_system = systemOf(settings, facts.coordinate_system, &facts.remarks);
  if (settings.transforms()) {
    transform_.emplace(facts.coordinate_system, settings.to_crs, box, facts.unit);
    facts.unit = transform_->unit();
    if (!transform_->isIdentity()) {
      facts.remarks.insert(facts.remarks.end(), transform_->remarks().begin(), transform_->remarks().end());
      if (settings.beams)
        facts.remarks.push_back("its beams without a return see nothing: their directions are not turned to '" +
                                transform_->target().name + "'");
      facts.coordinate_system = transform_->target();
      facts.las = nullptr;
    }
  }
  else {
    scale_ = scaleOf(settings, facts.unit, &facts.remarks);
    if (settings.unit) facts.unit = settings.unit;
    if (!scale_.isOne()) {
      facts.scale = scale_;
      facts.unit = settings.to_unit;
      facts.coordinate_system = {};
      facts.las = nullptr;
    }
  }
  if (!facts.las && !facts.coordinate_system.definition.empty())
    facts.las = std::make_shared<const LasHeader>(LasHeader{.system = facts.coordinate_system});
}

void Conversion::operator()(pcl::PCLPointCloud2& records, std::uint64_t first) const
{
  if (transform_) {
    transformPlaces(records, *transform_, first);
    for (const pcl::PCLPointField& field : records.fields) // they would point elsewhere
      if (isBeamField(field.name) && !transform_->isIdentity())
        for (std::size_t at = field.offset; at < records.data.size(); at += records.point_step)
          std::memset(&records.data[at], 0, sizeof(float));
  }
  else
    scaleLengths(records, scale_, length_fields_);
}

void Conversion::moveScanners(CloudFacts& facts) const
{
  const auto move = [&](Viewpoint& viewpoint) {
    if (!tellsPlace(viewpoint)) return;
    Point3 place = {viewpoint[0], viewpoint[1], viewpoint[2]};
    if (transform_)
      (*transform_)({&place, 1}, 0);
    else
      for (double& coordinate : place) coordinate = scale_(coordinate);
    std::copy(place.begin(), place.end(), viewpoint.begin());
  };
  if (isNothing()) return;
  move(facts.viewpoint);
  for (Viewpoint& scanner : facts.scanners) move(scanner);
}

void convert(pcl::PCLPointCloud2& cloud, CloudFacts& facts, const ReadSettings& settings)
{
  Eigen::AlignedBox3d box;
  if (settings.transforms()) extendBy(cloud, box);
  const Conversion conversion(facts, settings, box);
  conversion(cloud);
  conversion.moveScanners(facts);
}

void convertHeader(pcl::PCLPointCloud2& header, const CloudFacts& told, const ReadSettings& settings)
{
  CloudFacts facts = told;
  const Conversion possible(facts, settings, {});
  if (settings.transforms())
    makeCoordinatesDouble(header);
  else
    possible(header);
}

} // namespace pcl_bsh::io
