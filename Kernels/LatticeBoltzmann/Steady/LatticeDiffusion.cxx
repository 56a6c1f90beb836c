#include "LatticeBoltzmann/Steady/LatticeDiffusion.h"

#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double Reduction = 0.1;     ///< reduction of the residual on all voxels, in the preconditioner's norm
constexpr double CellReduction = 0.1; ///< reduction of the residual on cells
constexpr int MostCorrections = 20;
constexpr double Damping = 0.7;   ///< damping factor of Jacobi's method
constexpr double Thinnest = 0.05; ///< lower limit of sigma_t h; thinner voxels are treated as this thick
constexpr std::size_t MostCells = std::size_t{ 1 } << 18; ///< most cells in a distributed solve
constexpr int LeastVoxels = 8; ///< least voxels per cell in a distributed solve, if the grid has as many

/// Halvings of each axis in a distributed solve: one for each axis with more than one voxel, then the longest axes
/// until there are few enough cells.
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
  while ((1 << (halvings[0] + halvings[1] + halvings[2]) < LeastVoxels || all(cells) > MostCells) && all(cells) > 1)
  {
    halve(static_cast<int>(std::max_element(cells.begin(), cells.end()) - cells.begin()));
  }
  return halvings;
}
}

LatticeDiffusion::LatticeDiffusion(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const LatticeVoxels& voxels)
  : TheDevice(device)
  , TheDomain(problem.TheDomain())
  , Box(problem.Box())
  , Periodic(settings.periodic)
  , Ghosts(this->TheDomain.Comm(), this->TheDomain.Partition(), settings.periodic, 1)
  , Halvings(this->TheDomain.IsSerial() ? std::array<int, 3>() : HalvingsFor(this->TheDomain.Whole()))
{
  this->TheDomain.Collective([&] { this->LoadVoxels(settings, voxels); });
  this->LoadCells();
}

/// @param voxel  of the block
std::array<int, 3> LatticeDiffusion::InWhole(std::size_t voxel) const
{
  Grid grid;
  grid.size = this->Box.own.size;
  std::array<int, 3> at = grid.VoxelAt(voxel);
  const std::array<int, 3>& first = this->TheDomain.Own().first;
  std::transform(at.begin(), at.end(), first.begin(), at.begin(), std::plus<int>());
  return at;
}

/// @param voxel  of the block
std::size_t LatticeDiffusion::CellOf(std::size_t voxel) const
{
  return this->TheDomain.IsSerial() ? voxel : this->CellAt(this->InWhole(voxel));
}

/// @param inWhole  a voxel of the whole grid, or one layer beyond a periodic end
std::size_t LatticeDiffusion::CellAt(const std::array<int, 3>& inWhole) const
{
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int size = this->TheDomain.Whole().size[axis];
    cell[axis] = (inWhole[axis] + size) % size >> this->Halvings[axis];
  }
  return this->Cells.IndexOf(cell);
}

void LatticeDiffusion::LoadVoxels(const LatticeSettings& settings, const LatticeVoxels& voxels)
{
  this->Conductance.reserve(this->Box.Count());
  const double thin = 1.0 / (0.5 + 1.0 / (3.0 * LatticeSquares(settings.directions) * Thinnest));
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const std::array<int, 3> at = this->Box.known.VoxelAt(known);
    std::array<float, 6> conductance = {};
    double loss = voxels.lost[known] * voxels.squared[known];
    for (std::size_t face = 0; face < 6; ++face)
    {
      if (this->Periodic[face / 2] && this->TheDomain.Whole().size[face / 2] == 1)
      {
        continue; // the voxel is its own neighbour
      }
      const std::size_t beyond = this->Box.Beyond(at, face);
      if (beyond == Outside)
      {
        loss += 1.0 / voxels.ResistanceOfFace(known, face, thin);
      }
      else if (face % 2 == 0 || !this->TheDomain.IsSerial())
      {
        conductance[face] = static_cast<float>(1.0 / voxels.ResistanceBetween(known, beyond, thin));
      }
    }
    this->Conductance.push_back(conductance);
    this->Loss.push_back(static_cast<float>(loss));
  }
}

/// Assembles the cells as a coarser level of multigrid: the spacing of cell centres doubles with each halving of an
/// axis.
void LatticeDiffusion::LoadCells()
{
  const Grid& whole = this->TheDomain.Whole();
  std::array<double, 3> edges = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Cells.size[axis] = ((whole.size[axis] - 1) >> this->Halvings[axis]) + 1;
    edges[axis] = whole.spacing[axis] * (1 << this->Halvings[axis]);
  }
  const std::size_t cells = this->Cells.VoxelCount();
  Values sums(4 * cells, 0.0); // conductances of the faces -x, -y, -z, then losses
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::array<int, 3> at = this->InWhole(i);
    const std::size_t cell = this->CellOf(i);
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
  sums = this->TheDomain.Sum(sums);
  this->TheDomain.Collective([&] {
    if (this->TheDomain.Rank() > 0)
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
  if (this->TheDomain.IsSerial()) // the solver already has them
  {
    this->Conductance = {};
    this->Loss = {};
  }
}

LatticeDiffusion::Values LatticeDiffusion::Solve(const Values& residual, double unit)
{
  return this->TheDomain.IsSerial() ? this->SolveCells(residual, unit) : this->SolveVoxels(residual);
}

/// Solves on the cells on this rank. @param residual by cell
LatticeDiffusion::Values LatticeDiffusion::SolveCells(const Values& residual, double unit)
{
  this->Solver->Right().Write(InRows(this->Solver->Rows(), residual).data());
  this->Found.Fill(0.0);
  this->Solver->Solve(this->Found, unit, CellReduction);
  return this->Found.Read();
}

/// Product of the matrix with values of the voxels and their ghost voxels.
LatticeDiffusion::Values LatticeDiffusion::Applied(const std::vector<float>& withGhosts) const
{
  const LatticeBox box(this->Ghosts);
  const std::array<std::size_t, 3> strides = box.known.Strides();
  Values applied;
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    const std::size_t here = box.Known(i);
    double sum = this->Diagonal(i) * withGhosts[here];
    for (std::size_t face = 0; face < 6; ++face)
    {
      if (this->Conductance[i][face] > 0.0f)
      {
        const std::size_t stride = strides[face / 2];
        sum -= static_cast<double>(this->Conductance[i][face]) * withGhosts[face % 2 ? here + stride : here - stride];
      }
    }
    applied.push_back(sum);
  }
  return applied;
}

double LatticeDiffusion::Diagonal(std::size_t voxel) const
{
  const std::array<float, 6>& conductance = this->Conductance[voxel];
  return std::accumulate(conductance.begin(), conductance.end(), 0.0) + this->Loss[voxel];
}

/// Solution on cells for a residual by voxel; returned by cell, the same on all ranks.
LatticeDiffusion::Values LatticeDiffusion::ByCells(const Values& residual)
{
  Values sums(this->Cells.VoxelCount(), 0.0);
  for (std::size_t i = 0; i < residual.size(); ++i)
  {
    sums[this->CellOf(i)] += residual[i];
  }
  sums = this->TheDomain.Sum(sums);
  const double square = std::inner_product(sums.begin(), sums.end(), sums.begin(), 0.0);
  Values found(sums.size(), 0.0);
  this->TheDomain.Collective([&] {
    if (this->Solver && square > 0.0)
    {
      found = this->SolveCells(sums, std::sqrt(square / static_cast<double>(sums.size())));
    }
  });
  return this->TheDomain.Sum(found); // the other ranks have zeros
}

/// Applies the preconditioner. In single precision, in which ghost voxels are exchanged, so that the result does not
/// depend on the partition.
std::vector<float> LatticeDiffusion::Preconditioned(const Values& residual)
{
  std::vector<float> own;
  const auto jacobi = [&](std::size_t i, double left) { return Damping * left / this->Diagonal(i); };
  this->TheDomain.Collective([&] {
    own.resize(residual.size());
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      own[i] = static_cast<float>(jacobi(i, residual[i]));
    }
  });
  std::vector<float> withGhosts = this->Ghosts.Spread(own, 1);
  Values left;
  this->TheDomain.Collective([&] {
    left = residual;
    const Values applied = this->Applied(withGhosts);
    std::transform(left.begin(), left.end(), applied.begin(), left.begin(), std::minus<double>());
  });
  const Values byCells = this->ByCells(left);
  this->TheDomain.Collective([&] {
    this->AddCells(byCells, withGhosts);
    const Values corrected = this->Applied(withGhosts);
    const LatticeBox box(this->Ghosts);
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      own[i] = static_cast<float>(withGhosts[box.Known(i)] + jacobi(i, residual[i] - corrected[i]));
    }
  });
  return own;
}

/// Adds each cell's value to its voxels, ghost voxels included.
void LatticeDiffusion::AddCells(const Values& byCells, std::vector<float>& withGhosts) const
{
  const Grid known = this->Ghosts.KnownGrid();
  for (std::size_t i = 0; i < withGhosts.size(); ++i)
  {
    std::array<int, 3> at = known.VoxelAt(i);
    const std::array<int, 3>& first = this->Ghosts.Known().first;
    std::transform(at.begin(), at.end(), first.begin(), at.begin(), std::plus<int>());
    withGhosts[i] = static_cast<float>(withGhosts[i] + byCells[this->CellAt(at)]);
  }
}

/// Scalar product over all ranks.
double LatticeDiffusion::Dot(const Values& a, const std::vector<float>& b) const
{
  return this->TheDomain.Sum(std::inner_product(a.begin(), a.end(), b.begin(), 0.0));
}

/// Conjugate gradients over all voxels of all ranks.
LatticeDiffusion::Values LatticeDiffusion::SolveVoxels(const Values& residual)
{
  Values left, found;
  this->TheDomain.Collective([&] {
    left = residual;
    found.assign(residual.size(), 0.0);
  });
  std::vector<float> better = this->Preconditioned(left), direction;
  this->TheDomain.Collective([&] { direction = better; });
  double norm = this->Dot(left, better);
  const double first = norm;
  for (int iteration = 0; iteration < MostCorrections && norm > Reduction * Reduction * first; ++iteration)
  {
    const std::vector<float> withGhosts = this->Ghosts.Spread(direction, 1);
    Values applied;
    this->TheDomain.Collective([&] { applied = this->Applied(withGhosts); });
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
    // Flexible conjugate gradients, since the solve on cells is itself iterative.
    const double part = -length * this->Dot(applied, better) / norm;
    norm = this->Dot(left, better);
    std::transform(better.begin(), better.end(), direction.begin(), direction.begin(),
      [part](float z, float p) { return static_cast<float>(z + part * p); });
  }
  return found;
}
}
