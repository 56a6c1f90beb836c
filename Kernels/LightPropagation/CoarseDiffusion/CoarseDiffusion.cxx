#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Device/Sizes.h"
#include "LightPropagation/CoarseDiffusion/CoarseMatrix.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double Reduction = 0.02; ///< reduction of the residual per order: sweeps reduce the error by less than that

std::array<int, 3> CellsOf(const std::array<int, 3>& voxels, const std::array<int, 3>& halvings)
{
  std::array<int, 3> cells;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells[axis] = (voxels[axis] + (1 << halvings[axis]) - 1) >> halvings[axis];
  }
  return cells;
}

std::array<double, 3> EdgesOf(const std::array<double, 3>& voxel, const std::array<int, 3>& halvings)
{
  return { voxel[0] * (1 << halvings[0]), voxel[1] * (1 << halvings[1]), voxel[2] * (1 << halvings[2]) };
}
}

CoarseDiffusion::CoarseDiffusion(Device& device, const VolumeLayout& layout, int channel, const MediumOnDevice& medium,
  const std::array<bool, 3>& periodic, const std::array<int, 3>& halvings, bool linear)
  : TheDevice(device)
  , TheMedium(medium)
  , TheGrid(layout.grid)
  , Linear(linear)
  , Solver(device, CellsOf(layout.grid.size, halvings), EdgesOf(layout.grid.spacing, halvings))
  , Tally(device, Count(layout.grid.size[1]) * Count(layout.grid.size[2]), "sums")
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Box.size[axis] = layout.grid.size[axis];
    this->Box.spacing[axis] = static_cast<float>(layout.grid.spacing[axis]);
    this->Box.periodic[axis] = periodic[axis];
    this->Box.halvings[axis] = halvings[axis];
  }
  this->Box.first = static_cast<cl_int>(channel * layout.Stride());
  this->Box.firstT = static_cast<cl_int>(layout.ExtinctionFirst(channel));
  this->Box.cells = this->Solver.Rows();
  this->Found = ExactValues(device, this->CellGrid().VoxelCount(), "diffusion on cells");
  this->FindMatrix();
}

cl::Kernel CoarseDiffusion::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::CoarseDiffusion,
    MultigridSolver::RowOptions(this->TheDevice) + Define("LINEAR", this->Linear) + ExactOption(this->TheDevice));
}

/// Sum over the voxels of each cell, x fastest.
std::vector<float> CoarseDiffusion::SumOfVoxels(const Buffer<float>& values, int first)
{
  cl::Kernel kernel = this->Kernel("sum_cells");
  With(kernel, this->Box, values, 1.0f, 0.0f, this->Solver.Right(), cl_ulong(first));
  MultigridSolver::RunRows(this->TheDevice, kernel, this->Box.cells);
  return OfRows(this->Box.cells, this->Solver.Right().Read());
}

void CoarseDiffusion::FindMatrix()
{
  const std::vector<float> sigmaT = this->SumOfVoxels(this->TheMedium.SigmaT(), this->Box.firstT);
  const std::vector<float> sigmaS = this->SumOfVoxels(this->TheMedium.SigmaS(), this->Box.first);
  CoarseMatrix matrix = FindCoarseMatrix(this->TheGrid, this->Box, this->CellGrid(), sigmaT, sigmaS);
  this->Solver.Conductance().Write(matrix.conductance.data());
  this->Solver.Loss().Write(matrix.loss.data());
  this->Solver.Coarsen();
  this->Borders = std::move(matrix.borders);
}

CoarseDiffusion::Powers CoarseDiffusion::ScatterOrder(const Buffer<float>& path, const Buffer<float>& fluence,
  const Buffer<float>& source, double onTheWay, const Buffer<float>* guess)
{
  const double perSource = 4.0 * Pi * this->TheGrid.VoxelVolume();
  const Sums swept = this->Scatter(path, source, 1.0, false);
  this->Found.Fill(0.0);
  if (!guess)
  {
    this->Solve(source, perSource * swept.second, onTheWay);
  }
  const Sums absorbed = guess ? this->AddGuess(*guess, path, fluence) : this->AddFound(path, fluence);
  const Sums scattered = this->Scatter(path, source, -1.0, true);
  Powers powers;
  powers.absorbed = absorbed.first;
  powers.scattered = perSource * scattered.first;
  powers.magnitude = perSource * scattered.second;
  powers.out = this->OutThroughFaces();
  powers.left = perSource * swept.first - absorbed.second - std::accumulate(powers.out.begin(), powers.out.end(), 0.0);
  for (int face = 0; face < 6; ++face)
  {
    powers.kept[face] = perSource * (swept.byFace[face] + scattered.byFace[face]);
    powers.out[face] -= perSource * swept.byFace[face];
  }
  return powers;
}

/// Solves for all later orders, from the power that the last sweep scattered and the power still in flight, W.
void CoarseDiffusion::Solve(const Buffer<float>& source, double magnitude, double onTheWay)
{
  const double all = magnitude + std::abs(onTheWay);
  if (!(all > 0.0))
  {
    return;
  }
  cl::Kernel sum = this->Kernel("sum_cells");
  With(sum, this->Box, source, static_cast<float>(4.0 * Pi * this->TheGrid.VoxelVolume()),
    static_cast<float>(onTheWay / static_cast<double>(this->TheGrid.VoxelCount())), this->Solver.Right(),
    cl_ulong(this->Box.first));
  MultigridSolver::RunRows(this->TheDevice, sum, this->Box.cells);
  this->Solver.Solve(this->Found, all / static_cast<double>(this->CellGrid().VoxelCount()), Reduction);
}

/// Adds the light scattered from path integrals, times a sign, to the source. @return sums of the kernel's tally
CoarseDiffusion::Sums CoarseDiffusion::Scatter(
  const Buffer<float>& path, const Buffer<float>& source, double sign, bool adds)
{
  cl::Kernel kernel = this->Kernel("scatter_row");
  With(kernel, this->Box, path, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), source,
    static_cast<float>(sign / (4.0 * Pi * this->TheGrid.VoxelVolume())), cl_int(adds), this->Tally);
  return this->RunByRows(kernel);
}

CoarseDiffusion::Sums CoarseDiffusion::AddFound(const Buffer<float>& path, const Buffer<float>& fluence)
{
  cl::Kernel kernel = this->Kernel("add_found");
  With(kernel, this->Box, this->Found.Handle(), path, fluence, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(),
    static_cast<float>(this->TheGrid.VoxelVolume()), this->Tally);
  return this->RunByRows(kernel);
}

CoarseDiffusion::Sums CoarseDiffusion::AddGuess(
  const Buffer<float>& guess, const Buffer<float>& path, const Buffer<float>& fluence)
{
  cl::Kernel kernel = this->Kernel("add_guess");
  With(kernel, this->Box, guess, path, fluence, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(),
    static_cast<float>(this->TheGrid.VoxelVolume()), this->Tally);
  return this->RunByRows(kernel);
}

CoarseDiffusion::Sums CoarseDiffusion::RunByRows(cl::Kernel& kernel)
{
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(this->Tally.Size()), GroupOfLargeItems(this->TheDevice));
  Sums sums;
  for (const cl_float8& row : this->Tally.Read())
  {
    sums.first += row.s[0];
    sums.second += row.s[1];
    for (int face = 0; face < 6; ++face)
    {
      sums.byFace[face] += row.s[2 + face];
    }
  }
  return sums;
}

std::array<double, 6> CoarseDiffusion::OutThroughFaces() const
{
  const std::vector<double> found = this->Found.Read();
  std::array<double, 6> out = {};
  ForBoxFaceCells(this->CellGrid(),
    [&](const BoxFaceCell& cell) { out[cell.face] += this->Borders[cell.number] * found[cell.voxel]; });
  return out;
}

/// A grid of the cells; only its size is meaningful.
Grid CoarseDiffusion::CellGrid() const
{
  const int* const n = this->Box.cells.size;
  Grid grid;
  grid.size = { n[0], n[1], n[2] };
  return grid;
}
}
