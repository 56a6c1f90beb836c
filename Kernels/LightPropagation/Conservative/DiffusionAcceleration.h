#pragma once

#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Iteration with diffusion acceleration (numerics.md, section 7): each sweep carries all scattered light once; a
/// diffusion system (DiffusionSystem.h), corrected by the power that the sweep found to pass each voxel's faces, then
/// gives the fluence of all orders, which is the next sweep's source.
class DiffusionAcceleration : public Iteration
{
public:
  /// @param parts  must stay; made for acceleration
  explicit DiffusionAcceleration(TransportParts& parts);
  IterationResult Run(const Monitor& monitor) override;

private:
  bool NeedsMoments() const;
  void AddLamps(const Monitor& monitor);
  void PassLampLight(const Buffer<float>& path, const Buffer<float>& moments);
  void AddBoundaryDifference(const Monitor& monitor);
  double PartOfDifference(std::size_t voxel, int channel) const;
  void GiveFirstScattered();
  void MakeSweep();
  void Sweep(int iteration, const Monitor& monitor);
  void MakeSystems();
  void Correct(int iteration);
  void CountLight();
  double UnitPower(int channel) const;
  bool Done(int iterations) const;
  std::vector<float> SweptFluence() const;
  void WriteFluence();
  void LimitFlux(const std::vector<float>& fluence);
  void FindSurfaceRadiance();

  TransportParts& Parts;
  const PropagationSettings& Settings;
  const Medium& TheMedium;
  bool LinearSource;

  // Uncollided light
  EnergyLedger OfLamps;
  std::vector<float> Lamps; ///< fluence, W / length^2, [channel][stride]; W length before GiveFirstScattered
  Buffer<float> Passed;     ///< as DiffusionSystem::Arrays has it
  Rgb Stranded = {};        ///< W, of uncollided light whose rays go round a periodic axis without end

  // Scattered light, and what comes in along the usual directions
  Buffer<float> Given, PartialCurrents; ///< as DiffusionSystem::Arrays has them
  std::unique_ptr<SweepOperator> Swept;
  std::vector<std::unique_ptr<DiffusionSystem>> Systems;
  SweepTally Tally;                       ///< of the last sweep
  Rgb GivenPower = {}, PowerIn = {};      ///< W, emitted or first scattered; through faces
  std::vector<std::vector<double>> Found; ///< W / length^2, without lamps'
  double Change = 1.0, LastRatio = 1.0, Residual = 1.0;

  IterationResult Result;
};
}
