// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/triangle_answers.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/counted.h>

#include <cmath>
#include <tuple>

namespace pcl_bsh {

namespace {

void requireApart(const SurfaceCover& cover)
{
  if (cover.triangles_apart) return;
  throw InvalidInput(Input::surface, "surface", "its balls hold parts of several triangles each",
                     "cover it with triangles_apart to ask about triangles");
}

void requireOnePerBall(const SurfaceCover& cover, const char* what, std::size_t count)
{
  if (count == cover.centers.size()) return;
  throw InvalidInput(Input::result, what, counted(count, "value") + " for " + counted(cover.centers.size(), "ball"),
                     "give those of a query about this cover, all of them");
}

void requireVerdict(Verdict verdict, std::size_t ball)
{
  if (verdict <= Verdict::sparse) return;
  throw InvalidInput(Input::result, "verdicts",
                     plainText(static_cast<int>(verdict), " of ball ", ball, " is no verdict"))
      .withIndex(ball);
}

template <typename Distance>
std::vector<std::uint32_t> nearestOf(const SurfaceCover& cover, const std::vector<Distance>& distances,
                                     const std::vector<std::int32_t>& closest_poses)
{
  requireApart(cover);
  requireOnePerBall(cover, "distances", distances.size());
  if (!closest_poses.empty()) requireOnePerBall(cover, "closest poses", closest_poses.size());
  const auto measure = [&](std::uint32_t ball) {
    return std::tuple(distances[ball], closest_poses.empty() ? 0 : closest_poses[ball]);
  };
  std::vector<std::uint32_t> nearest(cover.triangle_count, kNothing);
  for (std::uint32_t ball = 0; ball < distances.size(); ++ball) {
    std::uint32_t& best = nearest[cover.triangles[ball]];
    if (std::isnan(distances[ball])) continue;
    if (best == kNothing || measure(ball) < measure(best)) best = ball;
  }
  return nearest;
}

} // namespace

std::vector<Verdict> triangleVerdicts(const SurfaceCover& cover, const std::vector<Verdict>& ball_verdicts)
{
  requireApart(cover);
  requireOnePerBall(cover, "verdicts", ball_verdicts.size());
  std::vector<Verdict> verdicts(cover.triangle_count, Verdict::free);
  for (std::size_t ball = 0; ball < ball_verdicts.size(); ++ball) {
    requireVerdict(ball_verdicts[ball], ball);
    Verdict& verdict = verdicts[cover.triangles[ball]];
    verdict = graver(verdict, ball_verdicts[ball]);
  }
  return verdicts;
}

std::vector<std::uint32_t> nearestBalls(const SurfaceCover& cover, const std::vector<double>& distances,
                                        const std::vector<std::int32_t>& closest_poses)
{
  return nearestOf(cover, distances, closest_poses);
}

std::vector<std::uint32_t> nearestBalls(const SurfaceCover& cover, const std::vector<float>& distances,
                                        const std::vector<std::int32_t>& closest_poses)
{
  return nearestOf(cover, distances, closest_poses);
}

std::vector<std::int32_t> triangleFirstPoses(const SurfaceCover& cover, const std::vector<std::int32_t>& first_poses)
{
  requireApart(cover);
  requireOnePerBall(cover, "first poses", first_poses.size());
  std::vector<std::int32_t> first(cover.triangle_count, -1);
  for (std::size_t ball = 0; ball < first_poses.size(); ++ball) {
    std::int32_t& pose = first[cover.triangles[ball]];
    if (first_poses[ball] >= 0 && (pose < 0 || first_poses[ball] < pose)) pose = first_poses[ball];
  }
  return first;
}

} // namespace pcl_bsh
