#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "Light/LightField.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Steps that were done already, which count.
struct StepsBefore
{
  int steps = 0;
  double seconds = 0.0;
};

/// A lattice that steps, in one memory or over ranks.
class SteppedLattice
{
public:
  virtual ~SteppedLattice() = default;

  /// @param done  of all that is to be done, to be told while steps go on
  virtual void Step(int steps, double done, const Monitor& monitor) = 0;
  virtual std::vector<float> Probed() const = 0;  ///< fluence of the last step at the voxels that are looked at
  virtual std::vector<float> Fluence() const = 0; ///< by voxel

  /// Sums over ranks of what each has of them.
  virtual std::vector<double> Sum(const std::vector<double>& ofRank) { return ofRank; }
  /// What a rank does by itself: where it fails on one, it does on all.
  virtual void Alone(const std::function<void()>& work) { work(); }
};

/// One that lies in one device's memory.
class SteppedInMemory : public SteppedLattice
{
public:
  SteppedInMemory(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings);

  void Step(int steps, double done, const Monitor& monitor) override;
  std::vector<float> Probed() const override;
  std::vector<float> Fluence() const override { return this->TheLattice.Fluence(); }

private:
  Device& TheDevice;
  Lattice& TheLattice;
  const LatticeSettings& Settings;
  Buffer<cl_int> Places; ///< voxels that are looked at; empty: all
};

/// Numbers of the voxels at which it is looked how much steps change; empty: all.
std::vector<std::size_t> ProbesOf(const Grid& grid, const LatticeSettings& settings);

/// Steps until little changes, or as many as were asked for.
class Settling
{
public:
  Settling(SteppedLattice& lattice, const LatticeSettings& settings)
    : TheLattice(lattice)
    , Settings(settings)
  {
  }

  /// @return fluence of the last step
  std::vector<float> Run(const StepsBefore& before, const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  double Change();
  double Estimate(double change);

  SteppedLattice& TheLattice;
  const LatticeSettings& Settings;
  std::vector<float> Last; ///< fluence at the probes when it was looked at last
  double LastChange = 0.0;
};
}
