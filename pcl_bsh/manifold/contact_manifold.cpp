// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/contact_manifold.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/depths/depths.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/manifold/candidate_search.h>
#include <pcl_bsh/manifold/contact_normal.h>
#include <pcl_bsh/pairs/nearest_places.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/solid/labels.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace pcl_bsh {
namespace {

void checkLength(const std::string& name, double length, bool above_zero = false)
{
  if (std::isfinite(length) && length >= 0.0 && !(above_zero && length == 0.0)) return;
  throw InvalidInput(Input::clearance, name, std::to_string(length),
                     above_zero ? "give a finite length above 0" : "give a finite length of at least 0")
      .withValue(length);
}

void check(const PlacedCollider& a, const PlacedCollider& b, const ManifoldRequest& request)
{
  checkPoses(a.pose, b.pose);
  checkExact(request);
  checkLength("margin", request.margin);
  if (request.thickness) checkLength("thickness", *request.thickness);
  if (request.height) checkLength("height of patches", *request.height);
  if (request.fit) checkLength("radius of fitted planes", *request.fit, true);
  if (request.same_within) checkLength("way of a contact that lives on", *request.same_within);
}

/// Adds candidates for the places of a channel that the solid of the other side holds, by their depths.
void addEnclosed(const Solid* solid, double thickness, Channel& channel, Work& work)
{
  if (!solid) return;
  LabelsResult labels = labelPoints(channel.probe, {*solid, channel.surface.pose});
  work += labels.work;
  if (labels.inside + labels.on_surface == 0) return;
  std::vector<std::uint32_t> enclosed;
  for (std::uint32_t i = 0; i < labels.labels.size(); ++i)
    if (labels.labels[i] != labelOf(Label::outside)) enclosed.push_back(i);
  const PointDistances near = pointDistances(channel.probe, enclosed, channel.surface);
  work += near.work;
  std::vector<float> radii;
  const PointsView below = sunk(channel.probe.hierarchy().view(), radii);
  const RecordDistance depth(below, channel.probe.pose, channel.surface.hierarchy().view(), channel.surface.pose);
  for (const std::uint32_t i : enclosed) {
    const PointPair pair{i, near.closest_point[i]};
    Candidate inside;
    inside.gap = -depth.gap(pair) - thickness;
    inside.channel = channel.number;
    inside.pair = pair;
    inside.is_enclosed = true;
    inside.place = probePlace(channel, i);
    channel.inside.push_back(inside);
  }
  channel.enclosed = std::move(labels.labels);
}

using MovedContact = std::tuple<double, std::uint32_t, std::size_t>; ///< how far, its id, its number now

/// Memory of one manifold after another, to be had by a ScratchLease.
struct ManifoldScratch {
  std::vector<Channel> channels;
  PatchGoal goal;
  std::vector<Contact> contacts;
  std::vector<MovedContact> near;
  std::vector<std::uint32_t> used;
  Neighbors neighbors;

  std::size_t bytes() const noexcept
  {
    return channels.capacity() * sizeof(Channel) + contacts.capacity() * sizeof(Contact) +
           near.capacity() * sizeof(MovedContact) + used.capacity() * sizeof(std::uint32_t) +
           neighbors.indices.capacity() * sizeof(std::int32_t) + neighbors.squared_distances.capacity() * sizeof(float);
  }
};

class Making {
public:
  Making(const PlacedCollider& a, const PlacedCollider& b, const ManifoldRequest& request)
  : a_(a.collider->parts()),
    b_(b.collider->parts()),
    pose_a_(a.pose),
    pose_b_(b.pose),
    request_(request)
  {
    const double spacing = std::max(a_.spacing, b_.spacing);
    const bool are_points = a_.spacing > 0.0 && b_.spacing > 0.0;
    made_.thickness = request.thickness.value_or(are_points ? 0.5 * spacing : 0.0);
    made_.pose_a = a.pose, made_.pose_b = b.pose;
    fit_ = request.fit.value_or(4.0 * spacing);
    channels_.clear(), contacts_.clear();
    const auto add = [this](std::uint8_t number, const Placed& probe, const Placed& surface) -> Channel& {
      return channels_.emplace_back(Channel{number, probe, surface, nullptr, nullptr, {}, {}});
    };
    if (!a_.isSurface() || b_.isSurface()) {
      add(0, {a_.places(), a.pose}, {b_.thing, b.pose});
      addEnclosed(b_.solid, made_.thickness, channels_.back(), made_.work);
    }
    if (a_.isSurface()) {
      add(1, {b_.places(), b.pose}, {a_.thing, a.pose});
      addEnclosed(a_.solid, made_.thickness, channels_.back(), made_.work);
    }
    if (a_.isSurface() && b_.isSurface()) {
      Channel& edges = add(2, {*a_.edges, a.pose}, {*b_.edges, b.pose});
      edges.sharp_probe = &a_.sharp, edges.sharp_surface = &b_.sharp;
    }
  }

  ~Making() { channels_.clear(); }
  Making(const Making&) = delete;
  Making& operator=(const Making&) = delete;

  void make(Manifold& result)
  {
    searchCandidates(channels_, request_.margin, made_.thickness, [this](CandidateSearch& search) { choose(search); });
    giveIds();
    made_.contacts.swap(result.contacts);
    made_.contacts.assign(contacts_.begin(), contacts_.end());
    result = std::move(made_);
  }

private:
  void choose(CandidateSearch& search)
  {
    PatchGoal& goal = (*scratch_).goal;
    goal.reset(request_.margin);
    for (std::uint32_t patch = 0; patch < request_.most_patches && request_.most > 0; ++patch) {
      const Candidate first = seek(search, goal);
      if (!first.isThere()) break;
      take(first, patch);
      const double usual = 2.0 * (request_.margin + made_.thickness + std::abs(first.gap));
      goal.begin(first, contacts_.back().normal, request_.height.value_or(usual));
      for (std::size_t i = 1; i < request_.most; ++i) {
        const Candidate next = seek(search, goal);
        if (!next.isThere()) break;
        take(next, patch);
        goal.add(next.place);
      }
      goal.end();
    }
  }

  Candidate seek(CandidateSearch& search, const PatchGoal& goal)
  {
    Candidate best;
    for (const Channel& channel : channels_)
      for (Candidate inside : channel.inside) {
        inside.score = goal.score(inside.place, inside.gap);
        if (inside.isThere() && inside.isBefore(best)) best = inside;
      }
    search.seek(goal, best, made_.work);
    return best;
  }

  void take(const Candidate& candidate, std::uint32_t patch)
  {
    const Channel& channel = *std::find_if(channels_.begin(), channels_.end(),
                                           [&](const Channel& one) { return one.number == candidate.channel; });
    Contact contact;
    contact.distance = candidate.gap;
    contact.patch = patch;
    if (channel.isOfEdges()) {
      const EdgeCrossing crossing = *crossingOf(channel, candidate.pair);
      contact.pair = {a_.sharp[candidate.pair.a].triangles[0], b_.sharp[candidate.pair.b].triangles[0]};
      contact.normal = crossing.normal;
      contact.place_a = crossing.on_probe, contact.place_b = crossing.on_surface;
      contacts_.push_back(contact);
      return;
    }
    const PointsView &of_probe = channel.probe.hierarchy().view(), &of_surface = channel.surface.hierarchy().view();
    auto [on_probe, on_surface] = nearestPlaces(channel.probe, channel.surface, candidate.pair);
    const SurfaceNormal found = of_surface.triangles
                                    ? normalOfTriangle(channel, candidate, on_surface)
                                    : normalOfPoints(a_, b_, channel, candidate, fit_, (*scratch_).neighbors);
    on_probe -= of_probe.ownRadius(candidate.pair.a) * found.normal;
    on_surface += of_surface.ownRadius(candidate.pair.b) * found.normal;
    const bool probe_is_a = channel.number == 0;
    const Collider::Parts& prober = probe_is_a ? a_ : b_;
    const std::uint32_t probe = prober.recordOfPlace(candidate.pair.a), surface = candidate.pair.b;
    contact.pair = probe_is_a ? PointPair{probe, surface} : PointPair{surface, probe};
    contact.normal = probe_is_a ? found.normal : (-found.normal).eval();
    contact.place_a = probe_is_a ? on_probe : on_surface;
    contact.place_b = probe_is_a ? on_surface : on_probe;
    contact.residual = found.residual;
    contacts_.push_back(contact);
  }

  /// Pairs contacts before with contacts now: the nearest two, then the nearest two of those left. Pairs keep the id
  /// before, other contacts get new ids.
  void giveIds()
  {
    const double within = request_.same_within.value_or(2.0 * (request_.margin + made_.thickness));
    std::vector<MovedContact>& near = (*scratch_).near;
    std::vector<std::uint32_t>& used = (*scratch_).used;
    near.clear(), used.clear();
    if (request_.previous) {
      const Manifold& before = *request_.previous;
      made_.next_id = before.next_id;
      const Eigen::Isometry3d carried_a = pose_a_ * before.pose_a.inverse(Eigen::Isometry),
                              carried_b = pose_b_ * before.pose_b.inverse(Eigen::Isometry);
      for (const Contact& old : before.contacts)
        for (std::size_t i = 0; i < contacts_.size(); ++i) {
          const Contact& now = contacts_[i];
          const double moved =
              std::min((now.place_a - carried_a * old.place_a).norm(), (now.place_b - carried_b * old.place_b).norm());
          if (moved <= within) near.emplace_back(moved, old.id, i);
        }
    }
    std::sort(near.begin(), near.end());
    for (const auto& [moved, id, i] : near) {
      if (contacts_[i].id != 0 || std::find(used.begin(), used.end(), id) != used.end()) continue;
      contacts_[i].id = id;
      used.push_back(id);
    }
    for (Contact& contact : contacts_)
      if (contact.id == 0) contact.id = made_.next_id++;
  }

  const Collider::Parts &a_, &b_;
  const Eigen::Isometry3d pose_a_, pose_b_;
  const ManifoldRequest& request_;
  double fit_ = 0.0;
  const ScratchLease<ManifoldScratch> scratch_;
  std::vector<Channel>& channels_ = (*scratch_).channels;
  std::vector<Contact>& contacts_ = (*scratch_).contacts;
  Manifold made_;
};

} // namespace

std::optional<EdgeCrossing> crossingOf(const Channel& channel, PointPair edges)
{
  constexpr double parallel = 1e-12, slack = 1e-9;
  const auto endOf = [](const Placed& placed, std::uint32_t edge, std::size_t end) {
    const Point3 p = placed.hierarchy().view().triangles->triangle(edge)[end];
    return (placed.pose * Eigen::Vector3d(p[0], p[1], p[2])).eval();
  };
  const Eigen::Vector3d p = endOf(channel.probe, edges.a, 0), q = endOf(channel.surface, edges.b, 0);
  const Eigen::Vector3d u = endOf(channel.probe, edges.a, 1) - p, v = endOf(channel.surface, edges.b, 1) - q;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), across = uu * vv - uv * uv;
  if (!(across > parallel * uu * vv)) return std::nullopt;
  const Eigen::Vector3d from = q - p;
  const double s = (vv * u.dot(from) - uv * v.dot(from)) / across, t = (uv * u.dot(from) - uu * v.dot(from)) / across;
  for (const double at : {s, t})
    if (!(at > slack && at < 1.0 - slack)) return std::nullopt;
  const auto isOutside = [&](const SharpEdge& edge, const Placed& placed, const Eigen::Vector3d& way,
                             const Eigen::Vector3d& normal) {
    const Eigen::Vector3d n = placed.pose.linear() * edge.normals[0], m = placed.pose.linear() * edge.normals[1];
    const double between = n.cross(m).dot(way);
    const double side = between < 0.0 ? -1.0 : 1.0, least = -slack * way.norm();
    return side * n.cross(normal).dot(way) >= least && side * normal.cross(m).dot(way) >= least &&
           normal.dot(n + m) > 0.0;
  };
  const Eigen::Vector3d normal = u.cross(v).stableNormalized();
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d out = side * normal;
    if (isOutside((*channel.sharp_surface)[edges.b], channel.surface, v, out) &&
        isOutside((*channel.sharp_probe)[edges.a], channel.probe, u, -out))
      return EdgeCrossing{p + s * u, q + t * v, out};
  }
  return std::nullopt;
}

void contactManifold(const PlacedCollider& a, const PlacedCollider& b, const ManifoldRequest& request, Manifold& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  Making(a, b, request).make(result);
  progress.finish();
}

Manifold contactManifold(const PlacedCollider& a, const PlacedCollider& b, const ManifoldRequest& request)
{
  Manifold made;
  contactManifold(a, b, request, made);
  return made;
}

} // namespace pcl_bsh
