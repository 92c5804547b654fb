// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/text_cursor.h>

namespace pcl_bsh::io {

namespace {

constexpr auto mend_the_count = "mend the count in its header, or export the file again";

std::string namedCount(const HeaderCount& count, std::uint64_t number)
{
  return std::to_string(number) + ' ' + (number == 1 ? count.one : count.many);
}

const char* verbOf(std::uint64_t number)
{
  return number == 1 ? " is" : " are";
}

} // namespace

void requireNoFewer(const HeaderCount& count, std::uint64_t there)
{
  if (there >= count.told) return;
  throw FormatError("is truncated: " + std::to_string(there) + " of " + namedCount(count, count.told) +
                    verbOf(count.told) + " there");
}

FormatError otherCount(const HeaderCount& count, std::uint64_t there)
{
  return FormatError("has " + namedCount(count, there) + ", and its header counts " + std::to_string(count.told),
                     mend_the_count);
}

void requireNoMore(const HeaderCount& count, std::uint64_t there)
{
  if (there > count.told) throw otherCount(count, there);
}

void requireNoMoreLines(const HeaderCount& count, TextCursor& text)
{
  if (!text.nextLine()) return;
  const TextCursor first = text;
  std::uint64_t there = count.told + 1;
  while (text.nextLine()) ++there;
  first.fail("is one more " + count.one + " than the header promises",
             std::string("mend the count in its header, for there") + verbOf(there) + ' ' + namedCount(count, there) +
                 ", or export the file again");
}

void requireNoMoreBytes(const HeaderCount& count, std::uint64_t left, std::uint64_t record, bool exact)
{
  if (left < record) return;
  if (exact) throw otherCount(count, count.told + left / record);
  throw FormatError("has " + std::to_string(left) + (left == 1 ? " byte" : " bytes") + " behind the " +
                        namedCount(count, count.told) + " that its header counts",
                    mend_the_count);
}

std::optional<std::string> remarkOnMoreBytes(const HeaderCount& count, std::uint64_t left, std::string_view first,
                                             std::uint64_t record)
{
  if (left < record || first.find_first_not_of('\0') == std::string_view::npos) return std::nullopt;
  const std::uint64_t more = left / record;
  return "its header counts " + std::to_string(count.told) + " of the " + namedCount(count, count.told + more) +
         " there is room for: " + std::to_string(more) + verbOf(more) + " left out";
}

std::optional<std::string> remarkOnCount(const HeaderCount& count, std::uint64_t there)
{
  if (there == count.told) return std::nullopt;
  return "its header counts " + namedCount(count, count.told) + ", and " + std::to_string(there) + verbOf(there) +
         " there: all that are there are read";
}

} // namespace pcl_bsh::io
