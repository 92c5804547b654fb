// SPDX-License-Identifier: BSD-3-Clause
// SphereHierarchy::validate(): each thing that queries rely on is broken by hand, and named.
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A lattice of 8 * 4 * 4 points 1/4 apart, of which two voxels hold the half each: without rounding, in trees of
/// several levels.
class HierarchyDefects : public testing::Test {
protected:
  using Break = std::function<void(SphereHierarchy::Storage&)>;

  HierarchyDefects()
  {
    for (int i = 0; i < 128; ++i)
      points_.push_back({0.25 * (i % 8) + 8.125, 0.25 * (i / 8 % 4) + 8.125, 0.25 * (i / 32) + 8.125});
    options_.voxel_edge = 1.0;
  }

  std::vector<std::string> linesOf(const test::Cloud& cloud, const Break& breaks) const
  {
    SphereHierarchy hierarchy(cloud.view(), options_);
    hierarchy.buildAll();
    EXPECT_THAT(hierarchy.validate().lines, IsEmpty());
    breaks(const_cast<SphereHierarchy::Storage&>(hierarchy.storage()));
    return hierarchy.validate().lines;
  }

  std::vector<std::string> linesOf(const Break& breaks) const { return linesOf(test::Cloud(points_), breaks); }

  /// The parts of the first voxel's block, one after the other: x, y, z, records.
  static float* block(SphereHierarchy::Storage& s) { return s.voxels[0].block; }
  static std::uint32_t* records(SphereHierarchy::Storage& s)
  {
    return reinterpret_cast<std::uint32_t*>(s.voxels[0].block + 3 * std::size_t{s.voxels[0].count});
  }
  static Node& root(SphereHierarchy::Storage& s) { return s.voxels[0].nodes[0]; }

  /// The first leaf of the first voxel: its node, and which child.
  static std::pair<Node&, std::uint32_t> leaf(SphereHierarchy::Storage& s)
  {
    for (Node& node : s.voxels[0].nodes)
      for (std::uint32_t i = 0; i < node.count; ++i)
        if (node.isLeaf(i)) return {node, i};
    throw std::logic_error("no leaf");
  }

  std::vector<Point3> points_;
  HierarchyOptions options_;
};

TEST_F(HierarchyDefects, OfVoxels)
{
  EXPECT_THAT(linesOf([](auto& s) { std::swap(s.voxels[0].key, s.voxels[1].key); }),
              Contains("voxel 1: key out of order"));
  EXPECT_THAT(linesOf([](auto& s) { s.voxels[0].key = s.voxels[1].key; }), Contains("voxel 1: key out of order"));
  EXPECT_THAT(linesOf([](auto& s) { ++s.voxels[1].begin; }),
              Contains("voxel 1: its points do not begin where the last voxel's end"));
  EXPECT_THAT(linesOf([](auto& s) { s.voxels[1].nodes.clear(); }), Contains("voxel 1: no nodes"));
  EXPECT_THAT(linesOf([](auto& s) { ++s.size; }), Contains("cloud: voxels hold 128 of 129 points"));
}

TEST_F(HierarchyDefects, OfPoints)
{
  std::vector<std::string> lines = linesOf([](auto& s) { records(s)[0] = 128; });
  EXPECT_THAT(lines, Contains("voxel 0: no such record: 128"));
  EXPECT_THAT(lines, Contains(HasSubstr("is held 0 times, not 1")));
  lines = linesOf([](auto& s) { records(s)[0] = records(s)[1]; });
  EXPECT_THAT(lines, Contains(HasSubstr("is held 0 times, not 1")));
  EXPECT_THAT(lines, Contains(HasSubstr("is held 2 times, not 1")));
  lines = linesOf([](auto& s) { s.voxels[1].key = std::uint64_t{1} << 40; });
  EXPECT_THAT(lines, Contains(HasSubstr("farther outside its voxel's cell than is known")));
  for (std::uint32_t k = 0; k < 3; ++k) {
    lines = linesOf([k](auto& s) { block(s)[k * s.voxels[0].count] = 100.0f; });
    EXPECT_THAT(lines, Contains(HasSubstr("beyond the reach")));
    lines = linesOf([k](auto& s) { block(s)[k * s.voxels[0].count] *= 1.0f - 0x1p-22f; });
    EXPECT_THAT(lines, Contains(HasSubstr("stored too far from where it is")));
    EXPECT_THAT(lines, Contains(HasSubstr("not stored as given in a lossless frame")));
    EXPECT_THAT(lines, testing::Not(Contains(HasSubstr("beyond the reach"))));
  }
}

TEST_F(HierarchyDefects, OfNodes)
{
  EXPECT_THAT(linesOf([](auto& s) { root(s).child[1] = 999; }), Contains("voxel 0: node 999: no such node"));
  EXPECT_THAT(linesOf([](auto& s) { root(s).count = 0; }), Contains("voxel 0: node 0: has 0 children"));
  EXPECT_THAT(linesOf([](auto& s) { root(s).count = 9; }), Contains("voxel 0: node 0: has 9 children"));
  EXPECT_THAT(linesOf([](auto& s) { ++root(s).begin[0]; }),
              Contains("voxel 0: node 0: its children do not span its range"));
  EXPECT_THAT(linesOf([](auto& s) { --root(s).begin[root(s).count]; }),
              Contains("voxel 0: node 0: its children do not span its range"));
  EXPECT_THAT(linesOf([](auto& s) { root(s).begin[2] = root(s).begin[1]; }),
              Contains("voxel 0: node 0: child 1 is empty"));
  EXPECT_THAT(linesOf([](auto& s) { root(s).r[1] *= 0.5f; }),
              Contains(HasSubstr("voxel 0: node 0: sphere 1 does not contain point")));
  EXPECT_THAT(linesOf([](auto& s) { s.top[0].r[1] *= 0.5f; }),
              Contains(HasSubstr("cloud: node 0: sphere 1 does not contain point")));
  EXPECT_THAT(linesOf([](auto& s) { ++root(s).lowest[1]; }),
              Contains("voxel 0: node 0: lowest record of child 1 is wrong"));
  EXPECT_THAT(linesOf([](auto& s) { --s.top[0].lowest[1]; }),
              Contains("cloud: node 0: lowest record of child 1 is wrong"));
  EXPECT_THAT(linesOf([](auto& s) {
                s.top[0].count = 1;
                s.top[0].begin[1] = 2;
              }),
              Contains("cloud: node 0: leaf 0 is too large"));
}

TEST_F(HierarchyDefects, OfInnerNodes)
{
  std::vector<Point3> many; // more than eight leaves hold
  for (int i = 0; i < 4096; ++i)
    many.push_back({0.03125 * (i % 32) + 0.01, 0.03125 * (i / 32 % 16) + 0.01, 0.125 * (i / 512) + 0.01});
  const test::Cloud cloud(many);
  EXPECT_THAT(linesOf(cloud,
                      [](auto& s) {
                        ASSERT_FALSE(root(s).isLeaf(1));
                        root(s).child[1] = 0;
                      }),
              Contains("voxel 0: node 0: child 1 does not follow its parent"));
  EXPECT_THAT(linesOf(cloud, [](auto& s) { root(s).child[1] = Node::kLeaf; }),
              Contains("voxel 0: node 0: leaf 1 is too large"));
}

TEST_F(HierarchyDefects, OfLeavesOfOnePlace)
{
  const std::vector<Point3> one_place(20, Point3{0.5, 0.25, 0.125});
  const auto linesAfter = [&](const Break& breaks) {
    test::Cloud cloud(one_place);
    cloud.setRadii(std::vector<float>(20, 0.25f));
    cloud.setUncertainties(0.0, std::vector<float>(20, 0.125f));
    return linesOf(cloud, breaks);
  };
  const auto is_too_large = Contains("voxel 0: node 0: leaf 0 is too large");
  EXPECT_THAT(linesAfter([](auto& s) { ASSERT_TRUE(leaf(s).first.isCoincident(leaf(s).second)); }), IsEmpty());
  EXPECT_THAT(linesAfter([](auto& s) { std::swap(records(s)[0], records(s)[19]); }), is_too_large);
  EXPECT_THAT(linesAfter([](auto& s) { const_cast<float*>(s.view.radii)[19] = 0.125f; }), is_too_large);
  EXPECT_THAT(linesAfter([](auto& s) { const_cast<float*>(s.view.uncertainties)[19] = 0.0f; }), is_too_large);
  EXPECT_THAT(linesAfter([](auto& s) {
                auto* last =
                    const_cast<unsigned char*>(static_cast<const unsigned char*>(s.view.data)) + 19 * s.view.stride;
                reinterpret_cast<float*>(last)[2] = 0.0625f;
              }),
              is_too_large);
}

TEST_F(HierarchyDefects, OfTriangles)
{
  const std::vector<Point3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto linesAfter = [&](const Break& breaks) {
    test::Cloud cloud(corners);
    std::vector<std::uint32_t> same;
    for (int i = 0; i < 60; ++i) same.push_back(static_cast<std::uint32_t>(i % 3));
    cloud.setTriangles(same);
    return linesOf(cloud, breaks);
  };
  EXPECT_THAT(linesAfter([](auto& s) { const_cast<float*>(s.view.radii)[7] *= 0.5f; }),
              Contains("voxel 0: triangle 7 reaches out of its ball"));
  EXPECT_THAT(linesAfter([](auto& s) { const_cast<std::uint32_t*>(s.view.triangles->corners)[57] = 1; }),
              Contains("voxel 0: node 0: leaf 0 is too large"));
}

TEST_F(HierarchyDefects, OfSlabs)
{
  const auto fits = [](LazySlabs& slabs, SphereHierarchy::Storage& s, double thinner) {
    BuildWork unasked;
    auto* fitted = const_cast<Slabs*>(slabs.of(s.voxels[0], s.view, unasked));
    for (std::size_t n = 0; n < s.voxels[0].nodes.size(); ++n)
      for (float& h : fitted[n].h) h *= static_cast<float>(thinner);
  };
  std::vector<Point3> many;
  for (int i = 0; i < 4096; ++i) many.push_back({i % 64 / 64.0, i / 64 / 64.0, 0.01 * (i % 5) + 0.1});
  const test::Cloud cloud(many);
  const auto is_named = Contains(HasSubstr(" does not contain point "));
  for (const auto slabs : {&Voxel::slabs, &Voxel::cross_slabs}) {
    EXPECT_THAT(linesOf(cloud, [&](auto& s) { fits(s.voxels[0].*slabs, s, 1.0); }), IsEmpty());
    EXPECT_THAT(linesOf(cloud, [&](auto& s) { fits(s.voxels[0].*slabs, s, 1.0 - 0x1p-12); }), is_named);
  }
}

TEST_F(HierarchyDefects, AreAHundredAtMost)
{
  const auto lines = linesOf([](auto& s) { s.voxels[0].frame.origin = {7, 7, 7}; });
  EXPECT_EQ(lines.size(), 100u);
}

} // namespace
} // namespace pcl_bsh
