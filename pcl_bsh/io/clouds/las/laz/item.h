// SPDX-License-Identifier: BSD-3-Clause
// Parts of a point record that are compressed by themselves. A chunk of points begins with a whole record; what follows
// is what each item of a record differs by from the one before.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/arithmetic_decoder.h>
#include <pcl_bsh/io/clouds/stored_number.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace pcl_bsh::io::laz {

/// Items of all points in one stream, point by point: formats 0 to 5.
class PointwiseItem {
public:
  virtual ~PointwiseItem() = default;

  /// @param item of the chunk's first record
  virtual void start(const char* item) = 0;

  /// The next record's item.
  virtual void read(ArithmeticDecoder& in, char* item) = 0;
};

/// @tparam Models their read(in, last) makes the last item the next one
template <class Models>
class PointwiseOf : public PointwiseItem {
public:
  PointwiseOf(std::size_t size, Models models) : last_(size), models_(std::move(models)) {}

  void start(const char* item) override { std::memcpy(last_.data(), item, last_.size()); }

  void read(ArithmeticDecoder& in, char* item) override
  {
    models_.read(in, last_.data());
    std::memcpy(item, last_.data(), last_.size());
  }

private:
  std::vector<char> last_;
  Models models_;
};

template <class Models>
std::unique_ptr<PointwiseItem> newPointwise(std::size_t size, Models models = {})
{
  return std::make_unique<PointwiseOf<Models>>(size, std::move(models));
}

/// A stream of a chunk that holds one attribute; without bytes where that does not change.
using Layer = std::optional<ArithmeticDecoder>;

/// Items in layers: formats 6 to 10. Each scanner channel has models and a last record of its own; the first item of a
/// record tells the channel to the others. Version 4 does so. Files of version 3 have been written by programs which
/// told the others channel 0 for all points but the first and those whose channel differs from that of the point
/// before.
class LayeredItem {
public:
  virtual ~LayeredItem() = default;

  virtual std::size_t layers() const = 0;

  /// @param item of the chunk's first record. @param layers as many as there are; they stay where they are
  virtual void start(const char* item, std::span<Layer> layers, unsigned& channel) = 0;

  virtual void read(char* item, unsigned& channel) = 0;
};

inline constexpr unsigned first_version_of_channels = 4;

/// Items of a record behind the first. A new channel begins with the last item of the channel before. A channel that
/// comes again goes on from its own last item in version 4. In version 3 it goes on, with its own models, from the last
/// item of the channel before, and changes that item.
/// @tparam Models their read(layers, last) makes the last item the next one
template <class Models>
class LayeredOf : public LayeredItem {
public:
  /// @param fresh models of a new channel
  LayeredOf(std::size_t size, std::size_t layers, unsigned version, Models fresh)
  : size_(size),
    layer_count_(layers),
    own_last_(version >= first_version_of_channels),
    fresh_(std::move(fresh))
  {
  }

  std::size_t layers() const override { return layer_count_; }

  void start(const char* item, std::span<Layer> layers, unsigned& channel) override
  {
    layers_ = layers;
    current_ = channel;
    channels_[channel].emplace(Channel{std::vector<char>(item, item + size_), fresh_});
  }

  void read(char* item, unsigned& channel) override
  {
    char* last = channels_[current_]->last.data();
    if (channel != current_) {
      const bool is_new = !channels_[channel];
      if (is_new) channels_[channel].emplace(Channel{channels_[current_]->last, fresh_});
      current_ = channel;
      if (is_new || own_last_) last = channels_[channel]->last.data();
    }
    channels_[current_]->models.read(layers_, last);
    std::memcpy(item, last, size_);
  }

private:
  struct Channel {
    std::vector<char> last;
    Models models;
  };

  std::size_t size_, layer_count_;
  bool own_last_;
  Models fresh_;
  std::span<Layer> layers_;
  std::array<std::optional<Channel>, 4> channels_;
  unsigned current_ = 0;
};

template <class Models>
std::unique_ptr<LayeredItem> newLayered(std::size_t size, std::size_t layers, unsigned version, Models fresh = {})
{
  return std::make_unique<LayeredOf<Models>>(size, layers, version, std::move(fresh));
}

using NewPointwise = std::unique_ptr<PointwiseItem>(unsigned version, std::size_t size);
using NewLayered = std::unique_ptr<LayeredItem>(unsigned version, std::size_t size);

NewPointwise newPoint10, newGpsTime11, newRgb12, newWavePacket13, newBytes;
NewLayered newPoint14, newRgb14, newRgbNir14, newWavePacket14, newBytes14;

} // namespace pcl_bsh::io::laz
