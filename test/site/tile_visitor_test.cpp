// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/program_run.h"

#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <gtest/gtest.h>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

namespace pcl_bsh::site {
namespace {

/// Listens where programs look for an X display, and hangs up on each that comes.
class XServer {
public:
  XServer()
  {
    std::filesystem::create_directories("/tmp/.X11-unix");
    for (int display = 9; display >= 0 && path_.empty(); --display) {
      sockaddr_un address = {AF_UNIX, {}};
      const std::string path = "/tmp/.X11-unix/X" + std::to_string(display);
      path.copy(address.sun_path, path.size());
      socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 && listen(socket_, 8) == 0)
        path_ = path;
      else
        close(socket_);
    }
    if (pipe(end_) != 0) throw std::runtime_error("no pipe");
    thread_ = std::thread([this] { hangUp(); });
  }
  ~XServer()
  {
    close(end_[1]);
    thread_.join();
    close(end_[0]);
    if (path_.empty()) return;
    close(socket_);
    unlink(path_.c_str());
  }

  bool listens() const { return !path_.empty(); }
  int calls() const { return calls_; }

private:
  void hangUp()
  {
    pollfd watched[] = {{end_[0], POLLIN, 0}, {path_.empty() ? -1 : socket_, POLLIN, 0}};
    while (poll(watched, 2, -1) > 0 && watched[0].revents == 0) {
      close(accept(socket_, nullptr, nullptr));
      ++calls_;
    }
  }

  std::string path_;
  int socket_ = -1;
  int end_[2] = {-1, -1};
  std::atomic<int> calls_ = 0;
  std::thread thread_;
};

/// A program that draws nothing must not end because an X server does.
TEST(TileVisitor, OpensNoDisplay)
{
  const XServer server;
  if (!server.listens()) GTEST_SKIP() << "an X display that is free: end what listens at :0 to :9";
  const io::TemporaryFolder folder;
  folder.write("scan.xyz", "0 0 0\n1 0 0\n");
  EXPECT_EQ(run("pcl_bsh_site", "make scan.xyz --out site", folder.path()).exit_code, 0);
  const Outcome done = run("pcl_bsh_site", "collide site scan.xyz --clearance 1 --report r.json", folder.path());
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(server.calls(), 0);
}

/// Open MPI's daemon would be sought where OPAL_BINDIR says: a question of one rank does without it, and leaves to the
/// programs that it starts what the user's environment was.
TEST(TileVisitor, StartsNoDaemonForOneRank)
{
  const io::TemporaryFolder folder;
  folder.write("scan.xyz", "0 0 0\n1 0 0\n");
  EXPECT_EQ(run("pcl_bsh_site", "make scan.xyz --out site", folder.path()).exit_code, 0);
  setenv("OPAL_BINDIR", folder.path().c_str(), 1);
  const Outcome done = run("pcl_bsh_site", "collide site scan.xyz --clearance 1 --report r.json", folder.path());
  unsetenv("OPAL_BINDIR");
  EXPECT_EQ(done.exit_code, 0) << done.err;

  EXPECT_EQ(ranks(), 1u);
  EXPECT_EQ(std::getenv("OMPI_MCA_pml"), nullptr);
  EXPECT_EQ(std::getenv("OMPI_MCA_ess_singleton_isolated"), nullptr);
}

} // namespace
} // namespace pcl_bsh::site
