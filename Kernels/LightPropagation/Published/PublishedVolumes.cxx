#include "LightPropagation/Published/PublishedVolumes.h"

#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Returns `grid` if kernels can index its padded voxels with 32-bit integers.
/// @throws DeviceError otherwise
const Grid& Addressable(const Device& device, const Grid& grid, int width)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double padded = static_cast<double>(RoundUp(grid.size[axis], width));
    const double voxels = padded * (grid.size[(axis + 1) % 3] + 17.0) * grid.size[(axis + 2) % 3];
    if (voxels > 2147483647.0)
    {
      throw DeviceError("The grid is too large for " + device.Name() +
        ": the published algorithm addresses 2^31 voxels. Use a coarser grid.");
    }
  }
  return grid;
}
}

VolumeLayouts::VolumeLayouts(const Grid& grid, int width)
  : PublishedLayouts{ { grid.size[0], grid.size[1], grid.size[2] }, {}, {}, {} }
{
  const int across[2][3] = { { this->size[0], this->size[1], this->size[2] },
    { this->size[1], this->size[2], this->size[0] } };
  for (int layout = 0; layout < 2; ++layout)
  {
    this->row[layout] = RoundUp(across[layout][0], width);
    const cl_int rows = this->row[layout] * across[layout][1];
    // Pads planes whose size would be a multiple of 4 KB: voxels of neighbouring planes would map to the same cache
    // sets.
    this->plane[layout] = RoundUp(rows, 16) + (rows % 1024 == 0 ? 16 : 0);
    this->volume[layout] = this->plane[layout] * across[layout][2];
  }
}

std::size_t VolumeLayouts::Index(int layout, int x, int y, int z) const
{
  return layout == 0 ? static_cast<std::size_t>(z) * this->plane[0] + y * this->row[0] + x
                     : static_cast<std::size_t>(x) * this->plane[1] + z * this->row[1] + y;
}

PublishedVolumes::PublishedVolumes(Device& device, const Medium& medium, const PublishedModel& model, int width)
  : Width(width)
  , Layouts(Addressable(device, medium.grid, width), width)
  , Coloured(medium.sigma_a.HasColour() || medium.sigma_s.HasColour())
  , TheDevice(device)
  , TheGrid(medium.grid)
  , Model(model)
{
  this->MakeMedium(medium);
  this->FindSlots();
  this->MakeSources(medium);
  for (Buffer<float>* moments : { &this->OrderMoments[0], &this->OrderMoments[1], &this->Totals })
  {
    const std::size_t size = this->LayoutSize(moments == &this->OrderMoments[1] ? 1 : 0);
    *moments = Buffer<float>(device, size * model.MomentCount(), "the moments");
    moments->Fill(0.0f);
  }
}

std::size_t PublishedVolumes::LayoutSize(int layout) const
{
  return static_cast<std::size_t>(this->Layouts.volume[layout]) * this->Channels();
}

/// Calls visit(index in an array in memory layout `layout`, index of the voxel x fastest, channel) for all voxels and
/// channels.
template <class Visit>
void PublishedVolumes::ForEach(int layout, int channels, Visit visit) const
{
  const auto& size = this->Layouts.size;
  for (int c = 0; c < channels; ++c)
  {
    ForGridVoxels({ size[0], size[1], size[2] }, [&](std::size_t voxel, int x, int y, int z) {
      visit(
        static_cast<std::size_t>(c) * this->Layouts.volume[layout] + this->Layouts.Index(layout, x, y, z), voxel, c);
    });
  }
}

/// Array in memory layout `layout` (0 or 1), filled with value(index of the voxel x fastest, channel).
template <class Value>
std::vector<float> PublishedVolumes::ArrangeValues(int layout, int channels, Value value) const
{
  std::vector<float> arranged(static_cast<std::size_t>(this->Layouts.volume[layout]) * channels, 0.0f);
  this->ForEach(layout, channels, [&](std::size_t at, std::size_t voxel, int c) { arranged[at] = value(voxel, c); });
  return arranged;
}

std::vector<float> PublishedVolumes::Arrange(int layout, const float* interleaved) const
{
  const std::size_t channels = static_cast<std::size_t>(this->Channels());
  return this->ArrangeValues(
    layout, this->Channels(), [&](std::size_t voxel, int c) { return interleaved[voxel * channels + c]; });
}

std::vector<float> PublishedVolumes::Interleave(int layout, const float* arranged) const
{
  const std::size_t channels = static_cast<std::size_t>(this->Channels());
  std::vector<float> values(this->TheGrid.VoxelCount() * channels);
  this->ForEach(layout, this->Channels(),
    [&](std::size_t at, std::size_t voxel, int c) { values[voxel * channels + c] = arranged[at]; });
  return values;
}

void PublishedVolumes::MakeMedium(const Medium& medium)
{
  const int channels = this->Coloured ? 3 : 1;
  const auto scattering = [&](std::size_t voxel, int c) { return medium.sigma_s.At(voxel, c); };
  const auto extinction = [&](std::size_t voxel, int c) {
    return medium.sigma_a.At(voxel, c) + medium.sigma_s.At(voxel, c);
  };
  for (int layout = 0; layout < 2; ++layout)
  {
    this->Extinction[layout] =
      Buffer<float>(this->TheDevice, this->ArrangeValues(layout, channels, extinction), "the extinction coefficient");
    this->Scattering[layout] =
      Buffer<float>(this->TheDevice, this->ArrangeValues(layout, channels, scattering), "the scattering coefficient");
  }
}

void PublishedVolumes::FindSlots()
{
  const DirectionSet& set = this->Model.Directions();
  for (int layout = 0; layout < 2; ++layout)
  {
    this->Slots[layout].assign(this->Model.SourceDirections().size(), -1);
    int slots = 0;
    for (std::size_t i = 0; i < set.directions.size(); ++i)
    {
      const int axis = static_cast<int>(i) / set.PerFace() / 2;
      int& slot = this->Slots[layout][this->Model.SourceOf(static_cast<int>(i))];
      slot = (layout == 1) == (axis == 0) && slot < 0 ? slots++ : slot;
    }
  }
}

/// Allocates the source U in the memory layouts in which ray maps read it, and sets it to the emission of the medium.
void PublishedVolumes::MakeSources(const Medium& medium)
{
  std::vector<PublishedPart> parts;
  for (int layout = 0; layout < 2; ++layout)
  {
    std::size_t slots = 0;
    for (std::size_t d = 0; d < this->Slots[layout].size(); ++d)
    {
      if (this->Slots[layout][d] >= 0)
      {
        const PublishedModel::Part part = this->Model.Source(static_cast<int>(d));
        parts.push_back({ part.moment, static_cast<float>(part.factor), layout, this->Slots[layout][d] });
        ++slots;
      }
    }
    this->Sources[layout] =
      Buffer<float>(this->TheDevice, this->LayoutSize(layout) * slots, "the unscattered radiance U");
    this->Sources[layout].Fill(0.0f);
  }
  this->Parts = Buffer<PublishedPart>(this->TheDevice, parts, "the list of U");
  if (medium.emission.values)
  {
    this->WriteSources([&](std::size_t voxel, int, int c) { return medium.emission.At(voxel, c); });
  }
}

/// Writes the source U of all source directions in all layouts.
/// @param value  function of (voxel, source direction, channel)
template <class Value>
void PublishedVolumes::WriteSources(Value value)
{
  for (int layout = 0; layout < 2; ++layout)
  {
    std::vector<float> all(this->Sources[layout].Size());
    for (std::size_t d = 0; d < this->Slots[layout].size(); ++d)
    {
      if (this->Slots[layout][d] >= 0)
      {
        const std::vector<float> one = this->ArrangeValues(
          layout, this->Channels(), [&](std::size_t voxel, int c) { return value(voxel, static_cast<int>(d), c); });
        std::copy(one.begin(), one.end(), all.begin() + this->Slots[layout][d] * this->LayoutSize(layout));
      }
    }
    this->Sources[layout].Write(all.data());
  }
}

void PublishedVolumes::WriteSource(const std::vector<float>& source)
{
  const std::size_t channels = static_cast<std::size_t>(this->Channels());
  const std::size_t directions = this->Model.SourceDirections().size();
  this->WriteSources([&](std::size_t voxel, int d, int c) { return source[(voxel * directions + d) * channels + c]; });
}

void PublishedVolumes::AddGiven(const UncollidedImage& image)
{
  std::vector<float> all = this->OrderMoments[0].Read();
  tyndall::AddGiven(
    this->Model, image, this->TheGrid.VoxelCount(), [&](std::size_t k, std::size_t voxel, int c, double value) {
      const std::array<int, 3> at = this->TheGrid.VoxelAt(voxel);
      all[k * this->LayoutSize(0) + static_cast<std::size_t>(c) * this->Layouts.volume[0] +
        this->Layouts.Index(0, at[0], at[1], at[2])] += static_cast<float>(value);
    });
  this->OrderMoments[0].Write(all.data());
}

std::vector<float> PublishedVolumes::ReadSource() const
{
  const std::size_t channels = static_cast<std::size_t>(this->Channels());
  const std::size_t directions = this->Model.SourceDirections().size();
  std::vector<float> all(this->TheGrid.VoxelCount() * channels * directions);
  for (std::size_t d = 0; d < directions; ++d)
  {
    const int layout = this->Slots[0][d] >= 0 ? 0 : 1;
    const int slot = this->Slots[layout][d];
    if (slot >= 0)
    {
      const std::size_t size = this->LayoutSize(layout);
      const std::vector<float> one =
        this->Interleave(layout, this->ReadPart(this->Sources[layout], slot * size, size).data());
      for (std::size_t i = 0; i < one.size(); ++i)
      {
        all[(i / channels * directions + d) * channels + i % channels] = one[i];
      }
    }
  }
  return all;
}

std::vector<float> PublishedVolumes::ReadMoment(const Buffer<float>& moments, int moment) const
{
  const std::size_t size = this->LayoutSize(0);
  return this->Interleave(0, this->ReadPart(moments, moment * size, size).data());
}

std::vector<float> PublishedVolumes::ReadPart(const Buffer<float>& buffer, std::size_t first, std::size_t count) const
{
  std::vector<float> part(count);
  this->TheDevice.Queue().enqueueReadBuffer(
    buffer.Handle(), CL_TRUE, first * sizeof(float), count * sizeof(float), part.data());
  return part;
}
}
