// SPDX-License-Identifier: BSD-3-Clause
// A small job for each program that writes files.
#pragma once

#include "process.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh {

struct Job {
  std::string program;
  std::vector<std::string> arguments; ///< in a folder made by prepareJobs()
  std::set<std::string> outputs;      ///< files; a folder for all that is in it ends with a slash
};

/// Without a program that this build leaves out.
inline std::vector<Job> allJobs()
{
  std::vector<Job> jobs = {
      {"pcl_bsh_collide",
       {"scan.xyz", "robot.xyz", "out.pcd", "--clearance", "0.1", "--report", "report.json", "--clashes", "list.json",
        "--clashes", "list.csv", "--clashes", "list.html", "--distances", "--distance-page", "distances.html"},
       {"out.pcd", "report.json", "list.json", "list.csv", "list.html", "distances.html"}},
      {"pcl_bsh_pipeline",
       {"pipeline.json", "--metadata", "run.json"},
       {"run.json", "out.pcd", "out.ply", "list.html", "list.csv", "distances.html", "distances.json"}},
      {"pcl_bsh_scene", {"scene.json", "--out", "run"}, {"run/"}},
      {"pcl_bsh_tunnel", {"run", "--scale", "0.0005"}, {"run/"}},
      {"pcl_bsh_demo", {"scan.xyz", "robot.xyz", "out.pcd"}, {"out.pcd"}},
      {"pcl_bsh_certify", {"scan.xyz", "--sample", "5", "--fit", "box", "--report", "report.json"}, {"report.json"}},
      {"pcl_bsh_view", {"scan.xyz", "--export", "out.vtm"}, {"out.vtm", "out/"}},
      {"pcl_bsh_accuracy", {"scan.xyz", "robot.xyz", "--clearance", "0.1", "--repeat", "1", "--out", "run"}, {"run/"}},
  };
  std::erase_if(jobs, [](const Job& job) {
    return !std::filesystem::exists(std::string(PCL_BSH_PROGRAM_DIR) + "/" + job.program);
  });
  return jobs;
}

/// The input of all jobs.
inline void prepareJobs(const files::TemporaryFolder& folder)
{
  std::string scan = "x y z\n", robot = scan;
  for (int i = 0; i < 3000; ++i) {
    scan += std::to_string(0.1 * (i % 60)) + ' ' + std::to_string(0.1 * (i / 60)) + " 0\n";
    if (i % 7 == 0) robot += std::to_string(0.1 * (i % 20)) + ' ' + std::to_string(0.07 * (i / 60)) + " 0.05\n";
  }
  folder.write("scan.xyz", scan);
  folder.write("robot.xyz", robot);
  folder.write("pipeline.json",
               R"(["scan.xyz", {"type": "filters.bsh_flag", "tag": "f", "obstacle": "robot.xyz", "clearance": 0.1},
                   {"type": "writers.clashes", "obstacle": "robot.xyz", "clearance": 0.1, "filename": "list.html",
                    "also": "list.csv"},
                   {"type": "writers.distances", "obstacle": "robot.xyz", "filename": "distances.html",
                    "also": "distances.json"}, {"type": "writers.pcd", "inputs": "f", "filename": "out.pcd"},
                   {"type": "writers.ply", "inputs": "f", "filename": "out.ply"}])");
  folder.write("scene.json",
               R"({"clouds": {"ball": {"sphere": {"radius": 0.5}, "spacing": 0.1}, "scan": "scan.xyz"},
                   "objects": [{"name": "still", "cloud": "scan", "fixed": true},
                               {"name": "ball", "cloud": "ball", "motion": {"velocity": [1, 0, 0]}}],
                   "clearance": 0.05, "steps": 3, "effects": {"any": true, "flags": true}, "outputs": {"clouds": "every"}})");
}

/// All files under a folder with their contents, by their paths from there; folders as paths that end with a slash.
inline std::map<std::string, std::string> contentsOf(const std::filesystem::path& folder)
{
  std::map<std::string, std::string> contents;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_directory())
      contents[name + "/"];
    else
      contents[name] = entry.is_regular_file() ? files::contentOf(entry.path()) : "";
  }
  return contents;
}

} // namespace pcl_bsh
