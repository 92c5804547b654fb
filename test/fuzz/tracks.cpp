// SPDX-License-Identifier: BSD-3-Clause
// Any text as an axis (elements, LandXML, points) and as an outline (DXF, columns). It is refused with a reason, or the
// axis has finite places and finds them again, and the outline's corners lie on it.
#include "refusal.h"

#include <pcl_bsh/io/tracks/axis_file.h>
#include <pcl_bsh/io/tracks/number_table.h>
#include <pcl_bsh/io/tracks/profile_file.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace pcl_bsh;

double planDistance(const Point3& a, const Point3& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

void requireLine(const Axis& axis)
{
  fuzz::require(std::isfinite(axis.length()) && axis.length() > 0.0, "an axis without a length");
  const AxisReach reach{std::min(10.0, 0.5 * axis.smallestRadius()), 5.0, 15.0};
  axis.requireReach(reach);
  for (const double share : {0.0, 0.3, 0.5, 1.0}) {
    const double distance = share * axis.length();
    const AxisFrame frame = axis.frame(distance);
    fuzz::require(isFinite(frame.origin) && isFinite(frame.along) && isFinite(frame.right) && isFinite(frame.up),
                  "a place that is not finite");
    fuzz::require(std::abs(std::hypot(frame.along[0], frame.along[1]) - 1.0) < 1e-9, "a direction of another length");
    const AxisPlaces found = axis.nearest(frame.origin, reach);
    const double size = axis.length() + std::hypot(frame.origin[0], frame.origin[1], frame.origin[2]);
    // Rounding may put an end beyond the axis, and a place of a vast one out of reach.
    const bool is_end = share == 0.0 || share == 1.0, is_vast = !(size < 1e8);
    fuzz::require(is_end || is_vast || hasPlace(found.state), "a place of the axis is not found");
    if (hasPlace(found.state))
      fuzz::require(found.best.distance >= 0.0 && found.best.distance <= axis.length(), "a place beyond the axis");
    if (is_end || is_vast) continue;
    fuzz::require(planDistance(axis.frame(found.best.distance).origin, frame.origin) <= 1e-9 * (1.0 + size),
                  "a place of the axis is not found again");
  }
}

void requireOutline(const std::vector<SectionPoint>& read)
{
  const std::vector<SectionPoint> outline = simplePolygon(read);
  for (const SectionPoint& corner : outline)
    fuzz::require(signedDistance(outline, corner) == 0.0, "a corner that is not on its outline");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> remarks;
  fuzz::mayRefuse([&] { requireLine(Axis(io::parseElements(text))); });
  fuzz::mayRefuse([&] { requireLine(Axis(io::parseLandXml(text, {}, remarks))); });
  fuzz::mayRefuse([&] {
    const io::NumberTable table =
        io::numberTable(text, {{{"chainage"}}, io::x_column, io::y_column, io::z_column}, false);
    std::vector<AxisPoint> points;
    for (const std::vector<double>& row : table.rows) points.push_back({row[0], {row[1], row[2], row[3]}, 0.0});
    fuzz::mayRefuse([&] { requireLine(Axis::through(points)); });
    requireLine(Axis::fitted(points, 0.05));
  });
  fuzz::mayRefuse([&] {
    std::optional<double> unit;
    requireOutline(io::parseDxf(text, unit, remarks));
  });
  fuzz::mayRefuse([&] {
    std::vector<SectionPoint> corners;
    for (const std::vector<double>& row : io::numberTable(text, {{{"offset"}}, {{"height"}}}, true).rows)
      corners.push_back({row[0], row[1]});
    requireOutline(corners);
  });
  return 0;
}
