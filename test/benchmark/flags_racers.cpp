// SPDX-License-Identifier: BSD-3-Clause
#include "flags_racers.h"

#include "harness.h"
#include "peer/uniform_grid.h"

#include <pcl_bsh/collide.h>

#include <stdexcept>

namespace pcl_bsh::bench {
namespace {

enum class Building { as_visited, ahead };

class OurRacer : public FlagsRacer {
public:
  explicit OurRacer(Building building) : building_(building) {}

  void adopt(const Points& a, const Points& b) override
  {
    a_ = viewOf(&a.data()->x, a.size());
    b_ = viewOf(&b.data()->x, b.size());
  }

  FlagsRun run(double d, unsigned threads) override
  {
    HierarchyOptions options;
    options.threads = threads;
    FlagsRequest request;
    request.clearance = d;
    request.threads = threads;

    const double faults = minorFaults();
    const Stopwatch build;
    const SphereHierarchy a(a_, options), b(b_, options);
    if (building_ == Building::ahead) {
      a.buildAll(threads);
      b.buildAll(threads);
    }
    const double build_seconds = build.seconds(), build_faults = minorFaults() - faults;
    const Stopwatch query;
    FlagsResult result = collisionFlags({a}, {b}, request);
    const double query_seconds = query.seconds();
    return {build_seconds, query_seconds, numbersOf(result.a), describe(result.work), build_faults};
  }

  FlagsRun runAny(double d) override
  {
    AnyRequest request;
    request.clearance = d;
    const double faults = minorFaults();
    const Stopwatch build;
    const SphereHierarchy a(a_), b(b_);
    if (building_ == Building::ahead) {
      a.buildAll();
      b.buildAll();
    }
    const double build_seconds = build.seconds(), build_faults = minorFaults() - faults;
    const Stopwatch query;
    const AnyResult result = anyCollision({a}, {b}, request);
    const double query_seconds = query.seconds();
    return {build_seconds,
            query_seconds,
            {static_cast<std::uint8_t>(result.verdict == Verdict::colliding)},
            describe(result.work),
            build_faults};
  }

private:
  static std::string describe(const Work& work)
  {
    return std::to_string(work.node_pairs) + " node pairs, " + std::to_string(work.updates()) + " updates, " +
           std::to_string(work.leaf_pairs) + " leaf pairs, " + std::to_string(work.exact_decisions) + " exact";
  }

  Building building_;
  PointsView a_, b_;
};

class PeerRacer : public FlagsRacer {
public:
  explicit PeerRacer(std::unique_ptr<ExistencePeer> peer) : peer_(std::move(peer)) {}

  void adopt(const Points& a, const Points& b) override
  {
    a_ = &a;
    b_ = &b;
    peer_->adopt(b);
  }

  FlagsRun run(double d, unsigned threads) override
  {
    const auto distance = static_cast<float>(d);
    const double faults = minorFaults();
    const Stopwatch build;
    peer_->build(*b_, distance);
    const double build_seconds = build.seconds(), build_faults = minorFaults() - faults;
    const Stopwatch query;
    std::vector<std::uint8_t> flags(a_->size());
    inParts(a_->size(), threads,
            [&](std::size_t begin, std::size_t end) { peer_->flag(*a_, begin, end, distance, flags.data()); });
    const double query_seconds = query.seconds();
    peer_->release();
    return {build_seconds, query_seconds, std::move(flags), remark_, build_faults};
  }

  FlagsRun runAny(double d) override
  {
    const auto distance = static_cast<float>(d);
    const double faults = minorFaults();
    const Stopwatch build;
    peer_->build(*b_, distance);
    const double build_seconds = build.seconds(), build_faults = minorFaults() - faults;
    const Stopwatch query;
    const bool found = peer_->any(a_->data(), a_->size(), distance);
    const double query_seconds = query.seconds();
    peer_->release();
    return {build_seconds, query_seconds, {static_cast<std::uint8_t>(found)}, remark_, build_faults};
  }

protected:
  const Points* a_ = nullptr;
  const Points* b_ = nullptr;
  std::unique_ptr<ExistencePeer> peer_;
  std::string remark_;
};

class GridRacer : public PeerRacer {
public:
  explicit GridRacer(GridCraft craft) : PeerRacer(nullptr), craft_(craft) {}

  void adopt(const Points& a, const Points& b) override
  {
    a_ = &a;
    b_ = &b;
  }

  void tune(double d) override { use(tuneGrid(craft_, *b_, *a_, static_cast<float>(d))); }

  std::vector<double> tuning() const override { return {tuning_.edge_per_d, tuning_.cells_per_point}; }
  void useTuning(const std::vector<double>& tuning) override { use({craft_, tuning.at(0), tuning.at(1)}); }

private:
  void use(const GridTuning& tuning)
  {
    tuning_ = tuning;
    peer_ = std::make_unique<UniformGrid>(tuning);
    remark_ = "edge " + text(tuning.edge_per_d) + " d, <= " + text(tuning.cells_per_point) + " cells/pt";
  }

  GridCraft craft_;
  GridTuning tuning_;
};

} // namespace

std::unique_ptr<FlagsRacer> makeFlagsRacer(const std::string& name)
{
  if (name == "pcl_bsh") return std::make_unique<OurRacer>(Building::as_visited);
  if (name == "pcl_bsh_warm") return std::make_unique<OurRacer>(Building::ahead);
  if (name == "grid") return std::make_unique<GridRacer>(GridCraft::crafted);
  if (name == "plain_grid") return std::make_unique<GridRacer>(GridCraft::plain);
  if (name == "fitted_grid") return std::make_unique<PeerRacer>(std::make_unique<UniformGrid>());
  if (name == "nanoflann") return std::make_unique<PeerRacer>(makeNanoflannTree());
  if (name == "pcl_kdtree") return std::make_unique<PeerRacer>(makePclKdTree());
  if (name == "pcl_octree") return std::make_unique<PeerRacer>(makePclOctree());
  throw std::invalid_argument("racer '" + name + "' is unknown: see --help");
}

} // namespace pcl_bsh::bench
