// SPDX-License-Identifier: BSD-3-Clause
// Seen and unseen places, against the definition of seen_space.h in numbers of 50 digits, beam by beam. Whether beams
// lie round a direction is tried in many directions of each cone. Shares no code with either form of markUnseen().
#include <pcl_bsh/seen/seen_space.h>
#include <pcl_bsh/seen/unseen_points.h>

#include "support/brute_force/unseen.h"
#include "support/made_scans.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using Number = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using Vector = std::array<Number, 3>;

Number dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Number length(const Vector& a)
{
  return sqrt(dot(a, a));
}

Vector difference(const Point3& a, const Point3& b)
{
  return {Number(a[0]) - b[0], Number(a[1]) - b[1], Number(a[2]) - b[2]};
}

Eigen::Vector3d unitOf(const Vector& way)
{
  const Number size = length(way);
  return {static_cast<double>(way[0] / size), static_cast<double>(way[1] / size), static_cast<double>(way[2] / size)};
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Whether beams lie round a direction: of those from `least` to `most` radians from it no two neighbours are farther
/// apart than `gap`, as seen from it.
bool areRound(const std::vector<Eigen::Vector3d>& beams, const Eigen::Vector3d& at, double least, double most,
              double gap)
{
  const Eigen::Vector3d side = at.unitOrthogonal(), up = at.cross(side);
  std::vector<double> turns;
  for (const Eigen::Vector3d& beam : beams) {
    const double off = angleBetween(beam, at);
    if (least <= off && off <= most) turns.push_back(std::atan2(beam.dot(up), beam.dot(side)));
  }
  if (turns.empty()) return false;
  std::sort(turns.begin(), turns.end());
  double widest = turns.front() + 2.0 * test::kPi - turns.back();
  for (std::size_t i = 1; i < turns.size(); ++i) widest = std::max(widest, turns[i] - turns[i - 1]);
  return widest <= gap;
}

/// How far the answer may be off: nothing is, or what not seen allows.
struct Tolerance {
  double length = 0.0;
  bool ample = false; ///< only where many beams lie round a direction it must be seen
};

class Definition {
public:
  Definition(const ScanBeams& scan, double angle) : origin_(scan.origin), angle_(angle)
  {
    const auto add = [&](const PointsView& view, bool returned) {
      for (std::size_t i = 0; i < view.size(); ++i) {
        const std::uint32_t record = view.record(i);
        const Point3 end = view.point(record);
        if (!isFinite(end) || end == scan.origin) continue;
        Beam beam{difference(end, scan.origin), 0, 0, {}};
        beam.range = length(beam.way);
        beam.empty = returned ? Number(beam.range - view.uncertainty) : Number(scan.misses_beyond);
        beam.direction = unitOf(beam.way);
        directions_.push_back(beam.direction);
        beams_.push_back(beam);
      }
    };
    add(scan.returns, true);
    if (scan.misses_beyond > 0.0) add(scan.misses, false);
  }

  bool sees(const Point3& place, double ball, const Tolerance& tolerance)
  {
    if (beams_.size() < 3) return false;
    const Vector way = difference(place, origin_);
    const Number distance = length(way), radius = Number(ball) + tolerance.length;
    const bool around = distance <= radius;
    const Eigen::Vector3d axis = around ? Eigen::Vector3d::UnitX().eval() : unitOf(way);
    const double cone = around ? test::kPi : static_cast<double>(asin(radius / distance));
    if (!isBetweenBeams(axis, around ? cone : cone + 0.334 * angle_, tolerance.ample)) return false;
    const double reach = 1.5 * angle_;
    const Number cosine_angle = cos(Number(reach)), sine_angle = sin(Number(reach)), sure = Number(1) - angle_;
    for (const Beam& beam : beams_) {
      if (!around && angleBetween(beam.direction, axis) > cone + reach + 1e-9) continue;
      Number along = distance, off = 0;
      if (distance > 0) {
        const Number cosine = dot(way, beam.way) / (distance * beam.range);
        const Number sine = sqrt(std::max(Number(0), Number(1 - cosine * cosine)));
        if (cosine < cosine_angle) { // turned towards the centre by the reach
          along = distance * (cosine * cosine_angle + sine * sine_angle);
          off = distance * (sine * cosine_angle - cosine * sine_angle);
        }
      }
      if (off > radius || (along < 0 && !around)) continue;
      if (along + sqrt(radius * radius - off * off) + tolerance.length >= beam.empty * sure) return false;
    }
    return true;
  }

private:
  struct Beam {
    Vector way;
    Number range, empty;
    Eigen::Vector3d direction;
  };

  /// In so many directions of the cone.
  bool isBetweenBeams(const Eigen::Vector3d& axis, double cone, bool ample) const
  {
    constexpr int kDirections = 60;
    const Eigen::Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
    std::vector<Eigen::Vector3d> near;
    for (const Eigen::Vector3d& beam : directions_)
      if (angleBetween(beam, axis) <= cone + 1.3 * angle_) near.push_back(beam);
    for (int i = 0; i <= kDirections; ++i) {
      const double off = cone * std::sqrt(static_cast<double>(i) / kDirections), turn = 2.399963 * i;
      const Eigen::Vector3d at = std::cos(off) * axis + std::sin(off) * (std::cos(turn) * side + std::sin(turn) * up);
      if (ample ? !areRound(near, at, 0.6 * angle_, 0.8 * angle_, 0.5)
                : !areRound(near, at, 0.0, 1.2 * angle_, test::kPi + 1e-6))
        return false;
    }
    return true;
  }

  Point3 origin_;
  double angle_;
  std::vector<Beam> beams_;
  std::vector<Eigen::Vector3d> directions_;
};

/// Scans, and places among them.
struct Asked {
  struct Scan {
    Point3 origin;
    std::vector<double> returns, misses;
    double misses_beyond = 0.0, uncertainty = 0.0;
  };
  std::vector<Scan> scans;
  double angle = 0.2, clearance = 0.1;
  std::vector<Point3> places;

  /// Beams in rows and columns from the last scan's origin, each as long as range() says, and off by a share of a step.
  template <class Range>
  void addBeams(test::Random& random, double step, double share, const Range& range, double lowest = -1.57,
                double first = 0.0, double last = 6.28)
  {
    Scan& scan = scans.back();
    for (double up = lowest; up <= 1.571; up += step) {
      for (double around = first; around <= last; around += step / std::max(0.05, std::cos(up))) {
        const double e = up + share * step * random.uniform(-0.5, 0.5),
                     a = around + share * step * random.uniform(-0.5, 0.5);
        const double r = range();
        const Eigen::Vector3d d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        for (std::size_t k = 0; k < 3; ++k)
          scan.returns.push_back(scan.origin[k] + r * d[static_cast<Eigen::Index>(k)]);
      }
    }
  }

  void addPlaces(test::Random& random, int count, const Point3& about, double reach)
  {
    for (int i = 0; i < count; ++i)
      places.push_back({about[0] + reach * random.uniform(-1, 1), about[1] + reach * random.uniform(-1, 1),
                        about[2] + reach * random.uniform(-1, 1)});
  }
};

class SeenByDefinition : public testing::Test {
protected:
  void expectAnswers(const Asked& asked, const std::string& what)
  {
    std::vector<ScanBeams> scans;
    std::vector<Definition> definitions;
    double reach = 0.0; // of coordinates
    for (const Asked::Scan& scan : asked.scans) {
      ScanBeams beams;
      beams.origin = scan.origin;
      beams.returns = viewOf(scan.returns.data(), scan.returns.size() / 3);
      beams.returns.uncertainty = scan.uncertainty;
      beams.misses = viewOf(scan.misses.data(), scan.misses.size() / 3);
      beams.misses_beyond = scan.misses_beyond;
      scans.push_back(beams);
      definitions.emplace_back(beams, asked.angle);
      for (const double x : scan.origin) reach += std::abs(x);
    }
    const SphereHierarchy model(viewOf(asked.places.front().data(), asked.places.size()));
    UnseenRequest request;
    request.clearance = asked.clearance;
    SeenOptions options;
    options.angle = asked.angle;
    std::vector<Verdict> verdicts(asked.places.size(), Verdict::free), expected = verdicts;
    markUnseen(SeenSpace(scans, options), {model}, request, verdicts);
    brute_force::markUnseen(scans, asked.angle, {model}, request, expected);
    EXPECT_EQ(verdicts, expected) << what;
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      const Point3& place = asked.places[i];
      if (!isFinite(place)) continue;
      const bool seen = verdicts[i] == Verdict::free;
      const double far = reach + std::abs(place[0]) + std::abs(place[1]) + std::abs(place[2]) + asked.clearance;
      const auto seesAny = [&](const Tolerance& tolerance) {
        return std::any_of(definitions.begin(), definitions.end(),
                           [&](Definition& scan) { return scan.sees(place, asked.clearance, tolerance); });
      };
      if (seen) {
        EXPECT_TRUE(seesAny({})) << what << ": place " << i << " is called seen";
      }
      else {
        EXPECT_FALSE(seesAny({0x1p-40 * far, true})) << what << ": place " << i << " is called unseen";
      }
      ++(seen ? seen_ : unseen_);
    }
  }

  std::size_t seen_ = 0, unseen_ = 0;
};

TEST_F(SeenByDefinition, OfUnevenBeams)
{
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    test::Random random(seed);
    Asked asked;
    asked.angle = random.uniform(0.16, 0.25);
    // The origin of the world, places of a country's grid, and far out.
    const double far = seed % 4 == 1 ? 5412345.25 : seed % 4 == 3 ? 1e9 : 0.0;
    for (int s = 0; s <= static_cast<int>(seed % 3); ++s) {
      asked.scans.push_back({{far + 4.0 * s, far / 8 + random.uniform(-1, 1), random.uniform(-1, 1)}, {}, {}});
      const double step = asked.angle * random.uniform(0.5, 0.9), near = random.uniform(0.5, 6.0);
      asked.addBeams(
          random, step, random.uniform(0, 1), [&] { return random.chance(0.02) ? near : random.uniform(7, 9); },
          random.pick({-1.57, -0.4}), random.uniform(0, 1), random.uniform(3, 6.28));
      asked.scans.back().uncertainty = random.pick({0.0, 0.1});
    }
    asked.clearance = random.pick({0.0, 0.05, 0.4, 1.5, 1e9});
    asked.addPlaces(random, 60, asked.scans.front().origin, 6.0);
    asked.places.push_back(asked.scans.front().origin); // the scanner itself
    expectAnswers(asked, "seed " + std::to_string(seed));
  }
  EXPECT_GT(seen_, 60u);
  EXPECT_GT(unseen_, 300u);
}

/// So dense that all of it is seen but what its beams tell of: a place is unseen for no other reason.
TEST_F(SeenByDefinition, OfDenseBeams)
{
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    test::Random random(100 + seed);
    Asked asked;
    asked.angle = 0.25;
    asked.scans.push_back({{random.uniform(-1, 1), 2, 3}, {}, {}});
    const double near = random.uniform(0.5, 6.0);
    asked.addBeams(
        random, 0.04, random.uniform(0, 1), [&] { return random.chance(0.001) ? near : random.uniform(7, 9); },
        random.pick({-1.57, -0.4}), 0.0, random.uniform(3, 6.28));
    asked.clearance = random.pick({0.0, 0.05, 0.4});
    asked.addPlaces(random, 60, asked.scans.front().origin, 6.0);
    expectAnswers(asked, "seed " + std::to_string(seed));
  }
  EXPECT_GT(seen_, 50u);
  EXPECT_GT(unseen_, 50u);
}

TEST_F(SeenByDefinition, OfTwoScannersWhoseConesOverlapInPart)
{
  test::Random random(1);
  Asked asked;
  for (const double side : {0.0, 1.0}) {
    asked.scans.push_back({{0, 0, 0}, {}, {}});
    asked.addBeams(
        random, 0.1, 0.3, [] { return 9.0; }, -1.57, 3.0 * side, 3.3 + 3.0 * side);
  }
  asked.clearance = 0.5;
  for (double turn = 0.0; turn < 6.28; turn += 0.02)
    for (const double far : {2.0, 6.0}) asked.places.push_back({far * std::cos(turn), far * std::sin(turn), 0.1});
  expectAnswers(asked, "two halves");
  EXPECT_GT(seen_, 50u);
  EXPECT_GT(unseen_, 10u);
}

TEST_F(SeenByDefinition, OfBeamsThatAreNone)
{
  test::Random random(2);
  const double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  Asked asked;
  asked.scans.push_back({{1, 2, 3}, {}, {}});
  asked.addBeams(random, 0.12, 0.2, [] { return 9.0; });
  asked.addPlaces(random, 40, {1, 2, 3}, 7.0);
  expectAnswers(asked, "all beams");
  const std::size_t seen = seen_;
  EXPECT_GT(seen, 10u);
  std::vector<double>& returns = asked.scans[0].returns;
  const std::vector<double> once = returns;
  returns.insert(returns.end(), once.begin(), once.end());
  for (const double x : {1.0, 2.0, 3.0, none, 2.0, 3.0, 1.0, infinite, 3.0, none, none, none}) returns.push_back(x);
  seen_ = 0;
  expectAnswers(asked, "each twice, at the scanner, not finite");
  EXPECT_EQ(seen_, seen);
  for (std::size_t i = 0; i < returns.size(); i += 3)
    if (i % 2 == 0) returns[i] = none; // half of both copies
  seen_ = 0;
  expectAnswers(asked, "every other one is lost");
  asked.scans[0].misses = once;
  returns.clear();
  for (const double beyond : {0.0, 6.0}) {
    seen_ = 0;
    asked.scans[0].misses_beyond = beyond;
    expectAnswers(asked, "none returned");
    EXPECT_EQ(seen_ > 0, beyond > 0.0);
  }
}

TEST_F(SeenByDefinition, OfOneBeamOfTwoAlikeAndOfARow)
{
  Asked asked;
  asked.scans.push_back({{0, 0, 0}, {9, 0, 0}, {}});
  asked.clearance = 0.05;
  asked.places = {{4, 0, 0}, {-4, 0, 0}, {4, 0.5, 0}, {0, 0, 0}, {0.02, 0, 0}, {8.99, 0, 0}};
  expectAnswers(asked, "one");
  EXPECT_EQ(seen_, 0u) << "of one beam no spacing is known";
  asked.scans[0].returns = {9, 0, 0, 9, 0, 0};
  expectAnswers(asked, "two");
  asked.scans[0].returns = {9, 0, 0, 9, 0.4, 0, 9, -0.4, 0, 9, 0.8, 0};
  expectAnswers(asked, "a row");
  EXPECT_EQ(seen_, 0u) << "no direction lies between them";
}

TEST_F(SeenByDefinition, AtTheAntipodeAndAHalfTurnAway)
{
  test::Random random(4);
  Asked asked;
  asked.scans.push_back({{0, 0, 0}, {}, {}});
  asked.addBeams(random, 0.12, 0.2, [] { return 9.0; });
  for (const double x : {-1e-3, 0.0, 0.0}) asked.scans[0].returns.push_back(x); // one that ends at once
  for (const double off : {0.0, 1e-9, 1e-6, 0.1, 0.19, 0.2, 0.21, 0.3})
    for (const double side : {-1.0, 1.0})
      for (const double range : {1e-3, 0.11, 4.0})
        asked.places.push_back({side * range * std::cos(off), range * std::sin(off), 0});
  for (const double clearance : {0.0, 0.1, 0.8, 3.9}) {
    asked.clearance = clearance;
    expectAnswers(asked, "clearance " + std::to_string(clearance));
  }
  EXPECT_GT(seen_, 30u);
  EXPECT_GT(unseen_, 30u);
}

} // namespace
} // namespace pcl_bsh
