#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/Settling.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// Mean directions times fluence, as LightField::netFlux has it.
std::vector<float> NetFluxOf(const UncollidedImage& image, const Grid& grid, int channels);

/// One channel: solved for, and added to the light of all.
class LatticeChannel
{
public:
  LatticeChannel(Device& device, const PropagationProblem& problem, const Field& ior, const LatticeSettings& settings,
    const Uncollided& direct, int channel)
    : TheDevice(device)
    , Problem(problem)
    , Settings(settings)
    , Direct(direct)
    , Voxels(problem, ior, settings, direct, channel)
    , Photons(device, problem.TheGrid(), settings, this->Voxels)
    , Channel(static_cast<std::size_t>(channel))
  {
  }

  double Thickest() const { return this->Voxels.thickest; }
  Lattice& TheLattice() { return this->Photons; }
  const LatticeVoxels& TheVoxels() const { return this->Voxels; }
  void Solve(const Monitor& monitor);
  /// Takes uncollided light that has changed.
  void Shine();
  /// Steps on, from densities that other steps have left.
  void Settle(const StepsBefore& before, const Monitor& monitor);
  void AddTo(LightField& light);

private:
  double CountVoxels(LightField& light) const;
  double CountFaces(LightField& light);
  void AddFlux(LightField& light);
  void AddCrossing(LightField& light) const;
  void AddRows(LightField& light) const;

  Device& TheDevice;
  const PropagationProblem& Problem;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  LatticeVoxels Voxels;
  Lattice Photons;
  std::size_t Channel;
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
