// SPDX-License-Identifier: BSD-3-Clause
// Runs a scene file: many objects in motion, and only the effects it lists.
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/scene_bodies.h>
#include <pcl_bsh/tools/cli/scene_robots.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/cli/used_files.h>
#include <pcl_bsh/tools/scene/clashes.h>
#include <pcl_bsh/tools/scene/cloud_names.h>
#include <pcl_bsh/tools/scene/explain.h>
#include <pcl_bsh/tools/scene/scene_report.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/scenes/scene_file.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <limits>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using Clock = std::chrono::steady_clock;

constexpr auto program = "pcl_bsh_scene";
constexpr auto footer =
    R"(A scene file names clouds, objects with poses and motions, pairs, and effects; see scene.schema.json and the samples
in examples/scenes. An effect that is not listed is not computed.
With --json, what is said of a check, an explanation or a run is JSON on standard output.
With --out, DIR gets steps.csv (a row a step), steps.jsonl (all results, a line a step), summary.json, and the
flagged clouds if the scene asks for them. Where clouds have an `uncertainty`, what may collide, but does not for
certain, is undecided, flag 2. In steps.jsonl, `unswept` lists objects that did more in a step than first_contact and
swept look at: those `reshaped` by a wave, and those `detoured` by a response or gravity. With the effect bodies,
`bodies` has the pose of each (12 numbers, row by row), its velocity and spin, and `body_contacts` what holds it.
With the effect clashes, --clashes lists where other objects came too near to the scan at any step, place by place;
poses are numbers of steps. summary.json has `clashes`, a table of the objects.
Exit code: 0 done; 1 failed, the scene file is wrong included; 2 command line not understood; 130 stopped by Ctrl-C.

Example:
  pcl_bsh_scene examples/scenes/drift.json --out drift
  pcl_bsh_scene examples/scenes/drift.json --explain
  pcl_bsh_scene examples/scenes/drift.json --validate --json
  pcl_bsh_scene hall.json --clashes week48.html --clashes week48.bcf --previous week47.bcf)";

struct Options : cli::ClashOptions {
  fs::path scene;
  fs::path out;
  bool validate = false;
  bool explain = false;
  bool json = false;
};

double seconds(Clock::time_point since)
{
  return std::chrono::duration<double>(Clock::now() - since).count();
}

double median(std::vector<double> values)
{
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Tells on stderr how far a run has come, when it takes more than a second.
class Progress {
public:
  explicit Progress(std::size_t steps) : steps_(steps) {}

  void done(std::size_t step)
  {
    if (seconds(last_) < 1.0) return;
    last_ = Clock::now();
    std::cerr << "> step " << step << " of " << steps_ << '\n';
  }

private:
  std::size_t steps_;
  Clock::time_point last_ = Clock::now();
};

/// Files of a run; each appears under its own name only when it is complete.
class RunFiles {
public:
  explicit RunFiles(const fs::path& folder)
  : folder_(folder),
    csv_(folder / "steps.csv"),
    json_(folder / "steps.jsonl"),
    summary_(folder / "summary.json")
  {
  }

  std::ostream& csv() { return csv_.stream(); }
  std::ostream& json() { return json_.stream(); }

  void finish(const nlohmann::ordered_json& summary)
  {
    cli::writeJson(summary_.stream(), summary);
    for (files::FileReplacement* file : {&csv_, &json_, &summary_}) file->commit();
  }

private:
  files::OutputFolder folder_;
  files::FileReplacement csv_, json_, summary_;
};

void writeClouds(const io::SceneFile& file, const cli::CloudNames& names, io::SceneWorld& world,
                 const SceneResult& result, const fs::path& folder, std::size_t step)
{
  const auto& parts = file.options.effects.flags ? result.flags : result.swept;
  for (const FlaggedPart& part : parts) {
    const io::PartEntry& entry = file.objects[part.object].parts[part.part];
    fs::path path = folder / names.of(part.object, part.part, step);
    if (const io::Obstacle* const surface = world.surface(entry.cloud)) {
      path.replace_extension(".ply"); // which holds faces
      const std::vector<std::uint8_t> flags = numbersOf(part.flags);
      io::writeMesh(path, surface->points(), *surface->triangles(), {{collision_field_name, &flags}});
      continue;
    }
    io::writeCloud(path, withField(world.cloud(entry.cloud), collision_field_name, part.flags));
  }
}

/// Refuses all that can be refused before the first cloud is loaded.
void check(const io::SceneFile& file, const cli::CloudNames& names, const Options& options)
{
  cli::requireBodies(file);
  if (!file.clashes && !options.clashes.empty())
    throw cli::UsageError("--clashes: " + file.path.string() +
                          " does not list the effect 'clashes': add \"clashes\": {\"of\": SCAN} to 'effects'");
  options.requireWritable();
  cli::CommandFiles used;
  used.reads("SCENE", options.scene);
  for (const auto& [what, path] : file.files()) used.reads(what, path);
  if (!options.out.empty()) {
    for (const char* name : {"steps.csv", "steps.jsonl", "summary.json"}) used.writes("--out", options.out / name);
    if (file.cloud_output != io::CloudOutput::none) {
      for (const io::CloudSource& cloud : file.clouds)
        if (names.mayBe(cloud.file.filename().string())) used.writes("--out", options.out / cloud.file.filename());
    }
  }
  options.addTo(used);
  used.requireApart();
}

nlohmann::ordered_json summaryOf(const io::SceneFile& file, const cli::SceneTotals& totals, std::size_t points,
                                 double load_seconds, bool tests_pairs, const cli::SceneClashList* clashes)
{
  nlohmann::ordered_json json = {{"scene", file.path.string()},
                                 {"objects", file.objects.size()},
                                 {"points", points},
                                 {"steps", totals.step_seconds.size()},
                                 {"tests_pairs", tests_pairs},
                                 {"accuracy", file.options.accuracy.text()},
                                 {"load_seconds", load_seconds},
                                 {"median_step_seconds", median(totals.step_seconds)}};
  const BroadPhaseCost& grid = totals.broad_phase;
  json["broad_phase"] = {{"moved_objects", grid.moved},           {"voxels_left", grid.voxels_left},
                         {"voxels_entered", grid.voxels_entered}, {"box_tests", grid.box_tests},
                         {"candidates", grid.candidates},         {"seconds", grid.seconds}};
  json["effects"] = nlohmann::ordered_json::object();
  for (std::size_t e = 0; e < kEffects; ++e)
    if (file.options.effects.has(static_cast<Effect>(e)))
      json["effects"][nameOf(static_cast<Effect>(e))] = cli::toJson(totals.costs[e]);
  if (file.bodies) json["effects"]["bodies"] = totals.bodies.json();
  if (file.options.effects.any) {
    json["colliding_steps"] = totals.colliding_steps;
    json["undecided_steps"] = totals.undecided_steps;
  }
  if (file.options.effects.first_contact || file.options.effects.swept) json["unswept_steps"] = totals.unswept_steps;
  if (totals.wanted > 0.0)
    json["moves"] = {{"travelled", totals.travelled}, {"wanted", totals.wanted}, {"touched", totals.touched_moves}};
  if (clashes) json["clashes"] = clashes->json();
  return json;
}

void printSummary(const io::SceneFile& file, const cli::SceneTotals& totals, bool tests_pairs)
{
  const auto counted = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  std::printf("%-14s %10s %10s %12s %12s %12s %8s %10s\n", "effect", "queries", "reused", "node pairs", "updates",
              "leaf pairs", "exact", "time [ms]");
  for (std::size_t e = 0; e < kEffects; ++e) {
    if (!file.options.effects.has(static_cast<Effect>(e))) continue;
    const EffectCost& cost = totals.costs[e];
    std::printf("%-14s %10llu %10llu %12llu %12llu %12llu %8llu %10.2f\n", nameOf(static_cast<Effect>(e)),
                counted(cost.pairs), counted(cost.reused), counted(cost.work.node_pairs), counted(cost.work.updates()),
                counted(cost.work.leaf_pairs), counted(cost.work.exact_decisions), 1e3 * cost.seconds);
  }
  if (file.bodies)
    std::printf("%-14s %zu solutions, %zu pairs, %zu contacts, %zu halts before surfaces, %.2f ms\n", "bodies",
                totals.bodies.steps, totals.bodies.solved.pairs, totals.bodies.solved.contacts,
                totals.bodies.solved.cut, 1e3 * totals.bodies.seconds);
  const BroadPhaseCost& grid = totals.broad_phase;
  std::printf("%-14s %llu objects moved, %llu voxels left, %llu entered, %llu boxes compared, %.2f ms\n", "grid",
              counted(grid.moved), counted(grid.voxels_left), counted(grid.voxels_entered), counted(grid.box_tests),
              1e3 * grid.seconds);
  std::printf("%zu steps, median %.3f ms", totals.step_seconds.size(), 1e3 * median(totals.step_seconds));
  if (!tests_pairs && file.options.effects.ofPairs())
    std::printf("; no pair of objects was tested");
  else if (file.options.effects.any)
    std::printf("; pairs collide in %zu of them", totals.colliding_steps);
  if (totals.undecided_steps > 0) std::printf(", are undecided in %zu", totals.undecided_steps);
  if (totals.unswept_steps > 0)
    std::printf("; in %zu objects changed otherwise than by the motion that was swept", totals.unswept_steps);
  if (totals.wanted > 0.0)
    std::printf("; travelled %.3f of %.3f, %zu moves met something", totals.travelled, totals.wanted,
                totals.touched_moves);
  std::printf("\n");
}

/// Prints the answer of --explain and --validate.
void tell(const io::SceneFile& file, const Options& options)
{
  if (options.json) {
    nlohmann::ordered_json json = {{"scene", file.path.string()}, {"valid", true}, {"objects", file.objects.size()}};
    if (options.explain) json.update(cli::explanationJson(file));
    cli::writeJson(std::cout, json);
    return;
  }
  if (options.explain) cli::explain(file, std::cout);
  if (options.validate)
    std::cout << file.path.string() << ": is valid: " << counted(file.objects.size(), "object") << '\n';
}

void runScene(const io::SceneFile& file, const Options& options)
{
  const cli::CloudNames names(file);
  check(file, names, options);
  std::optional<RunFiles> files;
  if (!options.out.empty()) files.emplace(options.out);
  auto start = Clock::now();
  cli::Step loading("Loading clouds");
  io::SceneWorld world(file);
  loading.done(counted(world.points(), "point"));
  cli::warn(program, world.warnings());
  const std::unique_ptr<SceneBodies> bodies = cli::bodiesOf(file, world.scene());
  if (bodies) cli::warn(program, bodies->warnings());
  std::optional<cli::SceneClashList> clashes;
  if (file.clashes) clashes.emplace(file, world, options);
  const double load_seconds = seconds(start);
  if (!options.json)
    std::printf("%s: %zu objects, %zu points in %zu clouds\n", options.scene.c_str(), file.objects.size(),
                world.points(), file.clouds.size());

  const cli::SceneTable table(file.options.effects, cli::mayBeUndecided(world.scene()), bodies.get());
  if (files) table.writeHeader(files->csv());
  cli::SceneTotals totals;
  Progress progress(file.steps);
  for (std::size_t step = 0; step <= file.steps; ++step) {
    start = Clock::now();
    if (step > 0) world.setTime(world.scene().time() + file.dt);
    BodiesStep done;
    if (step == 0)
      done.scene = world.scene().query();
    else
      done = cli::stepOf(world.scene(), bodies.get(), file.dt);
    totals.add(done, seconds(start));
    if (clashes) clashes->addStep();
    progress.done(step);
    if (!files) continue;
    table.writeRow(files->csv(), step, done);
    files->json() << cli::toJson(step, done, world.scene(), bodies.get())
                         .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                  << '\n';
    if (file.cloud_output == io::CloudOutput::every ||
        (file.cloud_output == io::CloudOutput::last && step == file.steps))
      writeClouds(file, names, world, done.scene, options.out, step);
  }
  if (clashes) {
    clashes->finish();
    cli::warn(program, clashes->warnings());
  }
  const bool tests_pairs = world.scene().testsPairs();
  const nlohmann::ordered_json summary =
      summaryOf(file, totals, world.points(), load_seconds, tests_pairs, clashes ? &*clashes : nullptr);
  if (files) files->finish(summary);
  if (options.json)
    cli::writeJson(std::cout, summary);
  else
    printSummary(file, totals, tests_pairs);
  if (clashes && !options.json) std::cout << clashes->summary();
}

void run(const Options& options)
{
  const bool only_tells = options.explain || options.validate;
  const io::SceneFile file =
      cli::checkTold(options.json && only_tells, {{"scene", options.scene.string()}, {"valid", false}},
                     [&] { return cli::readScene(options.scene); });
  cli::warn(program, file.warnings);
  if (only_tells)
    tell(file, options);
  else
    runScene(file, options);
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    Options options;
    CLI::App app("Moves the objects of a scene and computes the effects that it lists.", program);
    app.footer(footer);
    app.add_option("SCENE", options.scene, "scene file (JSON, comments allowed)")->type_name("")->required();
    app.add_option("--out", options.out, "folder for the results")->type_name("DIR");
    app.add_flag("--validate", options.validate, "only check the scene file");
    app.add_flag("--explain", options.explain,
                 "only print which effects are on, what each makes the program build, and why");
    options.ClashOptions::addTo(app, "lists of clashes");
    app.add_flag("--json", options.json, "print what is found as JSON, for programs");
    if (!cli::understood(app, program, argc, argv)) return 0;
    options.requireConsistent();
    run(options);
    return 0;
  });
}
