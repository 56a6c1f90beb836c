#include "Refraction/Octree/RefractionOctree.h"

#include "Device/Buffer.h"
#include "Device/Errors.h"
#include "Device/Sizes.h"
#include "Distribution/PyramidBlocks.h"
#include "Distribution/SharedMedium.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/IndexField.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

namespace tyndall
{
namespace
{
/// Number of octree levels that a rank builds in its block. For this the block is extended to complete nodes of the
/// last of these levels, which have 8 voxels per edge.
constexpr int LevelsOfBlock = 3;

/// Largest float that is at most the bound. For any float x, x <= AsBound(bound) is then equivalent to x <= bound.
float AsBound(double bound)
{
  const float nearest = static_cast<float>(bound);
  return nearest > bound ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

/// Checks the settings of the octree.
/// @throws InvalidInput if a setting is out of range
void Check(const OctreeSettings& settings)
{
  Require(settings.tolerance >= 0.0 && settings.tolerance <= 1.0,
    "Tolerance is " + Text("%g", settings.tolerance) + "; it must lie in [0, 1].");
  Require(settings.extinctionTolerance >= 0.0 && !std::isinf(settings.extinctionTolerance),
    "ExtinctionTolerance is " + Text("%g", settings.extinctionTolerance) + "; it must be finite and not negative.");
}

/// Maximum differences of the index in the nodes of each level, converted to floats by AsBound.
std::vector<float> IndexTolerances(int levels, double tolerance)
{
  return std::vector<float>(static_cast<std::size_t>(levels), AsBound(tolerance));
}

std::vector<float> ExtinctionTolerances(const Grid& grid, int levels, double tolerance)
{
  const double diagonal = std::hypot(grid.spacing[0], grid.spacing[1], grid.spacing[2]);
  std::vector<float> tolerances;
  for (int level = 0; level < levels; ++level)
  {
    tolerances.push_back(AsBound(tolerance / std::ldexp(diagonal, level)));
  }
  return tolerances;
}

/// Number of channels of extinction that restrict the octree's nodes: 0 if extinction is not included.
int ExtinctionChannels(const Medium& medium, const OctreeSettings& settings)
{
  const bool coloured = medium.sigma_a.components == 3 || medium.sigma_s.components == 3;
  return !settings.includeExtinction ? 0 : coloured ? 3 : 1;
}

/// Extinction, sigma_t = sigma_a + sigma_s, 1/length, of each voxel in one channel.
std::vector<float> Extinction(const Medium& medium, int channel, std::size_t voxels)
{
  std::vector<float> extinction(voxels);
  for (std::size_t i = 0; i < voxels; ++i)
  {
    extinction[i] = medium.sigma_a.At(i, channel) + medium.sigma_s.At(i, channel);
  }
  return extinction;
}

/// Whether a quantity has the same value in all voxels of the domain. Collective.
bool IsConstant(const Domain& domain, const float* values)
{
  const std::size_t count = domain.Own().VoxelCount();
  const double endless = std::numeric_limits<double>::infinity();
  const bool here = std::all_of(values, values + count, [&](float value) { return value == values[0]; });
  const double least = count == 0 ? endless : here ? values[0] : -endless;
  const double largest = count == 0 ? -endless : here ? values[0] : endless;
  return domain.Max(largest) == -domain.Max(-least);
}

/// Pyramids of minima and maxima over a domain, and the octree levels that follow from them, computed from the top down
/// (Pfeuti 2009, section 3.1.3).
///
/// A voxel's level is the largest k for which its node satisfies max - min <= tolerance for every quantity. The node of
/// level k is the cube of 2^k voxels per edge that begins at multiples of 2^k. The level is 0, a single voxel, if there
/// is no such k. A grid whose size is not a power of two is treated as if its last voxel were repeated: only voxels
/// inside the grid count for the range of a node.
class OctreePyramid
{
public:
  /// Creates the levels of the pyramid, without values.
  /// @param domain  domain of more than one voxel
  OctreePyramid(Device& device, const Domain& domain)
    : TheDevice(device)
    , TheDomain(domain)
    , Layout(domain.Whole().size)
    , Blocks(domain, std::min(LevelsOfBlock, this->Layout.Top()), 0, 1 << std::min(LevelsOfBlock, this->Layout.Top()))
  {
    const PyramidLayout ofBox(this->Blocks.Box().size);
    for (int level = 0; level <= this->Blocks.Shared(); ++level)
    {
      this->Add(level, ofBox.sizes[static_cast<std::size_t>(std::min(level, ofBox.Top()))]);
    }
    for (int level = this->Blocks.Shared(); level <= this->Layout.Top(); ++level)
    {
      this->Add(level, this->Layout.sizes[static_cast<std::size_t>(level)]);
    }
    domain.Collective([&] {
      const std::size_t nodes = domain.IsEmpty() ? 0 : this->NodeCount;
      this->Ranges = Buffer<cl_float2>(device, nodes, "the pyramid of smallest and largest values");
      this->Nodes = Buffer<cl_uchar>(device, nodes, "the octree's pyramid of levels");
      this->Levels = Buffer<cl_uchar>(device, this->Blocks.Box().VoxelCount(), "the octree's levels");
    });
  }

  /// Divides the nodes in which a quantity varies by more than its tolerance. Nodes that earlier quantities have
  /// divided stay divided. Collective.
  /// @param values      the quantity, one value per voxel of the block
  /// @param tolerances  tolerance for each level, which must not increase with the level; [0] is not used
  void Restrict(const float* values, const char* what, const std::vector<float>& tolerances)
  {
    std::vector<float> storage, cells;
    const float* const ofBox = this->Blocks.Gather(values, 1, storage);
    this->OnVoxels([&] {
      const Buffer<float> voxels(this->TheDevice, ofBox, this->Blocks.Box().VoxelCount(), what);
      this->FindRangesOfBox(voxels);
      cells = this->RangesOfCells();
    });
    cells = this->Blocks.GatherCells(cells, 2);
    this->OnVoxels([&] {
      this->FindRangesAbove(cells);
      this->FindLevels(tolerances);
    });
    this->Restricted = true;
  }

  /// Octree levels of the block's voxels, after all calls of Restrict. Collective.
  std::vector<std::uint8_t> Result() const
  {
    std::vector<std::uint8_t> levels;
    this->OnVoxels([&] { levels = this->Levels.Read(); });
    this->Blocks.Crop(levels);
    return levels;
  }

private:
  /// Nodes of one level. The shared level is the highest one that a rank computes from its own box. `Pyramid` holds
  /// first the levels up to the shared one, with the nodes of this rank's box, then the levels from the shared one on,
  /// with the nodes of the domain. It thus holds the shared level twice.
  struct NodesOfLevel
  {
    int level;               ///< number of the level, 0 for voxels
    std::array<int, 3> size; ///< number of nodes along each axis
    std::size_t first; ///< index of the first node in Ranges and Nodes, which do not contain the voxels of level 0
  };

  void Add(int level, const std::array<int, 3>& size)
  {
    this->Pyramid.push_back({ level, size, this->NodeCount });
    this->NodeCount += level > 0 ? Count(size[0]) * Count(size[1]) * Count(size[2]) : 0;
  }
  /// Nodes, in this rank's box, of the shared level, which is the highest one that a rank computes from its own box.
  const NodesOfLevel& OwnShared() const { return this->Pyramid[static_cast<std::size_t>(this->Blocks.Shared())]; }
  /// Nodes of the shared level in the domain, which follow those of this rank's box.
  const NodesOfLevel& AllShared() const { return (&this->OwnShared())[1]; }

  template <class Step>
  void OnVoxels(const Step& step) const
  {
    this->TheDomain.Collective([&] {
      if (!this->TheDomain.IsEmpty())
      {
        step();
      }
    });
  }

  void Run(const cl::Kernel& kernel, const std::array<int, 3>& nodes) const
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, PyramidRange(nodes), PyramidGroup());
  }

  void FindRanges(const NodesOfLevel& of, const NodesOfLevel& below)
  {
    cl::Kernel kernel = this->TheDevice.Kernel("min_max_of_nodes", kernel_source::RefractionOctree);
    With(kernel, this->Ranges, cl_ulong(below.first), Int4(below.size), cl_ulong(of.first), Int4(of.size));
    this->Run(kernel, of.size);
  }

  void FindRangesOfBox(const Buffer<float>& voxels)
  {
    cl::Kernel kernel = this->TheDevice.Kernel("min_max_of_voxels", kernel_source::RefractionOctree);
    const NodesOfLevel& first = this->Pyramid[1];
    With(kernel, voxels, Int4(this->Pyramid[0].size), this->Ranges, cl_ulong(first.first), Int4(first.size));
    this->Run(kernel, first.size);
    for (const NodesOfLevel* of = &first; of != &this->OwnShared(); ++of)
    {
      this->FindRanges(of[1], of[0]);
    }
  }

  std::vector<float> RangesOfCells() const
  {
    const NodesOfLevel& cells = this->OwnShared();
    std::vector<float> ranges(2 * (this->AllShared().first - cells.first));
    this->TheDevice.AwaitFirstRuns();
    this->TheDevice.Queue().enqueueReadBuffer(
      this->Ranges.Handle(), CL_TRUE, cells.first * sizeof(cl_float2), ranges.size() * sizeof(float), ranges.data());
    return ranges;
  }

  void FindRangesAbove(const std::vector<float>& cells)
  {
    this->TheDevice.Queue().enqueueWriteBuffer(this->Ranges.Handle(), CL_TRUE,
      this->AllShared().first * sizeof(cl_float2), cells.size() * sizeof(float), cells.data());
    for (const NodesOfLevel* of = &this->AllShared(); of != &this->Pyramid.back(); ++of)
    {
      this->FindRanges(of[1], of[0]);
    }
  }

  void FindLevels(const std::vector<float>& tolerances)
  {
    cl::Kernel ofNodes = this->TheDevice.Kernel("levels_of_nodes", kernel_source::RefractionOctree);
    for (const NodesOfLevel* of = &this->Pyramid.back(); of->level > 0; --of)
    {
      const bool atTop = of == &this->Pyramid.back(), entersBox = of == &this->OwnShared();
      const NodesOfLevel& above = atTop ? *of : of[1];
      const cl_int4 from = entersBox ? Int4(this->Blocks.BoxCells().first) : Int4({ 0, 0, 0 });
      With(ofNodes, this->Ranges, this->Nodes, cl_ulong(of->first), Int4(of->size), cl_ulong(above.first),
        Int4(above.size), from, entersBox ? 0 : 1, of->level, atTop ? of->level : of->level + 1,
        tolerances[static_cast<std::size_t>(of->level)]);
      this->Run(ofNodes, of->size);
    }
    cl::Kernel ofVoxels = this->TheDevice.Kernel("levels_of_voxels", kernel_source::RefractionOctree);
    const std::array<int, 3>& first = this->Pyramid[1].size;
    With(ofVoxels, this->Nodes, Int4(first), this->Levels, Int4(this->Pyramid[0].size), this->Restricted ? 1 : 0);
    this->Run(ofVoxels, first);
  }

  Device& TheDevice;
  const Domain& TheDomain;
  PyramidLayout Layout;              ///< number of nodes along each axis, for each level of the domain's pyramid
  PyramidBlocks Blocks;              ///< decomposition of the pyramid among ranks
  std::vector<NodesOfLevel> Pyramid; ///< levels of the pyramid, from the voxels up
  std::size_t NodeCount = 0;         ///< number of nodes of all levels above 0
  /// (min, max) in each node of the quantity that is being processed: n, or the extinction of one channel.
  Buffer<cl_float2> Ranges;
  Buffer<cl_uchar> Nodes, Levels;
  bool Restricted = false; ///< whether `Levels` already holds the levels that the quantities processed before allow
};
}

Octree BuildOctree(const Domain& domain, const Medium& medium, const Field& index, const OctreeSettings& settings,
  const std::string& device, const Monitor& monitor)
{
  domain.Collective([&] {
    Check(domain.Whole());
    domain.Partition().Check();
    Check(settings);
    if (!domain.IsEmpty())
    {
      Check(medium);
      Require(index.values && index.components == 1, "The refractive index must be given, with one component a voxel.");
      CheckIndex(index, domain);
    }
    Report(monitor, 0.0);
  });
  RequireSame(domain.Comm(), "settings", true,
    { settings.tolerance, 1.0 * settings.includeExtinction, settings.extinctionTolerance, 1.0 * settings.leaveOut });

  const std::size_t voxels = domain.Own().VoxelCount();
  const int levels = PyramidLayout(domain.Whole().size).LevelCount();
  Octree octree;
  octree.topLevel = levels - 1;
  std::shared_ptr<Device> found; // the device; null until a quantity is found that is not constant
  std::optional<OctreePyramid> pyramid;
  const bool skips = settings.leaveOut || domain.Whole().VoxelCount() == 1; // quantities that are constant
  /// Restricts the octree by one quantity.
  /// @return whether the quantity restricts nodes; false if it is constant and skipped
  const auto restrict = [&](const float* values, const char* what, const std::vector<float>& tolerances) {
    if (skips && IsConstant(domain, values))
    {
      return false;
    }
    if (!pyramid)
    {
      domain.Collective([&] { found = Device::Find(device); });
      pyramid.emplace(*found, domain);
    }
    pyramid->Restrict(values, what, tolerances);
    return true;
  };
  if (!restrict(index.values, "the refractive index", IndexTolerances(levels, settings.tolerance)))
  {
    octree.leftOut.emplace_back("the refractive index is constant: no pyramid of it");
  }
  const int channels = static_cast<int>(domain.Max(domain.IsEmpty() ? 0 : ExtinctionChannels(medium, settings)));
  bool uneven = false;
  for (int channel = 0; channel < channels; ++channel)
  {
    domain.Collective([&] { Report(monitor, (1.0 + channel) / (1.0 + channels)); });
    uneven |= restrict(Extinction(medium, channel, voxels).data(), "the extinction",
      ExtinctionTolerances(domain.Whole(), levels, settings.extinctionTolerance));
  }
  if (channels > 0 && !uneven)
  {
    octree.leftOut.emplace_back("the extinction is constant: no pyramid of it");
  }
  octree.levels =
    pyramid ? pyramid->Result() : std::vector<std::uint8_t>(voxels, static_cast<std::uint8_t>(octree.topLevel));
  octree.device = found ? found->Name() : std::string();
  domain.Collective([&] { Report(monitor, 1.0); });
  return octree;
}
}
