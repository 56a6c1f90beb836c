#include "Device/PoclCache.h"

#include "Device/Errors.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <vector>

namespace fs = std::filesystem;

namespace tyndall
{
namespace
{
/// Largest length of the cache folder's name: PoCL limits the names of files in the folder to 1024 characters.
constexpr std::size_t LongestName = 800;
/// Size, in bytes, of the files with which free space is tested.
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

struct FolderChoice
{
  std::string folder;
  std::string chosenBy; ///< name of the environment variable, or of the program, that chose this folder
};

/// The cache folder that PoCL chooses by its environment variables.
FolderChoice FolderOfEnvironment()
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

/// Warning about damaged files; empty if there are none.
std::string Told(const DamagedFiles& damaged, const std::string& folder)
{
  return damaged.count == 0 ? std::string()
                            : "The folder \"" + folder +
      "\" of compiled kernels (of PoCL, which runs OpenCL on the CPU) was damaged: " + damaged.first +
      (damaged.count > 1 ? ", and so on for " + std::to_string(damaged.count) + " files" : "") +
      ". Kernels are compiled again where needed. The damaged files now end in " + PoclCache::Damaged +
      " and can be deleted.";
}

/// A folder below the temporary directory that only the user can write, since files in it are executed.
/// @param trouble  receives the reason why the folder cannot be used; empty if it can
std::string PrivateFolder(std::string& trouble)
{
  std::error_code error;
  fs::path temporary = fs::temp_directory_path(error);
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
  fs::create_directories(folder, error);
  if (error)
  {
    return error.message();
  }
  int failed = 0;
  // The space is reserved in several files of `Piece` bytes, since the system may limit the size of a file; PoCL's own
  // files are far smaller.
  std::vector<int> files;
  for (std::size_t reserved = 0; reserved < bytes && failed == 0; reserved += Piece)
  {
    std::string name = folder + "/tyndall-room-XXXXXX";
    files.push_back(mkstemp(name.data()));
    failed = files.back() < 0 ? errno : posix_fallocate(files.back(), 0, Piece);
    unlink(name.c_str()); // the system frees the file's space once the file is closed
  }
  for (const int file : files)
  {
    close(file);
  }
  if (failed != 0)
  {
    return std::strerror(failed) + (failed == ENOSPC ? " (" + Megabytes(bytes) + " are needed)" : std::string());
  }
  return {};
}

namespace
{
/// The cache folder: PoCL's own choice if it is writable; else a private folder.
PoclCache ChooseCache()
{
  const FolderChoice own = FolderOfEnvironment();
  std::string trouble = WhyNotWritable(own.folder);
  if (trouble.empty())
  {
    const DamagedFiles damaged = SetDamagedAside(own.folder);
    if (damaged.trouble.empty())
    {
      return { own.folder, Told(damaged, own.folder) };
    }
    trouble = damaged.trouble;
  }
  const std::string said = "PoCL, which runs OpenCL on the CPU, cannot keep what it compiles in \"" + own.folder +
    "\" (chosen by " + own.chosenBy + "): " + trouble;
  std::string troubleElsewhere;
  const std::string elsewhere = PrivateFolder(troubleElsewhere);
  if (!troubleElsewhere.empty())
  {
    throw DeviceError(said + "; nor in \"" + elsewhere + "\": " + troubleElsewhere + "." + Advice());
  }
  SetDamagedAside(elsewhere);
  return { elsewhere, said + ". It is kept in \"" + elsewhere + "\" instead." + Advice() };
}

}

const PoclCache& PreparePocl()
{
  static const PoclCache& prepared = *new PoclCache([] {
    const PoclCache cache = ChooseCache();
    if (cache.folder != FolderOfEnvironment().folder)
    {
      setenv("POCL_CACHE_DIR", cache.folder.c_str(), 1);
    }
    setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
    return cache;
  }()); // the cache is never destroyed, since it is used when the process ends
  return prepared;
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
