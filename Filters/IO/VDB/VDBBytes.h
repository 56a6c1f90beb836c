#pragma once

// All sources include OpenVDB through this header, which gives OpenVDB's templates default visibility; the module hides
// its other symbols. With hidden templates openvdb::initialize would read a null pointer: std::call_once, which stays
// visible, would use the module's copy of a function together with the library's copy of a variable.
#pragma GCC visibility push(default)
#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#pragma GCC visibility pop

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace tyndall
{
/// Reads the bytes of a .vdb file through a buffer, never beyond the end of the file.
///
/// Every member function throws InvalidInput that names the file, the error and its byte position. The parameter `what`
/// names the item that is being read, for messages, e.g. "a grid".
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

  /// Reads a string as OpenVDB stores it: its length, then its bytes.
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
