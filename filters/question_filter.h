// SPDX-License-Identifier: BSD-3-Clause
// Base of all filters of this project, without a point type: a question about an obstacle, and its
// answer.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/uncertainty.h>

#include <pcl/PolygonMesh.h>
#include <pcl/common/io.h>
#include <pcl/types.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The fields of a cloud's records.
template <typename PointT>
std::vector<RecordField> fieldsOfRecords(const pcl::PointCloud<PointT>&)
{
  return recordFields(pcl::getFields<PointT>());
}
/// Fields of a cloud that are known at run time only.
inline std::vector<RecordField> fieldsOfRecords(const pcl::PCLPointCloud2& cloud)
{
  return recordFields(cloud.fields);
}

/// The triangles that a mesh's polygons are cut into (addTriangles()). Results about a mesh name triangles as records.
struct MeshTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> polygons; ///< which polygon each is a part of
};

/// Triangles of polygons with any number of corners. @throws std::invalid_argument as addTriangles() does
MeshTriangles trianglesOf(const pcl::PolygonMesh& mesh);

/// A mesh of PCL as a cloud of its triangles, which keeps it alive.
/// @throws std::invalid_argument when the pointer is null, or as trianglesOf() and viewOf() do
PointsView viewOf(const pcl::PolygonMesh::ConstPtr& mesh);

/// The settings of a question. A setting without a meaning makes filtering throw. Lengths are in the clouds' own unit.
class QuestionFilter {
public:
  /// Sets, and returns, all settings at once, also those that have no setter here. `wanted` is for filters to say.
  void setQuestion(const Question& question) { question_ = question; }
  const Question& getQuestion() const { return question_; }

  /// The cloud that the input is compared with: pcl::PointCloud of any point type, or pcl::PCLPointCloud2 (float64 at
  /// full precision). Its hierarchy is built on the first use and kept until the next call of this method. All other
  /// settings and the input may change meanwhile. The cloud's points must not: every use throws when they have (Shape).
  /// An empty cloud collides with nothing, and everything is farther from it than any length.
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does.
  template <typename Cloud>
  void setObstacleCloud(const std::shared_ptr<Cloud>& cloud)
  {
    if (!cloud) throw std::invalid_argument("obstacle cloud is null: give an empty cloud if there is no obstacle");
    obstacle_ = Shape(
        "the obstacle", [cloud] { return viewOf(*cloud); }, [cloud] { return fieldsOfRecords(*cloud); });
  }

  /// A surface instead of a cloud: the mesh's polygons, and all that lies on them. Results name their triangles:
  /// trianglesOf() says which polygon has each. The inside of a closed surface belongs to it only with
  /// setObstacleSolid(). The mesh must not change, as a cloud must not.
  /// @throws std::invalid_argument as viewOf() does
  void setObstacleSurface(const pcl::PolygonMesh::ConstPtr& mesh) { setSurface(viewOf(mesh)); }

  /// Sets triangles that are in no pcl::PolygonMesh. @throws std::invalid_argument as viewOf() does
  void setObstacleSurface(const TrianglesView& triangles) { setSurface(viewOf(triangles)); }

  /// Pose of the obstacle in the input's frame, T_input_obstacle. Rigid within 1e-6 (default: identity). Takes any of
  /// Eigen's transforms, and 4x4 matrices as PCL's registration returns them; float or double. Replaces a trajectory.
  template <typename Scalar, int Mode, int Options>
  void setPose(const Eigen::Transform<Scalar, 3, Mode, Options>& pose)
  {
    setPose(pose.matrix());
  }
  template <typename Derived>
  void setPose(const Eigen::MatrixBase<Derived>& pose)
  {
    question_.pose.matrix() = pose.template cast<double>();
    question_.path.reset();
  }

  /// true: an obstacle surface includes what its faces enclose. The faces must close: filtering throws where they do
  /// not, and names the first open edge. Its inside collides at any clearance; distances there are negative, and limits
  /// of distances may be. Default: false, a surface alone.
  void setObstacleSolid(bool solid) { question_.solid = solid; }

  /// How sure the answer has to be: less is faster. Default: exact. Filters say what they do with one that stops early.
  void setAccuracy(const Accuracy& accuracy) { question_.accuracy = accuracy; }

  /// Default 1; 0: all of the machine's. The answer is the same for any number.
  void setNumberOfThreads(unsigned threads) { question_.threads = threads; }

  /// For distances, and along a trajectory: called now and then, by the thread that filters, with the fraction done in
  /// [0, 1], ascending. False: stop, filtering throws Cancelled (pcl_bsh/base/cancelled.h). An exception that it throws
  /// comes out of the filter, too. Either way outputs stay as they were.
  void setProgress(std::function<bool(double)> progress) { question_.progress = std::move(progress); }

  /// Called with each sentence that users should know beside the answer (pcl_bsh/question/warnings/warnings.h), of each
  /// kind once in the filter's life, since clouds come in streams. How far points are apart is measured at the first
  /// query alone. Default: PCL_WARN.
  void setWarn(std::function<void(const std::string&)> warn) { warn_ = std::move(warn); }

  /// Cost of the last query.
  const Work& getWork() const { return work_; }

  /// How many points of the input the last query left undecided. 0 unless its accuracy let it stop early, points are
  /// uncertain, or the density guard is on.
  std::size_t getUndecidedCount() const { return undecided_; }

  /// How many points it left undecided because the obstacle is not scanned densely enough.
  std::size_t getSparseCount() const { return sparse_; }

  /// The part of the obstacle that the last query found unseen (setSeenOnly()).
  const Answer::Unseen& getUnseen() const { return unseen_; }

  /// Verdicts of the obstacle's points in the last query, as numbers: 0 free, 1 collides, 2 undecided, 4 unseen; along
  /// a trajectory the gravest of its poses. Empty without setSeenOnly().
  const std::vector<Verdict>& getObstacleFlags() const { return obstacle_flags_; }

protected:
  QuestionFilter() = default;
  ~QuestionFilter() = default;
  QuestionFilter(const QuestionFilter&) = default;
  QuestionFilter& operator=(const QuestionFilter& other)
  {
    return *this = QuestionFilter(other); // the copy may throw, the move does not: all is assigned or nothing
  }
  QuestionFilter(QuestionFilter&&) = default;
  QuestionFilter& operator=(QuestionFilter&&) = default;

  /// Asks the question, and tells the warnings that are new. @throws std::invalid_argument when the obstacle is
  /// missing, and as ask() does
  Answer answer(Shape input, const Wanted& wanted);

  /// Points, with the uncertainties of the question. @param fields of their records
  template <typename Cloud>
  Shape inputOf(const PointsView& points, const Cloud& cloud) const
  {
    const bool by_field = !question_.uncertainty.field.empty() || !question_.origin.field.empty();
    return Shape("the input", points, by_field ? fieldsOfRecords(cloud) : std::vector<RecordField>());
  }

  Question question_;
  std::size_t undecided_ = 0; ///< of the last query

private:
  void setSurface(const PointsView& triangles)
  {
    obstacle_ = Shape(
        "the obstacle", [triangles] { return triangles; }, [] { return std::vector<RecordField>(); });
  }

  Shape obstacle_;
  std::function<void(const std::string&)> warn_; ///< empty: PCL_WARN
  WarningsOnce warnings_;
  bool measured_ = false; ///< whether spacings were measured
  Work work_;
  std::size_t sparse_ = 0;
  Answer::Unseen unseen_;
  std::vector<Verdict> obstacle_flags_;
};

/// Divides the input's records, in their order, into kept and removed ones. Points that are not finite are always
/// removed. `kept` may be the very list of indices that `input` is a view of.
/// @param passes one per record: 1 where it is kept or, if `negative`, where it is not
/// @param removed may be null
void partRecords(const PointsView& input, const std::vector<std::uint8_t>& passes, bool negative, pcl::Indices& kept,
                 pcl::Indices* removed);

/// The settings that filters of collisions add.
///
/// Accuracy: no point is called free or colliding that is not, within the tolerance if one was given. A point that an
/// early stop leaves undecided is never kept as free: it counts as colliding wherever points are kept or removed; its
/// flag is 2. A time is that of the query alone, after both clouds are sorted into voxels. Filtering throws for what
/// TrajectoryRequest::accuracy says that a trajectory cannot tell.
class CollisionSettings : public QuestionFilter {
public:
  /// Greatest distance at which two points collide; touching counts. Finite and >= 0 (default 0).
  void setClearance(double clearance) { question_.clearance = clearance; }

  /// The obstacle moves: its poses in the input's frame, one after another, each rigid as setPose() asks. A point
  /// collides if it does at any of them. At least one pose. Replaces setPose(), and the other way round.
  void setTrajectory(const std::vector<Eigen::Isometry3d>& poses) { question_.path = poses; }

  /// > 0: points collide with the motion between consecutive poses of the trajectory too, to this tolerance. Points
  /// within clearance collide, points beyond clearance + tolerance do not. The obstacle's origin moves straight, the
  /// rotation is spherically interpolated. 0 (default): at the poses alone. Finite and >= 0; not at one pose.
  void setSwept(double tolerance) { question_.swept = tolerance; }

  /// How far the points of the input, or of the obstacle, may truly be from where they were measured. Then a point
  /// collides where it does wherever all points truly are, and it is free where it cannot collide. Else it is
  /// undecided: its flag is 2, and it counts as colliding wherever points are kept or removed. Default: not at all.
  /// @throws std::invalid_argument for numbers that are not finite and >= 0. Filtering throws where a field is missing,
  ///   or holds such a number for a finite point.
  void setInputUncertainty(const Uncertainty& uncertainty) { set(question_.uncertainty, "the input", uncertainty); }
  void setObstacleUncertainty(const Uncertainty& uncertainty)
  {
    set(question_.obstacle_uncertainty, "the obstacle", uncertainty);
  }

  /// The density guard. A free point is *not scanned densely enough* where a point of the obstacle is no farther than
  /// the clearance and half the spacing of the obstacle's points there. So it is undecided: its flag is 3, and it
  /// counts as colliding wherever points are kept or removed. FlagsRequest::spacings_of_b says what is promised and
  /// what not, patchSpacings() how wide the holes between the obstacle's points are taken to be. These are measured
  /// once for an obstacle. At one pose: along a trajectory, filtering throws. A surface has no holes, and nothing to
  /// guard. Default: false.
  void setDensityGuard(bool density_guard) { question_.density = density_guard; }

  /// A wider gap of the obstacle is an opening, not a surface. 0 (default): eight times the median distance of its
  /// points from their nearest neighbours. Where lines of a scan are farther apart than that, give more than what is
  /// between the lines. Finite and >= 0. Counts with the density guard alone.
  void setWidestGap(double widest_gap)
  {
    question_.widest_gap = widest_gap == 0.0 ? std::nullopt : std::optional(widest_gap);
  }

  /// Free points of the obstacle count as unseen where no scanner of the input saw that the space within the clearance
  /// about them is empty. pcl_bsh/seen/seen_space.h defines seen, and its blind spots. Needs setScanOrigins(). Not with
  /// swept motion. Flags of the input stay as they are. Default: false.
  void setSeenOnly(bool seen_only) { question_.seen = seen_only; }

  /// Where the input's scanners stood, in its frame; with setSeenOnly() alone.
  void setScanOrigins(const ScanOrigins& origins) { question_.origin = origins; }

  /// SeenOptions::angle of the beams, in radians, in [1e-4, 0.25]; 0 (default): measured of each scan.
  void setSeenAngle(double angle) { question_.seen_angle = angle == 0.0 ? std::nullopt : std::optional(angle); }

  /// The points of the input, and of the obstacle, that are not compared; their beams and their density still count. A
  /// field's name is one of the cloud's. Default: all count.
  void setIgnoredPoints(const IgnoredPoints& ignored) { question_.ignore_points = ignored; }
  void setIgnoredObstaclePoints(const IgnoredPoints& ignored) { question_.obstacle_ignore_points = ignored; }

  /// How far the obstacle's pose, or each of its trajectory, may truly be from what is given. Default: not at all.
  void setPoseUncertainty(const PoseUncertainty& uncertainty) { question_.pose_uncertainty = uncertainty; }

protected:
  CollisionSettings() { question_.clearance = 0.0; }

  /// One per record of the input, or per triangle of its surface.
  std::vector<Verdict> collisionFlags(Shape input);

  /// Returns all that is known of each record along the trajectory, or at the one pose.
  TrajectoryResult alongTrajectory(Shape input);

  /// One per record: 1 where it is free, else 0.
  std::vector<std::uint8_t> passing(Shape input);

private:
  static void set(Uncertainty& member, const char* cloud, const Uncertainty& uncertainty);
};

/// The settings that the filter of distances adds.
///
/// Accuracy: exact() or tolerance(), with which a distance is that much greater than the true one at most. Filtering
/// throws for an accuracy that stops early, because points would be left without a distance.
class DistanceSettings : public QuestionFilter {
public:
  /// The distances of the points that are kept, both ends inclusive and compared exactly. least <= most, and most may
  /// be infinity; 0 <= least unless the obstacle is solid. Default: 0 and infinity, all finite points that are not
  /// inside of a solid.
  void setFilterLimits(double least, double most) { question_.limits = {least, most}; }

  /// Greater distances are told as NaN; which points are kept does not depend on it. >= 0, inclusive. Default:
  /// infinity, no limit. A small one is faster.
  void setMaxDistance(double max_distance) { question_.max_distance = max_distance; }

protected:
  PointDistances distances(Shape input);

  /// 1: within the limits. @param told null, or gets the distances as floats, one per record: NaN beyond max_distance,
  /// where the record is not finite, and outside the view's subset
  std::vector<std::uint8_t> passing(Shape input, std::vector<float>* told = nullptr);
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
