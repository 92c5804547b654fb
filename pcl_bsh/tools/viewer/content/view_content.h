// SPDX-License-Identifier: BSD-3-Clause
// The data that the viewer shows, without how it is drawn: clouds, their hierarchies and poses, and collisions at each
// step.
#pragma once

#include "viewed_cloud.h"
#include <pcl_bsh/tools/viewer/view_options.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/trace.h>

#include <Eigen/Geometry>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh {
struct DragStep; // scene/dragged_object.h
}

namespace pcl_bsh::viewer {

/// The closest pair, in the world frame.
struct ClosestPair {
  Eigen::Vector3d a, b;
  double distance = 0.0;
};

/// The collisions with one of several obstacles that have names.
struct NamedCollisions {
  std::string name;
  std::size_t colliding = 0;          ///< parts of the scan
  std::optional<ClosestPair> closest; ///< where it is nearest to the scan
};

/// The collisions at one step.
struct StepCollisions {
  bool known = false;                      ///< whether a query ran or a field says it
  std::vector<std::vector<Verdict>> flags; ///< of each viewed cloud, per part; empty: all are free
  std::size_t colliding = 0;               ///< parts of the scan, or points of all clouds of a scene
  std::size_t undecided = 0;               ///< parts that may collide, or not
  std::size_t sparse = 0;                  ///< parts not scanned densely enough
  std::size_t unseen = 0;                  ///< free parts that no scanner saw
  std::optional<ClosestPair> closest;
  std::vector<NamedCollisions> named; ///< of each obstacle with a name; closest pairs of colliding ones are drawn
};

/// The poses that clouds take one after another, each path drawn as a line.
struct MotionPaths {
  std::string name;
  std::vector<std::vector<Eigen::Isometry3d>> poses;
};

/// How the query for any collision between two clouds went.
struct Trace {
  std::size_t a = 0, b = 0; ///< numbers of clouds
  CollisionTrace trace;
};

/// The values at the two ends of a range of colours.
struct ColorRange {
  double low = 0.0, high = 1.0;
};

/// The colours that all clouds share which are parts of one whole.
struct SharedColors {
  ColorRange heights;               ///< which plain colours are shaded by
  std::optional<ColorRange> values; ///< none where no value is known yet
  bool all_distances = false;       ///< free points have distances, too
};

class SiteContent;

/// An object that follows the mouse. It stays where it was led until another step is shown.
class DraggedCloud {
public:
  virtual ~DraggedCloud() = default;

  virtual const std::string& name() const = 0;       ///< of the object
  virtual const Eigen::Isometry3d& pose() const = 0; ///< T_world_object
  /// Moves it to a pose, as far as the response lets it. @throws std::invalid_argument for a way that is no motion
  virtual const DragStep& moveTo(const Eigen::Isometry3d& T_world_object) = 0;
  virtual void release() = 0;
  virtual std::string nameOfNearest() const = 0; ///< name of the object nearest to it; empty: none
};

/// Clouds and their poses at a number of steps; the first cloud is the one asked about: its points, or its triangles.
class ViewContent {
public:
  virtual ~ViewContent() = default;
  ViewContent(const ViewContent&) = delete;
  ViewContent& operator=(const ViewContent&) = delete;

  const Options& options() const { return options_; }
  const std::vector<ViewedCloud>& viewedClouds() const { return viewed_clouds_; }
  const ViewedCloud& scan() const { return viewed_clouds_.front(); } ///< the one that fields and values are shown of

  virtual std::string name() const = 0;     ///< of the window
  virtual std::size_t steps() const = 0;    ///< at least one
  virtual const char* stepName() const = 0; ///< the word for a step
  virtual Eigen::Isometry3d poseOf(std::size_t cloud, std::size_t step) const = 0;
  virtual bool moves(std::size_t cloud) const = 0;

  /// Whether points move in their cloud's own frame. They are where they belong at a step once its collisions() were
  /// asked for.
  virtual bool deforms(std::size_t /*cloud*/) const { return false; }
  virtual StepCollisions collisions(std::size_t step) const = 0;

  /// Lines of text above the picture.
  virtual std::string heading(const StepCollisions& collisions, std::size_t step) const = 0;
  virtual MotionPaths paths(std::size_t step) const = 0;

  /// Contacts that hold bodies.
  virtual std::vector<Contact> contacts(std::size_t /*step*/) const { return {}; }

  /// Leads a cloud, and what moves with it, by hand from where it is at a step. Null where nothing moves it.
  virtual DraggedCloud* drag(std::size_t /*cloud*/, std::size_t /*step*/) const { return nullptr; }

  // Distances of the scan, per part; empty where they are not known.
  virtual std::vector<float> distances(std::size_t /*step*/) const { return {}; }     ///< NaN where free
  virtual std::vector<double> allDistances(std::size_t /*step*/) const { return {}; } ///< of free points, too
  virtual std::vector<std::int32_t> firstPoses() const { return {}; }                 ///< -1 where always free

  /// More text about a picked part, put behind its name and coordinates; or empty.
  virtual std::string details(std::size_t /*cloud*/, std::uint32_t /*part*/, std::size_t /*step*/) const { return {}; }
  virtual std::vector<Trace> traces(std::size_t /*step*/) const { return {}; }

  /// Beams of the scan's scanner, from where it stood to some of its points.
  virtual std::vector<std::array<Eigen::Vector3d, 2>> beams() const { return {}; }

  /// The noun for `count` of the parts that have values.
  virtual std::string partsName(std::size_t count) const { return nounOf(count, scan().partName()); }
  virtual const SharedColors* sharedColors() const { return nullptr; } ///< null unless part of a whole
  virtual const SiteContent* site() const { return nullptr; }          ///< null unless tiles are drawn, too

protected:
  explicit ViewContent(Options options) : options_(std::move(options)) {}

  Options options_;
  std::vector<ViewedCloud> viewed_clouds_;
};

/// Loads and indexes the clouds that the options name. @throws files::FileError, io::JsonError, std::invalid_argument
/// naming the file
std::unique_ptr<ViewContent> makeViewContent(const Options& options);

} // namespace pcl_bsh::viewer
