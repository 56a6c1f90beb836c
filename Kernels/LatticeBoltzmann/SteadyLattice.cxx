#include "LatticeBoltzmann/SteadyLattice.h"

#include "Device/Clock.h"
#include "Device/Defines.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Ways[18][3] = LATTICE_WAYS;
constexpr double Thinnest = 0.05;      ///< sigma_t h as which the preconditioner takes thinner voxels
constexpr double InnerReduction = 0.1; ///< of the preconditioner's own residual
constexpr double Imbalance = 1e-6;     ///< of all power, that may be missing
constexpr int MostIterations = 400;
constexpr int Patience = 40; ///< iterations without a better estimate, after which rounding is taken as the reason

double Dot(const std::vector<double>& a, const std::vector<double>& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// a += factor b
void Add(std::vector<double>& a, double factor, const std::vector<double>& b)
{
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), [&](double x, double y) { return x + factor * y; });
}

double SumOfMagnitudes(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0, [](double sum, double x) { return sum + std::abs(x); });
}
}

SteadyLattice::SteadyLattice(Device& device, const Grid& grid, const LatticeSettings& settings,
  const LatticeVoxels& voxels, const Lattice& lattice)
  : TheDevice(device)
  , TheGrid(grid)
  , Settings(settings)
  , Voxels(voxels)
  , Densities(lattice)
  , Count(grid.VoxelCount())
  , Passes(device, voxels.passes, "how links pass light")
  , Squared(device, voxels.squared, "n^2")
  , Diffusion(device, grid.size, grid.spacing)
  , Start(ClockSeconds())
{
  this->Load();
  this->LoadDiffusion();
}

double SteadyLattice::Turns(std::size_t voxel) const
{
  return (1.0 - this->Voxels.lost[voxel]) * this->Voxels.turning[voxel];
}

void SteadyLattice::Load()
{
  const char* what = "lines of the lattice";
  this->Straight = ExactValues(this->TheDevice, this->Count, what);
  this->Even = ExactValues(this->TheDevice, this->Count, what);
  this->Behind = ExactValues(this->TheDevice, 2 * this->Count, what);
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  const bool closes = periodic[0] || periodic[1] || periodic[2];
  this->Share = ExactValues(this->TheDevice, closes ? this->Count : 1, what);
  this->Sum = ExactValues(this->TheDevice, this->Count, what);
  this->Correction = ExactValues(this->TheDevice, this->Count, what);
  Values straight;
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    straight.push_back((1.0 - this->Voxels.lost[i]) * (1.0 - this->Voxels.turning[i]));
  }
  this->Straight.Write(straight);
}

/// The diffusion of the lattice, of fluence over n^2, Eq. (L12).
void SteadyLattice::LoadDiffusion()
{
  const LatticeVoxels& voxels = this->Voxels;
  const double thin = 1.0 / (0.5 + 1.0 / (3.0 * LatticeSquares(this->Settings.directions) * Thinnest));
  std::vector<float> conductance(3 * this->Count, 0.0f), loss;
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    loss.push_back(voxels.lost[i] * voxels.squared[i]);
    const std::array<int, 3> at = this->TheGrid.VoxelAt(i);
    for (std::size_t a = 0; a < 3; ++a)
    {
      const int size = this->TheGrid.size[a];
      const bool periodic = this->Settings.periodic[a];
      const std::size_t step = this->TheGrid.Strides()[a];
      if (at[a] > 0 || (periodic && size > 1))
      {
        const std::size_t j = at[a] > 0 ? i - step : i + (size - 1) * step;
        conductance[a * this->Count + i] = static_cast<float>(1.0 / voxels.ResistanceBetween(i, j, thin));
      }
      for (std::size_t face = 2 * a; face < 2 * a + 2 && !periodic; ++face)
      {
        if (at[a] == (face % 2 ? size - 1 : 0))
        {
          loss.back() += static_cast<float>(1.0 / voxels.ResistanceOfFace(i, face, thin));
        }
      }
    }
  }
  this->Diffusion.Conductance().Write(InRows(this->Diffusion.Rows(), conductance, 3).data());
  this->Diffusion.Loss().Write(InRows(this->Diffusion.Rows(), loss).data());
  this->Diffusion.Coarsen();
}

/// What arrives in each voxel, W / length^2, where collisions make `even` even, Eq. (L8).
SteadyLattice::Values SteadyLattice::Sweep(const Values& even, double shines, bool writes, const Monitor& monitor)
{
  const LatticeVoxels& voxels = this->Voxels;
  cl::Kernel lines = this->TheDevice.Kernel("sweep_lines", kernel_source::LatticeLines,
    ExactOption(this->TheDevice) + Define("DIRECTIONS", this->Settings.directions) + Define("BENDS", voxels.bends) +
      Define("PASSES_ALL", voxels.passesAll) + Define("REFLECTS", voxels.Reflects()) + Define("PUBLISHED", 0));
  this->Even.Write(even);
  this->Sum.Fill(0.0);
  const std::array<int, 3>& size = this->TheGrid.size;
  for (int pair = 0; pair < this->Settings.directions / 2; ++pair)
  {
    const int* way = Ways[2 * pair];
    std::vector<int> moving, still;
    for (int a = 0; a < 3; ++a)
    {
      (way[a] != 0 ? moving : still).push_back(size[a]);
    }
    const cl::NDRange range = moving.size() == 1
      ? cl::NDRange(static_cast<std::size_t>(still[0]), static_cast<std::size_t>(still[1]))
      : cl::NDRange(static_cast<std::size_t>(moving[0] + moving[1]), static_cast<std::size_t>(still[0]));
    With(lines, this->Densities.Info(), this->Straight.Handle(), this->Passes, this->Squared, this->Even.Handle(),
      cl_int(pair));
    SetExact(this->TheDevice, lines, 6, shines);
    SetFrom(lines, 7, this->Behind.Handle(), this->Share.Handle(), this->Sum.Handle(), this->Densities.Densities(),
      cl_int(writes));
    this->TheDevice.Queue().enqueueNDRangeKernel(lines, cl::NullRange, range);
    this->TheDevice.Finish();
    this->Work += 1.0;
    Report(monitor, 1.0 - 1.0 / (1.0 + 0.01 * this->Work)); // how many sweeps it takes is not known
  }
  return this->Sum.Read();
}

/// What collisions make even, and sources, of fluence over n^2.
SteadyLattice::Values SteadyLattice::EvenOf(const Values& scaled, bool withSources) const
{
  Values even(this->Count);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const double half = withSources ? 0.5 * this->Voxels.source[i] : 0.0, kept = 1.0 - this->Voxels.lost[i];
    const double own = half * (1.0 + kept * (1.0 - this->Voxels.turning[i])); // of the half before the collision
    even[i] = this->Turns(i) * this->Voxels.squared[i] * scaled[i] + own;
  }
  return even;
}

/// W / length^2 that collisions would make even, less what they were taken to.
SteadyLattice::Values SteadyLattice::Residual(const Values& scaled, const Monitor& monitor)
{
  Values residual = this->Sweep(this->EvenOf(scaled, true), 1.0, false, monitor);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    residual[i] = this->Turns(i) * (residual[i] + 0.5 * this->Voxels.source[i] - this->Voxels.squared[i] * scaled[i]);
  }
  return residual;
}

/// The system's matrix times fluence over n^2, Eq. (L9).
SteadyLattice::Values SteadyLattice::Applied(const Values& scaled, const Monitor& monitor)
{
  Values applied = this->Sweep(this->EvenOf(scaled, false), 0.0, false, monitor);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    applied[i] = this->Turns(i) * (this->Voxels.squared[i] * scaled[i] - applied[i]);
  }
  return applied;
}

/// Eq. (L11).
SteadyLattice::Values SteadyLattice::Preconditioned(const Values& residual)
{
  const double unit = std::sqrt(Dot(residual, residual) / static_cast<double>(this->Count));
  if (!(unit > 0.0))
  {
    return Values(this->Count, 0.0);
  }
  this->Diffusion.Right().Write(InRows(this->Diffusion.Rows(), residual).data());
  this->Correction.Fill(0.0);
  this->Diffusion.Solve(this->Correction, unit, InnerReduction);
  Values corrected = this->Correction.Read();
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const double turns = this->Turns(i) * this->Voxels.squared[i];
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
  Values scaled(this->Count, 0.0);
  Values residual = this->Residual(scaled, monitor);
  const double power = SumOfMagnitudes(residual);
  Values better = this->Preconditioned(residual), direction = better;
  double rz = Dot(residual, better), smallest = 1.0, change = 1.0;
  int sinceBetter = 0;
  for (int iteration = 1; iteration <= MostIterations && power > 0.0 && rz > 0.0; ++iteration)
  {
    const Values applied = this->Applied(direction, monitor);
    const double curvature = Dot(direction, applied);
    if (!(curvature > 0.0))
    {
      break;
    }
    const double length = rz / curvature;
    Add(scaled, length, direction);
    Add(residual, -length, applied);
    better = this->Preconditioned(residual);
    const double all = SumOfMagnitudes(scaled), estimate = SumOfMagnitudes(better) / all;
    change = length * SumOfMagnitudes(direction) / all;
    this->Note(estimate, change, iteration, rows);
    const double imbalance = SumOfMagnitudes(residual) / power;
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
    // Flexible: the preconditioner is itself an iteration.
    const double part = -length * Dot(better, applied) / rz;
    rz = Dot(residual, better);
    std::transform(better.begin(), better.end(), direction.begin(), direction.begin(),
      [&](double z, double p) { return z + part * p; });
  }
  std::transform(scaled.begin(), scaled.end(), scaled.begin(), [](double x) { return std::max(x, 0.0); });
  const Values arrives = this->Sweep(this->EvenOf(scaled, true), 1.0, true, monitor);
  std::vector<float> fluence;
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    fluence.push_back(static_cast<float>(arrives[i] + 0.5 * this->Voxels.source[i]));
  }
  if (rows.empty()) // nothing collides: one sweep is all
  {
    this->Note(0.0, power > 0.0 ? change : 0.0, 1, rows);
  }
  return fluence;
}
}
