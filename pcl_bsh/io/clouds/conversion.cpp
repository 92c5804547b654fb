// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/conversion.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/systems/system_transform.h>

#include <algorithm>

namespace pcl_bsh::io {
namespace {

/// Changes where a file's scanners stood; a viewpoint at the origin says that it is not known.
template <typename Change>
void moveScanners(CloudFacts& facts, const Change& change)
{
  const auto move = [&](Viewpoint& viewpoint) {
    Point3 place = {viewpoint[0], viewpoint[1], viewpoint[2]};
    if (place == Point3{}) return;
    change(place);
    std::copy(place.begin(), place.end(), viewpoint.begin());
  };
  move(facts.viewpoint);
  for (Viewpoint& scanner : facts.scanners) move(scanner);
}

/// Coordinates in the system that is wanted. @pre facts have the file's own
void transform(pcl::PCLPointCloud2& cloud, CloudFacts& facts, const std::string& wanted)
{
  Eigen::AlignedBox3d box;
  extendBy(cloud, box);
  const SystemTransform way(facts.coordinate_system, wanted, box, facts.unit);
  transformPlaces(cloud, way);
  facts.unit = way.unit();
  if (way.isIdentity()) return;
  moveScanners(facts, [&](Point3& place) { way({&place, 1}, 0); });
  facts.remarks.insert(facts.remarks.end(), way.remarks().begin(), way.remarks().end());
  facts.coordinate_system = way.target();
  facts.las = nullptr;
}

} // namespace

void convert(pcl::PCLPointCloud2& cloud, CloudFacts& facts, const ReadSettings& settings)
{
  facts.coordinate_system = systemOf(settings, facts.coordinate_system, &facts.remarks);
  if (settings.transforms()) return transform(cloud, facts, settings.to_crs);
  const LengthScale scale = scaleOf(settings, facts.unit, &facts.remarks);
  if (settings.unit) facts.unit = settings.unit;
  if (scale.isOne()) return;
  facts.scale = scale;
  scaleLengths(cloud, scale, settings.length_fields);
  moveScanners(facts, [&](Point3& place) {
    for (double& coordinate : place) coordinate = scale(coordinate);
  });
  facts.unit = settings.to_unit;
  facts.las = nullptr;
  facts.coordinate_system = {};
}

void convertHeader(pcl::PCLPointCloud2& header, const CloudFacts& told, const ReadSettings& settings)
{
  const CoordinateSystem system = systemOf(settings, told.coordinate_system);
  if (!settings.transforms()) return scaleLengths(header, scaleOf(settings, told.unit), settings.length_fields);
  const SystemTransform possible(system, settings.to_crs, {}, told.unit);
  makeCoordinatesDouble(header);
}

} // namespace pcl_bsh::io
