// SPDX-License-Identifier: BSD-3-Clause
// Unseen records in a site are those of one SeenSpace over all of its points, whatever the tiles.
#include "float64_cloud.h"
#include "site_questions.h"
#include "support/made_scans.h"
#include "support/temporary_folder.h"
#include "tools/programs/program_run.h"
#include "two_ranks.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/question/model_shift.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/site_obstacles.h>

#ifdef PCL_BSH_SITE_QUERIES

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace pcl_bsh::site {
namespace {

using testing::HasSubstr;

/// A room with a pillar, scanned from two places into a file each, and a machine that drives round the pillar.
class SeeSite : public testing::Test {
protected:
  SeeSite()
  {
    test::MadeRoom room{{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(8, 6, 3)}, {}};
    room.boxes.emplace_back(Eigen::Vector3d(3, 2.5, 0), Eigen::Vector3d(3.5, 3.5, 3));
    test::Random random(1);
    for (std::size_t s = 0; s < 2; ++s) {
      const Eigen::Vector3d& o = origins[s];
      const std::vector<double> ends = test::makeScan(room, {o, 0.03, -1.2, 1.3}, random).returns;
      for (std::size_t i = 0; i < ends.size(); i += 3) scans[s].push_back({ends[i], ends[i + 1], ends[i + 2]});
      for (std::size_t i = 0; i < scans[s].size(); ++i) sigmas[s].push_back(i % 5 == 0 ? 0.1f : 0.01f);
      writeScan(s);
    }
    for (int i = 0; i < 800; ++i)
      machine.push_back({random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(0.0, 1.0)});
    for (int k = 0; k < 12; ++k) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(0.4 * k, Eigen::Vector3d::UnitZ()));
      pose.translation() = Eigen::Vector3d(4.0 + 2.8 * std::cos(0.5 * k), 3.0 + 2.2 * std::sin(0.5 * k), 0.2 + 0.1 * k);
      poses.push_back(pose);
    }
    request.origin = ScanOrigins::parse("source:0=1,1,1.5;1=7,5,1.5");
    request.seen_angle = 0.05;
    request.clearance = 0.1;
    request.seen = request.wanted.unseen_places = true;
    request.uncertainty = 0.01;
  }

  void writeScan(std::size_t s) const
  {
    pcl::PCLPointCloud2 cloud;
    for (const char* name : {"x", "y", "z"}) io::addField(cloud, name, io::Field::FLOAT64);
    io::addField(cloud, "sigma", io::Field::FLOAT32);
    io::allocate(cloud, static_cast<std::uint32_t>(scans[s].size()));
    for (std::size_t i = 0; i < scans[s].size(); ++i) {
      std::memcpy(&cloud.data[i * cloud.point_step], scans[s][i].data(), sizeof(Point3));
      std::memcpy(&cloud.data[i * cloud.point_step + sizeof(Point3)], &sigmas[s][i], sizeof(float));
    }
    io::writeCloud(folder / ("scan" + std::to_string(s) + ".pcd"), cloud);
  }

  Site siteOf(std::uint64_t tile_points)
  {
    MakeOptions options;
    options.tile_points = tile_points;
    return makeSite({folder / "scan0.pcd", folder / "scan1.pcd"}, folder / ("site" + std::to_string(tile_points)),
                    options);
  }

  /// Returns the unseen records among all points at once.
  Answer::Unseen expected(std::vector<Verdict>& gravest) const
  {
    std::vector<ScanBeams> beams;
    std::vector<Point3> all;
    std::vector<float> all_sigmas;
    for (std::size_t s = 0; s < 2; ++s) {
      beams.push_back({request.origin.entries[s].origin, viewOf(scans[s].front().data(), scans[s].size())});
      beams.back().returns.uncertainty = request.uncertainty.length;
      if (!request.uncertainty.field.empty()) beams.back().returns.uncertainties = sigmas[s].data();
      all.insert(all.end(), scans[s].begin(), scans[s].end());
      all_sigmas.insert(all_sigmas.end(), sigmas[s].begin(), sigmas[s].end());
    }
    SeenOptions options;
    options.angle = *request.seen_angle;
    const SeenSpace space(beams, options);
    PointsView view = viewOf(all.front().data(), all.size());
    view.uncertainty = request.uncertainty.length;
    if (!request.uncertainty.field.empty()) view.uncertainties = all_sigmas.data();
    Uncertainty of_pose;
    of_pose.pose = request.input_pose_uncertainty;
    view = withUncertainty(view, std::vector<RecordField>(), "all", of_pose);
    const SphereHierarchy scan(view), model(viewOf(machine.front().data(), machine.size()));
    FlagsRequest flags;
    flags.clearance = *request.clearance;
    flags.flagged = Flagged::b;
    UnseenRequest asked;
    asked.kinds = true;
    Answer::Unseen unseen;
    gravest.assign(machine.size(), Verdict::free);
    for (const Eigen::Isometry3d& pose : poses) {
      FlagsResult found = pcl_bsh::collisionFlags({scan}, {model, pose}, flags);
      asked.clearance = *request.clearance + // beams and their scanner move together
                        shiftOf(request.input_pose_uncertainty, CornerBox(model.view()), pose);
      UnseenResult left = markUnseen(space, {model, pose}, asked, found.b);
      unseen.addPose(found.b, true, gravest, std::move(left.kinds));
    }
    return unseen;
  }

  SiteAnswer asked(const Site& site) const
  {
    SiteQuestion question = request;
    question.path = poses;
    return site::asked(site, SphereHierarchy(viewOf(machine.front().data(), machine.size())), question);
  }

  io::TemporaryFolder folder;
  std::vector<Eigen::Vector3d> origins = {{1, 1, 1.5}, {7, 5, 1.5}};
  std::vector<Point3> scans[2], machine;
  std::vector<float> sigmas[2];
  std::vector<Eigen::Isometry3d> poses;
  SiteQuestion request;
};

TEST_F(SeeSite, AnswersAsOfAllPointsWhateverTheTiles)
{
  std::vector<Verdict> gravest;
  const Answer::Unseen right = expected(gravest);
  ASSERT_GT(right.count, 20u);
  ASSERT_LT(right.count, machine.size());
  for (const std::uint64_t tile_points : {1000000u, 3000u, 500u}) {
    const SiteAnswer found = asked(siteOf(tile_points));
    EXPECT_EQ(found.obstacle_flags, gravest) << tile_points;
    EXPECT_EQ(found.unseen.at_poses, right.at_poses);
    EXPECT_EQ(found.unseen.where, right.where);
    EXPECT_EQ(found.unseen.first_pose, right.first_pose);
    EXPECT_EQ(found.unseen.count, right.count);
    EXPECT_EQ(found.unseen.in_shadow, right.in_shadow);
    EXPECT_EQ(found.unseen.shadow_at_poses, right.shadow_at_poses);
    EXPECT_EQ(found.unseen.angles, (std::vector<double>{0.05, 0.05}));
    EXPECT_LT(found.beams_kept, scans[0].size() + scans[1].size()) << "those that look elsewhere are left out";
  }
}

TEST_F(SeeSite, TheSitesPoseMayBeUncertain)
{
  std::vector<Verdict> at_once, before;
  expected(before);
  const Site site = siteOf(3000);
  for (const PoseUncertainty& of_pose : {PoseUncertainty{0.05}, PoseUncertainty{0.0, 0.03, {1, 3, 1}}}) {
    request.input_pose_uncertainty = of_pose;
    const Answer::Unseen right = expected(at_once);
    ASSERT_NE(at_once, before);
    const SiteAnswer found = asked(site);
    EXPECT_EQ(found.unseen.where, right.where);
    EXPECT_EQ(found.obstacle_flags, at_once);
  }
}

/// Each with its own pose and clearance, of one visit to the beams.
TEST_F(SeeSite, SeveralObstaclesAreSeenAsEachAlone)
{
  const Shape shape("machine", viewOf(machine.front().data(), machine.size()));
  std::vector<PlacedShape> obstacles(4, {shape});
  obstacles[1].pose.translation().z() = 0.5;
  obstacles[1].clearance = 0.3;
  obstacles[2].pose.translation().x() = -1.0;
  obstacles[3].ignores_input = true;
  Question question = request;
  question.path = poses;
  question.wanted.flags = true;
  question.threads = 2;
  const Site site = siteOf(500);
  const SiteObstaclesAnswer found = ask(question, site, obstacles);
  for (std::size_t i = 0; i < 3; ++i) {
    Shape alone = shape;
    const SiteAnswer right = ask(questionOf(question, obstacles[i]), site, alone);
    ASSERT_GT(right.unseen.count, 0u);
    EXPECT_EQ(found.each[i].unseen, right.unseen.count);
    EXPECT_EQ(found.each[i].not_seen.where, right.unseen.where);
    EXPECT_EQ(found.each[i].not_seen.at_poses, right.unseen.at_poses);
    EXPECT_EQ(found.each[i].not_seen.shadow_at_poses, right.unseen.shadow_at_poses);
    EXPECT_GE(found.all.beams_kept, right.beams_kept);
  }
  EXPECT_EQ(found.each[3].unseen, 0u);
  EXPECT_LE(found.all.beam_tiles.read, site.tiles.size());
}

/// Each beam is as uncertain as its own return, on whichever tile that is; and the pose on top shortens none.
TEST_F(SeeSite, EachPointHasItsOwnUncertainty)
{
  std::vector<Verdict> of_a_length, gravest;
  expected(of_a_length);
  request.uncertainty = Uncertainty("sigma", 1.0);
  const Site site = siteOf(500);
  for (const double of_pose : {0.0, 0.03}) {
    request.input_pose_uncertainty.length = of_pose;
    const Answer::Unseen right = expected(gravest);
    EXPECT_NE(gravest, of_a_length);
    const SiteAnswer found = asked(site);
    EXPECT_EQ(found.unseen.where, right.where);
    EXPECT_EQ(found.obstacle_flags, gravest);
  }
}

/// A scan of one beam, or of none, for which all tiles are looked through once more.
TEST_F(SeeSite, BeamsAreUncertainWhateverElseIsRead)
{
  request.uncertainty = 0.05;
  std::uint64_t another = 0; // name for its folder
  for (const Point3& only : {Point3{7, 5, 3}, Point3{7, 5, 1.5}}) {
    scans[1] = {only};
    io::writeCloud(folder / "scan1.pcd", float64Cloud(scans[1]));
    std::vector<Verdict> at_once;
    const Answer::Unseen right = expected(at_once);
    EXPECT_GT(*std::max_element(right.shadow_at_poses.begin(), right.shadow_at_poses.end()), 0u);
    for (const std::uint64_t tile_points : {1000000u, 3000u}) {
      const Answer::Unseen found = asked(siteOf(tile_points + another)).unseen;
      EXPECT_EQ(found.where, right.where);
      EXPECT_EQ(found.shadow_at_poses, right.shadow_at_poses);
    }
    ++another;
  }
}

/// Answers of another question that may go on are none of this one.
TEST_F(SeeSite, TakesNoAnswersThatWereKept)
{
  struct Kept : TileAnswers {
    const std::vector<double>* known(std::size_t) const override { return &none; }
    void keep(std::size_t, const std::vector<double>&) override { ADD_FAILURE(); }
    std::vector<double> none;
  } kept;
  const Site site = siteOf(3000);
  poses = {Eigen::Isometry3d(Eigen::Translation3d(0.2, 3, 1))}; // partly in a wall
  const SiteAnswer right = asked(site);
  ASSERT_GT(countOf(right.obstacle_flags, Verdict::colliding), 0u);
  request.answers = &kept;
  request.progress = [](double) {
    ADD_FAILURE() << "of a part";
    return true;
  };
  EXPECT_EQ(asked(site).obstacle_flags, right.obstacle_flags);
}

TEST_F(SeeSite, CollidingWinsOverUndecidedOfAnotherTile)
{
  machine = {{0, 0, 0}};
  poses = {Eigen::Isometry3d(Eigen::Translation3d(4, 3, 1))};
  request.clearance = 0.25;
  request.uncertainty = 0.05;
  for (const double side : {1.0, -1.0}) {
    scans[0] = {{4 + 0.15 * side, 3, 1}, {4 - 0.27 * side, 3, 1}};
    scans[1] = {{0, 0, 0}, {8, 6, 3}};
    for (std::size_t s = 0; s < 2; ++s)
      io::writeCloud(folder / ("scan" + std::to_string(s) + ".pcd"), float64Cloud(scans[s]));
    EXPECT_EQ(asked(siteOf(side > 0 ? 1 : 2)).obstacle_flags, std::vector<Verdict>{Verdict::colliding});
    EXPECT_EQ(asked(siteOf(side > 0 ? 3 : 4)).obstacle_flags, std::vector<Verdict>{Verdict::colliding});
  }
}

TEST_F(SeeSite, ReadsTilesInTheDirectionsOfTheModelAlone)
{
  poses.resize(1);
  const SiteAnswer found = asked(siteOf(500));
  EXPECT_LT(found.beam_tiles.read, found.beam_tiles.tiles);
  EXPECT_EQ(found.beam_tiles.read, found.beam_tiles.needed);
  EXPECT_GT(found.beam_tiles.read, 0u);
  std::vector<Verdict> gravest;
  EXPECT_EQ(found.unseen.where, expected(gravest).where);
}

TEST_F(SeeSite, NeedsAllBeamsWhereABallHoldsTheScanner)
{
  poses = {Eigen::Isometry3d(Eigen::Translation3d(1, 1, 1))};
  request.clearance = 0.5;
  const SiteAnswer found = asked(siteOf(3000));
  EXPECT_GE(found.beams_kept, scans[0].size());
  std::vector<Verdict> gravest;
  EXPECT_EQ(found.unseen.where, expected(gravest).where);
}

TEST_F(SeeSite, WhatIsNoBeamIsNotCounted)
{
  scans[0] = {{std::nan(""), 0, 0}, {1, 1, 1.5}, {0, 0, 0}, {0, 0.1, 0}}; // the second is where the scanner is
  scans[1] = {{7, 1, 1.5}, {1, 5, 1.5}};
  for (std::size_t s = 0; s < 2; ++s)
    io::writeCloud(folder / ("scan" + std::to_string(s) + ".pcd"), float64Cloud(scans[s]));
  machine = {{0, 0, 0}};
  poses = {Eigen::Isometry3d(Eigen::Translation3d(1, 1, 1.5))}; // for which all beams of its scan count
  EXPECT_EQ(asked(siteOf(10)).beams_kept, 4u);
}

TEST_F(SeeSite, ABeamAloneSeesNothingWhateverTheTiles)
{
  request.origin = ScanOrigins::parse("source:0=1,1,1.5;1=1,1,1.5");
  scans[1] = {{7, 1, 1.5}, {1, 5, 1.5}};
  io::writeCloud(folder / "scan1.pcd", float64Cloud(scans[1]));
  scans[0] = {{0, 0, 0}, {0, 0.1, 0}};
  io::writeCloud(folder / "scan0.pcd", float64Cloud(scans[0]));
  machine = {{0, 0, 0}};
  poses = {Eigen::Isometry3d(Eigen::Translation3d(3, 1, 1.5))};
  request.clearance = 0.01;
  std::vector<Verdict> gravest;
  const Answer::Unseen right = expected(gravest);
  EXPECT_EQ(right.count, 1u) << "two beams have nothing between them";
  for (const std::uint64_t tile_points : {1000u, 1u}) EXPECT_EQ(asked(siteOf(tile_points)).obstacle_flags, gravest);
}

TEST_F(SeeSite, RefusesWhatItCannotTell)
{
  const auto refusal = [&](const Site& site) {
    try {
      asked(site);
    }
    catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Site site = siteOf(3000);
  request.origin = {};
  EXPECT_THAT(refusal(site), HasSubstr("does not say where its scanner stood: give `origin`"));
  request.origin = ScanOrigins::parse("source:0=1,1,1.5");
  EXPECT_THAT(refusal(site), HasSubstr("is of scan 1 in field 'source', which has no origin"));
  request.origin = ScanOrigins::parse("source:0=1,1,1.5;1=7,5,1.5");
  request.seen_angle.reset();
  EXPECT_THAT(refusal(site), HasSubstr("angle that a beam speaks for: 0 radians: give one in"));
  request.seen_angle = 0.05;
  request.memory = 1 << 20;
  request.clearance = 2.0; // so that all are needed
  EXPECT_THAT(refusal(site), HasSubstr("beams at least look at the model on its way"));
}

} // namespace
} // namespace pcl_bsh::site
#endif
