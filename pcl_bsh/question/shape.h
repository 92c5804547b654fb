// SPDX-License-Identifier: BSD-3-Clause
// One of the two things of a question: points or a surface, by the name that its user knows it by, and the structures
// that it keeps from one question to the next.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/question/ignored_points.h>
#include <pcl_bsh/question/named_cloud.h>
#include <pcl_bsh/question/scan_origins.h>
#include <pcl_bsh/question/uncertainty.h>
#include <pcl_bsh/seen/seen_space.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

class QueriedRecords;
class SolidBodies;

/// A copy shares what is built: two threads may ask about two copies. The records of its hierarchy are the user's:
/// points or, where the view is of triangles (viewOf(TrianglesView)), triangles: a surface.
class Shape {
public:
  Shape() = default; ///< nothing yet

  /// Points, or triangles, that do not change. @param fields of the points' records, for uncertainties
  Shape(std::string name, const PointsView& points, std::vector<RecordField> fields = {});

  /// Points or triangles that their owner could change, but must not. Every question compares a checksum of
  /// coordinates, corners and uncertainties. It takes some 20 instructions a point, a tenth or less of the cost of
  /// building.
  /// @param points and @param fields are called for each question, and keep alive the memory that they return; a view
  ///   of triangles is the same each time
  /// @throws what `points` does
  Shape(std::string name, std::function<PointsView()> points, std::function<std::vector<RecordField>()> fields);

  /// A hierarchy that is built already. Uncertainties are those of its points.
  Shape(std::string name, std::shared_ptr<const SphereHierarchy> hierarchy);

  explicit operator bool() const noexcept { return view_ || hierarchy_; } ///< whether it is something
  const std::string& name() const noexcept { return name_; }              ///< as its user knows it

  bool isSurface() const noexcept { return is_surface_; } ///< whether its records are triangles

  /// Returns a copy with another name.
  Shape named(std::string name) const;

  /// Sets which of its points do not count from now on. After another choice than before, all is built anew.
  void ignore(const IgnoredPoints& ignored);

  const IgnoredPoints& ignored() const noexcept { return ignored_; } ///< points that do not count

  /// The points that count, once hierarchy() was called.
  const CountedPoints* counted() const noexcept { return counted_.get(); } ///< null where all count

  /// Built on the first use, and anew for another uncertainty. @param threads that build it
  /// @throws InvalidInput when it is nothing, its points have changed, its uncertainties are not what
  ///   withUncertainty() asks for, or countedPoints() refuses what is to be ignored
  const SphereHierarchy& hierarchy(const Uncertainty& uncertainty, unsigned threads);

  /// Returns the hierarchy that was built last. @pre there is one
  const SphereHierarchy& hierarchy() const { return *hierarchy_; }

  /// The width of the holes beside each record, and the gap beyond which a hole is an opening.
  struct Patches {
    std::optional<double> asked; ///< none: usualGap()
    double gap = 0.0;            ///< > 0, or 0 where there are no two places
    std::vector<float> spacings; ///< patchSpacings(), one per record; empty where the gap is 0
  };

  /// Measured once for points and a gap. @pre hierarchy() was called. @param gap > 0; none: usualGap()
  const Patches& patches(const std::optional<double>& gap, const Effort& effort);

  /// Patches that its owner has measured, for questions without a gap. @param spacings one per record
  void setPatches(std::vector<float> spacings);

  /// Returns the space that its scanners saw to be empty. Made once for origins, an angle and a range.
  /// @pre hierarchy() was called. @param misses_beyond as scansOf() takes it
  /// @throws InvalidInput as scansOf() and SeenSpace do
  const SeenSpace& seen(const ScanOrigins& origins, const std::optional<double>& angle, unsigned threads,
                        double misses_beyond = 0.0);

  /// Returns the bodies that its faces enclose. Made once for all copies. @pre isSurface(), and hierarchy() was called
  /// @throws InvalidInput naming it, as Solid does
  const SolidBodies& solid();

  /// Whether its faces close: found out once, for a few hundred instructions a triangle. @pre as of solid()
  bool isClosed();

  /// Whether its faces close. Returns nothing on the first call, to spare a caller that asks only once the cost.
  std::optional<bool> isKnownToClose();

  /// Returns the places that solids are asked about: its points, or the corners of its triangles. Made once.
  /// @pre hierarchy() was called
  const QueriedRecords& queried();

  /// Returns the facts that warnings depend on. @pre hierarchy() was called
  /// @param spacing whether to measure the spacing of its points, once for all copies; never of triangles, nor of
  ///   balls, which are taken for a surface's
  NamedCloud facts(bool spacing) const;

private:
  /// Memory, and a checksum of its points.
  struct Seen {
    const void* data;
    std::size_t count;
    std::uint64_t points;
    bool operator!=(const Seen& other) const
    {
      return data != other.data || count != other.count || points != other.points;
    }
  };

  std::string name_;
  std::function<PointsView()> view_; ///< empty: the hierarchy was given
  std::function<std::vector<RecordField>()> fields_;
  bool watched_ = false;
  bool is_surface_ = false;
  std::shared_ptr<const SphereHierarchy> hierarchy_;
  Uncertainty uncertainty_;         ///< that the hierarchy was built with
  std::uint64_t uncertainties_ = 0; ///< checksum of its field
  IgnoredPoints ignored_;
  std::shared_ptr<const CountedPoints> counted_; ///< null where none are ignored
  std::optional<Seen> first_seen_;               ///< what was there at the first use
  std::shared_ptr<const Patches> patches_;       ///< once they are asked for
  /// All of its points, also those that do not count. @param uncertainty of these
  PointsView wholeView(const Uncertainty& uncertainty) const;

  struct Measured {
    std::mutex one_at_a_time;
    std::optional<Spacing> spacing;
  };
  std::shared_ptr<Measured> measured_ = std::make_shared<Measured>();

  struct Faces; ///< facts about the faces, for all copies
  std::shared_ptr<Faces> surface_;
  struct Built; ///< facts about the hierarchy, for all copies
  std::shared_ptr<Built> built_;

  /// The space that was seen, and the arguments that it was made with.
  struct Looked {
    ScanOrigins origins;
    std::optional<double> angle;
    double misses_beyond;
    Uncertainty uncertainty;
    SeenSpace space;
  };
  std::shared_ptr<const Looked> looked_; ///< once it is asked for
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
