// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/shape.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/made_once.h>
#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/solid/enclosure.h>
#include <pcl_bsh/solid/open_edges.h>

#include <atomic>
#include <utility>

namespace pcl_bsh {

struct Shape::Faces {
  struct Enclosing {
    explicit Enclosing(const TrianglesView& triangles) : solid(triangles) {}
    const Solid solid;
    const SolidBodies bodies{solid};
  };
  MadeOnce<const Enclosing> enclosing;
  MadeOnce<const bool> closed;
  std::atomic<bool> asked{false}; ///< isKnownToClose() was called
};

struct Shape::Built {
  MadeOnce<const QueriedRecords> queried;
  MadeOnce<const NamedCloud> facts; ///< without a spacing
};

namespace {

/// Memory that a view of the points that count keeps alive: their list, and the cloud.
struct Counted {
  std::shared_ptr<const CountedPoints> points;
  std::shared_ptr<const void> cloud;
};

/// Returns the object that another copy of a shape has made, or else makes it.
template <class T, class Make>
const T& madeOnce(MadeOnce<const T>& made, const Make& make)
{
  bool kept = false;
  const T* const known = made.get();
  return known ? *known : *made.keep(make(), kept);
}

} // namespace

Shape::Shape(std::string name, const PointsView& points, std::vector<RecordField> fields)
: name_(std::move(name)),
  view_([points] { return points; }),
  fields_([fields = std::move(fields)] { return fields; }),
  is_surface_(points.triangles != nullptr),
  surface_(std::make_shared<Faces>()),
  built_(std::make_shared<Built>())
{
}

Shape::Shape(std::string name, std::function<PointsView()> points, std::function<std::vector<RecordField>()> fields)
: name_(std::move(name)),
  view_(std::move(points)),
  fields_(std::move(fields)),
  watched_(true),
  surface_(std::make_shared<Faces>()),
  built_(std::make_shared<Built>())
{
  is_surface_ = view_().triangles != nullptr; // what cannot be read is refused here, not at the first use
}

Shape::Shape(std::string name, std::shared_ptr<const SphereHierarchy> hierarchy)
: name_(std::move(name)),
  is_surface_(hierarchy && hierarchy->view().triangles),
  hierarchy_(std::move(hierarchy)),
  surface_(std::make_shared<Faces>()),
  built_(std::make_shared<Built>())
{
}

const SphereHierarchy& Shape::hierarchy(const Uncertainty& uncertainty, unsigned threads)
{
  if (!*this) throw InvalidInput(Input::points, name_.empty() ? "a cloud" : name_, "is missing", "give one");
  if (!view_ && !uncertainty.isZero())
    throw InvalidInput(Input::uncertainty, name_, "is built already", "build it of points with uncertainties");
  if (!view_) return *hierarchy_;
  if (is_surface_ && !uncertainty.field.empty()) {
    throw InvalidInput(Input::uncertainty, name_, "is a surface, which has no field '" + uncertainty.field + "'",
                       "give a length, or `vertices_only`");
  }
  const bool same = hierarchy_ && uncertainty == uncertainty_;
  PointsView view = view_();
  const bool reads_fields = !uncertainty.field.empty() || !ignored_.empty();
  const std::vector<RecordField> fields = reads_fields && fields_ ? fields_() : std::vector<RecordField>();
  // The hierarchy points into the points' memory, its spheres hold them as they were, and so do the patches, which
  // outlive it.
  const Seen seen{view.data, view.count, watched_ ? checksumOf(view) : 0};
  const std::uint64_t uncertainties = watched_ ? checksumOf(view, fields, uncertainty.field) : 0;
  if ((first_seen_ && *first_seen_ != seen) || (same && uncertainties != uncertainties_))
    throw InvalidInput(Input::points, name_, "has changed since it was set", "set it again");
  if (same && (ignored_.empty() || !watched_)) return *hierarchy_;
  if (!ignored_.empty()) {
    const auto counted = std::make_shared<const CountedPoints>(countedPoints(view, fields, name_, ignored_));
    if (same && counted->records == counted_->records) return *hierarchy_;
    counted_ = counted;
    view.restrictTo(counted->records.data(), counted->records.size());
    view.owner = std::make_shared<const Counted>(Counted{counted, view.owner});
  }
  HierarchyOptions options;
  options.threads = threads;
  Uncertainty built_with = uncertainty;
  hierarchy_ = std::make_shared<SphereHierarchy>(withUncertainty(view, fields, name_, uncertainty), options);
  built_ = std::make_shared<Built>();
  uncertainty_ = std::move(built_with);
  uncertainties_ = uncertainties;
  first_seen_ = seen;
  return *hierarchy_;
}

void Shape::ignore(const IgnoredPoints& ignored)
{
  if (ignored == ignored_) return;
  if (!view_)
    throw InvalidInput(Input::points, name_, "is built already, of all its points", "build it of those that count");
  if (is_surface_)
    throw InvalidInput(Input::points, name_, "is a surface, which has no points to ignore", "give `vertices_only`");
  ignored_ = ignored;
  hierarchy_.reset();
  counted_.reset();
  patches_.reset();
  looked_.reset();
}

PointsView Shape::wholeView(const Uncertainty& uncertainty) const
{
  return withUncertainty(view_(), fields_ ? fields_() : std::vector<RecordField>(), name_, uncertainty);
}

const Shape::Patches& Shape::patches(const std::optional<double>& gap, const Effort& effort)
{
  if (patches_ && patches_->asked == gap) return *patches_;
  std::optional<SphereHierarchy> whole; // points that do not count are neighbours of those that do
  if (counted_) whole.emplace(wholeView({}));
  const SphereHierarchy& points = whole ? *whole : *hierarchy_;
  Patches measured{gap, gap ? *gap : usualGap(points), {}};
  if (measured.gap > 0.0) measured.spacings = patchSpacings(points, measured.gap, effort);
  patches_ = std::make_shared<const Patches>(std::move(measured));
  return *patches_;
}

const SeenSpace& Shape::seen(const ScanOrigins& origins, const std::optional<double>& angle, unsigned threads,
                             double misses_beyond)
{
  if (looked_ && looked_->origins == origins && looked_->angle == angle && looked_->misses_beyond == misses_beyond &&
      looked_->uncertainty == uncertainty_)
    return looked_->space;
  SeenOptions options;
  options.angle = angle;
  options.threads = threads;
  const std::vector<RecordField> fields = fields_ ? fields_() : std::vector<RecordField>();
  PointsView view = hierarchy_->view();
  if (counted_ || !uncertainty_.pose.isZero()) {
    Uncertainty of_ends = uncertainty_;
    of_ends.pose = {}; // beams and their scanner move together: it makes none of them shorter
    view = wholeView(of_ends);
  }
  looked_ =
      std::make_shared<const Looked>(Looked{origins, angle, misses_beyond, uncertainty_,
                                            SeenSpace(scansOf(view, fields, name_, origins, misses_beyond), options)});
  return looked_->space;
}

const SolidBodies& Shape::solid()
{
  const TrianglesView& triangles = *hierarchy_->view().triangles;
  try {
    return madeOnce(surface_->enclosing, [&] { return std::make_unique<const Faces::Enclosing>(triangles); }).bodies;
  }
  catch (const InvalidInput& error) {
    throw InvalidInput(Input::surface, name_, error.wrong(), error.remedy());
  }
}

bool Shape::isClosed()
{
  if (surface_->enclosing.get()) return true;
  return madeOnce(surface_->closed,
                  [this] { return std::make_unique<const bool>(closes(*hierarchy_->view().triangles)); });
}

std::optional<bool> Shape::isKnownToClose()
{
  if (!surface_->asked.exchange(true)) return std::nullopt;
  return isClosed();
}

const QueriedRecords& Shape::queried()
{
  return madeOnce(built_->queried, [this] { return std::make_unique<const QueriedRecords>(*hierarchy_); });
}

void Shape::setPatches(std::vector<float> spacings)
{
  patches_ = std::make_shared<const Patches>(Patches{std::nullopt, 0.0, std::move(spacings)});
}

NamedCloud Shape::facts(bool spacing) const
{
  NamedCloud facts =
      madeOnce(built_->facts, [this] { return std::make_unique<const NamedCloud>(namedCloud("", *hierarchy_)); });
  facts.name = name_;
  if (!spacing || is_surface_ || hierarchy_->view().radii) return facts;
  {
    const std::lock_guard lock(measured_->one_at_a_time);
    facts.spacing = measured_->spacing;
  }
  if (facts.spacing) return facts;
  facts.spacing = spacingOf(*hierarchy_); // not locked: two threads may measure at once, neither waits
  const std::lock_guard lock(measured_->one_at_a_time);
  measured_->spacing = facts.spacing;
  return facts;
}

Shape Shape::named(std::string name) const
{
  Shape same = *this;
  same.name_ = std::move(name);
  return same;
}

} // namespace pcl_bsh
