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
/// Diffusion synthetic acceleration (numerics.md, section 7). Each sweep transports all scattered light once. A
/// diffusion system (DiffusionSystem.h), corrected by the power that the sweep carried through each voxel face, then
/// gives the fluence of all orders, from which the next source is computed. Construct and run collectively.
class DiffusionAcceleration : public Iteration
{
public:
  /// @param parts  must outlive this; made for DSA
  /// @param kept  light of the previous solve (WarmStart.h), must outlive this; null, on all ranks: no first guess,
  ///   nothing is kept
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
  std::vector<float> FluenceOfSystems();
  void WriteFlux(const std::vector<float>& fluence);
  void Leave();
  void WriteFluence();
  void FindSurfaceRadiance();

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  SystemArrays Arrays;
  std::optional<UncollidedLight> Uncollided;
  std::vector<float> UncollidedFluence; ///< W / length^2, [channel][stride]
  std::unique_ptr<SweepOperator> Swept; ///< of scattered light and boundary light along the usual directions
  std::vector<std::unique_ptr<DiffusionSolver>> Systems; ///< by channel
  std::optional<FaceBalance> Box;                        ///< if light by cell of the box faces is needed
  SweepTally Tally;                                      ///< of the last sweep
  Rgb GivenPower = {}, PowerIn = {};                     ///< W: emitted or first scattered; incident through faces
  RestOfChanges Rest;
  double Residual = 1.0;
  WarmStart Warm;
  std::vector<float> First, FirstMoments; ///< of the first iteration, as in WarmStart, if light is kept

  IterationResult Result;
};
}
