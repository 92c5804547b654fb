// SPDX-License-Identifier: BSD-3-Clause
#include "hard_cases.h"

#include "pcd_points.h"

#include <pcl_bsh/geometry/exact_distance.h>

#include <nlohmann/json.hpp>

#include <fstream>

namespace pcl_bsh::hard_cases {

std::size_t countPairs(const HardCase& c)
{
  const ExactDistance distance(c.pose_a, c.pose_b);
  const test::Cloud a(c.a, {c.scalar}), b(c.b, {c.scalar});
  std::size_t pairs = 0;
  for (std::uint32_t i = 0; i < c.a.size(); ++i) {
    const Point3 p = a.view().point(i);
    for (std::uint32_t j = 0; isFinite(p) && j < c.b.size(); ++j) {
      const Point3 q = b.view().point(j);
      pairs += isFinite(q) && distance.compare(p, q, c.clearance) <= 0;
    }
  }
  return pairs;
}

std::vector<HardCase> catalogue()
{
  const std::string folder = PCL_BSH_SOURCE_DIR "/test/hard_cases/";
  std::ifstream file(folder + "cases.json");
  std::vector<HardCase> cases;
  const nlohmann::json all = nlohmann::json::parse(file);
  for (const nlohmann::json& told : all.at("cases")) {
    test::PcdPoints a = test::readPcdPoints(folder + told.at("a").get<std::string>()),
                    b = test::readPcdPoints(folder + told.at("b").get<std::string>());
    HardCase c{told.at("name"),      std::move(a.points),        std::move(b.points),
               told.at("clearance"), told.at("colliding_pairs"), a.scalar};
    c.colliding_a = told.at("colliding_points_of_a");
    c.colliding_b = told.at("colliding_points_of_b");
    if (!told.at("smallest_distance").is_null()) c.smallest_distance = told.at("smallest_distance");
    if (told.contains("pose"))
      for (Eigen::Index i = 0; i < 12; ++i)
        c.pose_b.matrix()(i / 4, i % 4) = told.at("pose").at(static_cast<std::size_t>(i));
    cases.push_back(std::move(c));
  }
  return cases;
}

} // namespace pcl_bsh::hard_cases
