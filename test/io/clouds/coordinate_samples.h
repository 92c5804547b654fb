// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>

#include <array>
#include <cmath>

namespace pcl_bsh::io {

/// EPSG:25833 as old WKT, without codes.
inline constexpr auto utm_33_wkt =
    "PROJCS[\"ETRS89 / UTM zone 33N\",GEOGCS[\"ETRS89\",DATUM[\"European_Terrestrial_Reference_System_1989\","
    "SPHEROID[\"GRS 1980\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
    "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",15],"
    "PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],"
    "UNIT[\"metre\",1],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]]";

/// East and north in a zone of UTM by the series of Krueger (1912) to the fourth power of n, on an ellipsoid of 6378137
/// m: within 1e-5 m near the zone. Angles in degrees.
inline std::array<double, 2> utmOf(double longitude, double latitude, double meridian, double inverse_flattening)
{
  const double degree = std::acos(-1.0) / 180, f = 1 / inverse_flattening, n = f / (2 - f), n2 = n * n, n3 = n2 * n,
               n4 = n2 * n2;
  const double radius = 6378137 / (1 + n) * (1 + n2 / 4 + n4 / 64), e = 2 * std::sqrt(n) / (1 + n);
  const std::array<double, 4> alpha = {n / 2 - 2 * n2 / 3 + 5 * n3 / 16 + 41 * n4 / 180,
                                       13 * n2 / 48 - 3 * n3 / 5 + 557 * n4 / 1440, 61 * n3 / 240 - 103 * n4 / 140,
                                       49561 * n4 / 161280};
  const double s = std::sin(latitude * degree), across = (longitude - meridian) * degree;
  const double t = std::sinh(std::atanh(s) - e * std::atanh(e * s));
  const double xi = std::atan2(t, std::cos(across)), eta = std::atanh(std::sin(across) / std::sqrt(1 + t * t));
  double north = xi, east = eta;
  for (std::size_t j = 0; j < alpha.size(); ++j) {
    const double k = 2.0 * static_cast<double>(j + 1);
    north += alpha[j] * std::sin(k * xi) * std::cosh(k * eta);
    east += alpha[j] * std::cos(k * xi) * std::sinh(k * eta);
  }
  return {500000 + 0.9996 * radius * east, 0.9996 * radius * north};
}

} // namespace pcl_bsh::io
