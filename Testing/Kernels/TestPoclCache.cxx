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
#include <vector>

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

TEST_F(PoclCacheTest, AFailureWithoutTheCompilersWordsIsTriedAgain)
{
  const std::vector<std::string> removed = { "Device pthread failed to build the program", "" };
  const std::vector<std::string> wrong = { "line 1: error: use of undeclared identifier", "" };
  const std::vector<std::string> never(9, "Device pthread failed to build the program");
  const auto timesOf = [](const std::vector<std::string>& logs, const std::string& last) {
    std::size_t times = 0;
    EXPECT_EQ(BuildBesideOthers([&] { return logs[times++]; }), last);
    return times;
  };
  EXPECT_EQ(timesOf(removed, ""), 2u);
  EXPECT_EQ(timesOf(wrong, wrong[0]), 1u) << "an error of the program stays one";
  EXPECT_EQ(timesOf(never, never[0]), 3u);
}
}
