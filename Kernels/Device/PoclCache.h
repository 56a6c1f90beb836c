#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace tyndall
{
/// The folder to which PoCL writes what it compiles. It is looked at before PoCL does: that finds no device where it
/// cannot make the folder, and ends the process where the folder's disk is full or a file in it is damaged.
struct PoclCache
{
  /// Bytes that are asked for: kernels of a scene take a part of it.
  static constexpr std::size_t Room = std::size_t(8) << 20;

  std::string folder;
  std::string warning; ///< why it is not the one that PoCL takes by itself, and what to do; else empty
};

/// The folder that PoCL takes by itself: POCL_CACHE_DIR, or one of the user's. Where that cannot be written, a private
/// one in the temporary directory: POCL_CACHE_DIR is set to it, so PoCL must not have been asked for devices before.
/// Damaged files are set aside.
/// @throws DeviceError where neither can be written
PoclCache ChoosePoclCache();

/// Why `bytes` cannot be written to files in a folder, which is made where it is missing; empty: they can.
std::string WhyNotWritable(const std::string& folder, std::size_t bytes = PoclCache::Room);

/// What was found damaged of what PoCL keeps.
struct DamagedFiles
{
  std::size_t count = 0;
  std::string first;   ///< one of them, and how
  std::string trouble; ///< why one cannot be set aside; empty: all are
};

/// While one lives, a locked file in the folder of PoCL's says that this process builds a program. PoCL ends the
/// process where the bitcode that it has kept is damaged in a way that cannot be seen; the file is then left.
class BuildMark
{
public:
  explicit BuildMark(const std::string& folder); ///< empty: nothing is marked
  ~BuildMark();
  BuildMark(const BuildMark&) = delete;
  BuildMark& operator=(const BuildMark&) = delete;

private:
  std::string File;
  int Descriptor = -1; ///< locked, for as long as the process lives
};

/// Renames damaged files below a folder of PoCL's to *.damaged, so that it compiles them anew: bitcode and libraries
/// that are cut off, overwritten or unreadable, and those that were changed since an earlier call noted their checksums
/// in the folder; and all programs, where two runs that began within the last hour, seconds apart, ended while they
/// built one (BuildMark). What is as it was noted is not read. Other processes may do so, and PoCL may write, at the
/// same time: it renames what it has written, and leaves nothing half.
DamagedFiles SetDamagedAside(const std::string& folder);

/// Notes the checksums of what PoCL has written to the folder since they were noted last.
void NoteChecksums(const std::string& folder);

/// PoCL compiles a kernel anew for each size of work-groups that it is run in, so for nearly every new grid. Its
/// variable POCL_WORK_GROUP_SPECIALIZATION is set to 0 where nobody set it: kernels are compiled once, for any size.
/// Before the first is.
void CompileForAnyGroup();

/// Quick enough to be asked before every program that is built.
/// @throws DeviceError where the disk of the folder, in which PoCL writes already, has become full
void RequireRoom(const std::string& folder);

/// Builds a program, and where that fails without a word of the compiler's builds it again, thrice at most: ranks that
/// begin with an empty folder compile the same programs at once, and one whose file another has just replaced fails
/// (PoCL 3.1: pocl_remove of program.bc).
/// @param build  builds it from its source. @return the log of a failure; empty: it is built
/// @return likewise, of the last time
std::string BuildBesideOthers(const std::function<std::string()>& build);
}
