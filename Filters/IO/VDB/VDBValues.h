#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
class VDBBytes;

/// How the values of a type of grid lie in a file, and in an image.
struct VDBValueType
{
  const char* Name;
  std::uint64_t Size;     ///< bytes of a value
  std::uint64_t HalfSize; ///< bytes of a value whose numbers are stored in 16 bits
  enum
  {
    Numbers,
    Bool,
    Mask
  } Leaves; ///< what a leaf holds beside its mask

  bool IsReal() const { return this->HalfSize < this->Size; }
  std::string GridType() const { return std::string("Tree_") + this->Name + "_5_4_3"; } ///< OpenVDB's name of it
};

/// The types that become images: float, double, int32, int64, bool, mask, vec3i, vec3s, vec3d; else null.
const VDBValueType* FindValueType(const std::string& name);

/// Checks the values of a grid's nodes as they lie in its file, without keeping them.
class VDBValues
{
public:
  /// @param half         whether real numbers are stored in 16 bits
  /// @param compression  OpenVDB's flags
  VDBValues(const VDBValueType& type, bool half, std::uint32_t compression);

  /// The values of one node: a flag, up to two inactive values and the mask that selects them, then a block of numbers.
  /// @param active      values that are active
  /// @param all         values of the node
  /// @param decompress  whether to try the block: OpenVDB leaks an inner node whose values do not decompress
  /// @throws InvalidInput where the block is not what the node takes: OpenVDB would write beyond the node
  void Check(VDBBytes& bytes, std::uint64_t active, std::uint64_t all, bool decompress);

private:
  void CheckBlock(VDBBytes& bytes, std::uint64_t count, bool decompress);
  void Decompress(VDBBytes& bytes, std::uint64_t compressed, std::uint64_t expected);

  VDBValueType Type;
  bool Half;
  std::uint32_t Compression;
  std::vector<char> Scratch;
};
}
