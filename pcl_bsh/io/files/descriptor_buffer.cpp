// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/descriptor_buffer.h>

#include <unistd.h>

#include <cerrno>

namespace pcl_bsh::files {

DescriptorBuffer::DescriptorBuffer(int descriptor) : descriptor_(descriptor), buffer_(std::size_t{1} << 16)
{
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

bool DescriptorBuffer::writeOut(const char* bytes, std::size_t count)
{
  while (count > 0 && error_ == 0) {
    const ssize_t written = ::write(descriptor_, bytes, count);
    if (written < 0) {
      if (errno != EINTR) error_ = errno;
      continue;
    }
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return error_ == 0;
}

bool DescriptorBuffer::flush()
{
  const bool done = writeOut(pbase(), static_cast<std::size_t>(pptr() - pbase()));
  setp(buffer_.data(), buffer_.data() + buffer_.size());
  return done;
}

DescriptorBuffer::int_type DescriptorBuffer::overflow(int_type byte)
{
  if (!flush()) return traits_type::eof();
  if (traits_type::eq_int_type(byte, traits_type::eof())) return traits_type::not_eof(byte);
  return sputc(traits_type::to_char_type(byte));
}

std::streamsize DescriptorBuffer::xsputn(const char* bytes, std::streamsize count)
{
  const auto size = static_cast<std::size_t>(count);
  if (size < buffer_.size()) return std::streambuf::xsputn(bytes, count);
  return flush() && writeOut(bytes, size) ? count : 0;
}

int DescriptorBuffer::sync()
{
  return flush() ? 0 : -1;
}

} // namespace pcl_bsh::files
