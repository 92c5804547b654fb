// SPDX-License-Identifier: BSD-3-Clause
#include "hand.h"

#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/scene/dragged_object.h>

#include <vtkCamera.h>

#include <algorithm>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace pcl_bsh::viewer {
namespace {

constexpr double seconds_of_picture = 1.0 / 30;
constexpr double radians_of_pixel = 0.5 * std::numbers::pi / 180;

double secondsSince(std::chrono::steady_clock::time_point then)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

} // namespace

bool Hand::take(int x, int y, bool turning)
{
  const auto seen = view_.cloudAt(x, y);
  object_ = seen ? content_.drag(seen->first, view_.step()) : nullptr;
  if (!object_) {
    if (seen) view_.setNote(content_.viewedClouds()[seen->first].name + " does not move");
    return false;
  }
  place_ = seen->second;
  renderer_.SetWorldPoint(place_.x(), place_.y(), place_.z(), 1.0);
  renderer_.WorldToDisplay();
  depth_ = renderer_.GetDisplayPoint()[2];
  x_ = x, y_ = y;
  turns_ = turning;
  pose_ = object_->pose();
  begin_ = std::chrono::steady_clock::now();
  drawn_ = {};
  pause_ = 0.0;
  events_ = pictures_ = 0;
  return true;
}

/// The pose that a pixel asks for: moved in the plane of the screen through the place that was taken, or turned about
/// that place.
Eigen::Isometry3d Hand::wanted(int x, int y) const
{
  Eigen::Isometry3d pose = pose_;
  if (turns_) {
    vtkCamera& camera = *renderer_.GetActiveCamera();
    const Eigen::Vector3d up(camera.GetViewUp()), right = Eigen::Vector3d(camera.GetDirectionOfProjection()).cross(up);
    pose.pretranslate(-place_);
    pose.prerotate(Eigen::AngleAxisd(radians_of_pixel * (x - x_), up.normalized()) *
                   Eigen::AngleAxisd(radians_of_pixel * (y_ - y), right.normalized()));
    return pose.pretranslate(place_);
  }
  renderer_.SetDisplayPoint(x, y, depth_);
  renderer_.DisplayToWorld();
  const double* const at = renderer_.GetWorldPoint();
  return pose.pretranslate(Eigen::Vector3d(at) / at[3] - place_);
}

void Hand::lead(int x, int y)
{
  ++events_;
  try {
    const auto begin = std::chrono::steady_clock::now();
    now_ = &object_->moveTo(wanted(x, y));
    response_ = secondsSince(begin);
  }
  catch (const std::invalid_argument& error) {
    view_.setNote(error.what()); // the object stays: another way may do
  }
}

bool Hand::draw(const std::function<void()>& render)
{
  if (!now_) return true;
  if (secondsSince(drawn_) < pause_) return false;
  ++pictures_;
  view_.follow(*now_, note());
  const auto begin = std::chrono::steady_clock::now();
  render();
  pause_ = std::max(seconds_of_picture, secondsSince(begin));
  drawn_ = std::chrono::steady_clock::now();
  now_ = nullptr;
  return true;
}

std::string Hand::note() const
{
  std::ostringstream text;
  text << object_->name() << (now_->held ? " is held: " : ": ") << counted(now_->contacts.size(), "contact");
  if (now_->nearest)
    text << ", " << lengthOf(now_->nearest->distance, content_.options().unit) << " from " << object_->nameOfNearest();
  const double all = std::max(secondsSince(begin_), seconds_of_picture);
  text << std::fixed << std::setprecision(1) << "\nresponse " << 1e3 * response_ << " ms, "
       << static_cast<double>(pictures_) / all << " pictures a second of " << static_cast<double>(events_) / all
       << " events";
  return text.str();
}

void Hand::letGo()
{
  object_->release();
  object_ = nullptr;
  now_ = nullptr;
}

} // namespace pcl_bsh::viewer
