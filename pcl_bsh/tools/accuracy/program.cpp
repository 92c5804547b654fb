// SPDX-License-Identifier: BSD-3-Clause
#include "program.h"

#include "accuracy_report.h"
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/path.h>
#include <pcl_bsh/tools/cli/question_options.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/used_files.h>
#include <pcl_bsh/tools/collide/collide_options.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/question/warnings/warnings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>

namespace pcl_bsh::accuracy {
namespace {

constexpr auto footer =
    R"(Queries whether the clouds collide, where, and their distance, at every setting: exact, tolerance, level of
detail, budgets. Writes accuracy.csv, accuracy.json, accuracy.md and accuracy.png.
A or B may be a pipe, or - for standard input.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: a robot in a hall, at ten poses about (1.5, 2, 0)
  pcl_bsh_accuracy hall.ply robot.pcd --clearance 0.05 --pose 1.5,2,0,0,0,1.57 --poses 10 --out study
Example: a wagon on its way
  pcl_bsh_accuracy tunnel.ply wagon.ply --clearance 0.05 --trajectory poses.txt --out study)";

constexpr std::size_t most_poses = 20; // of a trajectory's; every setting is measured at each, several times

constexpr std::array results = {"accuracy.csv", "accuracy.json", "accuracy.md", "accuracy.png"};

struct Options {
  std::filesystem::path a, b, out, trajectory;
  Question question; ///< at a pose, or each of the path
  unsigned poses = 1, repetitions = 5;
  std::string unit;
  cli::ReadChoice reading;
  cli::CommandFiles files;
};

std::optional<Options> parse(const char* program, int argc, char** argv)
{
  std::string pose;
  std::optional<unsigned> poses;
  Options options;
  CLI::App app("Measures what accuracy costs in time, on two clouds.", program);
  app.footer(footer);
  app.add_option("A", options.a, "the cloud whose points are tested, or a mesh")->type_name("")->required();
  app.add_option("B", options.b, "cloud or mesh to collide with")->type_name("")->required();
  Question& question = options.question;
  cli::addQuestionOptions(app, question, {"clearance"});
  app.add_option("--out", options.out, "folder for the results; made if it is not there")->type_name("DIR")->required();
  app.add_option("--pose", pose, "of B in A's frame, as for pcl_bsh_collide (default: no motion)")->type_name("POSE");
  const auto at_least_one = [](unsigned n) { return n >= 1; };
  app.add_option("--poses", poses,
                 "that pose, and N - 1 about it: up to 5 % of A's diameter and 10 degrees off (default: 1)")
      ->type_name("N")
      ->transform(cli::number<unsigned>("give a number of poses, 1 or more", at_least_one));
  app.add_option("--trajectory", options.trajectory,
                 "instead: a file of B's poses, as for pcl_bsh_collide; of more than 20,\n"
                 "20 in even steps")
      ->type_name("FILE");
  app.add_option("--repeat", options.repetitions, "repetitions of every measurement (default: 5)")
      ->type_name("N")
      ->transform(cli::number<unsigned>("give a number, 1 or more", at_least_one));
  cli::ReadOptions reading;
  reading.addTo(app);
  app.add_option("--unit", options.unit, "name of the clouds' unit, for the picture")->type_name("NAME");
  cli::addQuestionOptions(app, question, {"vertices_only", "threads"});
  if (!cli::understood(app, program, argc, argv)) return std::nullopt;
  cli::requireAccepted(question);
  if (!question.clearance) throw cli::UsageError("--clearance: is missing: give a length");
  if (!options.trajectory.empty() && (!pose.empty() || poses))
    throw cli::UsageError(std::string(pose.empty() ? "--poses" : "--pose") + ": --trajectory is given too: give one");
  options.poses = poses.value_or(1);
  if (!pose.empty()) {
    std::vector<std::string> warnings;
    question.pose = cli::parsePose("--pose", pose, warnings);
    cli::warn(program, warnings);
  }
  options.reading = reading.read({options.a, options.b});
  options.files.reads("A", options.a).reads("B", options.b).reads("--trajectory", options.trajectory);
  options.files.readsPose("--pose", pose);
  for (const char* name : results) options.files.writes("--out", options.out / name);
  return options;
}

io::Obstacle load(const char* program, const Options& options, const std::filesystem::path& path)
{
  double seconds = 0.0;
  const Question& question = options.question;
  io::Obstacle loaded =
      cli::loadObstacle(path, {question.vertices_only}, seconds, options.reading.of(path), nullptr, question.threads);
  cli::warn(program, cli::warningsOf(loaded, path));
  return loaded;
}

/// Names the file, and counts its records.
std::string describe(const io::Obstacle& compared, const std::filesystem::path& path)
{
  return "`" + path.filename().string() + "` (" + counted(compared.view().count, compared.partName()) + ")";
}

struct Box {
  Eigen::AlignedBox3d box;
  explicit Box(const PointsView& view)
  {
    const PointsView& points = view.triangles ? view.triangles->vertices : view;
    for (std::size_t i = 0; i < points.count; ++i) {
      const Point3 p = points.point(static_cast<std::uint32_t>(i));
      const Eigen::Vector3d v(p[0], p[1], p[2]);
      if (v.allFinite()) box.extend(v);
    }
  }
};

/// The pose, then others about it. They turn B about its middle, so that a B far from its origin does not swing away.
std::vector<Eigen::Isometry3d> posesAbout(const Options& options, double diameter, const Eigen::Vector3d& middle)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Eigen::Isometry3d> poses = {options.question.pose};
  while (poses.size() < options.poses) {
    const Eigen::Vector3d axis = Eigen::Vector3d(unit(random), unit(random), unit(random)).normalized();
    const Eigen::Vector3d shift = 0.05 * diameter * Eigen::Vector3d(unit(random), unit(random), unit(random));
    const double angle = unit(random) * 10.0 * 3.14159265358979323846 / 180.0;
    poses.push_back(Eigen::Translation3d(shift) * options.question.pose * Eigen::Translation3d(middle) *
                    Eigen::AngleAxisd(angle, axis) * Eigen::Translation3d(-middle));
  }
  return poses;
}

/// The file's poses, or some of them.
std::vector<Eigen::Isometry3d> posesOfFile(const char* program, const std::filesystem::path& file)
{
  std::vector<std::string> warnings;
  const std::vector<Eigen::Isometry3d> all = io::readPoses(file, &warnings);
  cli::warn(program, warnings);
  if (all.size() <= most_poses) return all;
  std::vector<Eigen::Isometry3d> some;
  for (std::size_t i = 0; i < most_poses; ++i) some.push_back(all[i * (all.size() - 1) / (most_poses - 1)]);
  return some;
}

int study(const char* program, const Options& options, Peers* measure_peers)
{
  options.files.requireApart();
  const std::vector<Eigen::Isometry3d> given =
      options.trajectory.empty() ? std::vector<Eigen::Isometry3d>() : posesOfFile(program, options.trajectory);
  const files::OutputFolder folder(options.out);
  for (const char* name : results) files::requireWritable(options.out / name);
  const io::Obstacle given_a = load(program, options, options.a), given_b = load(program, options, options.b);
  Subject subject{given_a.view(), given_b.view(), *options.question.clearance, {}, 0.0, options.unit};
  const Box a(subject.a), b(subject.b);
  if (a.box.isEmpty() || b.box.isEmpty())
    throw std::runtime_error((a.box.isEmpty() ? options.a : options.b).string() +
                             ": has no finite point: there is nothing to measure: give another cloud");
  subject.diameter = a.box.diagonal().norm();
  subject.poses = given.empty() ? posesAbout(options, subject.diameter, b.box.center()) : given;
  std::vector<std::string> told;
  Question question = options.question;
  question.path = subject.poses;
  addTexts(warningsOf(question, measuredCloud(options.a.string(), SphereHierarchy(subject.a)),
                      measuredCloud(options.b.string(), SphereHierarchy(subject.b))),
           told);
  cli::warn(program, told);

  const auto progress = [](const std::string& what, double done) {
    std::cerr << "> " << static_cast<int>(100 * done) << " %: " << what << '\n';
  };
  std::vector<Measurement> peers;
  if (measure_peers) peers = measure_peers(subject, std::min(options.repetitions, 3u), progress);
  for (const Measurement& m : peers) // tolerances with the errors of the peers
    if (m.query == "distance" && m.actual_error > 1e-6 * subject.diameter)
      subject.tolerances.push_back(roundLengthDown(m.actual_error));
  std::sort(subject.tolerances.begin(), subject.tolerances.end());
  subject.tolerances.erase(std::unique(subject.tolerances.begin(), subject.tolerances.end()), subject.tolerances.end());
  Study result = runStudy(subject, options.repetitions, question.threads, progress);
  for (Measurement& m : peers) result.measurements.push_back(std::move(m));

  std::string heading = describe(given_a, options.a) + " against " + describe(given_b, options.b) + ".";
  if (given_b.isSurface()) heading += " Here " + io::promiseOf(given_b, question.solid) + ".";
  writeReports(options.out, heading, subject, result);
  std::cout << advice(subject, result) << "\nWrote " << (options.out / "accuracy.md").string()
            << ", accuracy.csv and accuracy.png beside it.\n";
  return 0;
}

} // namespace

int studyProgram(const char* program, int argc, char** argv, Peers* measure_peers)
{
  return cli::runProgram(program, [&] {
    const std::optional<Options> options = parse(program, argc, argv);
    return options ? study(program, *options, measure_peers) : 0;
  });
}

} // namespace pcl_bsh::accuracy
