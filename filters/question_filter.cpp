// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/question_filter.h>

#include <pcl_bsh/surface/polygon_triangles.h>

#include <pcl/console/print.h>

#include <utility>

namespace pcl_bsh {

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

Answer QuestionFilter::answer(Shape input, const Wanted& wanted)
{
  if (!obstacle_) throw std::invalid_argument("obstacle cloud is missing: call setObstacleCloud() before filtering");
  Question question = question_;
  question.wanted = wanted;
  question.wanted.spacings = wanted.collisions() && !measured_;
  if (!question.density) question.widest_gap.reset(); // a setting that waits
  Answer found = ask(question, input, obstacle_);
  measured_ |= question.wanted.spacings;
  for (const Warning& warning : warnings_.unheard(std::move(found.warnings))) {
    if (warn_)
      warn_(warning.text);
    else
      PCL_WARN("[pcl_bsh] %s.\n", warning.text.c_str());
  }
  work_ = found.work;
  sparse_ = found.sparse;
  undecided_ = found.collisions.undecided + found.sparse;
  return found;
}

void partRecords(const PointsView& input, const std::vector<std::uint8_t>& passes, bool negative, pcl::Indices& kept,
                 pcl::Indices* removed)
{
  pcl::Indices keep;
  pcl::Indices remove;
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::uint32_t record = input.record(i);
    if ((passes[record] != 0) != negative && isFinite(input.point(record)))
      keep.push_back(static_cast<pcl::index_t>(record));
    else if (removed)
      remove.push_back(static_cast<pcl::index_t>(record));
  }
  kept = std::move(keep);
  if (removed) *removed = std::move(remove);
}

void CollisionSettings::set(Uncertainty& member, const char* cloud, const Uncertainty& uncertainty)
{
  checkUncertainty(cloud, uncertainty);
  Uncertainty copy = uncertainty;
  member = std::move(copy);
}

std::vector<Verdict> CollisionSettings::collisionFlags(Shape input)
{
  Wanted wanted;
  wanted.flags = true;
  return answer(std::move(input), wanted).collisions.flags;
}

TrajectoryResult CollisionSettings::alongTrajectory(Shape input)
{
  Wanted wanted;
  wanted.flags = wanted.contacts = wanted.poses = true;
  return answer(std::move(input), wanted).collisions;
}

std::vector<std::uint8_t> CollisionSettings::passing(Shape input)
{
  return maskOf(collisionFlags(std::move(input)), true);
}

PointDistances DistanceSettings::distances(Shape input)
{
  Wanted wanted;
  wanted.distances = true;
  return answer(std::move(input), wanted).distances.a;
}

std::vector<std::uint8_t> DistanceSettings::passing(Shape input, std::vector<float>* told)
{
  Wanted wanted;
  wanted.within = true;
  wanted.distances = told != nullptr;
  Answer found = answer(std::move(input), wanted);
  if (told) told->assign(found.distances.a.distance.begin(), found.distances.a.distance.end());
  return std::move(found.within);
}

} // namespace pcl_bsh
