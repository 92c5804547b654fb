// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/viewer/actors/value_bar.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

namespace pcl_bsh::viewer {
namespace {

constexpr int labels = 5;

std::string labelAt(double low, double high, int i)
{
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), labelFormat(low, high, labels).c_str(),
                low + (high - low) * i / (labels - 1));
  return text.data();
}

TEST(ValueBar, LabelsDiffer)
{
  for (const double high : {0.0, 1.0, 7.0, 500.0, 1234.5, 600000.0, 5.4e6, 1e-3, 1e12})
    for (double width = 1e-9; width < 1e6; width *= 3.7) {
      if (high + width / 8 == high || width < high * 1e-12) continue;
      for (const double sign : {1.0, -1.0}) {
        const double low = sign * high, top = low + width;
        std::set<std::string> told;
        for (int i = 0; i < labels; ++i) {
          told.insert(labelAt(low, top, i));
          const double value = low + width * i / (labels - 1);
          EXPECT_NEAR(std::stod(labelAt(low, top, i)), value, width / 8 + 0.005 * std::abs(value))
              << low << ' ' << width;
        }
        EXPECT_EQ(told.size(), 5U) << low << " to " << top;
      }
    }
}

TEST(ValueBar, LabelsAreShort)
{
  EXPECT_EQ(labelAt(0, 1, 1), "0.25");
  EXPECT_EQ(labelAt(0, 0.123456789, labels - 1), "0.123");
  EXPECT_EQ(labelAt(500.001, 500.004, labels - 1), "500.004");
}

} // namespace
} // namespace pcl_bsh::viewer
