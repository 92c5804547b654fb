// SPDX-License-Identifier: BSD-3-Clause
// Something prepared from clouds for many queries, and prepared again after points of the clouds have moved.
#pragma once

#include <pcl_bsh/python/python_question.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

/// Keeps the clouds. Several threads may ask at once.
template <class Made>
class OfClouds {
public:
  using Clouds = std::vector<std::shared_ptr<const Cloud>>;
  using Make = std::function<std::shared_ptr<const Made>()>;

  OfClouds(Clouds clouds, Make make) : clouds_(std::move(clouds)), make_(std::move(make)) {}

  const Clouds& clouds() const noexcept { return clouds_; }

  /// The result of `make` for the points as they are now. To be called while this thread computes, without the
  /// interpreter's lock. @throws as `make`
  std::shared_ptr<const Made> now() const
  {
    std::size_t changes = 0;
    for (const auto& cloud : clouds_) changes += cloud->changes();
    const std::lock_guard<std::mutex> turn(mutex_);
    if (!made_ || changes != changes_) {
      made_ = make_();
      changes_ = changes;
    }
    return made_;
  }

private:
  const Clouds clouds_;
  const Make make_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Made> made_;
  mutable std::size_t changes_ = 0; ///< sum of the clouds' changes() when it was made
};

} // namespace pcl_bsh::python
