#include "LightPropagation/Diffusion/MultigridExchange.h"

#include "Distribution/BoxExchange.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <functional>

namespace tyndall
{
namespace
{
/// Grid with the size of a level's box, for index computations only.
Grid GridOf(const MultigridLevel& level)
{
  Grid grid;
  std::copy_n(level.size, 3, grid.size.begin());
  return grid;
}

/// Indices, in the row layout of a level, of voxels given by their index in the level's box, x fastest.
Buffer<cl_int> PlacesInRows(Device& device, const MultigridLevel& level, const std::vector<std::size_t>& voxels)
{
  std::vector<cl_int> places;
  for (const std::size_t voxel : voxels)
  {
    const auto row = static_cast<int>(voxel / level.size[0]), x = static_cast<int>(voxel % level.size[0]);
    places.push_back(RowsLead + row / level.size[1] * level.plane + row % level.size[1] * level.pitch + x);
  }
  return { device, places, "ghost voxels" };
}

/// Adds an array over the voxels of a box to an array over the voxels of the grid that contains the box.
void AddPart(const std::vector<float>& part, const VoxelBox& box, const Grid& grid, float* values)
{
  Grid ofBox;
  ofBox.size = box.size;
  for (std::size_t i = 0; i < part.size(); ++i)
  {
    std::array<int, 3> cell = ofBox.VoxelAt(i);
    std::transform(cell.begin(), cell.end(), box.first.begin(), cell.begin(), std::plus<>());
    values[grid.IndexOf(cell)] += part[i];
  }
}
}

MultigridExchange::MultigridExchange(Device& device, const Domain& domain, const std::array<bool, 3>& periodic,
  const MultigridLevel& finest, const MultigridLevel& coarser)
  : TheDevice(device)
  , TheDomain(domain)
  , Coarser(coarser)
{
  const std::array<int, 3>& size = domain.Whole().size;
  const std::vector<VoxelBox>& blocks = domain.Partition().blocks;
  std::vector<std::vector<VoxelBox>> ghosts;
  for (const VoxelBox& block : blocks)
  {
    ghosts.push_back(LayersBeside(block, size, periodic));
    this->TouchedBoxes.push_back(Joined(finest, block));
  }
  const VoxelBox held = Hull(domain.Own(), ghosts[domain.Rank()]);
  const VoxelBox& touched = this->TouchedBoxes[domain.Rank()];
  this->OfBlock = PartOfLevel(finest, held, domain.Own(), touched);
  this->OfTouched = PartOfLevel(coarser, touched, touched);
  this->Ghosts = std::make_unique<GhostCells>(domain.Comm(), blocks, ghosts, held, size);
  this->Owned = PlacesInRows(device, this->OfBlock, this->Ghosts->OwnedPlaces());
  this->Copied = PlacesInRows(device, this->OfBlock, this->Ghosts->CopiedPlaces());
}

void MultigridExchange::FillGhosts(Buffer<float>& rows) const
{
  const auto run = [&](const char* name, const Buffer<float>& from, const Buffer<cl_int>& places,
                     const Buffer<float>& to) {
    if (places.Size() > 0)
    {
      cl::Kernel kernel = this->TheDevice.Kernel(
        name, kernel_source::MultigridSolver, RowOptions(this->TheDevice) + ExactOption(this->TheDevice));
      With(kernel, from, places, to);
      this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(places.Size()), cl::NullRange);
    }
  };
  std::vector<float> owned;
  this->TheDomain.Collective([&] {
    const Buffer<float> picked(this->TheDevice, this->Owned.Size(), "ghost voxels");
    run("pick_places", rows, this->Owned, picked);
    owned = picked.Read();
  });
  const std::vector<float> copied = this->Ghosts->Exchange(owned);
  this->TheDomain.Collective([&] {
    const Buffer<float> arrived(this->TheDevice, copied, "ghost voxels");
    run("put_places", arrived, this->Copied, rows);
    this->TheDevice.Finish();
  });
}

void MultigridExchange::FillGhosts(ExactValues& ofVoxels) const
{
  std::vector<double> values;
  this->TheDomain.Collective([&] { values = ofVoxels.Read(); });
  this->Ghosts->Fill(values.data(), 1, 0);
  this->TheDomain.Collective([&] { ofVoxels.Write(values); });
}

std::vector<float> MultigridExchange::Sum(const Buffer<float>& ofTouched, int arrays) const
{
  Communicator& comm = this->TheDomain.Comm();
  std::vector<float> own;
  this->TheDomain.Collective([&] { own = OfRows(this->OfTouched, ofTouched.Read(), arrays); });
  if (!this->IsFirst())
  {
    comm.Send(0, MessageTag::ValuesOfBoxes, own);
    return {};
  }
  const Grid cells = GridOf(this->Coarser);
  std::vector<float> sums(arrays * cells.VoxelCount(), 0.0f);
  for (int rank = 0; rank < comm.Ranks(); ++rank)
  {
    const std::vector<float> parts = rank == 0 ? own : comm.Receive<float>(rank, MessageTag::ValuesOfBoxes);
    const auto count = static_cast<std::ptrdiff_t>(this->TouchedBoxes[rank].VoxelCount());
    for (int array = 0; array < arrays; ++array)
    {
      const auto begin = parts.begin() + array * count;
      AddPart({ begin, begin + count }, this->TouchedBoxes[rank], cells, sums.data() + array * cells.VoxelCount());
    }
  }
  return InRows(this->Coarser, sums, arrays);
}

void MultigridExchange::Distribute(const Buffer<float>& whole, Buffer<float>& ofTouched) const
{
  BlockPartition onFirst = { GridOf(this->Coarser), std::vector<VoxelBox>(this->TouchedBoxes.size()) };
  onFirst.blocks.front().size = onFirst.whole.size;
  std::vector<float> values;
  this->TheDomain.Collective([&] { values = this->IsFirst() ? OfRows(this->Coarser, whole.Read()) : values; });
  values = ValuesInBox(this->TheDomain.Comm(), onFirst, this->TouchedBoxes, values, 1);
  this->TheDomain.Collective([&] { ofTouched.Write(InRows(this->OfTouched, values).data()); });
}
}
