// SPDX-License-Identifier: BSD-3-Clause
#include "peer.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace pcl_bsh::bench {
namespace {

pcl::PointCloud<pcl::PointXYZ>::Ptr toPcl(const Points& points)
{
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(points.size());
  for (const Point& p : points) cloud->emplace_back(p.x, p.y, p.z);
  return cloud;
}

/// Flags by radiusSearch(max_nn = 1), the way PCL offers to ask for existence.
template <typename Search>
class PclPeer : public ExistencePeer {
public:
  void adopt(const Points& points) override { cloud_ = toPcl(points); }

  void build(const Points&, float d) override
  {
    search_ = makeSearch(d);
    index();
  }

  void release() override { search_.reset(); }

  void flag(const Points& queries, std::size_t begin, std::size_t end, float d, std::uint8_t* out) const override
  {
    for (std::size_t i = begin; i < end; ++i) out[i] = near(queries[i], d);
  }

  bool any(const Point* queries, std::size_t count, float d) const override
  {
    for (std::size_t i = 0; i < count; ++i)
      if (near(queries[i], d)) return true;
    return false;
  }

private:
  static std::unique_ptr<Search> makeSearch(float d);
  void index();

  bool near(const Point& query, float d) const
  {
    thread_local pcl::Indices found;
    thread_local std::vector<float> squared;
    return search_->radiusSearch(pcl::PointXYZ(query.x, query.y, query.z), d, found, squared, 1) > 0;
  }

  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud_;
  std::unique_ptr<Search> search_;
};

using KdTree = pcl::KdTreeFLANN<pcl::PointXYZ>;
using Octree = pcl::octree::OctreePointCloudSearch<pcl::PointXYZ>;

template <>
std::unique_ptr<KdTree> PclPeer<KdTree>::makeSearch(float)
{
  return std::make_unique<KdTree>(/*sorted=*/false);
}

template <>
void PclPeer<KdTree>::index()
{
  search_->setInputCloud(cloud_);
}

template <>
std::unique_ptr<Octree> PclPeer<Octree>::makeSearch(float d)
{
  return std::make_unique<Octree>(d);
}

template <>
void PclPeer<Octree>::index()
{
  search_->setInputCloud(cloud_);
  search_->addPointsFromInputCloud();
}

} // namespace

std::unique_ptr<ExistencePeer> makePclKdTree()
{
  return std::make_unique<PclPeer<KdTree>>();
}
std::unique_ptr<ExistencePeer> makePclOctree()
{
  return std::make_unique<PclPeer<Octree>>();
}

} // namespace pcl_bsh::bench
