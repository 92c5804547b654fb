// SPDX-License-Identifier: BSD-3-Clause
// Makes a question along a path to try the tools on: a tunnel, a wagon, and the wagon's poses on its way through.
#include <examples/tunnel/tunnel.h>
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;

constexpr auto program = "pcl_bsh_tunnel";
constexpr auto footer =
    R"(Writes scan.ply, wagon.ply and poses.txt (one 3x4 matrix a line, of the wagon in the tunnel) into FOLDER.
At scale 1: 18.92 M points, 2.5 M points and 19,392 poses over 1144 m; lengths are the same at any scale.
Above scale 1 only the scan grows. In pieces, it may be larger than memory.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: where does the wagon come within 5 cm of the wall?
  pcl_bsh_tunnel tunnel --scale 0.1
  pcl_bsh_collide tunnel/scan.ply tunnel/wagon.ply tunnel/marked.ply --clearance 0.05 \
      --trajectory tunnel/poses.txt --clashes tunnel/clashes.html)";

void write(const fs::path& path, const std::vector<Eigen::Vector3f>& points)
{
  cli::Step step("Writing " + path.string());
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, pcl::PCLPointField::FLOAT32);
  io::allocate(cloud, static_cast<std::uint32_t>(points.size()));
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  io::writeCloud(path, cloud);
  step.done(counted(points.size(), "point"));
}

/// The names of the scan's files: one PLY, or so many PCD.
std::vector<fs::path> scanFiles(const fs::path& folder, unsigned pieces)
{
  if (pieces == 0) return {folder / "scan.ply"};
  std::vector<fs::path> names;
  for (unsigned i = 0; i < pieces; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "scan_%04u.pcd", i);
    names.push_back(folder / name);
  }
  return names;
}

/// The scan in binary PCD files, which pcl_bsh_site reads in batches.
class Pieces {
public:
  Pieces(std::vector<fs::path> names, std::size_t points) : names_(std::move(names)), points_(points)
  {
    for (const char* axis : {"x", "y", "z"}) io::addField(layout_, axis, pcl::PCLPointField::FLOAT32);
  }

  void add(const Eigen::Vector3f& point)
  {
    while (done_ == end_) next();
    file_->stream().write(reinterpret_cast<const char*>(point.data()), sizeof point);
    if (++done_ % 65536 == 0) step_.share(static_cast<double>(done_) / static_cast<double>(points_));
  }

  void finish()
  {
    while (piece_ < names_.size()) next();
    file_->commit();
    step_.done(counted(points_, "point"));
  }

private:
  void next()
  {
    if (file_) file_->commit();
    file_.emplace(names_[piece_++]);
    end_ = points_ * piece_ / names_.size();
    file_->stream() << io::binaryPcdHeader(layout_.fields, static_cast<std::uint32_t>(end_ - done_));
  }

  std::vector<fs::path> names_;
  std::size_t points_, piece_ = 0;
  std::size_t done_ = 0, end_ = 0; ///< points written, and those that are when this piece is full
  pcl::PCLPointCloud2 layout_;
  std::optional<files::FileReplacement> file_;
  cli::Step step_{"Writing pieces"};
};

/// Without holding the scan where its points come in the scanner's order.
void writePieces(const std::vector<fs::path>& names, std::size_t count, const std::vector<Eigen::Vector3f>* points)
{
  Pieces pieces(names, count);
  const auto add = [&](const Eigen::Vector3f& point) { pieces.add(point); };
  if (points)
    std::for_each(points->begin(), points->end(), add);
  else
    tunnel::forEachScanPoint(count, add);
  pieces.finish();
}

int makeTunnel(const fs::path& folder, double scale, bool tight, unsigned pieces)
{
  tunnel::Size size = tunnel::Size::atScale(scale);
  const std::size_t scan_points = size.scan;
  const bool streams = pieces > 0 && !tight;
  if (streams) size.scan = 0; // made as it is written
  const files::OutputFolder made(folder);
  const std::vector<fs::path> scan = scanFiles(folder, pieces);
  for (const fs::path& name : scan) files::requireWritable(name);
  for (const char* name : {"wagon.ply", "poses.txt"}) files::requireWritable(folder / name);

  cli::Step step("Making tunnel and wagon");
  const tunnel::Passage run = tunnel::makePassage(size, tight ? tunnel::Course::tight : tunnel::Course::winding);
  step.done(counted(run.poses.size(), "pose"));
  if (pieces > 0)
    writePieces(scan, scan_points, streams ? nullptr : &run.scan);
  else
    write(scan.front(), run.scan);
  write(folder / "wagon.ply", run.wagon);
  io::writePoses(folder / "poses.txt", run.poses);
  std::cout << "wrote a tunnel of " << counted(scan_points, "point") << ", a wagon of " << run.wagon.size() << " and "
            << counted(run.poses.size(), "pose") << " to " << folder.string() << '\n';
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    std::string folder;
    double scale = 0.1;
    bool tight = false;
    unsigned pieces = 0;
    CLI::App app("Makes a scanned railway tunnel, a wagon, and the wagon's way through.", program);
    app.footer(footer);
    app.add_option("FOLDER", folder, "where the three files go; made if it is not there")->type_name("")->required();
    app.add_option("--scale", scale, "share of the full number of points and poses, above 0, 100 at most")
        ->type_name("S")
        ->capture_default_str();
    app.add_flag("--tight", tight, "one long bend in which the vault grazes the wagon; points in random order");
    app.add_option("--pieces", pieces,
                   "write the scan as N files scan_0000.pcd ..., for pcl_bsh_site (default: scan.ply)")
        ->type_name("N")
        ->transform(
            cli::number<unsigned>("give a number from 1 to 9999", [](unsigned n) { return n > 0 && n < 10000; }));
    if (!cli::understood(app, program, argc, argv)) return 0;
    return makeTunnel(folder, scale, tight, pieces);
  });
}
