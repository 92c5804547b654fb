// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/pose_uncertainty.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/distance_between.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/question/text_numbers.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

InvalidInput refusal(const std::string& wrong, const std::string& remedy)
{
  return {Input::uncertainty, "pose uncertainty", wrong, remedy};
}

/// The greatest standard deviation of a block, in any direction.
double greatestDeviation(const Eigen::Matrix3d& covariance, const char* what)
{
  const Eigen::Vector3d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues();
  const double scale = covariance.cwiseAbs().maxCoeff();
  const bool symmetric = (covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * scale;
  if (!symmetric || !(variances.minCoeff() >= -1e-6 * scale))
    throw refusal(plainText("covariance of the ", what, " is none"),
                  "give one that is symmetric and has no negative variance");
  // The solver errs by some roundings of the largest element.
  return std::sqrt(std::max(0.0, variances.maxCoeff()) + 1e-12 * scale);
}

} // namespace

double PoseUncertainty::turned(const Point3& point, double radius) const
{
  if (angle == 0.0) return 0.0;
  constexpr double half_turn = 3.141592653589793;
  const double chord = angle >= half_turn ? 2.0 : 2.0 * std::sin(0.5 * angle);
  const double arm = distanceBetween(point, about) + radius;
  return chord * arm * (1.0 + kDoubleMargin);
}

PoseUncertainty PoseUncertainty::of(const Eigen::Matrix<double, 6, 6>& covariance, double sigmas, const Point3& about)
{
  if (!covariance.allFinite()) throw refusal("covariance has numbers that are not finite", "give 6 x 6 finite numbers");
  if (!(std::isfinite(sigmas) && sigmas >= 0.0))
    throw refusal(plainText(sigmas, " sigmas"), "give a finite number >= 0");
  return {sigmas * greatestDeviation(covariance.topLeftCorner<3, 3>(), "shift"),
          sigmas * greatestDeviation(covariance.bottomRightCorner<3, 3>(), "rotation"), about};
}

PoseUncertainty PoseUncertainty::parse(const std::string& text)
{
  if (text.empty()) return {};
  const auto none = [&] {
    return refusal("'" + text + "' is none",
                   "give T, T,W or T,W,X,Y,Z (a length, an angle in radians and the place it turns about), or "
                   "covariance=SIGMAS:N,... with 36 numbers");
  };
  const std::string key = "covariance=";
  if (text.compare(0, key.size(), key) == 0) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) throw none();
    const auto sigmas = numbersOf(std::string_view(text).substr(key.size(), colon - key.size()));
    const auto numbers = numbersOf(std::string_view(text).substr(colon + 1));
    if (!sigmas || sigmas->size() != 1 || !numbers || numbers->size() != 36) throw none();
    return of(Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(numbers->data()), sigmas->front());
  }
  const auto numbers = numbersOf(text);
  if (!numbers || (numbers->size() != 1 && numbers->size() != 2 && numbers->size() != 5)) throw none();
  PoseUncertainty parsed;
  parsed.length = (*numbers)[0];
  if (numbers->size() > 1) parsed.angle = (*numbers)[1];
  if (numbers->size() > 2) parsed.about = {(*numbers)[2], (*numbers)[3], (*numbers)[4]};
  if (parsed.length < 0.0 || parsed.angle < 0.0) throw none();
  return parsed;
}

std::string PoseUncertainty::text() const
{
  if (isZero()) return {};
  return textOfNumbers(length, angle, about[0], about[1], about[2]);
}

} // namespace pcl_bsh
