#include "IO/ReadableFile.h"

#include "Device/Errors.h"

#include <fstream>
#include <sys/stat.h>

namespace tyndall
{
bool HasAnEnd(const std::string& path)
{
  struct stat found = {};
  return stat(path.c_str(), &found) != 0 || S_ISREG(found.st_mode) || S_ISDIR(found.st_mode);
}

std::uint64_t ReadableSize(const std::string& path)
{
  if (!HasAnEnd(path))
  {
    throw InvalidInput("\"" + path +
      "\" is not a file but a pipe, a socket or a device, which has no end that is known. Write it to a file first.");
  }
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
  stream.seekg(0);
  // A folder opens, and has a size, but nothing can be read from it.
  if (size < 0 || (size > 0 && stream.peek() == std::ifstream::traits_type::eof()))
  {
    throw InvalidInput("\"" + path + "\" cannot be read. Check that it is a file, is there and may be read.");
  }
  return static_cast<std::uint64_t>(size);
}
}
