#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace tyndall
{
/// The bytes of a .vdb file, read through a window; nothing is ever read beyond the end.
///
/// All of it throws InvalidInput that names the file, what is wrong and the byte where it is; `what` in the parameters
/// is what is being read, e.g. "a grid".
class VDBBytes
{
public:
  VDBBytes(const std::string& path, std::uint64_t size);

  std::uint64_t Position() const { return this->At; }
  std::uint64_t Left() const { return this->Size - this->At; }

  void Seek(std::uint64_t position, const char* what);
  void Skip(std::uint64_t count, const char* what);
  void Read(void* target, std::uint64_t count, const char* what);

  template <typename T>
  T Value(const char* what)
  {
    T value;
    this->Read(&value, sizeof(T), what);
    return value;
  }

  std::string Text(std::uint64_t length, const char* what);

  /// A string as OpenVDB stores it: its length, then its bytes.
  std::string LengthAndText(const char* what) { return this->Text(this->Value<std::uint32_t>(what), what); }

  [[noreturn]] void Fail(const std::string& what) const;

private:
  void Need(std::uint64_t count, const char* what) const;
  void LoadWindow();

  std::string Path;
  std::ifstream Stream;
  std::uint64_t Size = 0;
  std::uint64_t At = 0;
  std::uint64_t WindowStart = 0;
  std::vector<char> Window;
};
}
