#pragma once

#include "LightPropagation/Conservative/Acceleration/FaceBalance.h"
#include "LightPropagation/Conservative/Acceleration/SystemArrays.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/UncollidedLight.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Diffusion/DiffusionSolver.h"

#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Diffusion synthetic acceleration, DSA (numerics.md, section 7). Each sweep transports the current estimate of all
/// scattered light. A diffusion system (DiffusionSystem.h), corrected by the power that the sweep carried through each
/// voxel face, then yields the fluence of all orders, from which the next source is computed. Construct and run
/// collectively.
class DiffusionAcceleration : public Iteration
{
public:
  /// @param parts  must outlive this object; made with IterationScheme::Dsa
  /// @param kept  light of the previous solve (WarmStart.h), must outlive this object. Null on all ranks: the solve
  ///   starts from zero and keeps no light
  explicit DiffusionAcceleration(TransportParts& parts, const KeptLight* kept = nullptr);
  IterationResult Run(const Monitor& monitor) override;

private:
  void GiveFirstScattered();
  void MakeSweep();
  Deposit DepositOfSweep();
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
  bool HasMoments() const { return this->Arrays.Moments().Any(); }
  std::vector<float> SweptFluence() const;
  void WriteFluenceOfSystems();
  void WriteFlux();
  void Leave();
  void WriteFluence();
  void FindSurfaceRadiance();

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  SystemArrays Arrays;
  std::optional<UncollidedLight> Uncollided;
  std::vector<float> UncollidedFluence; ///< fluence of uncollided light, W / length^2, [channel][voxel]
  /// Sweep of scattered and boundary light along the quadrature of scattered light.
  std::unique_ptr<SweepOperator> Swept;
  std::vector<std::unique_ptr<DiffusionSolver>> Systems; ///< diffusion systems, by channel
  /// Power through each cell of the box faces; unset unless faces reflect or face power is requested.
  std::optional<FaceBalance> Box;
  SweepTally Tally; ///< incident and escaped power of the last sweep
  /// Emitted plus first-scattered power, and power incident through the box faces, W by channel.
  Rgb GivenPower = {}, PowerIn = {};
  RestOfChanges Rest;
  double Residual = 1.0;
  WarmStart Warm;
  /// Fluence and angular moments of the first iteration; empty if no light is kept for the next solve. The next solve
  /// computes its own first iteration; this one is therefore subtracted from the light that is kept.
  std::vector<float> First, FirstMoments;

  IterationResult Result;
};
}
