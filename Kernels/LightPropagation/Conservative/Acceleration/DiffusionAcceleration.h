#pragma once

#include "LightPropagation/Conservative/Acceleration/FaceBalanceOfBlock.h"
#include "LightPropagation/Conservative/Acceleration/MomentsWithGhosts.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/UncollidedLight.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/DiffusionSolver.h"

#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Iteration with diffusion acceleration (numerics.md, section 7): each sweep carries all scattered light once; a
/// diffusion system (DiffusionSystem.h), corrected by the power that the sweep found to pass each voxel's faces, then
/// gives the fluence of all orders, which is the next sweep's source. Made and run collectively.
class DiffusionAcceleration : public Iteration
{
public:
  /// @param parts  must stay; made for acceleration
  /// @param kept  light of the last solve (WarmStart.h), must stay; null, on all ranks: none, and none is to be kept
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
  void ShapeSource();
  void BeginWarm();
  std::vector<double> GuessOf(int channel, const std::vector<float>& fluence) const;
  void Correct(int iteration);
  void ReflectUncollided();
  void CountLight();
  double VoxelPower(int channel) const;
  bool Done(int iterations) const;
  bool HasMoments() const { return this->Moments.Any(); }
  std::vector<float> SweptFluence() const;
  std::vector<float> FluenceOfSystems();
  void WriteFlux(const std::vector<float>& fluence);
  void Leave();
  void WriteFluence();
  void FindSurfaceRadiance();

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  const Medium& TheMedium;
  bool LinearSource;

  // What the diffusion systems read, with ghosts
  const BlockWithGhosts Block;
  const GhostedMedium Coefficients;
  MomentsWithGhosts Moments; ///< of the sweeps' path integrals
  GhostedBuffer GivenInSystems, GivenFluxInSystems, SourceInSystems, Currents;

  // Uncollided light
  std::optional<UncollidedLight> Uncollided;
  std::vector<float> UncollidedFluence; ///< W / length^2, [channel][stride]

  // Scattered light, and what comes in along the usual directions; of the block
  Buffer<float> Given, GivenFlux, PartialCurrents; ///< as DiffusionSystem::Arrays has them
  std::unique_ptr<SweepOperator> Swept;
  std::vector<std::unique_ptr<DiffusionSolver>> Systems; ///< by channel
  std::optional<FaceBalanceOfBlock> Box;                 ///< where light by cells of the box's faces is wanted
  SweepTally Tally;                                      ///< of the last sweep
  Rgb GivenPower = {}, PowerIn = {};                     ///< W, emitted or first scattered; through faces
  RestOfChanges Rest;
  double Residual = 1.0;

  WarmStart Warm;
  std::vector<float> First, FirstMoments; ///< of the first iteration, as WarmStart has them, where light is to be kept

  IterationResult Result;
};
}
