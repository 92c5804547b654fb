// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/question_filter.h>

#include <pcl_bsh/hierarchy/polygon_triangles.h>
#include <pcl_bsh/question/options.h>

#include <pcl/console/print.h>

#include <utility>

namespace pcl_bsh {

MeshTriangles trianglesOf(const pcl::PolygonMesh& mesh)
{
  const PointsView vertices = viewOf(mesh.cloud);
  MeshTriangles found;
  found.triangles.reserve(mesh.polygons.size());
  std::vector<std::uint32_t> corners;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const pcl::Indices& polygon = mesh.polygons[p].vertices;
    corners.assign(polygon.begin(), polygon.end()); // a negative index becomes one that is not there
    addTriangles(vertices, corners.data(), corners.size(), found.triangles);
    found.polygons.resize(found.triangles.size(), static_cast<std::uint32_t>(p));
  }
  return found;
}

PointsView viewOf(const pcl::PolygonMesh::ConstPtr& mesh)
{
  if (!mesh) throw std::invalid_argument("surface is null: give a mesh without polygons where you have no surface");
  PointsView vertices = viewOf(mesh->cloud);
  vertices.owner = mesh;
  return viewOf(trianglesOf(vertices, std::make_shared<const std::vector<Triangle>>(trianglesOf(*mesh).triangles)));
}

Answer QuestionFilter::answer(Shape input, const Wanted& wanted)
{
  if (!obstacle_) throw std::invalid_argument("obstacle cloud is missing: call setObstacleCloud() before filtering");
  Question question = question_;
  question.wanted = wanted;
  question.wanted.spacings = wanted.collisions() && !measured_;
  leaveOutWaiting(question);
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
  unseen_ = found.unseen;
  obstacle_flags_ = question.seen ? found.obstacle_flags : std::vector<Verdict>();
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
  wanted.flags = wanted.contacts = true;
  wanted.poses = question_.swept == 0.0; // of motion they take longer
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
