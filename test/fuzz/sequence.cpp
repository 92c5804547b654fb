// SPDX-License-Identifier: BSD-3-Clause
#include "sequence.h"
#include "support/question.h"

#include "changing_cloud.h"
#include "questions.h"
#include "surface_questions.h"
#include "target.h"

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/scene/scene.h>

#include <algorithm>
#include <deque>

namespace pcl_bsh::fuzz {
namespace {

using test::Random;

/// A scene of some of the clouds, which it shares with others.
class SharedScene {
public:
  SharedScene(std::deque<ChangingCloud>& clouds, double unit, Random& random)
  : clouds_(clouds),
    scene_(options(unit, random)),
    clearance_(scene_.options().clearance)
  {
    const int count = random.integer(2, 3);
    for (int i = 0; i < count; ++i) {
      const auto cloud = static_cast<std::size_t>(random.integer(0, static_cast<int>(clouds.size()) - 1));
      cloud_of_.push_back(cloud);
      scene_.add(object("object " + std::to_string(i), clouds[cloud].shared(), clouds[cloud].pose));
    }
  }

  std::size_t cloudOf(ObjectId object) const { return cloud_of_[object]; }
  std::size_t size() const { return cloud_of_.size(); }

  void setPose(ObjectId object, const Eigen::Isometry3d& pose) { scene_.setPose(object, pose); }

  RefitReport deform(ObjectId object, const PointsView& now) { return scene_.deform(object, 0, now); }

  void pointsChanged(std::size_t cloud)
  {
    for (ObjectId i = 0; i < size(); ++i)
      if (cloud_of_[i] == cloud) scene_.pointsChanged(i);
  }

  void compare()
  {
    const SceneResult found = scene_.query();
    std::vector<std::vector<Verdict>> flags(size());
    for (ObjectId i = 0; i < size(); ++i) flags[i].assign(clouds_[cloud_of_[i]].view().count, Verdict::free);
    std::size_t colliding = 0, near = 0, touching = 0;
    test::Question request;
    request.clearance = clearance_;
    request.flagged = Flagged::both;
    for (ObjectId i = 0; i < size(); ++i)
      for (ObjectId j = i + 1; j < size(); ++j) {
        const Placed a = placed(i), b = placed(j);
        const FlagsResult expected = brute_force::collisionFlags(a, b, request);
        const auto of = [&](const PartPair& pair) { return pair.a == i && pair.b == j; };
        const auto any = std::find_if(found.any.begin(), found.any.end(), of);
        require((any != found.any.end()) == (expected.colliding_a > 0), "scene: another verdict");
        colliding += expected.colliding_a > 0 ? 1 : 0;
        if (any != found.any.end()) requireColliding(a, b, any->pair);
        for (std::size_t k = 0; k < expected.a.size(); ++k) flags[i][k] = graver(flags[i][k], expected.a[k]);
        for (std::size_t k = 0; k < expected.b.size(); ++k) flags[j][k] = graver(flags[j][k], expected.b[k]);

        const DistanceResult closest = brute_force::closestPair(a, b);
        const double within = *scene_.options().effects.distance;
        const auto distant = std::find_if(found.distance.begin(), found.distance.end(), of);
        if (distant != found.distance.end()) {
          ++near;
          require(distant->distance == closest.distance && closest.pair && distant->pair == *closest.pair,
                  "scene: another distance");
        }
        else {
          require(!closest.pair || closest.distance >= within, "scene: a distance is missing");
        }
        const std::vector<PointPair> pairs = collidingPairs(a, b, clearance_);
        const std::size_t most = *scene_.options().effects.contacts;
        const auto contacts = std::find_if(found.contacts.begin(), found.contacts.end(), of);
        require((contacts != found.contacts.end()) == !pairs.empty(), "scene: contacts of another pair");
        if (contacts == found.contacts.end()) continue;
        ++touching;
        requireNearest(a, b, pairs, most, contacts->contacts);
      }
    require(found.any.size() == colliding && found.distance.size() == near && found.contacts.size() == touching,
            "scene: pairs that there are not");
    for (ObjectId i = 0; i < size(); ++i) {
      const auto part = std::find_if(found.flags.begin(), found.flags.end(),
                                     [&](const FlaggedPart& flagged) { return flagged.object == i; });
      const bool hit = countOf(flags[i], Verdict::colliding) > 0;
      require((part != found.flags.end()) == hit, "scene: flags of another object");
      if (hit) require(part->flags == flags[i], "scene: other flags");
    }
  }

private:
  static SceneOptions options(double unit, Random& random)
  {
    SceneOptions options;
    options.clearance = unit / 8 * random.integer(0, 4);
    options.effects.any = options.effects.flags = true;
    options.effects.distance = random.chance(0.5) ? 1e300 : unit / 2;
    options.effects.contacts = static_cast<std::size_t>(random.integer(1, 9));
    constexpr double growths[] = {1.0, 1.5, 100.0};
    options.effects.deform = random.pick(growths);
    options.threads = static_cast<unsigned>(random.integer(1, 2));
    options.remember = random.chance(0.8);
    return options;
  }

  Placed placed(ObjectId object) const { return {clouds_[cloud_of_[object]].hierarchy(), scene_.worldPose(object)}; }

  void requireColliding(const Placed& a, const Placed& b, const PointPair& pair) const
  {
    const PointsView &p = a.hierarchy().view(), &q = b.hierarchy().view();
    require(pair.a < p.count && pair.b < q.count, "scene: a witness that there is not");
    require(RecordDistance(p, a.pose, q, b.pose).compare(pair, clearance_) <= 0, "scene: the witness does not collide");
  }

  std::deque<ChangingCloud>& clouds_;
  Scene scene_;
  const double clearance_;
  std::vector<std::size_t> cloud_of_;
};

class Sequence {
public:
  Sequence(Bytes& bytes, bool surfaces) : bytes_(bytes), world_(bytes, surfaces)
  {
    log_ = world_.text();
    Random random(bytes.take<std::uint16_t>());
    const unsigned count = 2 + bytes.below(2);
    for (unsigned i = 0; i < count; ++i) {
      clouds_.emplace_back(world_, random);
      note("cloud " + std::to_string(i) + " of " + clouds_.back().text());
    }
  }

  std::size_t run()
  {
    constexpr std::size_t kMost = 24;
    std::size_t steps = 0;
    try {
      for (; steps < kMost && !bytes_.empty(); ++steps) step();
      for (const ChangingCloud& cloud : clouds_) requireSound(cloud.hierarchy()); // builds what was not visited
    }
    catch (const std::exception& error) {
      throw Finding(std::string(error.what()) + "\n  after: " + log_);
    }
    return steps;
  }

private:
  void note(const std::string& what) { log_ += "\n  " + what; }

  void step()
  {
    const unsigned operation = bytes_.below(16);
    const std::size_t which = bytes_.below(static_cast<unsigned>(clouds_.size()));
    Random random(bytes_.take<std::uint16_t>());
    change(operation, which, random);

    const auto kinds = bytes_.take<std::uint16_t>();
    const std::size_t first = bytes_.below(static_cast<unsigned>(clouds_.size()));
    const std::size_t second = bytes_.below(static_cast<unsigned>(clouds_.size()));
    const ChangingCloud &a = clouds_[random.chance(0.5) ? which : first], &b = clouds_[second];
    note("asked: kinds " + std::to_string(kinds) + " of cloud " +
         std::to_string(&a == &clouds_[which] ? which : first) + " and cloud " + std::to_string(second));
    questions_.ask({a.hierarchy(), a.pose}, {b.hierarchy(), b.pose}, world_.unit, kinds & asked(random), random);
    if ((kinds & 0x2000) != 0) askDistances({a.hierarchy(), a.pose}, {b.hierarchy(), b.pose}, world_.unit, random);
    if ((kinds & 0x1000) != 0) askSolid({a.hierarchy(), a.pose}, {b.hierarchy(), b.pose}, world_.unit, random);
    if ((kinds & 0x8000) != 0) {
      note("scenes asked");
      for (SharedScene& scene : scenes_) scene.compare();
    }
    if ((kinds & 0x4000) != 0) {
      note("checked");
      requireSound(a.hierarchy());
    }
  }

  /// A few kinds of queries: so many steps are worth more than many queries after each.
  static unsigned asked(Random& random)
  {
    unsigned kinds = 0;
    for (int i = 0; i < 4; ++i) kinds |= 1u << random.integer(0, static_cast<int>(Questions::kKinds) - 1);
    return kinds;
  }

  void change(unsigned operation, std::size_t which, Random& random)
  {
    ChangingCloud& cloud = clouds_[which];
    const auto did = [&](const std::string& what) { note("cloud " + std::to_string(which) + ": " + what); };
    did("change " + std::to_string(operation));
    switch (operation) {
    case 0:
      did(cloud.buildAnew(random));
      return tellScenes(which, random);
    case 1:
    case 2:
    case 3:
    case 4:
      did(cloud.refit(random));
      return tellScenes(which, random);
    case 5:
    case 6:
    case 7:
    case 8:
      did(cloud.update(random));
      return tellScenes(which, random);
    case 9:
      return did(cloud.buildSome(random));
    case 10:
      did(cloud.moveObject(random));
      return tellScenes(which, random);
    case 11:
      cloud.pose = world_.pose(random);
      return did("another pose");
    case 12:
      if (scenes_.size() < 2) scenes_.emplace_back(clouds_, world_.unit, random);
      return note("a scene more");
    case 13:
    case 14:
      return changeScene(random);
    default:
      return did("only asked");
    }
  }

  /// Some of them: they see by themselves what has changed.
  void tellScenes(std::size_t which, Random& random)
  {
    for (SharedScene& scene : scenes_)
      if (random.chance(0.2)) scene.pointsChanged(which);
  }

  void changeScene(Random& random)
  {
    if (scenes_.empty()) return note("no scene to change");
    const auto chosen = static_cast<std::size_t>(random.integer(0, static_cast<int>(scenes_.size()) - 1));
    SharedScene& scene = scenes_[chosen];
    const auto object = static_cast<ObjectId>(random.integer(0, static_cast<int>(scene.size()) - 1));
    const std::string name = "scene " + std::to_string(chosen) + ", object " + std::to_string(object) + ": ";
    if (random.chance(0.4)) {
      scene.setPose(object, world_.pose(random));
      return note(name + "another pose");
    }
    const std::size_t which = scene.cloudOf(object);
    note(name + "deforms cloud " + std::to_string(which));
    note(clouds_[which].deform(random, [&](const PointsView& now, double) { return scene.deform(object, now); }));
    tellScenes(which, random);
  }

  static void requireSound(const SphereHierarchy& hierarchy)
  {
    const HierarchyDefects defects = hierarchy.validate();
    if (!defects.none()) throw Finding("validate: " + defects.lines.front());
    std::size_t finite = 0;
    const PointsView& view = hierarchy.view();
    for (std::size_t i = 0; i < view.size(); ++i) finite += isFinite(view.point(view.record(i))) ? 1 : 0;
    require(hierarchy.size() == finite && hierarchy.statistics().points == finite, "another number of points");
  }

  Bytes& bytes_;
  World world_;
  std::deque<ChangingCloud> clouds_;
  std::deque<SharedScene> scenes_;
  Questions questions_;
  std::string log_;
};

} // namespace

std::size_t runSequence(Bytes& bytes, bool surfaces)
{
  return Sequence(bytes, surfaces).run();
}

} // namespace pcl_bsh::fuzz
