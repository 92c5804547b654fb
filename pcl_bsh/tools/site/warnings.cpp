// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "warnings.h"

#include <pcl_bsh/geometry/coordinate_spacing.h>
#include <pcl_bsh/question/warnings.h>
#include <pcl_bsh/site/site_clashes.h>

#include <optional>
#include <string>

namespace pcl_bsh::cli {

NamedCloud namedSite(const site::Site& site)
{
  NamedCloud cloud;
  cloud.name = site.folder.string();
  cloud.points = site.points;
  for (const site::Tile& tile : site.tiles)
    if (tile.bounds) cloud.finite += tile.points; // points that are not finite have tiles of their own
  cloud.spacing.emplace();
  cloud.spacing->samples = cloud.finite;
  cloud.spacing->median = site::spacingOf(site);
  if (!site.bounds) return cloud;
  cloud.box = Eigen::AlignedBox3d(Eigen::Vector3d::Map(site.bounds->low.data()),
                                  Eigen::Vector3d::Map(site.bounds->high.data()));
  for (const pcl::PCLPointField& field : site.fields) {
    if (field.name != "x" || field.datatype != pcl::PCLPointField::FLOAT32) continue;
    cloud.coordinate_spacing =
        float32Spacing(cloud.box.min().cwiseAbs().cwiseMax(cloud.box.max().cwiseAbs()).maxCoeff());
  }
  return cloud;
}

std::vector<std::string> warningsOf(const site::Site& site, const NamedCloud& obstacle,
                                    const std::vector<Eigen::Isometry3d>& poses, const SiteOptions& options)
{
  const bool distances = options.question == SiteQuestion::closest || options.question == SiteQuestion::distances;
  const Question question{namedSite(site), obstacle, poses,
                          distances ? std::nullopt : std::optional(options.clearance)};
  std::vector<std::string> told;
  addTexts(warningsOf(question), told);
  return told;
}

} // namespace pcl_bsh::cli
#endif
