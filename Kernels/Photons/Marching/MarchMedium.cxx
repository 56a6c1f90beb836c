#include "Photons/Marching/MarchMedium.h"

#include "Device/Device.h"
#include "Device/Errors.h"
#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "Device/Sizes.h"
#include "Distribution/SharedMedium.h"
#include "Photons/Marching/MarchRun.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tyndall
{
namespace
{
constexpr const char* MultiplyAdds = " -cl-mad-enable";
constexpr int RoundsAtMost = 64; ///< maximum length of a path, in multiples of the sum of the domain's edges
/// A photon with less power than this affects no sum; in units of PackedPhotons::unit (MarchInfo::darkness)
constexpr float DarkUnits = 1e-3f;
/// Arrays are stored by bricks if at most this fraction of the bricks is filled, that is, contains medium. With more
/// filled bricks, skipping empty ones saves little.
constexpr double FilledAtMost = 0.25;

// Values of `sigma`, the optical thickness of a voxel's diagonal, in PhotonMedium.cl: value outside the grid, and upper
// limit inside it.
constexpr float OutsideOfGrid = -3e38f;
constexpr float ThickestVoxel = 1e30f;

/// Number of components of a coefficient to upload: 0 if it is zero everywhere.
int ComponentsOf(const Field& field, bool needed)
{
  return field.values && needed ? field.components : 0;
}

IndexGrid SizeOf(const std::array<int, 3>& size)
{
  return { { size[0], size[1], size[2] } };
}

/// Creates the memory layout by bricks, in which an empty brick has a single record. If arrays are stored voxel by
/// voxel, creates a layout without bricks.
PhotonBricks BricksOf(Device& device, const Grid& grid, const FilledBricks& filled, const MarchSettings& settings,
  bool bends, bool scatters)
{
  const bool oneOrder = settings.maximumOrders == 1 || !scatters;
  if (!settings.byBricks || bends || !oneOrder || settings.counts || settings.batches)
  {
    return {};
  }
  return filled.FilledPart() > FilledAtMost ? PhotonBricks() : PhotonBricks(device, filled, grid);
}
}

FilledBricks CheckMarchedMedium(
  const Domain& domain, const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree)
{
  Check(domain.Whole());
  domain.Partition().Check();
  if (domain.IsEmpty())
  {
    return FilledBricks();
  }
  const std::string rank = std::to_string(domain.Rank());
  const FilledBricks filled = CheckedBricks(medium);
  Require(
    medium.grid.size == domain.Own().size, "The medium of rank " + rank + " does not have the size of its block.");
  CheckIndex(ior, domain);
  CheckLevels(levels, medium.grid, domain.Whole());
  Require((levels != nullptr) == octree,
    "The block of rank " + rank +
      (levels ? " has octree levels and others have none." : " has no octree levels and others have."));
  return filled;
}

void RequireSameMedium(const Domain& domain, const Medium& medium, const Field& ior)
{
  Communicator& communicator = domain.Comm();
  RequireSame(communicator, domain.Partition());
  const bool has = !domain.IsEmpty();
  RequireSame(communicator, "whether there is a refractive index", has, { ior.values ? 1.0 : 0.0 });
  const auto components = [](const Field& field) { return field.values ? field.components : 0; };
  RequireSame(communicator, "the components of sigma_a or sigma_s", has,
    { 1.0 * components(medium.sigma_a), 1.0 * components(medium.sigma_s) });
}

IndexRange IndexRangeOfAll(const Domain& domain, const IndexRange& own)
{
  const double endless = std::numeric_limits<double>::infinity();
  return { static_cast<float>(-domain.Max(domain.IsEmpty() ? -endless : -own.least)),
    static_cast<float>(domain.Max(domain.IsEmpty() ? -endless : own.largest)) };
}

int MarchTraits::Channels(const MarchSettings& settings) const
{
  return settings.leaveOut && this->grey ? 1 : 3;
}

MarchTraits MarchTraitsOf(const Domain& domain, const Medium& medium, const Field& ior, const FilledBricks& filled)
{
  const bool has = !domain.IsEmpty();
  MarchTraits traits;
  static_cast<MediumTraits&>(traits) = TraitsOfAll(domain.Comm(), has ? TraitsOf(medium, filled) : MediumTraits());
  traits.coloured = domain.Any(has && (medium.sigma_a.HasColour() || medium.sigma_s.HasColour()));
  traits.index = IndexRangeOfAll(domain, has ? IndexRangeOf(ior, medium.grid) : IndexRange());
  return traits;
}

PhotonBricks::PhotonBricks(Device& device, const FilledBricks& bricks, const Grid& grid)
  : Voxels(grid)
  , BrickCount(bricks.count)
  , RecordCount(1)
{
  this->Begin.reserve(bricks.filled.size());
  for (const unsigned char filled : bricks.filled)
  {
    const auto record = static_cast<cl_int>(this->RecordCount);
    this->Begin.push_back(filled ? record : -record);
    this->RecordCount += filled ? BrickVoxels : 1;
  }
  this->OnDevice = Buffer<cl_int>(device, this->Begin, "bricks of the medium");
}

template <class Act>
void PhotonBricks::ForFilled(const Act& act) const
{
  InThreads(this->Begin.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t brick = begin; brick < end; ++brick)
    {
      if (this->Begin[brick] < 0)
      {
        continue;
      }
      const int n = static_cast<int>(brick), nx = this->BrickCount[0], ny = this->BrickCount[1];
      const std::array<int, 3> low = { n % nx * BrickEdge, n / nx % ny * BrickEdge, n / (nx * ny) * BrickEdge };
      std::array<int, 3> high;
      for (int a = 0; a < 3; ++a)
      {
        high[a] = std::min(low[a] + BrickEdge, this->Voxels.size[a]);
      }
      for (int z = low[2]; z < high[2]; ++z)
      {
        for (int y = low[1]; y < high[1]; ++y)
        {
          const std::size_t voxel = this->Voxels.IndexOf({ low[0], y, z });
          const auto record =
            static_cast<std::size_t>(this->Begin[brick] + ((z - low[2]) * BrickEdge + (y - low[1])) * BrickEdge);
          act(record, voxel, static_cast<std::size_t>(high[0] - low[0]));
        }
      }
    }
  });
}

PhotonBricks::Coefficients PhotonBricks::Pack(
  const Medium& medium, double diagonal, int channels, int aComponents, int sComponents) const
{
  const std::size_t ofA = tyndall::Count(aComponents), ofS = tyndall::Count(sComponents);
  const std::size_t all = tyndall::Count(channels);
  Coefficients packed = { Zeros(this->RecordCount * all), Zeros(this->RecordCount * ofA),
    Zeros(this->RecordCount * ofS) };
  for (std::size_t c = 0; c < all; ++c)
  {
    packed.extinction[c * this->RecordCount] = OutsideOfGrid;
  }
  const auto over = static_cast<float>(diagonal);
  // Copies coefficients row by row, as the rows of a brick are far apart in the medium's arrays.
  this->ForFilled([&](std::size_t record, std::size_t voxel, std::size_t count) {
    std::copy_n(medium.sigma_a.values + voxel * ofA, count * ofA, packed.sigmaA.data() + record * ofA);
    std::copy_n(medium.sigma_s.values + voxel * ofS, count * ofS, packed.sigmaS.data() + record * ofS);
    for (std::size_t c = 0; c < all; ++c)
    {
      float* const values = packed.extinction.data() + c * this->RecordCount + record;
      for (std::size_t i = 0; i < count; ++i)
      {
        const int channel = static_cast<int>(c);
        const float extinction = medium.sigma_a.At(voxel + i, channel) + medium.sigma_s.At(voxel + i, channel);
        values[i] = std::min(over * extinction, ThickestVoxel);
      }
    }
  });
  return packed;
}

int MarchEventLimit(const Grid& whole, const MarchSettings& settings)
{
  const double edges = 1.0 * whole.size[0] + whole.size[1] + whole.size[2];
  return static_cast<int>(std::min(1e9, RoundsAtMost * edges * std::max(1.0, 1.0 / settings.stepSize)));
}

MarchMedium::MarchMedium(Device& onDevice, const Medium& medium, const Field& ior, const MarchSettings& with,
  const MarchTraits& ofAll, const MarchedPart& ofGrid, const FilledBricks* filled, const std::uint8_t* levels)
  : device(onDevice)
  , grid(medium.grid)
  , block(ofGrid)
  , settings(with)
  , traits(ofAll)
  , channels(ofAll.Channels(with))
  , bends(!with.leaveOut || ofAll.index.Varies())
  , hasLevels(levels && this->bends)
  , AComponents(ComponentsOf(medium.sigma_a, !with.leaveOut || this->traits.absorbs))
  , SComponents(ComponentsOf(medium.sigma_s, !with.leaveOut || this->traits.scatters))
{
  if (filled && !this->IsBlock())
  {
    this->bricks = BricksOf(this->device, medium.grid, *filled, with, this->bends, this->traits.scatters);
  }
  if (this->bricks.AreThere())
  {
    this->PackBricks(medium);
  }
  else if (this->IsBlock() && this->hasLevels)
  {
    // In a block of a larger domain, SetNodes sets the octree levels later. Until then all voxels have level 0, since
    // OwnNodes needs to know only where the refractive index varies.
    const std::vector<std::uint8_t> single(this->block.known.VoxelCount(), 0);
    this->PackVoxels(medium, ior, single.data());
  }
  else
  {
    this->PackVoxels(medium, ior, levels);
  }
  this->device.Finish();
}

std::vector<std::uint8_t> MarchMedium::OwnNodes(const std::uint8_t* levels) const
{
  const std::vector<cl_uchar> known = this->nodes.Read();
  std::vector<std::uint8_t> own;
  own.reserve(this->grid.VoxelCount());
  const Size row = Padded(this->block.known.size, 2);
  for (std::size_t i = 0; i < this->grid.VoxelCount(); ++i)
  {
    const std::array<int, 3> at = this->block.known.Within(this->block.own.VoxelAt(i));
    const bool varies = known[((at[2] + 1) * row[1] + at[1] + 1) * row[0] + at[0] + 1] > 0;
    own.push_back(static_cast<std::uint8_t>(varies ? 1 + levels[i] : 0));
  }
  return own;
}

void MarchMedium::SetNodes(const BrickedBytes& all)
{
  const std::vector<std::int32_t>& table = all.Table();
  std::vector<cl_uchar> bytes(table.size() * sizeof(std::int32_t) + all.Dense().size());
  std::memcpy(bytes.data(), table.data(), table.size() * sizeof(std::int32_t));
  std::copy(all.Dense().begin(), all.Dense().end(), bytes.end() - static_cast<std::ptrdiff_t>(all.Dense().size()));
  this->nodes = Buffer<cl_uchar>(this->device, bytes, "octree nodes");
  this->nodesOfWhole = true;
}

void MarchMedium::PackBricks(const Medium& medium)
{
  const PhotonBricks::Coefficients packed =
    this->bricks.Pack(medium, this->Diagonal(), this->channels, this->AComponents, this->SComponents);
  this->sigma = Buffer<float>(this->device, packed.extinction, "extinction");
  this->sigmaA = Buffer<float>(this->device, packed.sigmaA, "sigma_a");
  this->sigmaS = Buffer<float>(this->device, packed.sigmaS, "sigma_s");
  this->coefficients = Buffer<float>(this->device, 0, "squared index");
  this->nodes = Buffer<cl_uchar>(this->device, 0, "octree nodes");
}

void MarchMedium::PackVoxels(const Medium& medium, const Field& ior, const std::uint8_t* levels)
{
  const std::size_t voxels = this->grid.VoxelCount(), known = this->block.known.VoxelCount();
  this->sigmaA =
    Buffer<float>(this->device, medium.sigma_a.values, voxels * tyndall::Count(this->AComponents), "sigma_a");
  this->sigmaS =
    Buffer<float>(this->device, medium.sigma_s.values, voxels * tyndall::Count(this->SComponents), "sigma_s");
  const std::size_t padded = this->bends ? Count(Padded(this->block.known.size, 4)) : 0;
  Buffer<float> low(this->device, padded, "range of the index");
  Buffer<float> high(this->device, padded, "range of the index");
  this->coefficients = Buffer<float>(this->device, 0, "squared index");
  this->nodes = Buffer<cl_uchar>(this->device, 0, "octree nodes");
  if (this->bends)
  {
    const std::vector<float> even(ior.values ? 0 : known, 1.0f);
    Grid ofIndex = this->grid;
    ofIndex.size = this->block.known.size;
    this->coefficients = SquaredIndexCoefficients(
      this->device, ofIndex, Buffer<float>(this->device, ior.values ? ior.values : even.data(), known, "ior"));
    this->FindRanges(low, high);
    this->PackNodes(low, high, levels);
  }
  this->sigma =
    Buffer<float>(this->device, this->PaddedCount() * static_cast<std::size_t>(this->channels), "extinction");
  const auto before = [this](int axis) { return cl_int(this->block.own.first[axis] - this->block.known.first[axis]); };
  cl::Kernel pack = this->MediumKernel("pack_extinction");
  With(pack, this->DescribeGrid(), SizeOf(this->block.known.size), before(0), before(1), before(2),
    static_cast<float>(this->Diagonal()), cl_int(this->channels), cl_int(this->AComponents), cl_int(this->SComponents),
    cl_int(this->bends), this->sigmaA, this->sigmaS, low, high, this->sigma);
  this->Launch(pack, Range(this->Padded(2)));
  this->device.Finish(); // the kernel must end before its arguments `low` and `high` are released
}

void MarchMedium::PackNodes(const Buffer<float>& low, const Buffer<float>& high, const std::uint8_t* levels)
{
  const Size padded = Padded(this->block.known.size, 2);
  this->nodes = Buffer<cl_uchar>(this->device, Count(padded), "octree nodes");
  const Buffer<cl_uchar> given = this->hasLevels
    ? Buffer<cl_uchar>(this->device, levels, this->block.known.VoxelCount(), "octree levels")
    : Buffer<cl_uchar>(this->device, 0, "octree levels");
  cl::Kernel pack = this->MediumKernel("pack_nodes");
  With(pack, SizeOf(this->block.known.size), low, high, cl_int(this->hasLevels), given, this->nodes);
  this->Launch(pack, Range(padded));
  this->device.Finish(); // the kernel must end before its argument `given` is released
}

void MarchMedium::FindRanges(Buffer<float>& low, Buffer<float>& high) const
{
  const Size size = Padded(this->block.known.size, 4);
  Buffer<float> low2(this->device, Count(size), "range of the index");
  Buffer<float> high2(this->device, Count(size), "range of the index");
  cl::Kernel widen = this->MediumKernel("widen_range");
  const int strides[3] = { 1, static_cast<int>(size[0]), static_cast<int>(size[0] * size[1]) };
  const Buffer<float>* from[2] = { &this->coefficients, &this->coefficients };
  for (int a = 0; a < 3; ++a)
  {
    Buffer<float>& toLow = a % 2 == 0 ? low : low2;
    Buffer<float>& toHigh = a % 2 == 0 ? high : high2;
    const std::size_t reach = 4 * static_cast<std::size_t>(strides[a]);
    With(widen, strides[a], *from[0], *from[1], toLow, toHigh);
    this->Launch(widen, Count(size) - reach);
    from[0] = &toLow;
    from[1] = &toHigh;
  }
  this->device.Finish();
}

MarchMedium::Size MarchMedium::Padded(const std::array<int, 3>& size, int by)
{
  Size padded;
  for (int a = 0; a < 3; ++a)
  {
    padded[a] = static_cast<std::size_t>(size[a] + by);
  }
  return padded;
}

void MarchMedium::Launch(const cl::Kernel& kernel, const cl::NDRange& range, const cl::NDRange& local) const
{
  this->device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, local);
}

IndexGrid MarchMedium::DescribeGrid() const
{
  return SizeOf(this->grid.size);
}

LightSumsInfo MarchMedium::DescribeSums(const PackedPhotons& packed, const MarchShares& shares, float weightUnit) const
{
  LightSumsInfo info = {};
  info.grid = this->DescribeGrid();
  info.diagonal = static_cast<float>(this->Diagonal());
  info.fluence =
    static_cast<float>(std::frexp(packed.unit * this->Diagonal() / this->grid.VoxelVolume(), &info.exponent));
  std::copy(packed.colour.begin(), packed.colour.end(), info.colour);
  info.weight = weightUnit;
  info.absorption = this->AComponents;
  info.scattering = this->SComponents;
  info.copies = shares.copies;
  info.batches = shares.batches;
  return info;
}

double MarchMedium::Diagonal() const
{
  return std::hypot(this->grid.spacing[0], this->grid.spacing[1], this->grid.spacing[2]);
}

MarchInfo MarchMedium::Describe() const
{
  MarchInfo info = {};
  info.grid = this->DescribeGrid();
  info.whole = SizeOf(this->block.whole.size);
  info.known = SizeOf(this->block.known.size);
  for (int a = 0; a < 3; ++a)
  {
    info.first[a] = this->block.own.first[a];
    info.knownFirst[a] = this->block.known.first[a];
    info.spacing[a] = static_cast<float>(this->grid.spacing[a] / this->Diagonal());
  }
  info.stepSize = static_cast<float>(this->settings.stepSize);
  info.slowest = 0.5f * this->traits.index.least / *std::max_element(info.spacing, info.spacing + 3);
  info.darkness = DarkUnits;
  info.eventLimit = this->EventLimit();
  info.levels = this->hasLevels;
  info.copy = this->Records();
  return info;
}

std::string MarchMedium::Options() const
{
  return Define("MEDIUM_CHANNELS", this->channels) + Define("BENDS", this->bends) +
    Define("NODE_BRICKS", this->nodesOfWhole) + Define("BRICKS", this->bricks.AreThere()) +
    Define("BLOCKS", this->IsBlock()) + MultiplyAdds;
}

cl::Kernel MarchMedium::MediumKernel(const char* name) const
{
  return this->device.Kernel(name, kernel_source::PhotonMedium);
}

cl::Kernel MarchMedium::SumsKernel(const char* name, int lightChannels, const std::string& options) const
{
  return this->device.Kernel(name, kernel_source::PhotonSums,
    Define("BRICKS", this->bricks.AreThere()) + Define("CHANNELS", lightChannels) + options + MultiplyAdds);
}

cl::Kernel MarchMedium::MarchKernel(
  const char* name, int lightChannels, bool directions, const std::string& options) const
{
  return this->device.Kernel(name, kernel_source::PhotonMarch,
    this->Options() + Define("CHANNELS", lightChannels) + Define("DIRECTIONS", directions) +
      Define("ORDER", this->settings.order) + options);
}

Buffer<cl_int> MarchMedium::Cells(const std::array<int, 3>& cells) const
{
  Buffer<cl_int> numbers(this->device, this->PaddedCount(), "cells of the voxels");
  cl::Kernel assign = this->MediumKernel("assign_cells");
  const std::array<int, 3>& first = this->block.own.first;
  With(assign, this->DescribeGrid(), SizeOf(this->block.whole.size), cl_int(first[0]), cl_int(first[1]),
    cl_int(first[2]), IndexGrid{ { cells[0], cells[1], cells[2] } }, numbers);
  this->Launch(assign, Range(this->Padded(2)));
  this->device.Finish();
  return numbers;
}
}
