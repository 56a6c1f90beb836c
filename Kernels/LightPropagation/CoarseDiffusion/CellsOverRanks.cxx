#include "LightPropagation/CoarseDiffusion/CellsOverRanks.h"

#include "Distribution/BoxExchange.h"
#include "LightPropagation/CoarseDiffusion/CoarseMatrix.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace tyndall
{
namespace
{
/// Reduction of the residual per order: sweeps reduce the error by less than that.
constexpr double ReductionOverRanks = 0.02;

/// One channel of an array.
std::vector<float> ChannelOf(const Buffer<float>& values, std::size_t first, std::size_t count)
{
  const std::vector<float> all = values.Read();
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  return { begin, begin + static_cast<std::ptrdiff_t>(count) };
}

/// As part_of_first_term, sharpen and sharpen_at_face in CoarseDiffusion.cl.
double PartOfFirstTerm(double tau)
{
  return 1.0 / (1.0 + tau * (0.183 + 0.0163 * tau));
}

double Sharpen(double own, double other, double t, double s, double otherT, double otherS, double spacing)
{
  const double both = t + otherT;
  const double scattered = both > 0.0 ? (s * t + otherS * otherT) / both : 0.0;
  return scattered * (own - other) * PartOfFirstTerm(0.5 * spacing * both) / 12.0;
}

double SharpenAtFace(double own, double inner, double t, double s, double spacing)
{
  return s * (inner - own) * PartOfFirstTerm(spacing * t) / 24.0;
}

void WriteChannel(Buffer<float>& values, std::size_t first, const std::vector<float>& ofChannel)
{
  std::vector<float> all = values.Read();
  std::copy(ofChannel.begin(), ofChannel.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
  values.Write(all.data());
}
}

CellsOverRanks::CellsOverRanks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const VolumeLayout& layout, int channel, const MediumOnDevice& medium, const std::array<int, 3>& halvings,
  bool linear)
  : TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , Layout(layout)
  , First(channel * layout.Stride())
  , Linear(linear)
  , SigmaT(ChannelOf(medium.SigmaT(), layout.ExtinctionFirst(channel), layout.grid.VoxelCount()))
  , SigmaS(ChannelOf(medium.SigmaS(), this->First, layout.grid.VoxelCount()))
{
  std::array<double, 3> edges = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const int edge = 1 << halvings[axis];
    this->Box.size[axis] = partition.whole.size[axis];
    this->Box.spacing[axis] = static_cast<float>(partition.whole.spacing[axis]);
    this->Box.halvings[axis] = halvings[axis];
    this->Cells.size[axis] = (partition.whole.size[axis] + edge - 1) / edge;
    edges[axis] = partition.whole.spacing[axis] * edge;
  }
  this->Box.cells = MultigridLevels(this->Cells.size, edges).front();
  const std::vector<double> sigmaT = this->SumByCells(this->SigmaT), sigmaS = this->SumByCells(this->SigmaS);
  this->SigmaT = this->WithNeighbours(this->SigmaT);
  this->SigmaS = this->WithNeighbours(this->SigmaS);
  CoarseMatrix matrix = FindCoarseMatrix(partition.whole, this->Box, this->Cells,
    std::vector<float>(sigmaT.begin(), sigmaT.end()), std::vector<float>(sigmaS.begin(), sigmaS.end()));
  this->Borders = std::move(matrix.borders);
  communicator.Collective([&] {
    if (communicator.Rank() == 0)
    {
      this->Solver = std::make_unique<MultigridSolver>(device, this->Cells.size, edges);
      this->Solver->Conductance().Write(matrix.conductance.data());
      this->Solver->Loss().Write(matrix.loss.data());
      this->Solver->Coarsen();
      this->FoundOnDevice = ExactValues(device, this->Cells.VoxelCount(), "diffusion on cells");
    }
  });
}

namespace
{
/// Coordinates in the whole grid of voxel `number` of a box.
std::array<int, 3> VoxelIn(const VoxelBox& box, std::size_t number)
{
  Grid grid;
  grid.size = box.size;
  std::array<int, 3> voxel = grid.VoxelAt(number);
  for (int axis = 0; axis < 3; ++axis)
  {
    voxel[axis] += box.first[axis];
  }
  return voxel;
}
}

/// Index, in arrays with a halo, of a voxel of the whole grid.
std::size_t CellsOverRanks::PlaceOf(const std::array<int, 3>& voxel) const
{
  Grid grid;
  grid.size = this->Held.size;
  return grid.IndexOf(
    { voxel[0] - this->Held.first[0], voxel[1] - this->Held.first[1], voxel[2] - this->Held.first[2] });
}

/// Sum over the voxels of each cell, over all ranks. Collective.
std::vector<double> CellsOverRanks::SumByCells(const Values& ofVoxels)
{
  std::vector<double> sums(this->Cells.VoxelCount(), 0.0);
  const VoxelBox& block = this->Partition.blocks[this->Comm.Rank()];
  for (std::size_t i = 0; i < ofVoxels.size(); ++i)
  {
    std::array<int, 3> cell = this->Layout.grid.VoxelAt(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = (cell[axis] + block.first[axis]) >> this->Box.halvings[axis];
    }
    sums[this->Cells.IndexOf(cell)] += ofVoxels[i];
  }
  return this->Comm.Sum(sums);
}

/// Solves for all later orders, from the power that the last sweep scattered, W by voxel; no solve if they are guessed.
/// Collective.
/// @return power that it scattered, over all ranks, W
double CellsOverRanks::Solve(const Values& scattered, bool guessed)
{
  const std::vector<double> byCells = this->SumByCells(scattered);
  const auto magnitude = [](double sum, double value) { return sum + std::abs(value); };
  const double all = std::accumulate(byCells.begin(), byCells.end(), 0.0, magnitude);
  std::vector<double> found(byCells.size(), 0.0);
  this->Comm.Collective([&] {
    if (this->Solver && all > 0.0 && !guessed)
    {
      this->FoundOnDevice.Fill(0.0);
      this->Solver->Right().Write(InRows(this->Box.cells, byCells).data());
      this->Solver->Solve(this->FoundOnDevice, all / static_cast<double>(byCells.size()), ReductionOverRanks);
      found = this->FoundOnDevice.Read();
    }
  });
  this->Found = this->Comm.Sum(found); // the other ranks contribute zeros
  return std::accumulate(byCells.begin(), byCells.end(), 0.0);
}

/// The solution at a voxel: interpolated linearly between the cells' centres, and extrapolated beyond the last ones.
double CellsOverRanks::FoundAt(const std::array<int, 3>& voxel) const
{
  std::array<int, 3> from = {}, to = {};
  std::array<double, 3> way = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const int edge = 1 << this->Box.halvings[axis], cells = this->Cells.size[axis];
    const double place = (voxel[axis] + 0.5) / edge - 0.5;
    from[axis] = std::clamp(static_cast<int>(std::floor(place)), 0, std::max(0, cells - 2));
    to[axis] = std::min(from[axis] + 1, cells - 1);
    way[axis] = place - from[axis];
  }
  double found = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    std::array<int, 3> cell = {};
    double part = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool far = corner >> axis & 1;
      cell[axis] = far ? to[axis] : from[axis];
      part *= far ? way[axis] : 1.0 - way[axis];
    }
    found += part * this->Found[this->Cells.IndexOf(cell)];
  }
  return found;
}

/// Values of the block and, if light is linear across voxels, of its halo. Collective.
CellsOverRanks::Values CellsOverRanks::WithNeighbours(const Values& own)
{
  if (!this->Linear)
  {
    this->Held = this->Partition.blocks[this->Comm.Rank()];
    return own;
  }
  std::vector<VoxelBox> wanted;
  for (const VoxelBox& block : this->Partition.blocks)
  {
    wanted.push_back(block.VoxelCount() > 0 ? Grown(block, 1, this->Partition.whole) : VoxelBox());
  }
  this->Held = wanted[this->Comm.Rank()];
  return ValuesInBox(this->Comm, this->Partition, wanted, own, 1);
}

/// Power that a voxel scatters, W; as scatter_row in CoarseDiffusion.cl.
/// @param voxel  of the whole grid
/// @param light  W length, with a halo
/// @param kept  retained power at each face of the box, W, added to
double CellsOverRanks::ScatteredIn(
  const std::array<int, 3>& voxel, const Values& light, std::array<double, 6>& kept) const
{
  const std::array<std::size_t, 3> step = { 1, static_cast<std::size_t>(this->Held.size[0]),
    static_cast<std::size_t>(this->Held.size[0]) * this->Held.size[1] };
  const std::size_t at = this->PlaceOf(voxel);
  const double own = light[at], t = this->SigmaT[at], s = this->SigmaS[at];
  double scattered = s * own;
  for (int side = 0; side < 6 && this->Linear; ++side)
  {
    const int axis = side / 2, voxels = this->Partition.whole.size[axis];
    const double spacing = this->Partition.whole.spacing[axis];
    const std::size_t below = at - step[axis], above = at + step[axis];
    if (voxel[axis] != (side % 2 ? voxels - 1 : 0))
    {
      const std::size_t other = side % 2 ? above : below;
      scattered += Sharpen(own, light[other], t, s, this->SigmaT[other], this->SigmaS[other], spacing);
    }
    else if (voxels > 1)
    {
      const double more = SharpenAtFace(own, light[side % 2 ? below : above], t, s, spacing);
      scattered += more;
      kept[side] += more;
    }
  }
  return scattered;
}

/// Adds the path of all later orders, W length, to the light of the block and its halo. Collective.
void CellsOverRanks::AddComing(Values& light, const Buffer<float>* guess)
{
  if (guess)
  {
    Values own;
    this->Comm.Collective([&] { own = ChannelOf(*guess, this->First, this->Layout.grid.VoxelCount()); });
    const Values coming = this->WithNeighbours(own);
    std::transform(light.begin(), light.end(), coming.begin(), light.begin(), std::plus<float>());
    return;
  }
  const double volume = this->Layout.grid.VoxelVolume();
  for (std::size_t i = 0; i < light.size(); ++i)
  {
    light[i] += static_cast<float>(volume * this->FoundAt(VoxelIn(this->Held, i)));
  }
}

CellsOverRanks::Powers CellsOverRanks::ScatterOrder(
  Buffer<float>& path, Buffer<float>& fluence, Buffer<float>& source, const Buffer<float>* guess)
{
  const std::size_t count = this->Layout.grid.VoxelCount();
  const double volume = this->Layout.grid.VoxelVolume();
  Values gathered = ChannelOf(path, this->First, count), light = ChannelOf(fluence, this->First, count);
  Values all = this->WithNeighbours(gathered), shines(count);
  const VoxelBox& block = this->Partition.blocks[this->Comm.Rank()];
  std::array<double, 6> keptOfSwept = {}, kept = {};
  for (std::size_t i = 0; i < count; ++i)
  {
    shines[i] = static_cast<float>(this->ScatteredIn(VoxelIn(block, i), all, keptOfSwept)); // W
  }
  const double swept = this->Solve(shines, guess != nullptr);
  this->AddComing(all, guess);
  std::vector<double> sums(16, 0.0); // absorbed; absorbed of the solution; scattered; its magnitude; then by face
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::array<int, 3> voxel = VoxelIn(block, i);
    const std::size_t at = this->PlaceOf(voxel);
    const double ofFound = static_cast<double>(all[at]) - gathered[i];
    const double sigmaA = std::max(0.0f, this->SigmaT[at] - this->SigmaS[at]);
    const double scatters = this->ScatteredIn(voxel, all, kept);
    light[i] = static_cast<float>(light[i] + all[at] / volume);
    gathered[i] = static_cast<float>(-ofFound);
    shines[i] = static_cast<float>(scatters / (4.0 * Pi * volume));
    const double terms[] = { sigmaA * all[at], sigmaA * ofFound, scatters, std::abs(scatters) };
    std::transform(sums.begin(), sums.begin() + 4, terms, sums.begin(), std::plus<double>());
  }
  WriteChannel(path, this->First, gathered);
  WriteChannel(fluence, this->First, light);
  WriteChannel(source, this->First, shines);
  std::copy(keptOfSwept.begin(), keptOfSwept.end(), sums.begin() + 4);
  std::copy(kept.begin(), kept.end(), sums.begin() + 10);
  sums = this->Comm.Sum(sums);
  Powers powers;
  powers.absorbed = sums[0];
  powers.scattered = sums[2];
  powers.magnitude = sums[3];
  ForBoxFaceCells(this->Cells,
    [&](const BoxFaceCell& cell) { powers.out[cell.face] += this->Borders[cell.number] * this->Found[cell.voxel]; });
  powers.left = swept - sums[1] - std::accumulate(powers.out.begin(), powers.out.end(), 0.0);
  for (int face = 0; face < 6; ++face)
  {
    powers.kept[face] = sums[10 + face];
    powers.out[face] -= sums[4 + face];
  }
  return powers;
}
}
