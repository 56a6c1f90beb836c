#include "TyndallKernelSources.h"
#include "TyndallKernelsTestSources.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace
{
std::string ReadFile(const std::string& path)
{
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

int CountOf(const std::string& what, std::string_view text)
{
  int count = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what, at + 1))
  {
    ++count;
  }
  return count;
}
}

// Of a file that includes none.
TEST(EmbeddedKernels, AreTheirFilesByteForByte)
{
  const std::string file = ReadFile(TYNDALL_KERNELS_FOLDER "/Refraction/Octree/RefractionOctree.cl");
  ASSERT_FALSE(file.empty());
  EXPECT_EQ(tyndall::kernel_source::RefractionOctree, file);
}

// BentView.cl includes View.cl directly and through three others, and all need Numerics.cl.
TEST(EmbeddedKernels, HoldWhatTheyIncludeOnce)
{
  const std::string_view text = tyndall::kernel_source::BentView;
  EXPECT_EQ(CountOf("#include \"", text), 0);
  EXPECT_EQ(CountOf("#pragma once", text), 0);
  EXPECT_EQ(CountOf("} camera_rays;", text), 1);
  EXPECT_EQ(CountOf("typedef float real;", text), 1);
  EXPECT_LT(text.find("typedef float real;"), text.find("} camera_rays;"));
}

// A text without #pragma once comes as often as it is asked for: a sweep's bundles of 1, 2, 4 and 8 members.
TEST(EmbeddedKernels, HoldATextAsOftenAsItIsMeant)
{
  const std::string_view text = tyndall::kernel_source::Sweep;
  EXPECT_EQ(CountOf("#define MEMBERS ", text), 4);
  EXPECT_EQ(CountOf("static void CROSS_PLANES(", text), 4);
}

TEST(EmbeddedKernels, KeepWhatIsLongerThanOneLiteral)
{
  const std::string file = ReadFile(TYNDALL_LONG_SOURCE);
  ASSERT_GT(file.size(), 130000u);
  EXPECT_EQ(tyndall::kernel_source::Long, file);
}
