#include "LatticeBoltzmann/Distributed/DiffusionInBlocks.h"

#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double Reduction = 0.1;        ///< of the residual, in the norm of the preconditioner
constexpr double ReductionOfCells = 0.1; ///< the same on cells
constexpr int MostIterations = 20;
constexpr double Damping = 0.7;                                            ///< of Jacobi's steps
constexpr std::size_t MostCells = std::size_t{ 1 } << 18, LeastVoxels = 8; ///< of a cell, where there are as many

/// Every axis of more than one voxel, and the longest ones until cells are few enough.
std::array<int, 3> HalvingsFor(const Grid& grid)
{
  std::array<int, 3> halvings = {}, cells = grid.size;
  const auto halve = [&](int axis) {
    ++halvings[axis];
    cells[axis] = (cells[axis] + 1) / 2;
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    if (cells[axis] > 1)
    {
      halve(axis);
    }
  }
  const auto all = [](const std::array<int, 3>& of) { return std::size_t{ 1 } * of[0] * of[1] * of[2]; };
  while ((1 << (halvings[0] + halvings[1] + halvings[2]) < static_cast<int>(LeastVoxels) || all(cells) > MostCells) &&
    all(cells) > 1)
  {
    halve(static_cast<int>(std::max_element(cells.begin(), cells.end()) - cells.begin()));
  }
  return halvings;
}
}

DiffusionInBlocks::DiffusionInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels)
  : TheDevice(device)
  , Comm(communicator)
  , Around(communicator, partition, settings.periodic, 1)
  , Whole(partition.whole)
  , Periodic(settings.periodic)
  , Box(box)
  , Halvings(HalvingsFor(partition.whole))
{
  communicator.Collective([&] { this->LoadVoxels(settings, voxels); });
  this->LoadCells();
}

std::array<int, 3> DiffusionInBlocks::InWhole(std::size_t voxel) const
{
  Grid grid;
  grid.size = this->Box.own.size;
  std::array<int, 3> at = grid.VoxelAt(voxel);
  for (int axis = 0; axis < 3; ++axis)
  {
    at[axis] += this->Around.Own().first[axis];
  }
  return at;
}

/// @param voxel  of the whole grid, or one layer beyond a periodic end
std::size_t DiffusionInBlocks::CellOf(const std::array<int, 3>& voxel) const
{
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int size = this->Whole.size[axis];
    cell[axis] = (voxel[axis] + size) % size >> this->Halvings[axis];
  }
  return this->Cells.IndexOf(cell);
}

void DiffusionInBlocks::LoadVoxels(const LatticeSettings& settings, const LatticeVoxels& voxels)
{
  const double thin = LeastForDiffusion(settings);
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::size_t known = this->Box.Known(i);
    std::array<float, 6> conductance = {};
    double loss = voxels.lost[known] * voxels.squared[known], all = 0.0;
    for (std::size_t face = 0; face < 6; ++face)
    {
      if (this->Periodic[face / 2] && this->Whole.size[face / 2] == 1)
      {
        continue; // beyond it lies the voxel itself
      }
      const std::size_t beyond = VoxelBeyond(this->Box.known, {}, known, face);
      if (beyond == Outside)
      {
        loss += 1.0 / voxels.ResistanceOfFace(known, face, thin);
        continue;
      }
      conductance[face] = static_cast<float>(1.0 / voxels.ResistanceBetween(known, beyond, thin));
      all += conductance[face];
    }
    this->Conductance.push_back(conductance);
    this->Loss.push_back(static_cast<float>(loss));
    this->Diagonal.push_back(all + this->Loss.back());
  }
}

/// The matrix on cells, as that of a coarser level of multigrid: centres lie farther apart by as much as axes are
/// halved.
void DiffusionInBlocks::LoadCells()
{
  std::array<double, 3> edges = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Cells.size[axis] = ((this->Whole.size[axis] - 1) >> this->Halvings[axis]) + 1;
    edges[axis] = this->Whole.spacing[axis] * (1 << this->Halvings[axis]);
  }
  const std::size_t cells = this->Cells.VoxelCount();
  Values sums(4 * cells, 0.0); // conductance of low faces along x, y, z, losses
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::array<int, 3> at = this->InWhole(i);
    const std::size_t cell = this->CellOf(at);
    sums[3 * cells + cell] += this->Loss[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const bool hasLower = at[axis] > 0 || (this->Periodic[axis] && this->Cells.size[axis] > 1);
      if (hasLower && at[axis] % (1 << this->Halvings[axis]) == 0)
      {
        sums[axis * cells + cell] += this->Conductance[i][2 * axis] / (1 << this->Halvings[axis]);
      }
    }
  }
  sums = this->Comm.Sum(sums);
  this->Comm.Collective([&] {
    if (this->Comm.Rank() > 0)
    {
      return;
    }
    this->Solver = std::make_unique<MultigridSolver>(this->TheDevice, this->Cells.size, edges);
    const Values loss(sums.begin() + static_cast<std::ptrdiff_t>(3 * cells), sums.end());
    sums.resize(3 * cells);
    this->Solver->Conductance().Write(InRows(this->Solver->Rows(), sums, 3).data());
    this->Solver->Loss().Write(InRows(this->Solver->Rows(), loss).data());
    this->Solver->Coarsen();
    this->Found = ExactValues(this->TheDevice, cells, "diffusion on cells");
  });
}

/// The matrix times values of the voxels with a layer around them.
DiffusionInBlocks::Values DiffusionInBlocks::Applied(const std::vector<float>& around) const
{
  const LatticeBox box = BoxOf(this->Around);
  const std::array<std::size_t, 3> strides = box.known.Strides();
  Values applied;
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    const std::size_t here = box.Known(i);
    double sum = this->Diagonal[i] * around[here];
    for (std::size_t face = 0; face < 6; ++face)
    {
      if (this->Conductance[i][face] > 0.0f)
      {
        const std::size_t stride = strides[face / 2];
        sum -= static_cast<double>(this->Conductance[i][face]) * around[face % 2 ? here + stride : here - stride];
      }
    }
    applied.push_back(sum);
  }
  return applied;
}

/// On cells, about: by cell, the same on all ranks.
DiffusionInBlocks::Values DiffusionInBlocks::ByCells(const Values& residual)
{
  Values sums(this->Cells.VoxelCount(), 0.0);
  for (std::size_t i = 0; i < residual.size(); ++i)
  {
    sums[this->CellOf(this->InWhole(i))] += residual[i];
  }
  sums = this->Comm.Sum(sums);
  const double square = std::inner_product(sums.begin(), sums.end(), sums.begin(), 0.0);
  Values found(sums.size(), 0.0);
  this->Comm.Collective([&] {
    if (this->Solver && square > 0.0)
    {
      this->Solver->Right().Write(InRows(this->Solver->Rows(), sums).data());
      this->Found.Fill(0.0);
      this->Solver->Solve(this->Found, std::sqrt(square / static_cast<double>(sums.size())), ReductionOfCells);
      found = this->Found.Read();
    }
  });
  return this->Comm.Sum(found); // the other ranks have zeros
}

/// In float, as ranks tell each other, so that it is the same whoever has which voxel.
std::vector<float> DiffusionInBlocks::Preconditioned(const Values& residual)
{
  std::vector<float> own;
  const auto jacobi = [&](std::size_t i, double left) { return Damping * left / this->Diagonal[i]; };
  this->Comm.Collective([&] {
    own.resize(residual.size());
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      own[i] = static_cast<float>(jacobi(i, residual[i]));
    }
  });
  std::vector<float> around = this->Around.Spread(own, 1);
  Values left;
  this->Comm.Collective([&] {
    left = residual;
    const Values applied = this->Applied(around);
    std::transform(left.begin(), left.end(), applied.begin(), left.begin(), std::minus<double>());
  });
  const Values byCells = this->ByCells(left);
  this->Comm.Collective([&] {
    this->AddCells(byCells, around);
    const Values corrected = this->Applied(around);
    const LatticeBox box = BoxOf(this->Around);
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      own[i] = static_cast<float>(around[box.Known(i)] + jacobi(i, residual[i] - corrected[i]));
    }
  });
  return own;
}

/// Those of cells to their voxels, and those of the layer around.
void DiffusionInBlocks::AddCells(const Values& byCells, std::vector<float>& around) const
{
  const Grid known = this->Around.KnownGrid();
  for (std::size_t i = 0; i < around.size(); ++i)
  {
    std::array<int, 3> at = known.VoxelAt(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] += this->Around.Known().first[axis];
    }
    around[i] = static_cast<float>(around[i] + byCells[this->CellOf(at)]);
  }
}

/// Of all ranks.
double DiffusionInBlocks::Dot(const Values& a, const std::vector<float>& b)
{
  return this->Comm.Sum({ std::inner_product(a.begin(), a.end(), b.begin(), 0.0) })[0];
}

DiffusionInBlocks::Values DiffusionInBlocks::Solve(const Values& residual)
{
  Values left, found;
  this->Comm.Collective([&] {
    left = residual;
    found.assign(residual.size(), 0.0);
  });
  std::vector<float> better = this->Preconditioned(left), direction;
  this->Comm.Collective([&] { direction = better; });
  double norm = this->Dot(left, better);
  const double first = norm;
  for (int iteration = 0; iteration < MostIterations && norm > Reduction * Reduction * first; ++iteration)
  {
    const std::vector<float> around = this->Around.Spread(direction, 1);
    Values applied;
    this->Comm.Collective([&] { applied = this->Applied(around); });
    const double curvature = this->Dot(applied, direction);
    if (!(curvature > 0.0))
    {
      break;
    }
    const double length = norm / curvature;
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      found[i] += length * direction[i];
      left[i] -= length * applied[i];
    }
    better = this->Preconditioned(left);
    // Flexible: the solve on cells is itself an iteration.
    const double part = -length * this->Dot(applied, better) / norm;
    norm = this->Dot(left, better);
    std::transform(better.begin(), better.end(), direction.begin(), direction.begin(),
      [part](float z, float p) { return static_cast<float>(z + part * p); });
  }
  return found;
}
}
