#pragma once

#include <cstdint>
#include <string>
#include <sys/stat.h>

namespace tyndall
{
/// False for a pipe, a socket or a device, from which a process might wait for data forever. True for other files, and
/// if nothing exists at the path.
bool HasAnEnd(const std::string& path);

/// Returns the size of a file that is to be read, bytes.
/// @throws InvalidInput if the file does not exist, may not be read, is a folder, or has no end, such as a pipe
std::uint64_t ReadableSize(const std::string& path);

/// A file that replaces another one atomically: completely, or not at all.
///
/// Symbolic links are followed: their target is replaced. An existing file's mode and, if the system allows it, its
/// owner are kept; a new file has mode 0666 restricted by umask. If the file system supports unnamed files (O_TMPFILE),
/// even a killed process leaves nothing behind; otherwise it may leave a file `.tyndall-<process>-<number>`, whose name
/// is short even if that of the target is long. If an existing file has several names (hard links), the other names
/// keep its old content.
///
/// Every member function throws InvalidInput that names the file and the cause.
class WholeFile
{
public:
  /// Creates an empty file in the folder of the target.
  /// @throws InvalidInput if the target exists and may not be written, or is not a regular file
  explicit WholeFile(const std::string& path);
  ~WholeFile(); ///< deletes the unfinished file, unless Finish has moved it to the target

  WholeFile(const WholeFile&) = delete;
  void operator=(const WholeFile&) = delete;

  /// Path to the unfinished file, for writing it and reading it back.
  const std::string& WorkPath() const { return this->Work; }

  /// Moves the file to its target.
  void Finish();

  [[noreturn]] void Fail(const std::string& why) const;

private:
  void LookAtTarget();
  bool OpenUnnamed();
  void OpenNamed();
  std::string NextName();
  void KeepOwnerAndMode();

  std::string Path;   ///< the path as requested
  std::string Target; ///< the path after following symbolic links
  std::string Folder; ///< folder of Target, with a trailing slash
  struct stat Before = {};
  bool WasThere = false;
  int File = -1;
  std::string Work;
  std::string Name; ///< name of the temporary file in Folder; empty: the file is unnamed
};
}
