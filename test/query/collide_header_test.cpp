// SPDX-License-Identifier: BSD-3-Clause
// collide.h alone brings each query of plain arrays that the README names.
#include <pcl_bsh/collide.h>

#include <gmock/gmock.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>

namespace pcl_bsh {
namespace {

using pcl_bsh::anyCollision;
using pcl_bsh::anyCollisionAtPoses;
using pcl_bsh::anyCollisionOnMotions;
using pcl_bsh::closestPair;
using pcl_bsh::closestPairAtPoses;
using pcl_bsh::collideAlong;
using pcl_bsh::collidingIndices;
using pcl_bsh::collisionFlags;
using pcl_bsh::findClashes;
using pcl_bsh::hausdorffDistance;
using pcl_bsh::labelPoints;
using pcl_bsh::markUnseen;
using pcl_bsh::pairsWithin;
using pcl_bsh::pointDistances;

/// The names above.
const std::set<std::string> brought = {
    "anyCollision", "anyCollisionAtPoses", "anyCollisionOnMotions", "closestPair",    "closestPairAtPoses",
    "collideAlong", "findClashes",         "collidingIndices",      "collisionFlags", "hausdorffDistance",
    "labelPoints",  "markUnseen",          "pairsWithin",           "pointDistances"};

/// The functions in the column C++ of the table "I want to ...", except setters of filters and what CGAL proves.
std::set<std::string> namedByTheReadme()
{
  std::ifstream readme(PCL_BSH_SOURCE_DIR "/README.md");
  std::set<std::string> names;
  bool in_table = false;
  for (std::string line; std::getline(readme, line);) {
    in_table = line.rfind("| | C++ |", 0) == 0 || (in_table && !line.empty());
    if (!in_table) continue;
    const std::size_t from = line.find('|', 1);
    const std::string cell = line.substr(from, line.find('|', from + 1) - from);
    const std::regex call("`([a-zA-Z]+)\\(\\)`");
    for (std::sregex_iterator found(cell.begin(), cell.end(), call), end; found != end; ++found) {
      const std::string name = (*found)[1];
      if (name.rfind("set", 0) != 0 && name != "certify") names.insert(name);
    }
  }
  return names;
}

TEST(CollideHeader, BringsWhatTheReadmeNames)
{
  const std::set<std::string> named = namedByTheReadme();
  EXPECT_GE(named.size(), 10U);
  for (const std::string& name : named) EXPECT_EQ(brought.count(name), 1U) << name;
}

TEST(CollideHeader, BringsWhatItTakesToAsk)
{
  const double xyz[] = {0, 0, 0, 3, 4, 0};
  const pcl_bsh::SphereHierarchy a(pcl_bsh::viewOf(xyz, 1)), b(pcl_bsh::viewOf(xyz + 3, 1));
  const pcl_bsh::Effort effort(pcl_bsh::Accuracy(), 2);
  EXPECT_EQ(hausdorffDistance({a}, {b}, pcl_bsh::HausdorffRequest(effort)).distance, 5.0);
  EXPECT_EQ(hausdorffDistance({a}, {b}, effort).distance, 5.0);
  EXPECT_EQ(hausdorffDistance({a}, {b}, {}).distance, 5.0);
  EXPECT_EQ(hausdorffDistance({a}, {b}, {pcl_bsh::Accuracy(), 2}).distance, 5.0);
  EXPECT_EQ(closestPair({a}, {b}, pcl_bsh::DistanceRequest(effort)).distance, 5.0);
  EXPECT_EQ(pointDistances({a}, {b}, {effort, 7.0}).distance.at(0), 5.0);
  EXPECT_EQ(pairsWithin({a}, {b}, {5.0, pcl_bsh::ContactsRequest::kAll, effort}).pairs.size(), 1U);
  EXPECT_EQ(anyCollision({a}, {b}, {5.0, effort}).verdict, pcl_bsh::Verdict::colliding);
}

} // namespace
} // namespace pcl_bsh
