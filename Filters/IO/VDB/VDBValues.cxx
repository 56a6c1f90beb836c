#include "IO/VDB/VDBValues.h"

#include "IO/VDB/OpenVDB.h"
#include "IO/VDB/VDBBytes.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

namespace tyndall
{
namespace
{
constexpr VDBValueType ValueTypes[] = {
  { "float", 4, 2, VDBValueType::Numbers },
  { "double", 8, 2, VDBValueType::Numbers },
  { "int32", 4, 4, VDBValueType::Numbers },
  { "int64", 8, 8, VDBValueType::Numbers },
  { "vec3i", 12, 12, VDBValueType::Numbers },
  { "vec3s", 12, 6, VDBValueType::Numbers },
  { "vec3d", 24, 6, VDBValueType::Numbers },
  { "bool", 1, 1, VDBValueType::Bool },
  { "mask", 1, 1, VDBValueType::Mask },
};

const char* const NodesValues = "a node's values";
}

const VDBValueType* FindValueType(const std::string& name)
{
  const auto found = std::find_if(
    std::begin(ValueTypes), std::end(ValueTypes), [&](const VDBValueType& type) { return name == type.Name; });
  return found == std::end(ValueTypes) ? nullptr : found;
}

VDBValues::VDBValues(const VDBValueType& type, bool half, std::uint32_t compression)
  : Type(type)
  , Half(half)
  , Compression(compression)
{
}

void VDBValues::Check(VDBBytes& bytes, std::uint64_t active, std::uint64_t all, bool decompress)
{
  using namespace openvdb::io;
  const auto flag = bytes.Value<std::int8_t>("the flag of a node's values");
  if (flag < NO_MASK_OR_INACTIVE_VALS || flag > NO_MASK_AND_ALL_VALS)
  {
    bytes.Fail("the flag of a node's values is unknown");
  }
  const bool one = flag == NO_MASK_AND_ONE_INACTIVE_VAL || flag == MASK_AND_ONE_INACTIVE_VAL;
  const bool two = flag == MASK_AND_TWO_INACTIVE_VALS;
  bytes.Skip((one ? 1 : two ? 2 : 0) * this->Type.Size, "a node's inactive values");
  if (flag == MASK_AND_NO_INACTIVE_VALS || flag == MASK_AND_ONE_INACTIVE_VAL || two)
  {
    bytes.Skip(all / 8, "the mask of a node's inactive values");
  }
  const bool onlyActive = (this->Compression & COMPRESS_ACTIVE_MASK) && flag != NO_MASK_AND_ALL_VALS;
  this->CheckBlock(bytes, onlyActive ? active : all, decompress);
}

void VDBValues::CheckBlock(VDBBytes& bytes, std::uint64_t count, bool decompress)
{
  using namespace openvdb::io;
  const bool half = this->Half && this->Type.IsReal();
  if (half && count == 0)
  {
    return; // OpenVDB stores nothing then, not even a length.
  }
  const std::uint64_t expected = count * (half ? this->Type.HalfSize : this->Type.Size);
  if (!(this->Compression & (COMPRESS_BLOSC | COMPRESS_ZIP)))
  {
    bytes.Skip(expected, NodesValues);
    return;
  }
  const std::uint64_t start = bytes.Position();
  const auto length = bytes.Value<std::int64_t>(NodesValues);
  if (length <= 0) // stored as they are
  {
    if (length != -static_cast<std::int64_t>(expected))
    {
      bytes.Fail("a node's values have the wrong length");
    }
    bytes.Skip(expected, NodesValues);
    return;
  }
  const std::uint64_t end = bytes.Position() + static_cast<std::uint64_t>(length);
  if (static_cast<std::uint64_t>(length) > bytes.Left())
  {
    bytes.Fail("it ends within a node's values");
  }
  if (this->Compression & COMPRESS_BLOSC)
  {
    // Blosc believes the sizes in its header.
    std::array<std::uint32_t, 4> header = {};
    if (length >= static_cast<std::int64_t>(sizeof(header)))
    {
      bytes.Read(header.data(), sizeof(header), NodesValues);
    }
    if (header[1] != expected || header[3] != length)
    {
      bytes.Fail("a node's compressed values have the wrong length");
    }
  }
  if (decompress)
  {
    bytes.Seek(start, NodesValues);
    this->Decompress(bytes, end - start, expected);
  }
  bytes.Seek(end, NodesValues);
}

void VDBValues::Decompress(VDBBytes& bytes, std::uint64_t compressed, std::uint64_t expected)
{
  std::istringstream block(bytes.Text(compressed, NodesValues));
  this->Scratch.resize(expected);
  try
  {
    if (this->Compression & openvdb::io::COMPRESS_BLOSC)
    {
      openvdb::io::bloscFromStream(block, this->Scratch.data(), expected);
    }
    else
    {
      openvdb::io::unzipFromStream(block, this->Scratch.data(), expected);
    }
  }
  catch (const std::exception&)
  {
    bytes.Fail("a node's values do not decompress");
  }
}
}
