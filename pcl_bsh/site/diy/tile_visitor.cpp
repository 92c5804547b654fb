// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <mpi.h>

#include <stdexcept> // which DIY does not include
#include <vtk_diy2.h>
// clang-format off
#include VTK_DIY2(diy/assigner.hpp)
#include VTK_DIY2(diy/master.hpp)
#include VTK_DIY2(diy/mpi.hpp)
// clang-format on

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <limits>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

namespace {

/// Whether a launcher of MPI's began this process: else there is one rank.
bool launched()
{
  constexpr std::array<const char*, 3> kLaunchers = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  return std::any_of(kLaunchers.begin(), kLaunchers.end(), [](const char* name) { return std::getenv(name); });
}

/// MPI_Init() with these variables of the environment. A value that the user has set stays. The others are gone
/// afterwards, for other programs that this process starts.
void initMpi(const std::vector<std::pair<const char*, const char*>>& variables)
{
  std::vector<const char*> made;
  for (const auto& [name, value] : variables) {
    if (std::getenv(name)) continue;
    setenv(name, value, 0);
    made.push_back(name);
  }
  MPI_Init(nullptr, nullptr);
  for (const char* name : made) unsetenv(name);
}

void beginMpi()
{
  int begun = 0;
  MPI_Initialized(&begun);
  if (begun != 0) return;
  // MPI asks hwloc what the machine is made of, and hwloc's component `gl` opens each X display from :0 to :9 for it: a
  // server that ends meanwhile ends the program.
  std::vector<std::pair<const char*, const char*>> variables = {{"HWLOC_COMPONENTS", "-gl"}};
  // Open MPI starts a daemon and looks for networks even for one rank, which takes longer than most questions.
  if (!launched())
    variables.insert(variables.end(),
                     {{"OMPI_MCA_ess_singleton_isolated", "1"}, {"OMPI_MCA_pml", "ob1"}, {"OMPI_MCA_btl", "self"}});
  initMpi(variables);
  std::atexit([] {
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended == 0) MPI_Finalize();
  });
}

diy::mpi::communicator world()
{
  beginMpi();
  return {};
}

/// Deals numbers to the ranks of an MPI job, to each when it asks, so that slow ranks get fewer.
class SharedCounter {
public:
  /// To be called by all ranks, as the destructor.
  SharedCounter() : is_alone_(ranks() == 1)
  {
    if (is_alone_) return;
    // Memory that MPI allocates is shared within a machine, so that the first rank need not stop to answer. DIY's
    // window is of memory of its own: there the others wait until the first rank has done its tile.
    const bool has_counter = rankHere() == 0;
    MPI_Win_allocate(has_counter ? sizeof(std::uint64_t) : 0, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                     &counter_, &window_);
    if (has_counter) *counter_ = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
  }
  ~SharedCounter()
  {
    if (is_alone_) return;
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;

  /// Returns the next number, from 0. No other rank gets it.
  std::uint64_t next() { return taken(1); }

  /// Ends the dealing: from now on, next() returns no number less than `numbers`.
  void end(std::uint64_t numbers) { taken(numbers); }

private:
  std::uint64_t taken(std::uint64_t count)
  {
    std::uint64_t before = own_counter_;
    own_counter_ += count;
    if (is_alone_) return before;
    MPI_Fetch_and_op(&count, &before, MPI_UINT64_T, 0, 0, MPI_SUM, window_);
    MPI_Win_flush(0, window_);
    return before;
  }

  bool is_alone_;
  std::uint64_t* counter_ = nullptr; ///< on the first rank
  MPI_Win window_ = MPI_WIN_NULL;
  std::uint64_t own_counter_ = 0; ///< where there is one rank
};

/// DIY's block of a tile. Its points are in memory only while it is visited, so DIY need not put blocks away.
struct Block {
  std::uint32_t tile = 0;
  std::uint32_t place = 0; ///< in the order of the visits
};

void* makeBlock()
{
  return new Block;
}

void destroyBlock(void* block)
{
  delete static_cast<Block*>(block);
}

} // namespace

int rankHere()
{
  return world().rank();
}

int ranks()
{
  return world().size();
}

void endAllRanks()
{
  MPI_Abort(world(), 1);
  std::abort();
}

double leastOfAllRanks(double value)
{
  double least = value;
  diy::mpi::all_reduce(world(), value, least, diy::mpi::minimum<double>());
  return least;
}

std::uint64_t sumOfAllRanks(std::uint64_t value)
{
  std::uint64_t sum = value;
  diy::mpi::all_reduce(world(), value, sum, std::plus<std::uint64_t>());
  return sum;
}

std::string gatheredFromAllRanks(const std::string& bytes)
{
  if (sumOfAllRanks(bytes.size()) > std::numeric_limits<int>::max()) // which MPI counts in
    throw std::runtime_error("the ranks' answers are too long for one message: ask on one rank");
  std::vector<std::vector<char>> parts;
  diy::mpi::all_gather(world(), std::vector<char>(bytes.begin(), bytes.end()), parts);
  std::string all;
  for (const std::vector<char>& part : parts) all.append(part.begin(), part.end());
  return all;
}

void throwOfAnyRank(const std::exception_ptr& failure)
{
  const std::uint64_t failures = sumOfAllRanks(failure ? 1 : 0);
  if (failure) std::rethrow_exception(failure);
  if (failures > 0) throw std::runtime_error("another rank has failed: its line says why");
}

TileVisitor::TileVisitor(const Site& site, std::uint64_t memory) : site_(site)
{
  // A tile and its hierarchy, which takes at most twice 32 bytes for each point.
  for (const Tile& tile : site.tiles)
    bytes_for_largest_ = std::max<std::uint64_t>(bytes_for_largest_, tile.points * (recordBytes(site) + 64));
  if (bytes_for_largest_ > memory) {
    throw std::invalid_argument("memory: the largest tile needs " + std::to_string(bytes_for_largest_) +
                                " bytes: give more, or make the site again with smaller tiles");
  }
}

std::exception_ptr TileVisitor::visit(std::uint32_t tile, std::uint32_t place, const Use& use)
try {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  };
  const Clock::time_point begin = Clock::now();
  cloud_ = readTile(site_, site_.tiles[tile], std::move(cloud_));
  const Clock::time_point there = Clock::now();
  ++read_;
  place_ = place;
  use(site_.tiles[tile], cloud_);
  costs_.push_back({tile, place, seconds(begin, there), seconds(there, Clock::now())});
  return nullptr;
}
catch (...) {
  return std::current_exception();
}

void TileVisitor::visitAll(const std::vector<std::uint32_t>& tiles, const Use& use, std::size_t run,
                           const std::function<bool(std::uint32_t)>& still)
{
  const diy::mpi::communicator comm = world();
  SharedCounter shared_counter;
  diy::Master master(comm, 1, -1, makeBlock, destroyBlock); // all ranks make it together
  std::exception_ptr failure;
  const auto visit_block = [&](Block* block, const diy::Master::ProxyWithLink&) {
    failure = visit(block->tile, block->place, use);
  };
  const std::size_t runs = (tiles.size() + run - 1) / run;
  for (std::size_t number = shared_counter.next(); number < runs; number = shared_counter.next()) {
    for (std::size_t place = number * run; place < std::min((number + 1) * run, tiles.size()) && !failure; ++place) {
      if (still && !still(tiles[place])) continue;
      master.clear();
      master.add(0, new Block{tiles[place], static_cast<std::uint32_t>(place)}, new diy::Link);
      master.foreach (visit_block);
    }
    if (failure) shared_counter.end(runs);
  }
  throwOfAnyRank(failure);
}

void TileVisitor::visitInTurn(const std::vector<std::uint32_t>& tiles, const Use& use,
                              const std::function<bool(std::size_t)>& go_on)
{
  const diy::mpi::communicator comm = world();
  diy::Master master(comm, 1, -1, makeBlock, destroyBlock);
  const diy::RoundRobinAssigner assigner(comm.size(), static_cast<int>(tiles.size()));
  std::vector<int> mine;
  assigner.local_gids(comm.rank(), mine);
  for (const int gid : mine)
    master.add(gid, new Block{tiles[static_cast<std::size_t>(gid)], static_cast<std::uint32_t>(gid)}, new diy::Link);

  std::exception_ptr failure;
  const auto per_rank = static_cast<std::size_t>(comm.size());
  for (std::size_t round = 0; round < (tiles.size() + per_rank - 1) / per_rank; ++round) {
    master.foreach (
        [&](Block* block, const diy::Master::ProxyWithLink&) {
          if (block != nullptr) // DIY calls for blocks that are skipped, too
            failure = visit(block->tile, block->place, use);
        },
        [&](int i, const diy::Master&) { return static_cast<std::size_t>(i) != round; });
    throwOfAnyRank(failure);
    if (!go_on(std::min((round + 1) * per_rank, tiles.size()))) return;
  }
}

} // namespace pcl_bsh::site
