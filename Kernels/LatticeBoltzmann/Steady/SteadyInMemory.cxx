#include "LatticeBoltzmann/Steady/SteadyInMemory.h"

#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
namespace
{
constexpr double InnerReduction = 0.1; ///< of the diffusion's own residual
}

SteadyInMemory::SteadyInMemory(Device& device, const Grid& grid, const LatticeSettings& settings,
  const LatticeVoxels& voxels, const Lattice& lattice)
  : TheDevice(device)
  , TheGrid(grid)
  , Settings(settings)
  , Voxels(voxels)
  , Densities(lattice)
  , Count(grid.VoxelCount())
  , Passes(device, voxels.passes, "how links pass light")
  , Squared(device, voxels.squared, "n^2")
  , Endless(device, voxels.endless, "lines without an end")
  , Diffusion(device, grid.size, grid.spacing)
{
  this->Load();
  this->LoadDiffusion();
}

void SteadyInMemory::Load()
{
  const char* what = "lines of the lattice";
  this->Straight = ExactValues(this->TheDevice, this->Count, what);
  this->Even = ExactValues(this->TheDevice, this->Count, what);
  this->Behind = ExactValues(this->TheDevice, 2 * this->Count, what);
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  const bool closes = periodic[0] || periodic[1] || periodic[2];
  this->Share = ExactValues(this->TheDevice, closes ? this->Count : 1, what);
  this->Arriving = ExactValues(this->TheDevice, this->Count, what);
  this->Correction = ExactValues(this->TheDevice, this->Count, what);
  this->Straight.Write(GoesStraight(LatticeBox(this->TheGrid), this->Voxels));
}

/// The diffusion of the lattice, of fluence over n^2, Eq. (L12).
void SteadyInMemory::LoadDiffusion()
{
  const LatticeVoxels& voxels = this->Voxels;
  const double thin = LeastForDiffusion(this->Settings);
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

SteadyInMemory::Values SteadyInMemory::Sweep(const Values& even, double shines, bool writes, const Monitor& monitor)
{
  cl::Kernel lines = this->TheDevice.Kernel(
    "sweep_lines", kernel_source::LatticeLines, OptionsOfLines(this->TheDevice, this->Settings, this->Voxels));
  this->Even.Write(even);
  this->Arriving.Fill(0.0);
  for (int pair = 0; pair < this->Settings.directions / 2; ++pair)
  {
    const std::array<std::size_t, 2> range = LinesOfPair(this->TheGrid.size, pair);
    With(lines, this->Densities.Info(), this->Straight.Handle(), this->Passes, this->Squared, this->Even.Handle(),
      cl_int(pair));
    SetExact(this->TheDevice, lines, 6, shines);
    SetFrom(lines, 7, this->Behind.Handle(), this->Share.Handle(), this->Arriving.Handle(), this->Densities.Densities(),
      this->Endless, cl_int(writes));
    this->TheDevice.Queue().enqueueNDRangeKernel(lines, cl::NullRange, cl::NDRange(range[0], range[1]));
    this->TheDevice.Finish();
    this->Work += 1.0;
    Report(monitor, 1.0 - 1.0 / (1.0 + 0.01 * this->Work)); // how many sweeps it takes is not known
  }
  return this->Arriving.Read();
}

SteadyInMemory::Values SteadyInMemory::Diffuse(const Values& residual, double unit)
{
  this->Diffusion.Right().Write(InRows(this->Diffusion.Rows(), residual).data());
  this->Correction.Fill(0.0);
  this->Diffusion.Solve(this->Correction, unit, InnerReduction);
  return this->Correction.Read();
}
}
