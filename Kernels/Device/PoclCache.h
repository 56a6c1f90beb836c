#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace tyndall
{
/// The cache folder to which PoCL writes compiled programs. It is checked before PoCL uses it. PoCL finds no device if
/// it cannot create the folder, and ends the process if the disk is full or a file in the folder is damaged.
struct PoclCache
{
  /// Free space that the folder must have, bytes; the compiled kernels of a scene need less.
  static constexpr std::size_t Room = std::size_t(8) << 20;
  static constexpr const char* Damaged = ".damaged"; ///< text appended to the names of damaged files

  std::string folder;
  std::string warning; ///< why the folder is not PoCL's default, and what to do; empty if it is the default
};

/// Prepares PoCL. Must be called before any OpenCL call that asks PoCL for devices, since PoCL reads its environment
/// then. This is the only code that changes the process's environment: PoCL has no other interface for these settings.
///  - POCL_CACHE_DIR: unchanged if PoCL's own folder (POCL_CACHE_DIR, or one of the user's) is writable; else set to a
///    private folder in the temporary directory. Damaged files in the folder are set aside.
///  - POCL_WORK_GROUP_SPECIALIZATION: set to 0 unless it is set, so that kernels are compiled once for all work-group
///    sizes, and not again for nearly every new grid.
/// Later calls return the result of the first.
/// @throws DeviceError if no folder is writable
const PoclCache& PreparePocl();

/// Reason why `bytes` bytes cannot be written to a folder, which is created if it does not exist; empty if they can.
std::string WhyNotWritable(const std::string& folder, std::size_t bytes = PoclCache::Room);

/// Damaged files found in PoCL's cache folder.
struct DamagedFiles
{
  std::size_t count = 0;
  std::string first;   ///< name of the first damaged file, and how it is damaged
  std::string trouble; ///< why a file cannot be set aside; empty if all files were set aside
};

/// A locked file in PoCL's cache folder that exists during the lifetime of this object and marks that this process is
/// building a program. If cached bitcode is damaged in a way that cannot be detected, PoCL ends the process while it
/// builds; the file then remains.
class BuildMark
{
public:
  explicit BuildMark(const std::string& folder); ///< creates the file; does nothing if `folder` is empty
  ~BuildMark();
  BuildMark(const BuildMark&) = delete;
  BuildMark& operator=(const BuildMark&) = delete;

private:
  std::string File;
  int Descriptor = -1; ///< descriptor of the file, which is locked as long as the process lives; -1: no file
};

/// Renames damaged files in PoCL's cache folder to *.damaged, so that PoCL compiles their programs again. Files count
/// as damaged in three cases:
///  - they are bitcode or libraries that are truncated, overwritten or unreadable;
///  - their contents changed since an earlier call recorded their checksums in the folder;
///  - two processes that started within the last hour, at least ten seconds apart, ended while they were building a
///    program (BuildMark): then the files of all programs count as damaged.
/// Files that look unchanged since their checksums were recorded are not read. Other processes may call this function
/// at the same time, and PoCL may write: it writes files under another name and then renames them, so that none is
/// incomplete.
DamagedFiles SetDamagedAside(const std::string& folder);

/// Records the checksums of files that PoCL has written to the folder since the last call.
void NoteChecksums(const std::string& folder);

/// Checks the free space of PoCL's cache folder; fast enough to be called before every program build.
/// @throws DeviceError if the disk of the folder, which PoCL already uses, has become full
void RequireRoom(const std::string& folder);

/// Builds a program, with up to three attempts if the build fails without a compiler message. Ranks that start with an
/// empty folder compile the same programs at once, and a rank's build fails if another rank has just replaced its file
/// (PoCL 3.1: pocl_remove of program.bc).
/// @param build  builds the program from its source and returns the log of a failure; empty: it succeeded
/// @return the log of the last attempt; empty: it succeeded
std::string BuildBesideOthers(const std::function<std::string()>& build);
}
