// What is asked of the folder that PoCL writes to; TestCompilerCache of the filters has what users see of it.
#include "Device/Errors.h"
#include "Device/PoclCache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

using namespace tyndall;

namespace
{
namespace fs = std::filesystem;

class PoclCacheTest : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Folder = fs::temp_directory_path() / ("tyndall_pocl_cache_" + std::to_string(getpid()));
    fs::create_directories(this->Folder);
  }
  void TearDown() override { fs::remove_all(this->Folder); }

  fs::path Folder;
};

TEST_F(PoclCacheTest, AFolderThatCanBeMadeWillDo)
{
  const fs::path below = this->Folder / "one" / "two";
  EXPECT_EQ(WhyNotWritable(below.string()), "");
  EXPECT_TRUE(fs::is_directory(below));
  EXPECT_TRUE(fs::is_empty(below)) << "nothing of the trial stays";
  EXPECT_NO_THROW(RequireRoom(below.string()));
}

TEST_F(PoclCacheTest, WhatIsNoFolderIsTold)
{
  std::ofstream(this->Folder / "file") << "text";
  EXPECT_EQ(WhyNotWritable((this->Folder / "file" / "below").string()), "Not a directory");
  EXPECT_NE(WhyNotWritable((this->Folder / "file").string()), "");
  EXPECT_EQ(WhyNotWritable(""), "it is empty");
  EXPECT_THAT(WhyNotWritable((this->Folder / std::string(900, 'x')).string()), testing::HasSubstr("longer than 800"));
}

TEST_F(PoclCacheTest, AFolderThatTakesTooLittleIsTold)
{
  struct rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = { 4096, before.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_EQ(WhyNotWritable(this->Folder.string(), 1), "File too large");
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(WhyNotWritable(this->Folder.string(), 1), "");
}
}
