// SPDX-License-Identifier: BSD-3-Clause
// A stream into an open file that knows why it failed.
#pragma once

#include <cstddef>
#include <streambuf>
#include <vector>

namespace pcl_bsh::files {

/// Writes to a descriptor, which it does not close.
class DescriptorBuffer : public std::streambuf {
public:
  explicit DescriptorBuffer(int descriptor);

  /// errno of the first write that failed, after which none is tried; 0: none has.
  int error() const noexcept { return error_; }

protected:
  int_type overflow(int_type byte) override;
  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int sync() override;

private:
  bool writeOut(const char* bytes, std::size_t count);
  bool flush();

  int descriptor_;
  int error_ = 0;
  std::vector<char> buffer_;
};

} // namespace pcl_bsh::files
