// What is asked of the folder that PoCL writes to; TestCompilerCache of the filters has what users see of it.
#include "DeviceTest.h"

#include "Device/PoclCache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <elf.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
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

namespace
{
std::string ReadBytes(const fs::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>() };
}

/// Into the file that is there, as damage comes; not a new one in its place, as PoCL writes.
void WriteBytes(const fs::path& file, const std::string& bytes)
{
  static int seconds = 0;
  std::ofstream(file, std::ios::binary) << bytes;
  fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::seconds(++seconds)); // no two alike
}

/// As PoCL writes.
void Compile(const fs::path& file, const std::string& bytes)
{
  const fs::path fresh = file.string() + "_8yRcjt.temp";
  WriteBytes(fresh, bytes);
  fs::rename(fresh, file);
}

template <class Value>
std::string AsBytes(const Value& value)
{
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

/// Two blocks.
std::string Bitcode()
{
  std::string bytes = "BC\xc0\xde";
  for (const std::uint32_t words : { 40u, 3u })
  {
    bytes += AsBytes(std::uint32_t{ 0xc35 }) + AsBytes(words) + std::string(4 * words, 'b');
  }
  return bytes;
}

/// One section, and its description.
std::string Library()
{
  const std::string contents(200, 's');
  Elf64_Ehdr header = {};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS64;
  header.e_shnum = 1;
  header.e_shoff = sizeof(header) + contents.size();
  Elf64_Shdr section = {};
  section.sh_type = SHT_PROGBITS;
  section.sh_offset = sizeof(header);
  section.sh_size = contents.size();
  return AsBytes(header) + contents + AsBytes(section);
}

/// A folder of PoCL's with one program, which has one kernel.
class KeptProgram : public PoclCacheTest
{
protected:
  void SetUp() override
  {
    PoclCacheTest::SetUp();
    this->Program = this->Folder / "IH" / "MNBIIDKHHKKOBBBGIKHKHNKACDNNGOBLEAMGO";
    this->Compiled = this->Program / "program.bc";
    this->Linked = this->Program / "sweep" / "0-0-0" / "sweep.so";
    fs::create_directories(this->Linked.parent_path());
    WriteBytes(this->Program / "last_accessed", "");
    WriteBytes(this->Compiled, Bitcode());
    WriteBytes(this->Linked, Library());
  }

  /// As if all that builds, or did when it ended, had begun so long ago.
  void SetBack(std::chrono::seconds ago) const
  {
    for (const auto& entry : fs::directory_iterator(this->Folder))
    {
      if (entry.path().filename().string().rfind("tyndall-building-", 0) == 0)
      {
        fs::last_write_time(entry.path(), fs::file_time_type::clock::now() - ago);
      }
    }
  }

  DamagedFiles SetAside() const { return SetDamagedAside(this->Folder.string()); }

  fs::path Program, Compiled, Linked;
};

using Damage = std::function<std::string(std::string)>;
const std::vector<Damage> Damages = {
  [](const std::string&) { return std::string(); },
  [](const std::string& bytes) { return bytes.substr(0, bytes.size() / 2); },
  [](const std::string& bytes) { return bytes.substr(0, bytes.size() - 4); },
  [](const std::string& bytes) { return bytes + "more"; },
  [](const std::string& bytes) { return std::string(bytes.size(), '\0'); },
  [](const std::string& bytes) { return std::string(bytes.size(), 'x'); },
  [](const std::string& bytes) { return bytes.substr(0, bytes.size() / 2) + std::string(bytes.size() / 2, 'x'); },
};
}

TEST_F(KeptProgram, StaysWhereItIsWhole)
{
  for (int times = 0; times < 2; ++times)
  {
    const DamagedFiles damaged = this->SetAside();
    EXPECT_EQ(damaged.count, 0u) << damaged.first;
    EXPECT_TRUE(fs::exists(this->Compiled) && fs::exists(this->Linked));
  }
}

TEST_F(KeptProgram, IsSetAsideWhereItIsDamaged)
{
  for (const bool noted : { false, true })
  {
    for (const fs::path& file : { this->Compiled, this->Linked })
    {
      const std::string whole = ReadBytes(file);
      for (std::size_t i = 0; i < Damages.size(); ++i)
      {
        const std::string broken = Damages[i](whole);
        const bool extendedLibrary = file == this->Linked && broken.size() > whole.size(); // loads all the same
        if (noted)
        {
          EXPECT_EQ(this->SetAside().count, 0u);
        }
        WriteBytes(file, broken);
        const DamagedFiles damaged = this->SetAside();
        EXPECT_EQ(damaged.count, extendedLibrary && !noted ? 0u : 1u) << file << ", damage " << i << ", " << noted;
        EXPECT_EQ(damaged.trouble, "");
        if (damaged.count > 0)
        {
          EXPECT_THAT(damaged.first, testing::HasSubstr(file.filename().string()));
          EXPECT_EQ(ReadBytes(file.string() + ".damaged"), broken);
          EXPECT_FALSE(fs::exists(file));
          EXPECT_EQ(this->SetAside().count, 0u) << "once is enough";
        }
        Compile(file, whole);
      }
    }
  }
}

TEST_F(KeptProgram, IsKnownByItsChecksum)
{
  NoteChecksums(this->Folder.string());
  std::string bytes = Bitcode();
  bytes[60] ^= 1;
  WriteBytes(this->Compiled, bytes);
  NoteChecksums(this->Folder.string()); // another process that ends
  const DamagedFiles damaged = this->SetAside();
  EXPECT_EQ(damaged.count, 1u);
  EXPECT_THAT(damaged.first, testing::HasSubstr("program.bc\" was changed"));
}

TEST_F(KeptProgram, MayBeReplacedByAnother)
{
  NoteChecksums(this->Folder.string());
  std::string bytes = Bitcode();
  bytes[60] ^= 1;
  Compile(this->Compiled, bytes);
  EXPECT_EQ(this->SetAside().count, 0u);
  fs::last_write_time(this->Linked, fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(this->SetAside().count, 0u) << "the same bytes";
}

namespace
{
void EndWhileBuilding(const std::string& folder)
{
  const pid_t child = fork();
  if (child == 0)
  {
    new BuildMark(folder);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
}
}

TEST_F(KeptProgram, IsSetAsideWhereTwoStartsEndedWhileTheyBuilt)
{
  const BuildMark own(this->Folder.string());
  EndWhileBuilding(this->Folder.string());
  EXPECT_EQ(this->SetAside().count, 0u) << "one may have been killed";
  EndWhileBuilding(this->Folder.string());
  EXPECT_EQ(this->SetAside().count, 0u) << "two ranks of one start";
  this->SetBack(std::chrono::hours(2));
  EXPECT_EQ(this->SetAside().count, 0u) << "long ago";
  EndWhileBuilding(this->Folder.string());
  this->SetBack(std::chrono::minutes(1));
  EndWhileBuilding(this->Folder.string());
  const DamagedFiles damaged = this->SetAside();
  EXPECT_EQ(damaged.count, 1u);
  EXPECT_THAT(damaged.first, testing::HasSubstr("two runs ended"));
  EXPECT_FALSE(fs::exists(this->Program));
  EXPECT_EQ(this->SetAside().count, 0u) << "once is enough";
}

TEST_F(KeptProgram, IsAllThatIsLookedAt)
{
  const fs::path others[] = { this->Folder / "lib" / "own.so", this->Folder / "AB" / "own.so",
    this->Folder / "AB" / "SHORT" / "own.so", this->Folder / "tempfile_XXqanL.so" };
  for (const fs::path& other : others)
  {
    fs::create_directories(other.parent_path());
    WriteBytes(other, "no library");
  }
  EXPECT_EQ(this->SetAside().count, 0u);
  for (const fs::path& other : others)
  {
    EXPECT_TRUE(fs::exists(other)) << other;
  }
}

TEST_F(KeptProgram, IsSetAsideByRanksThatBeginAtOnce)
{
  WriteBytes(this->Compiled, "");
  WriteBytes(this->Linked, "");
  std::vector<DamagedFiles> found(8);
  std::vector<std::thread> ranks;
  for (DamagedFiles& of : found)
  {
    ranks.emplace_back([&] { of = this->SetAside(); });
  }
  std::size_t count = 0;
  for (std::size_t rank = 0; rank < ranks.size(); ++rank)
  {
    ranks[rank].join();
    EXPECT_EQ(found[rank].trouble, "");
    count += found[rank].count;
  }
  EXPECT_GE(count, 2u);
  EXPECT_FALSE(fs::exists(this->Compiled) || fs::exists(this->Linked));
}

namespace
{
constexpr const char* Twice = "kernel void twice(global float* values) { values[get_global_id(0)] *= 2.0f; }";
constexpr const char* Thrice = "kernel void thrice(global float* values) { values[get_global_id(0)] *= 3.0f; }";

/// What a process does that comes to a folder of compiled kernels, and what it says of it.
void MultiplyBySix(Device& device)
{
  for (const std::string& warning : Device::TakeWarnings())
  {
    std::cout << "Warned: " << warning << std::endl;
  }
  Buffer<float> values(device, std::vector<float>{ 1.0f, 2.0f, 3.0f, 4.0f }, "four numbers");
  for (const auto& [source, name] : { std::pair(Twice, "twice"), std::pair(Thrice, "thrice") })
  {
    cl::Kernel kernel = device.Kernel(name, source);
    kernel.setArg(0, values.Handle());
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(4));
  }
  EXPECT_EQ(values.Read(), std::vector<float>({ 6.0f, 12.0f, 18.0f, 24.0f }));
}

std::vector<fs::path> FilesOf(const fs::path& folder, const std::string& extension)
{
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
  {
    files.insert(files.end(), entry.path().extension() == extension ? 1 : 0, entry.path());
  }
  return files;
}
}

class DamagedCache : public DeviceTest
{
};

TEST_F(DamagedCache, IsMendedByTheNextProcess)
{
  if (std::getenv("TYNDALL_MULTIPLIES"))
  {
    MultiplyBySix(this->GetDevice());
    return;
  }
  if (this->GetDevice().Name().find("Portable Computing Language") == std::string::npos)
  {
    GTEST_SKIP() << "The cache is PoCL's.";
  }
  const fs::path folder = fs::temp_directory_path() / ("tyndall_damaged_cache_" + std::to_string(getpid()));
  const std::string said = folder.string() + "-said";
  const auto process = [&] {
    const std::string command = "TYNDALL_MULTIPLIES=1 POCL_CACHE_DIR=" + folder.string() + " " +
      fs::read_symlink("/proc/self/exe").string() + " --gtest_filter=DamagedCache.IsMendedByTheNextProcess >" + said +
      " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << ReadBytes(said);
    return ReadBytes(said).find("Warned: ") != std::string::npos;
  };
  EXPECT_FALSE(process());
  const std::vector<fs::path> compiled = FilesOf(folder, ".bc"), linked = FilesOf(folder, ".so");
  ASSERT_EQ(compiled.size(), 2u);
  ASSERT_EQ(linked.size(), 2u);
  fs::resize_file(compiled[0], fs::file_size(compiled[0]) / 2);
  fs::resize_file(linked[0], fs::file_size(linked[0]) / 2);
  std::string bytes = ReadBytes(linked[1]);
  bytes.replace(0x1000, 64, std::string(64, '\xff')); // no instructions
  WriteBytes(linked[1], bytes);
  EXPECT_TRUE(process()) << "it says what was damaged";
  EXPECT_THAT(ReadBytes(said), testing::HasSubstr("and so on for 3 files"));
  EXPECT_FALSE(process());
  fs::remove_all(folder);
  fs::remove(said);
}
