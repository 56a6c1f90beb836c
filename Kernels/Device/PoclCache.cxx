#include "Device/PoclCache.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr std::size_t LongestName = 800; ///< PoCL has 1024 characters for the names of files in it
constexpr std::size_t Piece = std::size_t(1) << 20;

std::string Megabytes(std::size_t bytes)
{
  return std::to_string(bytes >> 20) + " MiB";
}

std::string Advice()
{
  return " Free space there, or set the environment variable POCL_CACHE_DIR to a folder where " +
    Megabytes(PoclCache::Room) + " can be written.";
}

struct Candidate
{
  std::string folder;
  std::string chosenBy; ///< what leads PoCL there
};

/// As PoCL finds it.
Candidate FolderOfEnvironment()
{
  if (const char* said = std::getenv("POCL_CACHE_DIR"))
  {
    return { said, "POCL_CACHE_DIR" };
  }
  const char* use = std::getenv("POCL_KERNEL_CACHE");
  const std::string below = use && use[0] != '1' ? "/pocl/uncached" : "/pocl/kcache";
  const char* caches = std::getenv("XDG_CACHE_HOME");
  if (caches && caches[0] != '\0')
  {
    return { caches + below, "XDG_CACHE_HOME" };
  }
  if (const char* home = std::getenv("HOME"))
  {
    return { home + ("/.cache" + below), "HOME" };
  }
  return { "/tmp" + below, "PoCL itself" };
}

/// A file that has no name any more, so that it goes with the process.
class Scratch
{
public:
  explicit Scratch(const std::string& folder)
  {
    std::string name = folder + "/tyndall-room-XXXXXX";
    this->Number = mkstemp(name.data());
    this->Error = this->Number < 0 ? errno : 0;
    if (this->Number >= 0)
    {
      unlink(name.c_str());
    }
  }
  Scratch(Scratch&& other) noexcept
    : Number(std::exchange(other.Number, -1))
    , Error(other.Error)
  {
  }
  ~Scratch()
  {
    if (this->Number >= 0)
    {
      close(this->Number);
    }
  }

  /// @return 0 or what went wrong
  int Write(const std::vector<char>& bytes)
  {
    for (std::size_t written = 0; this->Error == 0 && written < bytes.size();)
    {
      const ssize_t more = write(this->Number, bytes.data() + written, bytes.size() - written);
      this->Error = more > 0 ? 0 : more < 0 ? errno : ENOSPC;
      written += more > 0 ? static_cast<std::size_t>(more) : 0;
    }
    return this->Error;
  }

private:
  int Number = -1;
  int Error = 0;
};

/// Bytes that a file system which compresses cannot make fewer.
std::vector<char> Noise()
{
  std::vector<char> bytes(Piece);
  std::uint64_t state = 1;
  std::generate(bytes.begin(), bytes.end(), [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<char>(state >> 56);
  });
  return bytes;
}

/// One of the user's own: what others could put there would be run.
std::string PrivateFolder(std::string& trouble)
{
  std::error_code error;
  std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  if (error)
  {
    temporary = "/tmp";
  }
  const std::string folder = (temporary / ("tyndall-pocl-" + std::to_string(geteuid()))).string();
  struct stat found = {};
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST)
  {
    trouble = std::strerror(errno);
  }
  else if (lstat(folder.c_str(), &found) != 0)
  {
    trouble = std::strerror(errno);
  }
  else if (!S_ISDIR(found.st_mode) || found.st_uid != geteuid() || (found.st_mode & (S_IRWXG | S_IRWXO)) != 0)
  {
    trouble = "it is not a folder of this user alone";
  }
  else
  {
    trouble = WhyNotWritable(folder);
  }
  return folder;
}
}

std::string WhyNotWritable(const std::string& folder, std::size_t bytes)
{
  if (folder.empty())
  {
    return "it is empty";
  }
  if (folder.size() > LongestName)
  {
    return "its name is longer than " + std::to_string(LongestName) + " characters";
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
  {
    return error.message();
  }
  const std::vector<char> noise = Noise();
  std::vector<Scratch> files; // in pieces: there may be a limit to files, which PoCL's do not come near
  for (std::size_t written = 0; written < bytes; written += Piece)
  {
    files.emplace_back(folder);
    if (const int failed = files.back().Write(noise))
    {
      return std::strerror(failed) + (failed == ENOSPC ? " (" + Megabytes(bytes) + " are needed)" : std::string());
    }
  }
  return {};
}

PoclCache ChoosePoclCache()
{
  const Candidate own = FolderOfEnvironment();
  const std::string trouble = WhyNotWritable(own.folder);
  if (trouble.empty())
  {
    return { own.folder, {} };
  }
  const std::string said = "PoCL, which runs OpenCL on the CPU, cannot keep what it compiles in \"" + own.folder +
    "\" (chosen by " + own.chosenBy + "): " + trouble;
  std::string troubleElsewhere;
  const std::string elsewhere = PrivateFolder(troubleElsewhere);
  if (!troubleElsewhere.empty())
  {
    throw DeviceError(said + "; nor in \"" + elsewhere + "\": " + troubleElsewhere + "." + Advice());
  }
  setenv("POCL_CACHE_DIR", elsewhere.c_str(), 1);
  return { elsewhere, said + ". It is kept in \"" + elsewhere + "\" instead." + Advice() };
}

void CompileForAnyGroup()
{
  setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
}

void RequireRoom(const std::string& folder)
{
  struct statvfs disk = {};
  if (statvfs(folder.c_str(), &disk) == 0 && disk.f_bavail * disk.f_frsize < PoclCache::Room)
  {
    throw DeviceError("PoCL, which runs OpenCL on the CPU, cannot keep what it compiles in \"" + folder +
      "\": " + std::to_string(disk.f_bavail * disk.f_frsize) + " bytes are left there, " + Megabytes(PoclCache::Room) +
      " are needed." + Advice());
  }
}

std::string BuildBesideOthers(const std::function<std::string()>& build)
{
  constexpr int MostTimes = 3;
  std::string log = build();
  for (int times = 1; times < MostTimes && !log.empty() && log.find("error") == std::string::npos; ++times)
  {
    log = build();
  }
  return log;
}
}
