// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/poses/waypoints.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

namespace pcl_bsh::io {
namespace {

constexpr double most_poses = 1e7;
constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr auto first_word = "waypoints";
constexpr auto forms_of_a_step =
    "give `waypoints LENGTH DEGREES`, the largest step from a pose to the next, both finite and > 0";
constexpr auto forms_of_a_waypoint =
    "give x y z heading, the heading in degrees, and turn or arc where its way is no line";

Waypoint::Way wayOf(std::string_view word, const TextCursor& line)
{
  if (word == "turn") return Waypoint::Way::turn;
  if (word == "arc") return Waypoint::Way::arc;
  line.fail("has '" + std::string(word) + "', which is no way", forms_of_a_waypoint);
}

/// The poses from one waypoint to the next, without the first.
class Leg {
public:
  Leg(const Waypoint& from, const Waypoint& to, double turn) : from_(from), to_(to), turn_(turn) {}

  /// @return how many steps; a whole number
  double steps(const LargestStep& step) const
  {
    return std::ceil(std::max(length() / step.length, std::abs(turn_) / step.degrees));
  }

  Eigen::Isometry3d pose(double fraction) const
  {
    const Eigen::Vector3d line = to_.place - from_.place;
    Eigen::Vector3d moved = fraction * line;
    if (const double half = halfTurnOfArc(); half != 0.0) { // the chord from the first pose to this one
      const double share = std::sin(fraction * half) / std::sin(half), beside = (fraction - 1.0) * half;
      moved.head<2>() = share * (Eigen::Rotation2Dd(beside) * Eigen::Vector2d(line.head<2>()));
    }
    return placeAt(from_.place + moved, from_.heading + fraction * turn_);
  }

private:
  /// In radians; 0 where the way is a line.
  double halfTurnOfArc() const { return to_.way == Waypoint::Way::arc ? 0.5 * turn_ * degree : 0.0; }

  double length() const
  {
    const Eigen::Vector3d line = to_.place - from_.place;
    const double half = halfTurnOfArc(), longer = half == 0.0 ? 1.0 : half / std::sin(half);
    return std::hypot(longer * line.head<2>().norm(), line.z());
  }

  const Waypoint& from_;
  const Waypoint& to_;
  double turn_; ///< in degrees
};

} // namespace

Eigen::Isometry3d placeAt(const Eigen::Vector3d& place, double heading)
{
  const double beside = std::remainder(heading, 90.0), quarters = std::round((heading - beside) / 90.0);
  const auto quarter = static_cast<std::size_t>(std::fmod(std::fmod(quarters, 4.0) + 4.0, 4.0));
  const double rest = beside * degree;
  const double c = std::cos(rest), s = std::sin(rest);
  const double cosines[] = {c, -s, -c, s}, sines[] = {s, c, -s, -c};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().topLeftCorner<2, 2>() << cosines[quarter], -sines[quarter], sines[quarter], cosines[quarter];
  pose.translation() = place;
  return pose;
}

bool areWaypoints(std::string_view text)
{
  TextCursor cursor(text, '#');
  if (!cursor.nextLine()) return false;
  cursor.separateBy(separatorOf(cursor.line()));
  return cursor.word() == first_word;
}

WaypointPath parseWaypoints(std::string_view text)
{
  WaypointPath path;
  TextCursor cursor(text, '#');
  const auto read = [&](std::initializer_list<double*> numbers, const char* remedy) {
    for (double* const number : numbers) {
      if (cursor.line().empty()) cursor.fail("has too few numbers", remedy);
      *number = cursor.number<double>();
      if (!std::isfinite(*number)) cursor.fail("has a number that is not finite", remedy);
    }
  };
  for (bool first = true; cursor.nextLine(); first = false) {
    cursor.separateBy(separatorOf(cursor.line()));
    if (first) {
      cursor.word();
      read({&path.step.length, &path.step.degrees}, forms_of_a_step);
      if (!(path.step.length > 0.0 && path.step.degrees > 0.0)) cursor.fail("has no largest step", forms_of_a_step);
      cursor.requireEndOfLine();
      continue;
    }
    Waypoint next;
    read({&next.place[0], &next.place[1], &next.place[2], &next.heading}, forms_of_a_waypoint);
    if (!cursor.line().empty()) next.way = wayOf(cursor.word(), cursor);
    cursor.requireEndOfLine();
    path.way.push_back(next);
  }
  if (path.way.empty()) throw FormatError("holds no waypoint", forms_of_a_waypoint);
  return path;
}

std::vector<Eigen::Isometry3d> posesAlong(const WaypointPath& path)
{
  const std::vector<Waypoint>& way = path.way;
  std::vector<Eigen::Isometry3d> poses;
  const auto add = [&poses, &step = path.step](const Leg& leg, const Waypoint& end) {
    const double steps = leg.steps(step);
    if (!(static_cast<double>(poses.size()) + steps <= most_poses))
      throw FormatError("has more than ten million poses", "give a larger step");
    for (double k = 1.0; k < steps; ++k) poses.push_back(leg.pose(k / steps));
    if (steps > 0.0) poses.push_back(placeAt(end.place, end.heading));
  };
  for (const Waypoint& to : way) {
    if (poses.empty()) {
      poses.push_back(placeAt(to.place, to.heading));
      continue;
    }
    const Waypoint& from = *(&to - 1);
    const double turn = std::remainder(to.heading - from.heading, 360.0);
    if (std::abs(turn) > 180.0 - 1e-9) {
      throw FormatError("has waypoint " + std::to_string(&to - way.data()) + " half a turn from the one before",
                        "add one between them, which tells which way round");
    }
    if (to.way != Waypoint::Way::turn) {
      add({from, to, turn}, to);
      continue;
    }
    Waypoint turned = to;
    turned.place = from.place;
    add({from, turned, turn}, turned);
    add({turned, to, 0.0}, to);
  }
  return poses;
}

} // namespace pcl_bsh::io
