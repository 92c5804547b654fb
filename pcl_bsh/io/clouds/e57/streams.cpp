// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/e57/streams.h>
#include <pcl_bsh/io/text/format_error.h>

namespace pcl_bsh::io {

namespace {

constexpr std::uint8_t index_packet = 0, data_packet = 1, empty_packet = 2, section_id = 1;
constexpr std::size_t section_head = 32, packet_head = 4, data_head = 6, room_behind = 16;

} // namespace

E57Streams::E57Streams(E57Pages& pages, std::uint64_t section_at, std::size_t streams)
: pages_(pages),
  cursors_(streams)
{
  const std::uint64_t at = pages_.logical(section_at);
  std::array<std::uint8_t, section_head> head;
  pages_.read(at, head.data(), head.size());
  const auto bytes = loaded<std::uint64_t>(&head[8]), data_at = loaded<std::uint64_t>(&head[16]);
  if (head[0] != section_id) throw FormatError("points to a section that holds no points");
  end_ = at + std::min(bytes, pages_.size() - at);
  const std::uint64_t first = pages_.logical(data_at);
  for (Cursor& cursor : cursors_) cursor.next = first;
}

/// The first packet of data at this place or behind it.
const E57Streams::Packet& E57Streams::packetAt(std::uint64_t at)
{
  for (const Packet& packet : packets_)
    if (packet.at == at || packet.data_at == at) return packet;
  Packet& packet = packets_[oldest_];
  oldest_ = (oldest_ + 1) % packets_.size();
  packet.at = packet.data_at = nowhere; // should loading throw
  load(packet, at);
  packet.at = at;
  return packet;
}

void E57Streams::load(Packet& packet, std::uint64_t at)
{
  for (;;) {
    if (at > end_ || end_ - at < packet_head)
      throw FormatError("is truncated: a scan's section ends before the last of its points");
    std::array<std::uint8_t, packet_head> head;
    pages_.read(at, head.data(), head.size());
    const std::size_t size = loaded<std::uint16_t>(&head[2]) + std::size_t{1};
    const bool known = head[0] == index_packet || head[0] == data_packet || head[0] == empty_packet;
    if (!known || size % 4 != 0 || size > end_ - at)
      throw FormatError("is damaged: a scan has a packet of no known kind or length");
    packet.next = at + size;
    if (head[0] == data_packet) {
      packet.bytes.resize(size + room_behind);
      pages_.read(at, packet.bytes.data(), size);
      std::size_t start = data_head + 2 * cursors_.size();
      if (start > size || loaded<std::uint16_t>(&packet.bytes[4]) != cursors_.size())
        throw FormatError("is damaged: a packet has another number of streams than a point has values");
      packet.starts.clear();
      for (std::size_t i = 0; i < cursors_.size(); ++i) {
        packet.starts.push_back(static_cast<std::uint32_t>(start));
        start += loaded<std::uint16_t>(&packet.bytes[data_head + 2 * i]);
      }
      packet.starts.push_back(static_cast<std::uint32_t>(start));
      if (start > size) throw FormatError("is damaged: streams of a packet reach behind its end");
      packet.data_at = at;
      return;
    }
    at = packet.next;
  }
}

/// The next value, where it begins in one packet and ends in another.
std::uint64_t E57Streams::valueAcross(std::size_t stream, unsigned width)
{
  Cursor& cursor = cursors_[stream];
  std::uint64_t value = 0;
  for (unsigned got = 0; got < width;) {
    if (cursor.bit == cursor.end) {
      const Packet& packet = packetAt(cursor.next);
      cursor = {packet.data_at, packet.next, std::uint64_t{packet.starts[stream]} * 8,
                std::uint64_t{packet.starts[stream + 1]} * 8};
      continue;
    }
    const auto some = static_cast<unsigned>(std::min<std::uint64_t>(width - got, cursor.end - cursor.bit));
    value |= bitsAt(packetAt(cursor.packet).bytes.data(), cursor.bit, some) << got;
    cursor.bit += some;
    got += some;
  }
  return value;
}

} // namespace pcl_bsh::io
