#pragma once

#include "LightPropagation/Conservative/Acceleration/FaceBalance.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/UncollidedLight.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"

#include <memory>
#include <optional>
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
  /// @param kept  light of the last solve (WarmStart.h), must stay; null: none, and none is to be kept
  explicit DiffusionAcceleration(TransportParts& parts, const KeptLight* kept = nullptr);
  IterationResult Run(const Monitor& monitor) override;

private:
  void GiveFirstScattered();
  void MakeSweep();
  Deposit DepositOfSweep() const;
  void ScatterFound();
  void FindShown();
  void Sweep(int iteration, const Monitor& monitor);
  void MakeSystems();
  void LookAtDirect();
  void BeginWarm();
  std::vector<double> WithGuess(int channel) const;
  void Correct(int iteration);
  void ReflectUncollided();
  void TakeSweptFaces();
  std::vector<double> LeftByCell() const;
  void CountLight();
  double VoxelPower(int channel) const;
  bool Done(int iterations) const;
  std::vector<float> SweptFluence() const;
  void Leave();
  void WriteFluence();
  void FindSurfaceRadiance();

  TransportParts& Parts;
  const PropagationSettings& Settings;
  const Medium& TheMedium;
  bool LinearSource;

  // Uncollided light
  std::optional<UncollidedLight> Uncollided;
  std::vector<float> UncollidedFluence; ///< W / length^2, [channel][stride]

  // Scattered light, and what comes in along the usual directions
  Buffer<float> Given, GivenFlux, PartialCurrents, OfLamps; ///< as DiffusionSystem::Arrays has them
  std::unique_ptr<SweepOperator> Swept;
  std::vector<std::unique_ptr<DiffusionSystem>> Systems;
  /// By channel, where light by cells of the box's faces is wanted: as DiffusionSystem::Arrays has it.
  std::vector<Buffer<float>> Faces;
  std::optional<FaceBalance> Box;
  SweepTally Tally;                  ///< of the last sweep
  Rgb GivenPower = {}, PowerIn = {}; ///< W, emitted or first scattered; through faces
  RestOfChanges Rest;
  double Residual = 1.0;

  WarmStart Warm;
  std::vector<float> First, FirstMoments; ///< of the first iteration, as WarmStart has them, where light is to be kept

  IterationResult Result;
};
}
