// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/uncertainty.h>

#include <pcl_bsh/base/invalid_input.h>

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float infinity_of_floats = std::numeric_limits<float>::infinity();

/// A point and a number of each type.
struct NumbersOfAllTypes {
  double x, y, z, float64;
  std::int32_t int32;
  std::uint32_t uint32;
  float float32;
  std::int16_t int16;
  std::uint16_t uint16;
  std::int8_t int8;
  std::uint8_t uint8;

  static std::uint32_t offsetOf(std::uint8_t datatype)
  {
    using Numbers = NumbersOfAllTypes;
    constexpr std::size_t offsets[] = {0,
                                       offsetof(Numbers, int8),
                                       offsetof(Numbers, uint8),
                                       offsetof(Numbers, int16),
                                       offsetof(Numbers, uint16),
                                       offsetof(Numbers, int32),
                                       offsetof(Numbers, uint32),
                                       offsetof(Numbers, float32),
                                       offsetof(Numbers, float64)};
    return static_cast<std::uint32_t>(offsets[datatype]);
  }
};

PointsView allOf(const std::vector<NumbersOfAllTypes>& records)
{
  return viewOf(&records[0].x, records.size(), sizeof(NumbersOfAllTypes));
}

/// How far points may be from where they are, by a field.
std::vector<float> lengthsOf(const PointsView& view, const RecordField& field, double sigmas)
{
  const PointsView uncertain = withUncertainty(view, {{"other", 0, 8, 1}, field}, "scan", {field.name, sigmas});
  return {uncertain.uncertainties, uncertain.uncertainties + view.count};
}

TEST(UncertaintyOfAField, IsReadWhateverTheTypeOfItsNumbers)
{
  const std::vector<NumbersOfAllTypes> records = {{0, 0, 0, 0.5, 70000, 3000000000u, 0.25f, 300, 60000, 100, 200},
                                                  {1, 2, 3, 1.5, 80000, 4000000000u, 0.75f, 400, 50000, 50, 250}};
  const std::vector<std::vector<float>> numbers = {{},           {100, 50},      {200, 250},
                                                   {300, 400},   {60000, 50000}, {70000, 80000},
                                                   {3e9f, 4e9f}, {0.25f, 0.75f}, {0.5f, 1.5f}};
  for (std::uint8_t type = 1; type < numbers.size(); ++type)
    EXPECT_EQ(lengthsOf(allOf(records), {"sigma", NumbersOfAllTypes::offsetOf(type), type, 1}, 1.0), numbers[type])
        << int{type};
  EXPECT_EQ(lengthsOf(allOf(records), {"sigma", NumbersOfAllTypes::offsetOf(8), 8, 1}, 3.0),
            (std::vector<float>{1.5f, 4.5f}));
  for (const int unknown : {0, 9, 255})
    EXPECT_THAT(
        [&] {
          lengthsOf(allOf(records), {"sigma", 24, static_cast<std::uint8_t>(unknown), 1}, 1.0);
        },
        ThrowsMessage<InvalidInput>(HasSubstr("scan: field 'sigma' of point 0 is nan: give finite lengths")));
}

TEST(UncertaintyOfAField, IsOneNumberAPointWithinItsRecord)
{
  const std::vector<NumbersOfAllTypes> records(2);
  const auto asked = [&](const RecordField& field) {
    return [&records, field] { lengthsOf(allOf(records), field, 1.0); };
  };
  EXPECT_THAT(
      asked({"sigma", 24, 7, 2}),
      ThrowsMessage<InvalidInput>(HasSubstr("scan: field 'sigma' holds 2 values per point: give one that holds one")));
  EXPECT_NO_THROW(asked({"sigma", sizeof(NumbersOfAllTypes) - 4, 7, 1})());
  EXPECT_THAT(
      asked({"sigma", sizeof(NumbersOfAllTypes) - 3, 7, 1}),
      ThrowsMessage<InvalidInput>(HasSubstr("scan: field 'sigma' reaches beyond its record: mend the cloud's fields")));
  EXPECT_NO_THROW(lengthsOf(viewOf(&records[0].x, 0), {"sigma", 999, 7, 1}, 1.0)) << "there is no record";
}

TEST(UncertaintyOfAField, IsFiniteAndNotNegativeWherePointsAre)
{
  std::vector<NumbersOfAllTypes> records(3);
  records[1].x = NAN;
  records[1].float64 = -1.0; // of a point that takes part in nothing
  const auto lengths = [&](double sigmas) { return lengthsOf(allOf(records), {"sigma", 24, 8, 1}, sigmas); };
  EXPECT_EQ(lengths(1.0), std::vector<float>(3, 0.0f));
  for (const double wrong : {-0x1p-1074, static_cast<double>(INFINITY), std::nan("")}) {
    records[2].float64 = wrong;
    EXPECT_THAT([&] { lengths(1.0); }, ThrowsMessage<InvalidInput>(HasSubstr("scan: field 'sigma' of point 2 is ")))
        << wrong;
  }
  records[2].float64 = 1e38;
  EXPECT_NO_THROW(lengths(3.0));
  EXPECT_THAT([&] { lengths(4.0); },
              ThrowsMessage<InvalidInput>(HasSubstr("field 'sigma' of point 2 is 1e+38: give finite lengths >= 0, no "
                                                    "more than 3.40282e+38 in all")));
}

/// The product is above 1 by less than a double tells.
TEST(UncertaintyOfAField, IsNoLessThanItsProduct)
{
  std::vector<NumbersOfAllTypes> records(1);
  records[0].float64 = 1.0 + 0x1p-27;
  const auto length = [&](double sigmas) { return lengthsOf(allOf(records), {"sigma", 24, 8, 1}, sigmas)[0]; };
  const double sigmas = 1.0 - 0x1p-27 + 0x1p-53;
  ASSERT_EQ(records[0].float64 * sigmas, 1.0);
  EXPECT_EQ(length(sigmas), std::nextafter(1.0f, infinity_of_floats));
  EXPECT_EQ(length(1.0 - 0x1p-27), 1.0f) << "below 1";
  records[0].float64 = 0.5;
  EXPECT_EQ(length(2.0), 1.0f) << "exact";
}

TEST(UncertaintyOfAField, HasAChecksumOfItsNumbersAlone)
{
  std::vector<NumbersOfAllTypes> records(2);
  const std::vector<RecordField> fields = {
      {"sigma", NumbersOfAllTypes::offsetOf(7), 7, 1}, {"out", sizeof(NumbersOfAllTypes) - 3, 7, 1}, {}};
  const auto sum = [&](const char* name) { return checksumOf(allOf(records), fields, name); };
  for (NumbersOfAllTypes& record : records) record = {0.1, 0.2, 0.3, 0.4, 1, 2, 0.5f, 3, 4, 5, 6};
  const std::uint64_t before = sum("sigma");
  EXPECT_NE(before, 0u);
  records[1].x = records[1].float64 = 7.1;
  EXPECT_EQ(sum("sigma"), before) << "beside them";
  for (NumbersOfAllTypes& record : records) {
    record.float32 = 0.75f;
    EXPECT_NE(sum("sigma"), before);
    record.float32 = 0.5f;
  }
  EXPECT_EQ(sum(""), 0u) << "no field is asked for, though one has no name";
  EXPECT_EQ(sum("none"), 0u);
  EXPECT_EQ(sum("out"), 0u) << "it is refused where it is read";
}

} // namespace
} // namespace pcl_bsh
