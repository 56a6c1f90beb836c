#include "IO/VDB/VDBBytes.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cstring>

namespace tyndall
{
VDBBytes::VDBBytes(const std::string& path, std::uint64_t size)
  : Path(path)
  , Stream(path, std::ios::binary)
  , Size(size)
{
}

void VDBBytes::Seek(std::uint64_t position, const char* what)
{
  if (position > this->Size)
  {
    this->Fail(std::string(what) + " would lie beyond the end of the file");
  }
  this->At = position;
}

void VDBBytes::Skip(std::uint64_t count, const char* what)
{
  this->Need(count, what);
  this->At += count;
}

void VDBBytes::Read(void* target, std::uint64_t count, const char* what)
{
  this->Need(count, what);
  char* to = static_cast<char*>(target);
  while (count > 0)
  {
    if (this->At < this->WindowStart || this->At >= this->WindowStart + this->Window.size())
    {
      this->LoadWindow();
    }
    const std::uint64_t offset = this->At - this->WindowStart;
    const std::uint64_t part = std::min<std::uint64_t>(count, this->Window.size() - offset);
    std::memcpy(to, this->Window.data() + offset, part);
    to += part;
    count -= part;
    this->At += part;
  }
}

std::string VDBBytes::Text(std::uint64_t length, const char* what)
{
  this->Need(length, what);
  std::string text(length, '\0');
  this->Read(&text[0], length, what);
  return text;
}

void VDBBytes::Fail(const std::string& what) const
{
  throw InvalidInput("\"" + this->Path + "\" is truncated or corrupt: " + what + " (byte " + std::to_string(this->At) +
    " of " + std::to_string(this->Size) + "). Copy or write the file again.");
}

void VDBBytes::Need(std::uint64_t count, const char* what) const
{
  if (count > this->Left())
  {
    this->Fail(std::string("it ends within ") + what);
  }
}

void VDBBytes::LoadWindow()
{
  constexpr std::uint64_t windowSize = 1 << 18;
  this->WindowStart = this->At;
  this->Window.resize(std::min(windowSize, this->Left()));
  this->Stream.clear();
  this->Stream.seekg(static_cast<std::streamoff>(this->At));
  this->Stream.read(this->Window.data(), static_cast<std::streamsize>(this->Window.size()));
  if (!this->Stream)
  {
    this->Window.clear();
    throw InvalidInput("\"" + this->Path + "\" cannot be read at byte " + std::to_string(this->At) +
      ". Check the disk and the file's permissions.");
  }
}
}
