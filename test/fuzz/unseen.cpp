// SPDX-License-Identifier: BSD-3-Clause
// Any scans, and any model in them: unseen parts, against brute force. The bytes are also read as texts of options.
#include "bytes.h"
#include "refusal.h"

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/scan_origins.h>
#include <pcl_bsh/seen/unseen_points.h>

#include "support/brute_force/unseen.h"

#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh::fuzz {
namespace {

/// Small numbers mostly, and any.
double number(Bytes& bytes)
{
  const unsigned kind = bytes.below(32);
  if (kind == 0) return bytes.take<double>();
  if (kind == 1) return bytes.take<float>();
  return static_cast<double>(bytes.take<std::int8_t>()) / (kind < 16 ? 16.0 : 7.0);
}

std::vector<double> places(Bytes& bytes, unsigned most)
{
  std::vector<double> xyz(3 * bytes.below(most));
  for (double& x : xyz) x = number(bytes);
  return xyz;
}

/// Beams in rows and columns about the origin: places alone seldom leave no hole.
void addGrid(Bytes& bytes, const Point3& origin, std::vector<double>& xyz)
{
  const double range = 0.25 * (1 + bytes.below(40)), step = 0.15 + 0.05 * bytes.below(4);
  const double lowest = bytes.below(2) == 0 ? -1.57 : -0.5;
  for (double elevation = lowest; elevation <= 1.57; elevation += step) {
    for (double azimuth = 0.0; azimuth < 6.28; azimuth += step) {
      xyz.push_back(origin[0] + range * std::cos(elevation) * std::cos(azimuth));
      xyz.push_back(origin[1] + range * std::cos(elevation) * std::sin(azimuth));
      xyz.push_back(origin[2] + range * std::sin(elevation));
    }
  }
}

void compareAnswers(Bytes bytes)
{
  std::vector<std::vector<double>> returns(1 + bytes.below(3)), misses(returns.size());
  std::vector<ScanBeams> scans(returns.size());
  for (std::size_t s = 0; s < scans.size(); ++s) {
    ScanBeams& scan = scans[s];
    for (double& x : scan.origin) x = number(bytes);
    if (bytes.below(4) != 0) addGrid(bytes, scan.origin, returns[s]);
    for (const double x : places(bytes, 12)) returns[s].push_back(x);
    misses[s] = places(bytes, 6);
    scan.returns = viewOf(returns[s].data(), returns[s].size() / 3);
    scan.misses = viewOf(misses[s].data(), misses[s].size() / 3);
    if (bytes.below(4) == 0) scan.misses_beyond = number(bytes);
    if (bytes.below(4) == 0) scan.returns.uncertainty = number(bytes);
  }
  SeenOptions options;
  options.angle = bytes.below(8) == 0 ? number(bytes) : 0.13 + 0.03 * bytes.below(5);
  if (std::isfinite(*options.angle) && *options.angle < 0.1) return; // too many cells for brute force, or refused
  const std::vector<double> model = places(bytes, 40);
  std::vector<float> radii(model.size() / 3);
  PointsView view = viewOf(model.data(), radii.size());
  if (bytes.below(4) == 0) {
    for (float& radius : radii) radius = static_cast<float>(bytes.below(8)) / 16.0f;
    view.radii = radii.data();
  }
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1 * bytes.below(63), Eigen::Vector3d(1, 2, 3).normalized()));
  for (Eigen::Index k = 0; k < 3; ++k) pose.translation()[k] = number(bytes);
  std::vector<std::uint32_t> corners;
  TrianglesView triangles;
  if (!view.radii && view.count > 0 && bytes.below(4) == 0) {
    for (unsigned i = 3 * (1 + bytes.below(6)); i > 0; --i)
      corners.push_back(static_cast<std::uint32_t>(bytes.below(static_cast<unsigned>(view.count))));
    triangles.vertices = view;
    triangles.corners = corners.data();
    triangles.count = corners.size() / 3;
  }
  UnseenRequest request;
  request.clearance = std::abs(number(bytes)) / 4.0;
  std::vector<Verdict> verdicts(radii.size(), Verdict::free), expected = verdicts;
  std::string refusal, expected_refusal;
  try {
    if (triangles.count > 0) {
      view = viewOf(triangles);
      verdicts.assign(triangles.count, Verdict::free);
      expected = verdicts;
    }
    const SphereHierarchy hierarchy(view);
    markUnseen(SeenSpace(scans, options), {hierarchy, pose}, request, verdicts);
  }
  catch (const InvalidInput& error) {
    requireReason(error);
    return;
  }
  brute_force::markUnseen(scans, *options.angle, {SphereHierarchy(view), pose}, request, expected);
  require(verdicts == expected, "other points are unseen than brute force says");
}

template <typename T>
void readText(const std::string& text)
{
  try {
    const T read = T::parse(text);
    require(T::parse(read.text()) == read, "an option that is another when read again");
  }
  catch (const InvalidInput& error) {
    require(std::string(error.what()).find(": ") != std::string::npos, "a refusal without a reason");
  }
}

} // namespace
} // namespace pcl_bsh::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::readText<ScanOrigins>(text);
  fuzz::readText<PoseUncertainty>(text);
  fuzz::compareAnswers({data, size});
  return 0;
}
