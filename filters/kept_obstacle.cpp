// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/kept_obstacle.h>

#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/surface/polygon_triangles.h>

#include <pcl/PCLPointField.h>
#include <pcl/common/io.h>

#include <cstring>
#include <string>
#include <utility>

namespace pcl_bsh {
namespace {

/// Of a field as it is written. Bytes beside it may change.
/// @param name empty: none
std::uint64_t fieldChecksum(const PointsView& view, const std::vector<pcl::PCLPointField>& fields,
                            const std::string& name)
{
  std::uint64_t sum = 0;
  for (const pcl::PCLPointField& named : fields) {
    if (name.empty() || named.name != name) continue;
    const auto bytes = static_cast<std::size_t>(pcl::getFieldSize(named.datatype));
    if (named.offset + bytes > view.stride) continue; // it is refused where it is read
    const auto* record = static_cast<const unsigned char*>(view.data) + named.offset;
    for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
      std::uint64_t word = 0;
      std::memcpy(&word, record, bytes);
      sum = mixed(sum, word);
    }
  }
  return sum;
}

} // namespace

std::shared_ptr<const SurfaceCover> coverOf(const pcl::PolygonMesh::ConstPtr& mesh, double tolerance,
                                            bool polygons_apart)
{
  if (!mesh) throw std::invalid_argument("obstacle surface is null: give a mesh without polygons if there is none");
  const PointsView vertices = viewOf(mesh->cloud);
  std::vector<Triangle> triangles;
  triangles.reserve(mesh->polygons.size());
  std::vector<std::uint32_t> polygon_of; // a triangle
  std::vector<std::uint32_t> corners;
  for (const pcl::Vertices& polygon : mesh->polygons) {
    corners.clear(); // a negative index becomes one that is not there
    for (const pcl::index_t vertex : polygon.vertices) corners.push_back(static_cast<std::uint32_t>(vertex));
    addTriangles(vertices, corners.data(), corners.size(), triangles);
    if (polygons_apart)
      polygon_of.resize(triangles.size(), static_cast<std::uint32_t>(&polygon - mesh->polygons.data()));
  }
  SurfaceRequest request;
  request.tolerance = tolerance;
  request.triangles_apart = polygons_apart;
  auto cover = std::make_shared<SurfaceCover>(coverSurface(vertices, triangles, request));
  if (polygons_apart) {
    for (std::uint32_t& part : cover->triangles) part = polygon_of[part];
    cover->triangle_count = mesh->polygons.size();
  }
  return cover;
}

void KeptObstacle::setSurface(const std::shared_ptr<const SurfaceCover>& cover)
{
  if (!cover) throw std::invalid_argument("obstacle surface is null: give the cover of no triangles if there is none");
  setView([cover] { return cover->view(); }, [] { return std::vector<pcl::PCLPointField>(); });
  surface_ = cover;
}

void KeptObstacle::setView(std::function<PointsView()> view, Fields fields)
{
  view(); // a cloud that cannot be read is refused here, not at the first use
  view_ = std::move(view);
  fields_ = std::move(fields);
  surface_.reset();
  first_seen_.reset();
  hierarchy_.reset();
  spacings_.reset();
}

void KeptObstacle::setUncertainty(const Uncertainty& uncertainty)
{
  checkUncertainty("obstacle cloud", uncertainty);
  Uncertainty copy = uncertainty;
  uncertainty_ = std::move(copy);
  hierarchy_.reset();
}

const SphereHierarchy& KeptObstacle::hierarchy(unsigned threads)
{
  if (!view_) throw std::invalid_argument("obstacle cloud is missing: call setObstacleCloud() before filtering");
  const PointsView view = view_();
  const auto fields = uncertainty_.field.empty() ? std::vector<pcl::PCLPointField>() : fields_();
  const Seen seen{view.data, view.count, checksumOf(view)};
  const std::uint64_t uncertainties = fieldChecksum(view, fields, uncertainty_.field);
  // The hierarchy points into the cloud's memory, its spheres hold the points as they were, and so do the spacings,
  // which outlive it.
  if ((first_seen_ && *first_seen_ != seen) || (hierarchy_ && uncertainties != uncertainties_))
    throw std::invalid_argument("obstacle cloud has changed since setObstacleCloud(): call it again");
  if (hierarchy_) return *hierarchy_;
  HierarchyOptions options;
  options.threads = threads;
  hierarchy_ =
      std::make_shared<SphereHierarchy>(withUncertainty(view, fields, "obstacle cloud", uncertainty_), options);
  first_seen_ = seen;
  uncertainties_ = uncertainties;
  return *hierarchy_;
}

const PointsView& KeptObstacle::view() const
{
  return hierarchy_->view();
}

const std::vector<float>& KeptObstacle::spacings(double widest_gap, unsigned threads)
{
  if (!spacings_ || spaced_gap_ != widest_gap) {
    const double gap = widest_gap > 0.0 ? widest_gap : usualGap(*hierarchy_);
    spacings_ = std::make_shared<std::vector<float>>(gap > 0.0 ? patchSpacings(*hierarchy_, gap, threads)
                                                               : std::vector<float>(hierarchy_->view().count));
    spaced_gap_ = widest_gap;
  }
  return *spacings_;
}

} // namespace pcl_bsh
