#include "LatticeBoltzmann/Steady/SteadyLattice.h"

#include "Device/Clock.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
/// Factor by which a solve reduces the residual, in the norm of the multigrid preconditioner.
constexpr double Reduction = 0.1;
constexpr double Thinnest = 0.05; ///< smallest optical thickness of a voxel, sigma_t h, in the matrix
}

LatticeDiffusion::LatticeDiffusion(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const LatticeVoxels& voxels)
  : TheDomain(problem.TheDomain())
  , Block(this->TheDomain, settings.periodic, 1, true)
{
  this->TheDomain.Collective([&] {
    const Matrix matrix = this->MatrixOf(problem.Box(), settings, voxels);
    this->Multigrid = std::make_unique<MultigridSolver>(device, this->TheDomain, settings.periodic);
    std::vector<float> conductance;
    for (const std::vector<float>& ofAxis : matrix.conductance)
    {
      conductance.insert(conductance.end(), ofAxis.begin(), ofAxis.end());
    }
    this->Multigrid->Conductance().Write(InRows(this->Multigrid->Rows(), conductance, 3).data());
    this->Multigrid->Loss().Write(InRows(this->Multigrid->Rows(), matrix.loss).data());
    this->Found = ExactValues(device, matrix.loss.size(), "diffusion of the lattice");
  });
  this->Multigrid->Coarsen();
}

LatticeDiffusion::Matrix LatticeDiffusion::MatrixOf(
  const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels) const
{
  const Grid& held = this->Block.WithGhosts().grid;
  const std::array<std::size_t, 3> strides = held.Strides();
  const double thin = 1.0 / (0.5 + 1.0 / (3.0 * LatticeSquares(settings.directions) * Thinnest));
  Matrix matrix;
  matrix.conductance.fill(std::vector<float>(held.VoxelCount(), 0.0f));
  matrix.loss.assign(held.VoxelCount(), 0.0f);
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    const std::size_t known = box.Known(i), place = this->Block.PlaceOf(i);
    const std::array<int, 3> at = box.known.VoxelAt(known), atHeld = held.VoxelAt(place);
    double loss = voxels.lost[known] * voxels.squared[known];
    for (std::size_t face = 0; face < 6; ++face)
    {
      const std::size_t axis = face / 2;
      if (settings.periodic[axis] && this->TheDomain.Whole().size[axis] == 1)
      {
        continue; // on a periodic axis of one voxel, the voxel is its own neighbour, and no light is exchanged
      }
      const std::size_t beyond = box.Beyond(at, face);
      std::array<int, 3> above = atHeld;
      ++above[axis];
      const bool isHigh = face % 2 == 1, hasGhostAbove = above[axis] < held.size[axis] && !this->Block.IsOwn(above);
      if (beyond == Outside)
      {
        loss += 1.0 / voxels.ResistanceOfFace(known, face, thin);
      }
      else if (!isHigh || hasGhostAbove) // high faces between own voxels are handled as low faces of the next voxel
      {
        matrix.conductance[axis][isHigh ? place + strides[axis] : place] =
          static_cast<float>(1.0 / voxels.ResistanceBetween(known, beyond, thin));
      }
    }
    matrix.loss[place] = static_cast<float>(loss);
  }
  return matrix;
}

LatticeDiffusion::Values LatticeDiffusion::Solve(const Values& residual, double unit)
{
  std::vector<float> right;
  this->TheDomain.Collective([&] {
    right.assign(this->Block.WithGhosts().grid.VoxelCount(), 0.0f);
    for (std::size_t i = 0; i < residual.size(); ++i)
    {
      right[this->Block.PlaceOf(i)] = static_cast<float>(residual[i]);
    }
    this->Multigrid->Right().Write(InRows(this->Multigrid->Rows(), right).data());
    this->Found.Fill(0.0);
  });
  this->Multigrid->Solve(this->Found, unit, Reduction);
  const Values values = this->Found.Read();
  Values found(residual.size());
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    found[i] = values[this->Block.PlaceOf(i)];
  }
  return found;
}

namespace
{
constexpr double Imbalance = 1e-6; ///< largest relative error of the energy balance at which the iteration may stop
constexpr int MostIterations = 400;
constexpr int Patience = 40; ///< number of iterations without a smaller estimated error after which the iteration stops

/// Computes a += factor b.
void Add(std::vector<double>& a, double factor, const std::vector<double>& b)
{
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), [&](double x, double y) { return x + factor * y; });
}

double SumOfMagnitudes(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0, [](double sum, double x) { return sum + std::abs(x); });
}
}

SteadyLattice::SteadyLattice(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
  const LatticeVoxels& voxels, const Lattice* densities)
  : TheDomain(problem.TheDomain())
  , Box(problem.Box())
  , Settings(settings)
  , Voxels(voxels)
  , Lines(device, problem, settings, voxels, densities)
  , Diffusion(device, problem, settings, voxels)
  , Count(problem.Box().Count())
  , CountOfAll(static_cast<double>(problem.TheDomain().Whole().VoxelCount()))
  , Start(ClockSeconds())
{
}

double SteadyLattice::Turns(std::size_t known) const
{
  return (1.0 - this->Voxels.lost[known]) * this->Voxels.turning[known] / this->Voxels.OpenWeight(known);
}

/// Scalar product over all ranks.
double SteadyLattice::Dot(const Values& a, const Values& b) const
{
  return this->TheDomain.Sum(std::inner_product(a.begin(), a.end(), b.begin(), 0.0));
}

/// Light that collisions emit isotropically, W / length^2 (e of Eq. (L7)), for a given fluence / n^2, by own voxel.
/// @param withSources  whether to include the sources
std::vector<double> SteadyLattice::EvenOf(const Values& scaled, bool withSources) const
{
  Values even(this->Count);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double half = withSources ? 0.5 * this->Voxels.source[known] : 0.0, kept = 1.0 - this->Voxels.lost[known];
    // Half of the source is emitted before the collision, half after it.
    const double own = half * (1.0 + kept * (1.0 - this->Voxels.turning[known]));
    even[i] = this->Turns(known) * this->Voxels.squared[known] * scaled[i] + own / this->Voxels.OpenWeight(known);
  }
  return even;
}

/// Light that arrives in each voxel in a sweep, W / length^2 (m of Eq. (L8)), for a given fluence / n^2.
/// @param withSources  whether to include sources and incident light
std::vector<double> SteadyLattice::Arriving(const Values& scaled, bool withSources, bool writes, const Monitor& monitor)
{
  Values even;
  this->TheDomain.Collective([&] { even = this->EvenOf(scaled, withSources); });
  return this->Lines.Sweep(even, withSources, writes, monitor);
}

/// Residual of Eq. (L9), W / length^2, for a given fluence / n^2.
std::vector<double> SteadyLattice::Residual(const Values& scaled, const Monitor& monitor)
{
  Values residual = this->Arriving(scaled, true, false, monitor);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const std::size_t known = this->Box.Known(i);
    residual[i] =
      this->Turns(known) * (residual[i] + 0.5 * this->Voxels.source[known] - this->Voxels.squared[known] * scaled[i]);
  }
  return residual;
}

/// Product of the system matrix with fluence / n^2, Eq. (L9).
std::vector<double> SteadyLattice::Applied(const Values& scaled, const Monitor& monitor)
{
  Values applied = this->Arriving(scaled, false, false, monitor);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const std::size_t known = this->Box.Known(i);
    applied[i] = this->Turns(known) * (this->Voxels.squared[known] * scaled[i] - applied[i]);
  }
  return applied;
}

/// Applies the preconditioner of Eq. (L11) to a residual.
std::vector<double> SteadyLattice::Preconditioned(const Values& residual)
{
  const double unit = std::sqrt(this->Dot(residual, residual) / this->CountOfAll);
  if (!(unit > 0.0))
  {
    return Values(this->Count, 0.0);
  }
  Values corrected = this->Diffusion.Solve(residual, unit);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double turns = this->Turns(known) * this->Voxels.squared[known];
    corrected[i] += turns > 0.0 ? residual[i] / turns : 0.0;
  }
  return corrected;
}

void SteadyLattice::Note(double estimate, double change, int iteration, std::vector<ConvergenceRow>& rows) const
{
  ConvergenceRow row;
  row.iteration = iteration;
  row.seconds = ClockSeconds() - this->Start;
  row.residual = std::min(estimate, 1.0);
  row.change = change;
  rows.push_back(row);
}

std::vector<float> SteadyLattice::Solve(const Monitor& monitor, std::vector<ConvergenceRow>& rows)
{
  Values scaled;
  this->TheDomain.Collective([&] { scaled.assign(this->Count, 0.0); });
  Values residual = this->Residual(scaled, monitor);
  const double power = this->TheDomain.Sum(SumOfMagnitudes(residual));
  Values better = this->Preconditioned(residual), direction;
  this->TheDomain.Collective([&] { direction = better; });
  double rz = this->Dot(residual, better), smallest = 1.0, change = 1.0;
  int sinceBetter = 0;
  for (int iteration = 1; iteration <= MostIterations && power > 0.0 && rz > 0.0; ++iteration)
  {
    const Values applied = this->Applied(direction, monitor);
    const double curvature = this->Dot(direction, applied);
    if (!(curvature > 0.0))
    {
      break;
    }
    const double length = rz / curvature;
    Add(scaled, length, direction);
    Add(residual, -length, applied);
    better = this->Preconditioned(residual);
    const Values sums = this->TheDomain.Sum(Values{
      SumOfMagnitudes(scaled), SumOfMagnitudes(better), SumOfMagnitudes(direction), SumOfMagnitudes(residual) });
    const double estimate = sums[1] / sums[0], imbalance = sums[3] / power;
    change = length * sums[2] / sums[0];
    this->Note(estimate, change, iteration, rows);
    if (estimate <= this->Settings.tolerance && imbalance <= Imbalance)
    {
      break;
    }
    sinceBetter = estimate < 0.9 * smallest ? 0 : sinceBetter + 1;
    smallest = std::min(smallest, estimate);
    if (sinceBetter > Patience)
    {
      break;
    }
    // Flexible conjugate gradients, since the preconditioner is itself iterative.
    const double part = -length * this->Dot(better, applied) / rz;
    rz = this->Dot(residual, better);
    std::transform(better.begin(), better.end(), direction.begin(), direction.begin(),
      [&](double z, double p) { return z + part * p; });
  }
  std::transform(scaled.begin(), scaled.end(), scaled.begin(), [](double x) { return std::max(x, 0.0); });
  const Values arrives = this->Arriving(scaled, true, true, monitor);
  std::vector<float> fluence;
  this->TheDomain.Collective([&] {
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      fluence.push_back(static_cast<float>(arrives[i] + 0.5 * this->Voxels.source[this->Box.Known(i)]));
    }
  });
  if (rows.empty()) // no light collides, so there was no iteration
  {
    this->Note(0.0, power > 0.0 ? change : 0.0, 1, rows);
  }
  return fluence;
}
}
