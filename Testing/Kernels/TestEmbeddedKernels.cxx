#include "TyndallKernelSources.h"
#include "TyndallKernelsTestSources.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace
{
std::string ReadFile(const std::string& path)
{
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}
}

TEST(EmbeddedKernels, AreTheirFilesByteForByte)
{
  const std::string file = ReadFile(TYNDALL_KERNELS_FOLDER "/Numerics/Numerics.cl");
  ASSERT_FALSE(file.empty());
  EXPECT_EQ(tyndall::kernel_source::Numerics, file);
}

TEST(EmbeddedKernels, KeepWhatIsLongerThanOneLiteral)
{
  const std::string file = ReadFile(TYNDALL_LONG_SOURCE);
  ASSERT_GT(file.size(), 130000u);
  EXPECT_EQ(tyndall::kernel_source::Long, file);
}
