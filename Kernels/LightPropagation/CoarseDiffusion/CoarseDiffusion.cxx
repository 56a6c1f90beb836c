#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
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
