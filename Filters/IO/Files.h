#pragma once

#include <cstdint>
#include <string>
#include <sys/stat.h>

namespace tyndall
{
/// Whether what has that name, if anything, is not a pipe, a socket or a device: who opens these may wait for ever.
bool HasAnEnd(const std::string& path);

/// Bytes of a file that is to be read.
/// @throws InvalidInput where it is not there, may not be read, is a folder, or has no end, as a pipe
std::uint64_t ReadableSize(const std::string& path);

/// A file that takes the place of another when it is whole, or never.
///
/// Symbolic links are followed, so that what they lead to is replaced. Mode and, where the system allows it, owner of a
/// file that was there are kept; a new file has mode 0666 but what umask forbids. Where the file system knows files
/// without a name (O_TMPFILE), even a killed process leaves nothing; else it may leave `.tyndall-<process>-<number>`, a
/// name that is short however long the file's own is. A file that was there under several names (hard links) keeps what
/// it was under the others.
///
/// All of it throws InvalidInput that names the file and the cause.
class WholeFile
{
public:
  /// Begins an empty file beside the place.
  /// @throws InvalidInput where the place has a file that may not be written, or no file but something else
  explicit WholeFile(const std::string& path);
  ~WholeFile(); ///< forgets what was written, unless it is in its place

  WholeFile(const WholeFile&) = delete;
  void operator=(const WholeFile&) = delete;

  /// Where to write, and to read what was written: another path to the file.
  const std::string& WorkPath() const { return this->Work; }

  /// Puts the file in its place.
  void Finish();

  [[noreturn]] void Fail(const std::string& why) const;

private:
  void LookAtTarget();
  bool OpenUnnamed();
  void OpenNamed();
  std::string NextName();
  void KeepOwnerAndMode();

  std::string Path;   ///< as it was asked for
  std::string Target; ///< where it leads
  std::string Folder; ///< of Target, with a slash
  struct stat Before = {};
  bool WasThere = false;
  int File = -1;
  std::string Work;
  std::string Name; ///< beside Target, to remove; empty: it has none
};
}
