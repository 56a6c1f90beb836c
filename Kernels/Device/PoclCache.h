#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace tyndall
{
/// The cache folder to which PoCL writes compiled programs. It is checked before PoCL uses it, because PoCL finds no
/// device if it cannot create the folder, and ends the process if the disk is full or a file in it is damaged.
struct PoclCache
{
  /// Free space that is required, bytes; the kernels of a scene take a part of it.
  static constexpr std::size_t Room = std::size_t(8) << 20;
  static constexpr const char* Damaged = ".damaged"; ///< appended to the names of damaged files

  std::string folder;
  std::string warning; ///< why the folder is not PoCL's default, and what to do; empty if it is
};

/// Prepares PoCL before it is asked for devices; call it before any such OpenCL call, since PoCL reads its
/// environment then. This is the only place where the process's environment is changed: PoCL has no other interface for
/// these settings.
///  - POCL_CACHE_DIR: left alone if PoCL's own folder (POCL_CACHE_DIR, or one of the user's) is writable; else a
///    private folder in the temporary directory. Damaged files in it are set aside.
///  - POCL_WORK_GROUP_SPECIALIZATION, unless it is set: 0, so that kernels are compiled once for any work-group size,
///    and not again for nearly every new grid.
/// Later calls return the same.
/// @throws DeviceError if no folder is writable
const PoclCache& PreparePocl();

/// Why `bytes` bytes cannot be written to a folder, which is created if missing; empty if they can.
std::string WhyNotWritable(const std::string& folder, std::size_t bytes = PoclCache::Room);

/// Damaged files found in PoCL's cache.
struct DamagedFiles
{
  std::size_t count = 0;
  std::string first;   ///< the first damaged file, and how it is damaged
  std::string trouble; ///< why a file cannot be set aside; empty if all were
};

/// During its lifetime, a locked file in PoCL's cache folder marks that this process is building a program. PoCL ends
/// the process if cached bitcode is damaged in an undetectable way; the file then remains.
class BuildMark
{
public:
  explicit BuildMark(const std::string& folder); ///< empty: no file is made
  ~BuildMark();
  BuildMark(const BuildMark&) = delete;
  BuildMark& operator=(const BuildMark&) = delete;

private:
  std::string File;
  int Descriptor = -1; ///< locked, for as long as the process lives
};

/// Renames damaged files in PoCL's cache folder to *.damaged, so that PoCL compiles them again. Damaged are: bitcode
/// and libraries that are truncated, overwritten or unreadable; files that were changed since an earlier call noted
/// their checksums in the folder; and all programs, if two runs that started within the last hour, seconds apart, ended
/// while they were building one (BuildMark). Files that are unchanged since they were noted are not read. Other
/// processes may do the same, and PoCL may write, at the same time: PoCL writes files under another name and then
/// renames them, so that none is incomplete.
DamagedFiles SetDamagedAside(const std::string& folder);

/// Notes the checksums of files that PoCL has written to the folder since the last call.
void NoteChecksums(const std::string& folder);

/// Checks free space; quick enough to be called before every program build.
/// @throws DeviceError if the disk of the folder, which PoCL already uses, has become full
void RequireRoom(const std::string& folder);

/// Builds a program, with up to three attempts if the build fails without a compiler message: ranks that start with an
/// empty folder compile the same programs at once, and a rank fails if another has just replaced its file (PoCL 3.1:
/// pocl_remove of program.bc).
/// @param build  builds it from its source. @return the log of a failure; empty: it is built
/// @return the log of the last attempt, likewise
std::string BuildBesideOthers(const std::function<std::string()>& build);
}
