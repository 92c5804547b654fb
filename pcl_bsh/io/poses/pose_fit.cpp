// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_fit.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <pcl_bsh/base/counted.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {
namespace {

constexpr std::size_t least_pairs = 3;
constexpr double narrow = 1e-3; // greatest width of places on a line, as a share of their length
constexpr double other_size = 2.0;
constexpr auto forms_of_a_pair = "give x y z of the obstacle and x y z of the input, a pair to a line";

std::string shown(double length)
{
  return numberText(length, std::chars_format::general, 4);
}

/// How far places reach along their three main directions, as root mean squares.
Eigen::Vector3d extentsOf(const Eigen::Matrix3Xd& centred)
{
  const Eigen::Matrix3d spread = centred * centred.transpose() / static_cast<double>(centred.cols());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .reverse()
      .cwiseMax(0.0)
      .cwiseSqrt();
}

double rmsOf(const std::vector<double>& residuals)
{
  double sum = 0.0;
  for (const double residual : residuals) sum += residual * residual;
  return std::sqrt(sum / static_cast<double>(residuals.size()));
}

} // namespace

std::string PoseFit::text() const
{
  const auto greatest = std::max_element(residuals.begin(), residuals.end());
  std::string all;
  for (const double residual : residuals) all += (all.empty() ? "" : ", ") + shown(residual);
  return "the pose fits " + counted(residuals.size(), "pair") + " with residuals of " + all + ": RMS " +
         shown(rmsOf(residuals)) + ", the greatest of pair " + std::to_string(greatest - residuals.begin());
}

PoseFit fitPose(const std::vector<PlacePair>& pairs)
{
  if (pairs.size() < least_pairs)
    throw FormatError("has " + counted(pairs.size(), "pair") + ", and a pose takes three at least", forms_of_a_pair);
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd body(3, count), scan(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    body.col(i) = pairs[static_cast<std::size_t>(i)].body;
    scan.col(i) = pairs[static_cast<std::size_t>(i)].scan;
  }
  const Eigen::Vector3d middle_of_body = body.rowwise().mean(), middle_of_scan = scan.rowwise().mean();
  body.colwise() -= middle_of_body; // coordinates of maps are large
  scan.colwise() -= middle_of_scan;
  const double size_of_body = body.norm(), size_of_scan = scan.norm();
  const auto [small, large] = std::minmax(size_of_body, size_of_scan);
  if (small > 0.0 && large > other_size * small) {
    throw FormatError("has places of the " + std::string(size_of_body > size_of_scan ? "obstacle" : "input") + " " +
                          shown(large / small) + " times as far apart as those of the other",
                      "give both in the units of their files, and name these: --input-unit and --obstacle-unit");
  }
  PoseFit fit;
  fit.pose.matrix() = Eigen::umeyama(body, scan, false);
  fit.pose.translation() = middle_of_scan - fit.pose.linear() * middle_of_body;
  for (Eigen::Index i = 0; i < count; ++i)
    fit.residuals.push_back((fit.pose.linear() * body.col(i) - scan.col(i)).norm());
  for (const auto& [side, of] : {std::pair{&body, "obstacle"}, {&scan, "input"}}) {
    const Eigen::Vector3d extents = extentsOf(*side);
    if (extents[1] > std::max(narrow * extents[0], rmsOf(fit.residuals))) continue;
    throw FormatError("has places of the " + std::string(of) + " on one line, to within " + shown(extents[1]),
                      "add a pair that is beside it");
  }
  return fit;
}

std::vector<PlacePair> parsePairs(std::string_view text)
{
  std::vector<PlacePair> pairs;
  TextCursor cursor(text, '#');
  while (cursor.nextLine()) {
    const TextCursor line = cursor;
    const std::vector<double> n = numbersOfLine(cursor);
    if (n.size() != 6) line.fail("has " + counted(n.size(), "number") + ", not 6", forms_of_a_pair);
    if (!std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); }))
      line.fail("has a number that is not finite", forms_of_a_pair);
    pairs.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  return pairs;
}

PoseFit readPoseFit(const std::filesystem::path& path, const LengthScale& scale)
{
  const FileBytes file(path);
  return naming(path, [&] {
    std::vector<PlacePair> pairs = parsePairs(file.view());
    for (PlacePair& pair : pairs)
      for (double& length : pair.body) length = scale(length);
    return fitPose(pairs);
  });
}

} // namespace pcl_bsh::io
