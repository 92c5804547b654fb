// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/joint_values.h>

#include "io/clouds/samples.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <fstream>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

TEST(JointValuesText, IsNamesWithNumbers)
{
  EXPECT_EQ(parseJointValues("a=1,b_2=-0.5e-1"), (JointValues{{"a", 1}, {"b_2", -0.05}}));
  EXPECT_EQ(parseJointValues(""), JointValues());
  for (const char* wrong : {"a", "=1", "a=", "a=x", "a=nan", "a=inf", "a=1.#QNAN", "a=-1.#IND", "a=1.#INF",
                            "a=nan(ind)", "a=1,a=2", "a=1 b=2", "a=1,,b=2"})
    EXPECT_THROW(parseJointValues(wrong), io::FormatError) << wrong;
}

class JointStates : public testing::Test {
protected:
  std::vector<JointValues> read(const std::string& text) const
  {
    std::ofstream(folder / "states") << text;
    return readJointStates(folder / "states");
  }

  const io::TemporaryFolder folder;
};

TEST_F(JointStates, AreLinesUnderNames)
{
  const std::vector<JointValues> wanted = {{{"a", 1}, {"b", 2}}, {{"a", 3}, {"b", -4.5}}};
  EXPECT_EQ(read("a,b\n1,2\n3,-4.5\n"), wanted);
  EXPECT_EQ(read("# robot\n  a b\n\n 1 2 # first\r\n3\t-4.5"), wanted);
  EXPECT_EQ(read("\"a\";\"b\"\n1;2\n3;-4.5\n"), wanted);
}

TEST_F(JointStates, NameTheLineThatIsWrong)
{
  const auto wrong = [&](const std::string& text) {
    try {
      read(text);
    }
    catch (const files::FileError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_THAT(wrong("a,b\n1,2\n3\n"), HasSubstr("line 3 has fewer values"));
  EXPECT_THAT(wrong("a,b\n1,2,3\n"), HasSubstr("line 2 has more values"));
  EXPECT_THAT(wrong("a,b\n1,x\n"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(wrong("a,b\n1,inf\n"), HasSubstr("not finite"));
  for (const char* none : {"1.#QNAN", "-1.#IND", "1.#SNAN", "nan(ind)", "1.#INF"})
    EXPECT_THAT(wrong(std::string("a b\n1 2\n3 ") + none + '\n'),
                HasSubstr(std::string("line 3 is damaged: '") + none + "' is not finite"));
  EXPECT_THAT(wrong("1,2\n3,4\n"), HasSubstr("where a name should be"));
  EXPECT_THAT(wrong("a,a\n1,2\n"), HasSubstr("names joint 'a' twice"));
  EXPECT_THAT(wrong("a,b\n"), HasSubstr("no line of values"));
  EXPECT_THAT(wrong("# nothing\n"), HasSubstr("no line of names"));
}

} // namespace
} // namespace pcl_bsh::io
