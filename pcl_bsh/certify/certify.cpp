// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/certify/certify.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/certify/exact_sphere.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
#include <random>
#include <utility>

namespace pcl_bsh {
namespace {

using Storage = SphereHierarchy::Storage;

struct SphereId {
  std::uint32_t tree; ///< number of a voxel, or kAboveVoxels
  std::uint32_t node, child;
};

const Node& nodeOf(const Storage& storage, const SphereId& id)
{
  return id.tree == kAboveVoxels ? storage.top[id.node] : storage.voxels[id.tree].nodes[id.node];
}

StoredSphere sphereOf(const Storage& storage, const SphereId& id)
{
  const Node& node = nodeOf(storage, id);
  return {node.x[id.child], node.y[id.child], node.z[id.child], node.r[id.child]};
}

/// Findings of one thread on one level.
struct LevelFindings {
  LevelCertificate sums;
  std::vector<SphereId> spheres; ///< of this level; above voxels, listTop() adds them
};

/// Findings below one voxel, its levels from the top down.
struct VoxelFindings {
  std::vector<LevelFindings> above, below;
  LevelFindings own;
  std::vector<Leak> leaks;
};

/// Tells the caller how far we are; seldom, and one at a time.
class Progress {
public:
  Progress(std::function<void(double)> tell, std::size_t total) : tell_(std::move(tell)), total_(total) {}

  void add(std::size_t done)
  {
    done_ += done;
    if (!tell_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock) tell_(std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_)));
  }

private:
  const std::function<void(double)> tell_;
  const std::size_t total_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
};

/// Checks one voxel's points against all spheres above them.
class VoxelCheck {
public:
  VoxelCheck(const Storage& storage, std::uint32_t voxel, std::vector<std::uint8_t>& held)
  : storage_(storage),
    index_(voxel),
    voxel_(storage.voxels[voxel]),
    held_(held)
  {
  }

  VoxelFindings run()
  {
    const std::vector<CertifiedPoint> in_cloud = points(storage_.frame), in_voxel = points(voxel_.frame);
    std::uint32_t node = 0;
    for (unsigned depth = 0; node != Node::kLeaf; ++depth) {
      const Node& above = storage_.top[node];
      const auto past = std::upper_bound(above.begin, above.begin + above.count, index_);
      const auto child = static_cast<std::uint32_t>(past - above.begin) - 1;
      check({SphereLevel::above_voxels, depth}, {kAboveVoxels, node, child}, storage_.frame, in_cloud, 0, voxel_.count);
      node = above.child[child];
    }
    const StoredSphere ball{0.0f, 0.0f, 0.0f, voxel_.radius};
    check(findings_.own, {SphereLevel::voxel, 0}, {index_, 0, 0}, ball, voxel_.frame, in_voxel, 0, voxel_.count);
    checkNode(0, 0, in_voxel);
    return std::move(findings_);
  }

private:
  std::vector<CertifiedPoint> points(const LocalFrame& frame) const
  {
    std::vector<CertifiedPoint> points;
    points.reserve(voxel_.count);
    for (std::uint32_t i = 0; i < voxel_.count; ++i) {
      const std::uint32_t record = voxel_.records()[i];
      points.push_back(certifiedPoint(frame, storage_.view.point(record), storage_.view.radius(record)));
    }
    return points;
  }

  void checkNode(std::uint32_t index, unsigned depth, const std::vector<CertifiedPoint>& in_voxel)
  {
    const Node& node = voxel_.nodes[index];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      check({SphereLevel::in_voxel, depth}, {index_, index, i}, voxel_.frame, in_voxel, node.begin[i],
            node.begin[i + 1]);
      if (node.isLeaf(i)) {
        for (std::uint32_t k = node.begin[i]; k < node.begin[i + 1]; ++k) held_[voxel_.records()[k]] = 1;
      }
      else {
        checkNode(node.child[i], depth + 1, in_voxel);
      }
    }
  }

  void check(const SphereLevel& level, const SphereId& id, const LocalFrame& frame,
             const std::vector<CertifiedPoint>& points, std::uint32_t begin, std::uint32_t end)
  {
    auto& levels = level.kind == SphereLevel::above_voxels ? findings_.above : findings_.below;
    if (levels.size() <= level.depth) levels.resize(level.depth + 1);
    check(levels[level.depth], level, id, sphereOf(storage_, id), frame, points, begin, end);
  }

  void check(LevelFindings& findings, const SphereLevel& level, const SphereId& id, const StoredSphere& sphere,
             const LocalFrame& frame, const std::vector<CertifiedPoint>& points, std::uint32_t begin, std::uint32_t end)
  {
    LevelCertificate& sums = findings.sums;
    sums.level = level;
    if (level.kind != SphereLevel::above_voxels) {
      ++sums.spheres;
      findings.spheres.push_back(id);
    }
    sums.checks += end - begin;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (surelyContains(sphere, points[i])) continue;
      ++sums.exact_checks;
      const double out = excess(frame, sphere, points[i]);
      if (!(out > 0.0)) continue;
      ++sums.leaks;
      if (findings_.leaks.size() < Certificate::most_leaks)
        findings_.leaks.push_back({level, index_, id.node, id.child, voxel_.records()[i], out});
    }
  }

  const Storage& storage_;
  const std::uint32_t index_;
  const Voxel& voxel_;
  std::vector<std::uint8_t>& held_; ///< per record; voxels share no record
  VoxelFindings findings_;
};

class Certifier {
public:
  Certifier(const SphereHierarchy& hierarchy, const CertifyOptions& options)
  : storage_(hierarchy.storage()),
    options_(options),
    threads_(threadCount(options.threads)),
    held_(storage_.view.count, 0)
  {
  }

  Certificate run()
  {
    checkContainment();
    countMissing();
    measureRadii();
    for (const LevelCertificate& level : certificate_.levels) addToTotal(level);
    if (options_.progress) options_.progress(1.0);
    return std::move(certificate_);
  }

private:
  /// Returns the callback for the progress of one half of the work, which begins at the share `from`.
  std::function<void(double)> half(double from) const
  {
    if (!options_.progress) return {};
    return [this, from](double share) { options_.progress(from + 0.5 * share); };
  }

  void checkContainment()
  {
    std::vector<VoxelFindings> findings(storage_.voxel_count);
    Progress progress(half(0.0), storage_.size);
    parallelFor(storage_.voxel_count, threads_, [&](std::size_t v) {
      BuildWork unasked;
      storage_.built(v, unasked);
      findings[v] = VoxelCheck(storage_, static_cast<std::uint32_t>(v), held_).run();
      progress.add(storage_.voxels[v].count);
    });

    std::vector<LevelFindings> above, own(1), below;
    for (VoxelFindings& voxel : findings) {
      merge(above, voxel.above);
      merge(below, voxel.below);
      merge(own[0], voxel.own);
      for (const Leak& leak : voxel.leaks)
        if (certificate_.leaks.size() < Certificate::most_leaks) certificate_.leaks.push_back(leak);
    }
    if (storage_.size == 0) return;
    listTop(above, 0, 0); // here, as the checks met each of these spheres once per voxel
    for (const auto* levels : {&above, &own, &below}) {
      for (const LevelFindings& level : *levels) {
        certificate_.levels.push_back(level.sums);
        spheres_.push_back(level.spheres);
      }
    }
  }

  static void merge(LevelFindings& into, LevelFindings& from)
  {
    into.sums.level = from.sums.level;
    into.sums.spheres += from.sums.spheres;
    into.sums.checks += from.sums.checks;
    into.sums.exact_checks += from.sums.exact_checks;
    into.sums.leaks += from.sums.leaks;
    into.spheres.insert(into.spheres.end(), from.spheres.begin(), from.spheres.end());
  }

  static void merge(std::vector<LevelFindings>& into, std::vector<LevelFindings>& from)
  {
    into.resize(std::max(into.size(), from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) merge(into[i], from[i]);
  }

  void listTop(std::vector<LevelFindings>& above, std::uint32_t index, unsigned depth) const
  {
    const Node& node = storage_.top[index];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      ++above[depth].sums.spheres;
      above[depth].spheres.push_back({kAboveVoxels, index, i});
      if (!node.isLeaf(i)) listTop(above, node.child[i], depth + 1);
    }
  }

  void countMissing()
  {
    const PointsView& view = storage_.view;
    for (std::size_t i = 0; i < view.size(); ++i) {
      const std::uint32_t record = view.record(i);
      const Point3 p = view.point(record);
      const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
      if (finite && held_[record] == 0) ++certificate_.missing;
    }
  }

  /// A sphere to compare with the smallest one, and the result.
  struct Measurement {
    std::size_t level;
    SphereId id;
    std::optional<double> ratio = {};
    bool leaks = false;
  };

  void measureRadii()
  {
    std::vector<Measurement> chosen;
    for (std::size_t level = 0; level < spheres_.size(); ++level) {
      if (certificate_.levels[level].level.kind == SphereLevel::voxel) continue;
      std::vector<SphereId> sample;
      std::mt19937_64 random(options_.seed + level);
      std::sample(spheres_[level].begin(), spheres_[level].end(), std::back_inserter(sample),
                  std::min(options_.sample, spheres_[level].size()), random);
      for (const SphereId& id : sample) chosen.push_back({level, id});
    }
    Progress progress(half(0.5), chosen.size());
    parallelFor(chosen.size(), threads_, [&](std::size_t i) {
      measure(chosen[i]);
      progress.add(1);
    });
    for (const Measurement& measurement : chosen) count(measurement);
  }

  void measure(Measurement& measurement) const
  {
    const SphereId& id = measurement.id;
    const Node& node = nodeOf(storage_, id);
    const LocalFrame& frame = id.tree == kAboveVoxels ? storage_.frame : storage_.voxels[id.tree].frame;
    std::vector<CertifiedPoint> points;
    const auto add = [&](const Voxel& voxel, std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t record = voxel.records()[i];
        points.push_back(certifiedPoint(frame, storage_.view.point(record), storage_.view.radius(record)));
      }
    };
    const std::uint32_t begin = node.begin[id.child], end = node.begin[id.child + 1];
    if (id.tree != kAboveVoxels)
      add(storage_.voxels[id.tree], begin, end);
    else
      for (std::uint32_t v = begin; v < end; ++v) add(storage_.voxels[v], 0, storage_.voxels[v].count);

    const StoredSphere sphere = sphereOf(storage_, id);
    measurement.leaks = std::any_of(points.begin(), points.end(), [&](const CertifiedPoint& point) {
      return !surelyContains(sphere, point) && excess(frame, sphere, point) > 0.0;
    });
    if (!measurement.leaks) measurement.ratio = radiusRatio(frame, sphere, points);
  }

  /// Adds the ratio of a sphere. A sphere that leaks has none: it is too small to be compared.
  void count(const Measurement& measurement)
  {
    RadiusRatios& ratios = certificate_.levels[measurement.level].ratio;
    if (measurement.leaks) return;
    if (!measurement.ratio) {
      ++ratios.one_place;
      return;
    }
    const double ratio = *measurement.ratio;
    ++ratios.measured;
    ratios.sum += ratio;
    ratios.worst = std::max(ratios.worst, ratio);
    const auto bin = std::upper_bound(RadiusRatios::edges.begin(), RadiusRatios::edges.end(), ratio);
    ++ratios.histogram[static_cast<std::size_t>(bin - RadiusRatios::edges.begin())];
  }

  void addToTotal(const LevelCertificate& level)
  {
    LevelCertificate& total = certificate_.total;
    total.spheres += level.spheres;
    total.checks += level.checks;
    total.exact_checks += level.exact_checks;
    total.leaks += level.leaks;
    total.ratio.measured += level.ratio.measured;
    total.ratio.one_place += level.ratio.one_place;
    total.ratio.sum += level.ratio.sum;
    total.ratio.worst = std::max(total.ratio.worst, level.ratio.worst);
    for (std::size_t i = 0; i < total.ratio.histogram.size(); ++i) total.ratio.histogram[i] += level.ratio.histogram[i];
  }

  const Storage& storage_;
  const CertifyOptions& options_;
  const unsigned threads_;
  std::vector<std::uint8_t> held_;
  std::vector<std::vector<SphereId>> spheres_; ///< of each level of the certificate
  Certificate certificate_;
};

} // namespace

Certificate certify(const SphereHierarchy& hierarchy, const CertifyOptions& options)
{
  const DefaultFloatEnvironment environment;
  return Certifier(hierarchy, options).run();
}

} // namespace pcl_bsh
