// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/gauge.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/track/bogies.h>
#include <pcl_bsh/track/gauge_table.h>

#include "made_lines.h"
#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <cmath>

namespace pcl_bsh {
namespace {

const std::vector<SectionPoint> gauge_box = {{-1.5, 0}, {1.5, 0}, {1.5, 4}, {-1.5, 4}};

/// Distance from the box, by its formula.
double boxDistance(double u, double v, double left, double right)
{
  const double dx = std::max(u - 1.5 - right, -1.5 - left - u), dy = std::max(v - 4, -v);
  return dx > 0 && dy > 0 ? std::hypot(dx, dy) : std::max(dx, dy);
}

TEST(Gauge, ClearancesAlongACurveWithCantAreThoseOfTheFormula)
{
  AxisDescription description;
  description.plan = test::curve({500000, 4000000, 0.4}, 150);
  description.grades = {{0, 30}, {400, 34}};
  description.cants = {{80, 0}, {140, 0.12}, {260, 0.12}, {320, 0}};
  description.chainages = {{0, 1000}, {200, 1200}, {200, 1500}, {400, 1700}};
  const Axis axis(description);
  const Vehicle vehicle{19, 3.7};
  const std::vector<Envelope> envelopes = {
      Envelope({"plain", gauge_box}), Envelope({"wagon", gauge_box, {}, {}, {}, vehicle}),
      Envelope({"table", gauge_box, {{1500, 1700}}, Piecewise::through({{0, 0}, {400, 0.4}}, Piecewise::Ends::held)})};
  test::Random random(5);
  std::vector<Point3> points;
  std::vector<AxisPlace> truth;
  for (int s = 0; s < 200; ++s) {
    const double at = random.uniform(0, 400);
    const AxisFrame frame = axis.frame(at);
    for (int i = 0; i < 20; ++i) {
      const double u = random.uniform(-4, 4), v = random.uniform(-1, 6);
      Point3 p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = frame.origin[k] + u * frame.right[k] + v * frame.up[k];
      points.push_back(p);
      truth.push_back({at, u, v});
    }
  }
  const GaugedPoints found = gauge(viewOf(points[0].data(), points.size()), axis, envelopes, {});
  EXPECT_EQ(found.counts[static_cast<std::size_t>(PlaceState::found)], points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [at, u, v] = truth[i];
    ASSERT_NEAR(found.place[i].offset, u, 2e-9);
    ASSERT_NEAR(found.place[i].height, v, 2e-9);
    const double k = axis.curvature(at), radius = 1 / std::abs(k);
    const double inner = k == 0 ? 0 : radius - std::sqrt(radius * radius - 9.5 * 9.5);
    const double outer = k == 0 ? 0 : std::sqrt(radius * radius - 9.5 * 9.5 + 13.2 * 13.2) - radius;
    EXPECT_NEAR(found.each[3 * i], boxDistance(u, v, 0, 0), 4e-9);
    EXPECT_NEAR(found.each[3 * i + 1], boxDistance(u, v, outer, inner), 4e-9);
    EXPECT_EQ(std::isnan(found.each[3 * i + 2]), at < 200);
    if (at >= 200) {
      EXPECT_NEAR(found.each[3 * i + 2], boxDistance(u, v, 0.001 * at, 0), 4e-9);
    }
    double least = std::min(found.each[3 * i], found.each[3 * i + 1]);
    if (at >= 200) least = std::min(least, found.each[3 * i + 2]);
    EXPECT_EQ(found.clearance[i], least);
    EXPECT_EQ(found.each[3 * i + static_cast<std::size_t>(found.envelope[i])], least);
  }
  for (const unsigned threads : {2u, 5u}) {
    const GaugedPoints again = gauge(viewOf(points[0].data(), points.size()), axis, envelopes, {{}, threads});
    EXPECT_EQ(again.clearance, found.clearance);
    EXPECT_EQ(again.envelope, found.envelope);
  }
}

TEST(Gauge, APointNearTwoTracksCountsAtTheNarrowerOne)
{
  AxisDescription description;
  description.plan = {{200, 0, 0, AxisStart{0, 0, 0}}, {188.49555921538759, 1.0 / 40, 1.0 / 40}, {200, 0, 0}};
  const Axis axis(description);
  const std::vector<Envelope> envelopes = {Envelope({"flat", {{-5, 1}, {5, 1}, {5, 2}, {-5, 2}}}),
                                           Envelope({"crossing", gauge_box, {{400, 500}}})};
  const Point3 point = {158, 1, 3}; // 1 from the first straight, 2 from the second
  const GaugedPoints found = gauge(viewOf(point.data(), 1), axis, envelopes, {});
  EXPECT_EQ(found.state[0], PlaceState::two_places);
  EXPECT_NEAR(found.clearance[0], 0.5, 1e-12) << "of the crossing track";
  EXPECT_EQ(found.envelope[0], 1);
  EXPECT_NEAR(found.place[0].offset, -2, 1e-12);
}

TEST(Gauge, CountsWhatHasNoPlace)
{
  AxisDescription description;
  description.plan = {{100, 0, 0, AxisStart{0, 0, 0}}};
  const Axis axis(description);
  const std::vector<Point3> points = {{50, 0, 1}, {-1, 0, 1}, {101, 0, 1}, {50, 50, 1}, {std::nan(""), 0, 1}};
  const GaugedPoints found = gauge(viewOf(points[0].data(), points.size()), axis, {Envelope({"box", gauge_box})}, {});
  EXPECT_THAT(found.counts, testing::ElementsAre(1, 0, 1, 1, 1, 1));
  EXPECT_TRUE(std::isnan(found.clearance[1]));
  EXPECT_EQ(found.envelope[1], -1);
  EXPECT_THROW(gauge(viewOf(points[0].data(), 1), axis, {}, {}), InvalidInput);
}

TEST(Envelope, RefusesWhatHasNoMeaning)
{
  const auto refusal = [](EnvelopeDescription description) -> std::string {
    try {
      const Envelope envelope(std::move(description));
      return {};
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
  };
  using testing::HasSubstr;
  const Piecewise below({{0, -1, 0, 0}});
  EXPECT_THAT(refusal({"a", {{0, 0}, {1, 1}, {1, 0}, {0, 1}}}), HasSubstr("envelope a: its edges"));
  EXPECT_THAT(refusal({"a", gauge_box, {{2, 1}}}), HasSubstr("its range ends at 1, before it begins at 2"));
  EXPECT_THAT(refusal({"a", gauge_box, {}, below}), HasSubstr("its widening at distance 0 is -1"));
  EXPECT_THAT(refusal({"a", gauge_box, {}, {}, {}, Vehicle{0, 1}}), HasSubstr("pivots 0 apart"));
  EXPECT_THROW(overthrowOf({20, 3}, 9), InvalidInput);
}

TEST(Envelope, FourSectorsGoRoundIt)
{
  const Envelope envelope({"box", gauge_box});
  EXPECT_LT(envelope.aroundOf({-2, 2}), 1);
  EXPECT_EQ(std::floor(envelope.aroundOf({0.5, 5})), 1);
  EXPECT_EQ(std::floor(envelope.aroundOf({2, 1})), 2);
  EXPECT_EQ(std::floor(envelope.aroundOf({0, -1})), 3);
  EXPECT_LT(envelope.aroundOf({-2, 0.5}), envelope.aroundOf({-2, 3}));
  EXPECT_LT(envelope.aroundOf({100, -150}), 4);
}

TEST(GaugeTable, SmallestOfEachPartAndSector)
{
  AxisDescription description;
  description.plan = {{10.5, 0, 0, AxisStart{0, 0, 0}}};
  const Axis axis(description);
  const std::vector<Envelope> envelopes = {Envelope({"box", gauge_box})};
  const std::vector<Point3> points = {{0.5, 2, 2}, {0.7, 1.75, 2}, {0.2, 0, 5}, {3.5, -1.25, 2}, {10.5, 0, -0.5}};
  const GaugedPoints found = gauge(viewOf(points[0].data(), points.size()), axis, envelopes, {});
  GaugeTable table(axis, 1, 1.0);
  table.add(found, envelopes);
  EXPECT_EQ(table.parts(), 11u);
  EXPECT_EQ(table.points(0), 3u);
  EXPECT_EQ(table.points(1), 0u);
  EXPECT_EQ(table.smallest(0, 0, Sector::left), 0.25);
  EXPECT_EQ(table.smallest(0, 0, Sector::above), 1);
  EXPECT_TRUE(std::isinf(table.smallest(0, 0, Sector::right))) << "no data";
  EXPECT_TRUE(std::isinf(table.smallest(1, 0))) << "no data";
  EXPECT_EQ(table.smallest(3, 0, Sector::right), -0.25);
  EXPECT_EQ(table.smallest(10, 0, Sector::below), 0.5);
  EXPECT_EQ(table.to(10), 10.5);
  EXPECT_THROW(GaugeTable(axis, 1, 0), InvalidInput);
}

TEST(GaugeTable, InfringementsLieTogether)
{
  AxisDescription description;
  description.plan = {{100, 0, 0, AxisStart{0, 0, 0}}};
  const Axis axis(description);
  const std::vector<Point3> points = {{10, 1.4, 2}, {10.5, 1.2, 2}, {60, -1.45, 1}, {30, 3, 3}, {60.2, -1.5, 1}};
  const PointsView view = viewOf(points[0].data(), points.size());
  std::vector<Infringing> list;
  addInfringing(view, gauge(view, axis, {Envelope({"box", gauge_box})}, {}), 0.0, 100, list);
  EXPECT_EQ(list.size(), 4u) << "on the outline is too near";
  const std::vector<Infringement> found = infringementsOf(list, 1.0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].worst.record, 101u);
  EXPECT_NEAR(found[0].worst.clearance, -0.3, 1e-15);
  EXPECT_EQ(found[0].from, 10);
  EXPECT_EQ(found[0].to, 10.5);
  EXPECT_EQ(found[1].members.size(), 2u);
  EXPECT_TRUE(infringementsOf({}, 1.0).empty());
}

TEST(Bogies, OverthrowOnACircleIsTheClosedFormula)
{
  for (const double radius : {60.0, 190.0, 1200.0}) {
    AxisDescription description;
    description.plan = {{150, 1 / radius, 1 / radius, AxisStart{10, 20, 0.3}}};
    const Axis axis(description);
    const Vehicle vehicle{19, 3.7};
    const Overthrow over = overthrowOf(vehicle, radius);
    EXPECT_NEAR(over.inner, radius - std::sqrt(radius * radius - 9.5 * 9.5), 1e-12 * radius);
    for (const double front : {19.5, 77.7, 150.0}) {
      const Eigen::Isometry3d pose = poseOnPivots(axis, 19, front);
      const auto offsetOf = [&](double x) {
        const Eigen::Vector3d p = pose * Eigen::Vector3d(x, 0, 0);
        return axis.nearest({p.x(), p.y(), p.z()}, {}).best.offset;
      };
      EXPECT_NEAR(offsetOf(0), over.inner, 1e-11);
      EXPECT_NEAR(offsetOf(9.5), 0, 1e-12);
      EXPECT_NEAR(offsetOf(-9.5), 0, 1e-12);
      if (front < 140) {
        EXPECT_NEAR(offsetOf(13.2), -over.outer, 1e-11);
      }
    }
  }
}

TEST(Bogies, StandOnRampsAndInclines)
{
  AxisDescription description;
  description.plan = test::curve({500000, 4000000, 0.4}, 150);
  description.grades = {{0, 30}, {200, 34, 60}, {400, 30}};
  description.cants = {{80, 0}, {140, 0.12}, {260, 0.12}, {320, 0}};
  const Axis axis(description);
  const std::vector<Eigen::Isometry3d> poses = posesAlong(axis, 19, 20, 399.3, 1.0);
  EXPECT_EQ(poses.size(), 381u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double front = i == 380 ? 399.3 : 20.0 + static_cast<double>(i), rear = rearPivotOf(axis, 19, front);
    for (const auto& [x, at] : {std::pair{9.5, front}, {-9.5, rear}}) {
      const Eigen::Vector3d p = poses[i] * Eigen::Vector3d(x, 0, 0);
      const Point3 on = axis.frame(at).origin;
      EXPECT_NEAR((p - Eigen::Vector3d(on[0], on[1], on[2])).norm(), 0, 1.5e-9);
    }
    EXPECT_NEAR((poses[i].linear().transpose() * poses[i].linear() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-14);
    EXPECT_GT(poses[i].linear()(2, 2), 0.99);
  }
  EXPECT_NEAR(frontPivotOf(axis, 19, rearPivotOf(axis, 19, 222)), 222, 2e-9);
  EXPECT_THROW(frontPivotOf(axis, 19, 390), InvalidInput);
  EXPECT_THROW(poseOnPivots(axis, 19, 10), InvalidInput);
  EXPECT_THROW(poseOnPivots(axis, 19, 401), InvalidInput);
  EXPECT_THROW(posesAlong(axis, 19, 20, 30, 0), InvalidInput);
}

} // namespace
} // namespace pcl_bsh
