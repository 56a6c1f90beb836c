#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double Floor = 0.05; ///< minimum optical length between cell centres in conductances
/// Term by which Marshak's boundary condition enters the resistance of a face of the box, Eq. (76d).
constexpr double Marshak = 2.0;

/// One grid of a hierarchy: edges and mean extinction of its cells. Each coarser grid joins two cells along each axis.
struct Level
{
  std::array<int, 3> size;
  std::array<std::vector<double>, 3> widths; ///< edges of cells along each axis, in units of length
  std::vector<double> sigmaT;                ///< mean extinction of each cell, 1/length

  std::size_t At(int x, int y, int z) const { return (std::size_t(z) * size[1] + y) * size[0] + x; }
  double Volume(int x, int y, int z) const { return this->widths[0][x] * this->widths[1][y] * this->widths[2][z]; }
  double Longest(int x, int y, int z) const
  {
    return std::max({ this->widths[0][x], this->widths[1][y], this->widths[2][z] });
  }
};

Level Finest(const Grid& grid, const CoarseCells& box, const std::vector<float>& sigmaT)
{
  Level level;
  for (int axis = 0; axis < 3; ++axis)
  {
    level.size[axis] = box.cells.size[axis];
    const int edge = 1 << box.halvings[axis];
    for (int cell = 0; cell < level.size[axis]; ++cell)
    {
      level.widths[axis].push_back(grid.spacing[axis] * std::min(edge, grid.size[axis] - cell * edge));
    }
  }
  level.sigmaT.assign(sigmaT.begin(), sigmaT.end());
  const double voxel = grid.VoxelVolume();
  ForGridVoxels(level.size,
    [&](std::size_t, int x, int y, int z) { level.sigmaT[level.At(x, y, z)] *= voxel / level.Volume(x, y, z); });
  return level;
}

Level Coarser(const Level& fine)
{
  Level level;
  for (int axis = 0; axis < 3; ++axis)
  {
    level.size[axis] = (fine.size[axis] + 1) / 2;
    level.widths[axis].assign(level.size[axis], 0.0);
    for (int cell = 0; cell < fine.size[axis]; ++cell)
    {
      level.widths[axis][cell / 2] += fine.widths[axis][cell];
    }
  }
  level.sigmaT.assign(std::size_t(level.size[0]) * level.size[1] * level.size[2], 0.0);
  ForGridVoxels(fine.size, [&](std::size_t, int x, int y, int z) {
    level.sigmaT[level.At(x / 2, y / 2, z / 2)] += fine.sigmaT[fine.At(x, y, z)] * fine.Volume(x, y, z);
  });
  ForGridVoxels(
    level.size, [&](std::size_t, int x, int y, int z) { level.sigmaT[level.At(x, y, z)] /= level.Volume(x, y, z); });
  return level;
}

/// Edge of the box around a cell that is one mean free path thick (W of numerics.md, Eq. (76h)), interpolated between a
/// thinner and a thicker box.
/// @param edge, wide  edges of the thinner and the thicker box, in units of length
/// @param thin, thick  optical width of the thinner and of the thicker box, divided by its edge, 1/length
double EdgeOfMeanFreePath(double edge, double thin, double wide, double thick)
{
  constexpr double Vacuum = 1e-9;
  const double tau = std::max(edge * thin, Vacuum);
  return edge * std::pow(wide / edge, -std::log(tau) / std::log(wide * thick / tau));
}

/// Extinction of each cell in the diffusion coefficient, 1/length: max(sigma_t, 1 / W), with W the edge of the box
/// around the cell that is one mean free path thick (numerics.md, Eq. (76h)). With a diffusion coefficient of 1 / (3
/// sigma_t), light would diffuse too fast in thin cells over distances below a mean free path.
std::vector<double> Diffusing(const Level& level)
{
  std::vector<double> sigma = level.sigmaT;
  if (sigma.size() == 1)
  {
    return sigma;
  }
  std::vector<double> around; // result of this function for the next coarser grid; computed when first needed
  Level coarser;
  ForGridVoxels(level.size, [&](std::size_t, int x, int y, int z) {
    double& here = sigma[level.At(x, y, z)];
    const double edge = level.Longest(x, y, z);
    if (here * edge >= 1.0)
    {
      return;
    }
    if (around.empty())
    {
      coarser = Coarser(level);
      around = Diffusing(coarser);
    }
    const std::size_t outer = coarser.At(x / 2, y / 2, z / 2);
    const double wide = coarser.Longest(x / 2, y / 2, z / 2);
    const bool isThick = coarser.sigmaT[outer] * wide >= 1.0;
    here = std::max(here, isThick ? 1.0 / EdgeOfMeanFreePath(edge, here, wide, coarser.sigmaT[outer]) : around[outer]);
  });
  return sigma;
}
}

CoarseMatrix FindCoarseMatrix(const Grid& grid, const CoarseCells& box, const Grid& cells,
  const std::vector<float>& sigmaT, const std::vector<float>& sigmaS)
{
  const Level level = Finest(grid, box, sigmaT);
  const std::vector<double> sigma = Diffusing(level);
  const std::size_t count = sigma.size();
  std::vector<double> conductance(3 * count, 0.0), loss(count, 0.0);
  ForGridVoxels(level.size, [&](std::size_t, int x, int y, int z) {
    const std::array<int, 3> at = { x, y, z };
    const std::size_t here = level.At(x, y, z);
    loss[here] = std::max(0.0, double(sigmaT[here]) - sigmaS[here]) * grid.VoxelVolume();
    for (int axis = 0; axis < 3; ++axis)
    {
      if (at[axis] == 0 && !box.periodic[axis])
      {
        continue;
      }
      std::array<int, 3> low = at;
      low[axis] = at[axis] == 0 ? level.size[axis] - 1 : at[axis] - 1;
      const double width = level.widths[axis][at[axis]], area = level.Volume(x, y, z) / width;
      const double between =
        sigma[here] * width + sigma[level.At(low[0], low[1], low[2])] * level.widths[axis][low[axis]];
      conductance[axis * count + here] = area / (1.5 * std::max(between, 2.0 * Floor));
    }
  });
  CoarseMatrix matrix;
  ForBoxFaceCells(cells, [&](const BoxFaceCell& cell) {
    const int axis = cell.face / 2;
    const std::array<int, 3> at = cells.VoxelAt(cell.voxel);
    const double width = level.widths[axis][at[axis]], area = level.Volume(at[0], at[1], at[2]) / width;
    const double passes = box.periodic[axis] ? 0.0 : area / (1.5 * sigma[cell.voxel] * width + Marshak);
    loss[cell.voxel] += passes;
    matrix.borders.push_back(passes);
  });
  matrix.conductance = InRows(box.cells, conductance, 3);
  matrix.loss = InRows(box.cells, loss);
  return matrix;
}

namespace
{
/// Factor by which a diffusion solve reduces its residual. A smaller factor would not save sweeps, because a sweep by
/// itself reduces the error of the light less strongly.
constexpr double Reduction = 0.02;
constexpr const char* Contents = "diffusion on cells";

Grid CellsOf(const Grid& voxels, const std::array<int, 3>& halvings)
{
  Grid cells;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int edge = 1 << halvings[axis];
    cells.size[axis] = (voxels.size[axis] + edge - 1) / edge;
    cells.spacing[axis] = voxels.spacing[axis] * edge;
  }
  return cells;
}
}

CoarseDiffusion::CoarseDiffusion(Device& device, const Domain& domain, const VolumeLayout& layout,
  const MediumOnDevice& medium, const Buffer<float>& path, const Settings& settings)
  : TheDevice(device)
  , TheDomain(domain)
  , TheMedium(medium)
  , Path(path)
  , Block(domain, settings.periodic, layout.channels, layout.sharedExtinction)
  , PathWithGhosts(device, this->Block, path, layout.channels, Contents)
  , SigmaT(device, this->Block, medium.SigmaT(), layout.sharedExtinction ? 1 : layout.channels, Contents)
  , SigmaS(device, this->Block, medium.SigmaS(), layout.channels, Contents)
  , Cells(CellsOf(domain.Whole(), settings.halvings))
{
  this->SigmaT.Fill();
  this->SigmaS.Fill();
  this->MakeBoxes(layout, settings);
  domain.Collective([&] {
    this->CellSums = Buffer<float>(device, Count(this->Channels.front().box.cells.floats), Contents);
    this->CellSums.Fill(0.0f);
    this->Tally = Buffer<cl_float8>(device, Count(layout.grid.size[1]) * Count(layout.grid.size[2]), "sums");
  });
  for (Channel& channel : this->Channels)
  {
    this->FindMatrix(channel);
  }
}

void CoarseDiffusion::MakeBoxes(const VolumeLayout& layout, const Settings& settings)
{
  const VolumeLayout& held = this->Block.WithGhosts();
  CoarseCells box = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    box.size[axis] = layout.grid.size[axis];
    box.origin[axis] = this->TheDomain.Own().first[axis];
    box.held[axis] = held.grid.size[axis];
    box.lead[axis] = box.origin[axis] - this->Block.Held().first[axis];
    box.wraps[axis] = this->Block.Periodic()[axis];
    box.spacing[axis] = static_cast<float>(layout.grid.spacing[axis]);
    box.periodic[axis] = settings.periodic[axis];
    box.halvings[axis] = settings.halvings[axis];
  }
  box.linear = settings.linear;
  box.cells = MultigridLevels(this->Cells.size, this->Cells.spacing).front();
  for (int c = 0; c < layout.channels; ++c)
  {
    box.first = static_cast<cl_int>(c * layout.Stride());
    box.firstT = static_cast<cl_int>(layout.ExtinctionFirst(c));
    box.heldFirst = static_cast<cl_int>(c * held.Stride());
    box.heldFirstT = static_cast<cl_int>(held.ExtinctionFirst(c));
    this->Channels.emplace_back();
    this->Channels.back().box = box;
  }
}

void CoarseDiffusion::FindMatrix(Channel& channel)
{
  const CoarseCells& box = channel.box;
  const std::vector<double> sigmaT = this->SumByCells(box, this->TheMedium.SigmaT(), box.firstT, 1.0, 0.0);
  const std::vector<double> sigmaS = this->SumByCells(box, this->TheMedium.SigmaS(), box.first, 1.0, 0.0);
  CoarseMatrix matrix = FindCoarseMatrix(this->TheDomain.Whole(), box, this->Cells,
    std::vector<float>(sigmaT.begin(), sigmaT.end()), std::vector<float>(sigmaS.begin(), sigmaS.end()));
  channel.borders = std::move(matrix.borders);
  this->TheDomain.Collective([&] {
    channel.foundOnDevice = ExactValues(this->TheDevice, this->Cells.VoxelCount(), Contents);
    if (this->TheDomain.Rank() == 0)
    {
      channel.solver = std::make_unique<MultigridSolver>(this->TheDevice, this->Cells.size, this->Cells.spacing);
      channel.solver->Conductance().Write(matrix.conductance.data());
      channel.solver->Loss().Write(matrix.loss.data());
      channel.solver->Coarsen();
    }
  });
}

cl::Kernel CoarseDiffusion::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(
    name, kernel_source::CoarseDiffusion, RowOptions(this->TheDevice) + ExactOption(this->TheDevice));
}

/// For each coarse cell, the sum of `scale` * value + `more` over its voxels on all ranks. Cells are in the order x
/// fastest.
/// @param first  offset of the channel in `values`
std::vector<double> CoarseDiffusion::SumByCells(
  const CoarseCells& box, const Buffer<float>& values, int first, double scale, double more) const
{
  std::vector<double> sums;
  this->TheDomain.Collective([&] {
    cl::Kernel kernel = this->Kernel("sum_cells");
    With(kernel, box, values, static_cast<float>(scale), static_cast<float>(more), this->CellSums, cl_ulong(first));
    RunRowsOf(this->TheDevice, kernel, box.cells);
    const std::vector<float> own = OfRows(box.cells, this->CellSums.Read());
    sums.assign(own.begin(), own.end());
  });
  return this->TheDomain.Sum(sums);
}

std::vector<CoarseDiffusion::Powers> CoarseDiffusion::ScatterOrder(
  const Buffer<float>& fluence, const Buffer<float>& source, const Rgb& onTheWay, const Buffer<float>* guess)
{
  const double perSource = 4.0 * Pi * this->TheDomain.Whole().VoxelVolume();
  std::vector<Powers> all(this->Channels.size());
  this->PathWithGhosts.Fill();
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    Channel& channel = this->Channels[c];
    Powers& powers = all[c];
    const Sums swept = this->Scatter(channel, source, 1.0, false);
    channel.found.assign(this->Cells.VoxelCount(), 0.0);
    if (!guess)
    {
      this->Solve(channel, source, perSource * swept.second, onTheWay[c]);
    }
    const Sums absorbed = this->AddLaterOrders(channel, guess, fluence);
    powers.absorbed = absorbed.first;
    powers.out = this->OutThroughFaces(channel);
    powers.left =
      perSource * swept.first - absorbed.second - std::accumulate(powers.out.begin(), powers.out.end(), 0.0);
    for (int face = 0; face < 6; ++face)
    {
      powers.kept[face] = swept.byFace[face];
      powers.out[face] -= perSource * swept.byFace[face];
    }
  }
  this->PathWithGhosts.Fill();
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    const Sums scattered = this->Scatter(this->Channels[c], source, -1.0, true);
    all[c].scattered = perSource * scattered.first;
    all[c].magnitude = perSource * scattered.second;
    for (int face = 0; face < 6; ++face)
    {
      all[c].kept[face] = perSource * (all[c].kept[face] + scattered.byFace[face]);
    }
  }
  return all;
}

/// Solves for the fluence of all later orders, from the power that the last sweep scattered and the power in flight.
/// @param source  source of the last sweep's scattered light, W / (length^3 sr)
/// @param magnitude  sum of the absolute values of `source`, W
/// @param onTheWay  power in flight around periodic axes, W
void CoarseDiffusion::Solve(Channel& channel, const Buffer<float>& source, double magnitude, double onTheWay) const
{
  const double all = magnitude + std::abs(onTheWay);
  if (!(all > 0.0))
  {
    channel.foundOnDevice.Fill(0.0);
    return;
  }
  const CoarseCells& box = channel.box;
  const Grid& whole = this->TheDomain.Whole();
  const std::vector<double> right = this->SumByCells(
    box, source, box.first, 4.0 * Pi * whole.VoxelVolume(), onTheWay / static_cast<double>(whole.VoxelCount()));
  this->TheDomain.Collective([&] {
    channel.foundOnDevice.Fill(0.0);
    if (channel.solver)
    {
      channel.solver->Right().Write(InRows(box.cells, right).data());
      channel.solver->Solve(channel.foundOnDevice, all / static_cast<double>(this->Cells.VoxelCount()), Reduction);
      channel.found = channel.foundOnDevice.Read();
    }
  });
  channel.found = this->TheDomain.Sum(channel.found); // all ranks but the first contribute zeros
  this->TheDomain.Collective([&] {
    if (!channel.solver)
    {
      channel.foundOnDevice.Write(channel.found);
    }
  });
}

/// Computes the source scattered from the path integrals, times `sign`.
/// @param adds  whether to add to `source` rather than replace it
/// @return sums over rows and ranks of the source, of its absolute value, and of the correction at each face of the box
CoarseDiffusion::Sums CoarseDiffusion::Scatter(
  const Channel& channel, const Buffer<float>& source, double sign, bool adds) const
{
  return this->RunByRows("scatter_row", [&](cl::Kernel& kernel) {
    With(kernel, channel.box, this->PathWithGhosts.Values(), this->SigmaT.Values(), this->SigmaS.Values(), source,
      static_cast<float>(sign / (4.0 * Pi * this->TheDomain.Whole().VoxelVolume())), cl_int(adds), this->Tally);
  });
}

/// Adds the path integrals of the last sweep and of all later orders to the fluence, and sets the path integrals to
/// minus those of all later orders.
/// @return sums over rows and ranks: power absorbed from all light that is added, and from the later orders only
CoarseDiffusion::Sums CoarseDiffusion::AddLaterOrders(
  const Channel& channel, const Buffer<float>* guess, const Buffer<float>& fluence) const
{
  return this->RunByRows(guess ? "add_guess" : "add_found", [&](cl::Kernel& kernel) {
    With(kernel, channel.box, guess ? guess->Handle() : channel.foundOnDevice.Handle(), this->Path, fluence,
      this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), static_cast<float>(this->TheDomain.Whole().VoxelVolume()),
      this->Tally);
  });
}

/// Runs a kernel with one work-item per row of the block's voxels. @return sums of the kernel's tally over rows and
/// ranks
CoarseDiffusion::Sums CoarseDiffusion::RunByRows(
  const char* name, const std::function<void(cl::Kernel&)>& setArguments) const
{
  std::vector<double> values(8, 0.0);
  this->TheDomain.Collective([&] {
    if (this->TheDomain.IsEmpty())
    {
      return;
    }
    cl::Kernel kernel = this->Kernel(name);
    setArguments(kernel);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(this->Tally.Size()), GroupOfLargeItems(this->TheDevice));
    for (const cl_float8& row : this->Tally.Read())
    {
      std::transform(values.begin(), values.end(), row.s, values.begin(), std::plus<double>());
    }
  });
  values = this->TheDomain.Sum(values);
  Sums sums = { values[0], values[1], {} };
  std::copy_n(values.begin() + 2, 6, sums.byFace.begin());
  return sums;
}

std::array<double, 6> CoarseDiffusion::OutThroughFaces(const Channel& channel) const
{
  std::array<double, 6> out = {};
  ForBoxFaceCells(this->Cells,
    [&](const BoxFaceCell& cell) { out[cell.face] += channel.borders[cell.number] * channel.found[cell.voxel]; });
  return out;
}
}
