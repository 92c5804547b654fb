// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/enclosure.h>

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/triangle_labels.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

bool isEnclosed(std::uint8_t label)
{
  return label != labelOf(Label::outside);
}

SphereHierarchy partOf(PointsView view, const std::vector<std::int32_t>& places)
{
  view.restrictTo(places.data(), places.size());
  return SphereHierarchy(view);
}

} // namespace

QueriedRecords::QueriedRecords(const SphereHierarchy& thing) : thing_(thing)
{
  if (!thing.view().triangles) return;
  const TrianglesView& triangles = *thing.view().triangles;
  std::vector<bool> named(triangles.count, false), used(triangles.vertices.count, false);
  for (std::size_t i = 0; i < thing.view().size(); ++i) named[thing.view().record(i)] = true;
  std::vector<Triangle> corners;
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    if (!named[i] || !isFinite(triangles.triangle(i))) continue;
    triangles_.push_back(i);
    corners.push_back(triangles.cornersOf(i));
    for (const std::uint32_t corner : corners.back()) used[corner] = true;
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) used_.push_back(static_cast<std::int32_t>(i));
  corners_ = std::make_unique<const SphereHierarchy>(partOf(triangles.vertices, used_));
  for (const std::uint32_t i :
       firstOfShells({triangles.vertices, corners.empty() ? nullptr : corners.front().data(), corners.size()}))
    shells_.push_back(triangles_[i]);
}

std::vector<std::int32_t> QueriedRecords::placesOf(const std::vector<std::uint32_t>& records) const
{
  std::vector<std::int32_t> places;
  for (const std::uint32_t record : records) {
    if (!isSurface())
      places.push_back(static_cast<std::int32_t>(record));
    else
      for (const std::uint32_t corner : thing_.view().triangles->cornersOf(record))
        places.push_back(static_cast<std::int32_t>(corner));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

std::vector<std::uint32_t> enclosedBy(const PlacedSolid& solid, const QueriedRecords& queried,
                                      const Eigen::Isometry3d& T_world_queried, unsigned threads, Work* work)
{
  const LabelsResult found = labelPoints({queried.places(), T_world_queried}, solid, threads);
  if (work) *work += found.work;
  std::vector<std::uint32_t> enclosed;
  if (found.inside + found.on_surface == 0) return enclosed;
  if (!queried.isSurface()) {
    for (std::uint32_t i = 0; i < found.labels.size(); ++i)
      if (isEnclosed(found.labels[i])) enclosed.push_back(i);
    return enclosed;
  }
  for (const std::uint32_t i : queried.triangles()) {
    const Triangle corners = queried.thing().view().triangles->cornersOf(i);
    if (std::any_of(corners.begin(), corners.end(),
                    [&](std::uint32_t corner) { return isEnclosed(found.labels[corner]); }))
      enclosed.push_back(i);
  }
  return enclosed;
}

std::vector<std::uint32_t> holdersOf(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid,
                                     const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                                     const std::vector<std::uint32_t>& enclosed, Work* work)
{
  std::vector<std::uint32_t> holders;
  if (enclosed.empty()) return holders;
  const PointsView& view = queried.places().view();
  const std::vector<std::int32_t> places = queried.placesOf(enclosed);
  const SphereHierarchy near = partOf(view, places);
  const LabelsResult labels = labelPoints({near, T_world_queried}, {solid.whole(), T_world_solid});
  if (work) *work += labels.work;
  const std::vector<SolidBodies::Body>& bodies = solid.all();
  std::vector<std::int32_t> within; // the whole solid: a hollow of it is inside some of its bodies, too
  for (const std::int32_t place : places) {
    const std::uint8_t label = labels.labels[static_cast<std::size_t>(place)];
    // On the face of one body a place may be inside of another.
    if (bodies.size() > 1 ? isEnclosed(label) : label == labelOf(Label::inside)) within.push_back(place);
  }
  if (within.empty()) return holders;
  const SphereHierarchy part = partOf(view, within);
  for (const SolidBodies::Body& body : bodies) {
    if (bodies.size() > 1 && !anyWithin({part, T_world_queried}, {solid.solidOf(body), T_world_solid}, work)) continue;
    holders.insert(holders.end(), body.triangles.begin(), body.triangles.end());
  }
  std::sort(holders.begin(), holders.end());
  return holders;
}

std::uint32_t holderOf(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid, const QueriedRecords& queried,
                       const Eigen::Isometry3d& T_world_queried, std::uint32_t enclosed, Work* work)
{
  const std::vector<std::int32_t> places = queried.placesOf({enclosed});
  const SphereHierarchy part = partOf(queried.places().view(), places);
  const std::vector<SolidBodies::Body>& bodies = solid.all();
  const auto holder = std::find_if(bodies.begin(), bodies.end() - 1, [&](const SolidBodies::Body& body) {
    return anyInside({part, T_world_queried}, {solid.solidOf(body), T_world_solid}, work);
  });
  return holder->triangles.front(); // the last one, where it is no other
}

std::optional<PointPair> findEnclosed(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid,
                                      const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                                      Work* work)
{
  const PlacedSolid whole(solid.whole(), T_world_solid);
  std::optional<std::uint32_t> record;
  if (!queried.isSurface()) {
    record = firstInside({queried.thing(), T_world_queried}, whole, work);
  }
  else {
    const TrianglesView& triangles = *queried.thing().view().triangles;
    const auto shell = std::find_if(queried.shells().begin(), queried.shells().end(), [&](std::uint32_t triangle) {
      return holdsAny(whole, triangles, {triangle}, T_world_queried);
    });
    if (shell != queried.shells().end()) record = *shell;
  }
  if (!record) return std::nullopt;
  return PointPair{*record, holderOf(solid, T_world_solid, queried, T_world_queried, *record, work)};
}

std::vector<std::uint32_t> certainlyEnclosed(const std::vector<std::uint32_t>& enclosed,
                                             const std::vector<Verdict>& of_queried)
{
  std::vector<std::uint32_t> certain;
  for (const std::uint32_t record : enclosed)
    if (of_queried[record] == Verdict::free) certain.push_back(record);
  return certain;
}

void addEnclosed(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid, const QueriedRecords& queried,
                 const Eigen::Isometry3d& T_world_queried, const std::vector<std::uint32_t>& enclosed, bool uncertain,
                 std::vector<Verdict>& of_queried, std::vector<Verdict>& of_solid, Work* work)
{
  const auto holders = [&](const std::vector<std::uint32_t>& records) {
    return of_solid.empty() ? std::vector<std::uint32_t>()
                            : holdersOf(solid, T_world_solid, queried, T_world_queried, records, work);
  };
  if (uncertain)
    for (const std::uint32_t triangle : holders(enclosed))
      of_solid[triangle] = graver(of_solid[triangle], Verdict::undecided);
  for (const std::uint32_t triangle : holders(uncertain ? certainlyEnclosed(enclosed, of_queried) : enclosed))
    of_solid[triangle] = Verdict::colliding;
  if (of_queried.empty()) return;
  for (const std::uint32_t record : enclosed)
    if (!uncertain || of_queried[record] == Verdict::free) of_queried[record] = Verdict::colliding;
}

} // namespace pcl_bsh
