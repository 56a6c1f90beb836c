#include "IO/Files.h"

#include "Device/Errors.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>

namespace tyndall
{
bool HasAnEnd(const std::string& path)
{
  struct stat found = {};
  return stat(path.c_str(), &found) != 0 || S_ISREG(found.st_mode) || S_ISDIR(found.st_mode);
}

std::uint64_t ReadableSize(const std::string& path)
{
  Require(HasAnEnd(path),
    "\"" + path +
      "\" is not a file but a pipe, a socket or a device, which has no end that is known. Write it to a file first.");
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
  stream.seekg(0);
  // Detects folders: a folder can be opened and has a size, but cannot be read.
  Require(size >= 0 && (size == 0 || stream.peek() != std::ifstream::traits_type::eof()),
    "\"" + path + "\" cannot be read. Check that it is a file, is there and may be read.");
  return static_cast<std::uint64_t>(size);
}

namespace
{
std::string FolderOf(const std::string& path)
{
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "./" : path.substr(0, slash + 1);
}

/// Returns the umask, if possible without setting it, since other threads may create files meanwhile.
mode_t Umask()
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
  {
    if (word == "Umask:" && status >> word)
    {
      return static_cast<mode_t>(std::strtoul(word.c_str(), nullptr, 8));
    }
  }
  const mode_t mask = umask(077);
  umask(mask);
  return mask;
}
}

WholeFile::WholeFile(const std::string& path)
  : Path(path)
  , Target(path)
{
  this->LookAtTarget();
  if (!this->OpenUnnamed())
  {
    this->OpenNamed();
  }
}

WholeFile::~WholeFile()
{
  if (this->File >= 0)
  {
    close(this->File);
  }
  if (!this->Name.empty())
  {
    unlink(this->Name.c_str());
  }
}

void WholeFile::Fail(const std::string& why) const
{
  throw InvalidInput("\"" + this->Path + "\" cannot be written: " + why +
    ". Check that its folder is there, may be written to and has room.");
}

void WholeFile::LookAtTarget()
{
  constexpr int mostLinks = 40; // maximum number of symbolic links to follow, as in Linux
  char link[PATH_MAX];
  for (int links = 0;; ++links)
  {
    const ssize_t length = readlink(this->Target.c_str(), link, sizeof(link));
    if (length < 0)
    {
      break; // the path is not a symbolic link
    }
    if (links == mostLinks)
    {
      this->Fail(std::strerror(ELOOP));
    }
    const std::string to(link, static_cast<std::size_t>(length));
    this->Target = to[0] == '/' ? to : FolderOf(this->Target) + to;
  }
  this->Folder = FolderOf(this->Target);
  this->WasThere = stat(this->Target.c_str(), &this->Before) == 0;
  if (!this->WasThere && errno != ENOENT)
  {
    this->Fail(std::strerror(errno));
  }
  if (this->WasThere && !S_ISREG(this->Before.st_mode))
  {
    this->Fail(S_ISDIR(this->Before.st_mode) ? "there is a folder of that name" : "what has that name is not a file");
  }
  // A read-only file is not replaced, although the system would allow it: replacing needs write permission for the
  // folder only, and root has every permission.
  const bool readOnly = this->WasThere &&
    ((this->Before.st_mode & 0222) == 0 || faccessat(AT_FDCWD, this->Target.c_str(), W_OK, AT_EACCESS) != 0);
  if (readOnly)
  {
    this->Fail("the file that is there is read-only");
  }
}

/// Opens an unnamed file if file system and process allow it. Such a file is accessible through its descriptor only,
/// and is deleted when the process ends.
bool WholeFile::OpenUnnamed()
{
#ifdef O_TMPFILE
  this->File = open(this->Folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  this->Work = "/proc/self/fd/" + std::to_string(this->File);
  const int again = this->File < 0 ? -1 : open(this->Work.c_str(), O_RDWR | O_CLOEXEC);
  if (again >= 0)
  {
    close(again);
    return true;
  }
  if (this->File >= 0)
  {
    close(this->File);
    this->File = -1;
  }
#endif
  return false;
}

void WholeFile::OpenNamed()
{
  do
  {
    this->Work = this->NextName();
    this->File = open(this->Work.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  } while (this->File < 0 && errno == EEXIST);
  if (this->File < 0)
  {
    this->Fail(std::strerror(errno));
  }
  this->Name = this->Work;
}

std::string WholeFile::NextName()
{
  static std::atomic<unsigned> count;
  return this->Folder + ".tyndall-" + std::to_string(getpid()) + "-" + std::to_string(++count);
}

void WholeFile::KeepOwnerAndMode()
{
  mode_t mode = this->WasThere ? this->Before.st_mode & 07777 : 0666 & ~Umask();
  struct stat now = {};
  if (this->WasThere && fstat(this->File, &now) == 0 &&
    (now.st_uid != this->Before.st_uid || now.st_gid != this->Before.st_gid) &&
    fchown(this->File, this->Before.st_uid, this->Before.st_gid) != 0)
  {
    mode &= 0777; // a file of another owner loses its set-user and set-group bits
  }
  if (fchmod(this->File, mode) != 0)
  {
    this->Fail(std::strerror(errno));
  }
}

void WholeFile::Finish()
{
  if (fsync(this->File) != 0) // some file systems report only now that they are full
  {
    this->Fail(std::strerror(errno));
  }
  this->KeepOwnerAndMode();
  while (this->Name.empty())
  {
    const std::string name = this->NextName();
    if (linkat(AT_FDCWD, this->Work.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
    {
      this->Name = name;
    }
    else if (errno != EEXIST)
    {
      this->Fail(std::strerror(errno));
    }
  }
  if (std::rename(this->Name.c_str(), this->Target.c_str()) != 0)
  {
    this->Fail(std::strerror(errno));
  }
  this->Name.clear();
}
}
