// SPDX-License-Identifier: BSD-3-Clause
// Questions about sites, each for one kind of answer.
#pragma once

#include <pcl_bsh/site/ask_site.h>

#include <memory>
#include <utility>

namespace pcl_bsh::site {

/// A question and its means.
struct SiteQuestion : Question, SiteMeans {};

/// Another site as the obstacle.
struct StandingSite {
  const Site& site;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Uncertainty uncertainty = {};
};

inline SiteAnswer asked(const Site& site, const Placed& b, SiteQuestion question)
{
  question.pose = b.pose;
  Shape shape("b", std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &b.hierarchy()));
  return ask(question, site, shape, question);
}

inline SiteAnswer asked(const Site& site, const StandingSite& b, SiteQuestion question)
{
  question.pose = b.pose;
  question.obstacle_uncertainty = b.uncertainty;
  return ask(question, site, b.site, question);
}

inline SiteQuestion forAny(SiteQuestion question)
{
  question.wanted.any = true;
  return question;
}

inline SiteQuestion forFlags(SiteQuestion question, Flagged flagged, TileReceiver receiver)
{
  question.wanted.flags = flagged != Flagged::b;
  question.wanted.obstacle_flags = flagged != Flagged::a;
  (flagged == Flagged::b ? question.obstacle_receiver : question.receiver) = std::move(receiver);
  return question;
}

inline SiteQuestion forClosest(SiteQuestion question)
{
  question.wanted.closest = true;
  return question;
}

inline SiteQuestion forDistances(SiteQuestion question, double most, TileReceiver receiver)
{
  question.wanted.distances = question.wanted.intervals = true;
  question.max_distance = most;
  question.receiver = std::move(receiver);
  return question;
}

inline SiteQuestion forPath(SiteQuestion question, const std::vector<Eigen::Isometry3d>& poses, TileReceiver receiver)
{
  question.wanted.flags = true;
  question.wanted.contacts = !question.accuracy.stopsEarly();
  question.path = poses;
  question.receiver = std::move(receiver);
  return question;
}

inline SiteAnswer anyCollision(const Site& site, const Placed& b, const SiteQuestion& question)
{
  return asked(site, b, forAny(question));
}

inline SiteAnswer anyCollision(const Site& site, const StandingSite& b, const SiteQuestion& question)
{
  return asked(site, b, forAny(question));
}

inline SiteAnswer collisionFlags(const Site& site, const Placed& b, Flagged flagged, const SiteQuestion& question,
                                 const TileReceiver& receiver = nullptr)
{
  return asked(site, b, forFlags(question, flagged, receiver));
}

inline SiteAnswer collisionFlags(const Site& site, const StandingSite& b, const SiteQuestion& question,
                                 const TileReceiver& receiver = nullptr)
{
  return asked(site, b, forFlags(question, Flagged::a, receiver));
}

inline SiteAnswer collisionFlagsOfB(const Site& site, const StandingSite& b, const SiteQuestion& question,
                                    const TileReceiver& receiver = nullptr)
{
  return asked(site, b, forFlags(question, Flagged::b, receiver));
}

inline SiteAnswer closestPair(const Site& site, const Placed& b, const SiteQuestion& question)
{
  return asked(site, b, forClosest(question));
}

inline SiteAnswer closestPair(const Site& site, const StandingSite& b, const SiteQuestion& question)
{
  return asked(site, b, forClosest(question));
}

inline SiteAnswer pointDistances(const Site& site, const Placed& b, double most, const SiteQuestion& question,
                                 const TileReceiver& receiver = nullptr)
{
  return asked(site, b, forDistances(question, most, receiver));
}

inline SiteAnswer pointDistances(const Site& site, const StandingSite& b, double most, const SiteQuestion& question,
                                 const TileReceiver& receiver = nullptr)
{
  return asked(site, b, forDistances(question, most, receiver));
}

inline SiteAnswer collideAlong(const Site& site, const SphereHierarchy& model,
                               const std::vector<Eigen::Isometry3d>& poses, const SiteQuestion& question,
                               const TileReceiver& receiver = nullptr)
{
  return asked(site, Placed(model), forPath(question, poses, receiver));
}

inline SiteAnswer collideAlong(const Site& site, const Site& model, const Uncertainty& of_model,
                               const std::vector<Eigen::Isometry3d>& poses, const SiteQuestion& question,
                               const TileReceiver& receiver = nullptr)
{
  return asked(site, {model, Eigen::Isometry3d::Identity(), of_model}, forPath(question, poses, receiver));
}

} // namespace pcl_bsh::site
