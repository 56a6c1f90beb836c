#pragma once

#include "LightPropagation/Conservative/Acceleration/EscapeCorrection.h"
#include "LightPropagation/Conservative/Acceleration/OrdersByCells.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/ThickVoxels/OctantSources.h"

#include <memory>
#include <optional>

namespace tyndall
{
/// Source iteration, one scattering order per sweep. Each sweep transports the light scattered in the one before; the
/// fluence is the sum over orders (numerics.md, section 6). Construct and run collectively.
class SourceIteration : public Iteration
{
public:
  /// @param parts  must outlive this
  /// @param kept  light of the previous solve (WarmStart.h), must outlive this; null, on all ranks: no first guess,
  ///   nothing is kept
  explicit SourceIteration(TransportParts& parts, const KeptLight* kept = nullptr);
  IterationResult Run(const Monitor& monitor) override;

private:
  void LetEscape();
  void MakeSweeps();
  void MakeLitSweep();
  void MakeFilledSweep();
  void AddUncollided(const Monitor& monitor);
  void ShowLamps();
  SweepTally AddLamp(const UncollidedSource& lamp, const Monitor& monitor);
  Deposit DepositOfSweep() const;
  void SweepOrder(const Monitor& monitor);
  void ReflectOrder();
  void ScatterOrder();
  void FindOctantSources();
  ScatteringOperator::Powers ScatterSwept();
  void ScatterByCells();
  void LookAtDirect(const Buffer<float>& fluence, double scale);
  void EstimateResidual();
  void BeginWarm();
  void GoOnWarm();
  void GatherMoments();
  void Leave();
  void SweepEmptySlabs(const Monitor& monitor);
  void AddOutside(const VoxelBox& box);
  bool InFilledPart() const { return this->Filled && this->Order > 0; }
  std::array<std::size_t, 2> SweptValues() const;
  bool Done() const;
  std::vector<std::string> LeftOut() const;

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  std::unique_ptr<SweepOperator> Whole;
  /// Sweep of the first order along directions with incident light only, if these are few and the medium does not emit;
  /// else null.
  std::unique_ptr<SweepOperator> Lit;
  /// Sweep of the later orders if the medium leaves much of the volume empty; else null.
  std::unique_ptr<SweepOperator> Filled;
  std::optional<EscapeCorrection> Escaping;
  std::optional<OrdersByCells> Cells;   ///< coarse-mesh DSA; none: plain source iteration
  std::optional<OctantSources> AtFaces; ///< sources by octant of optically thick voxels
  WarmStart Warm;
  std::vector<float> Direct; ///< W / length^2, [channel][stride], if light is kept for the next solve
  Buffer<float> Moments;     ///< of scattered light, summed over orders, W length, if kept
  double LitPart = 1.0;      ///< fraction of the rays that the first order sweeps

  IterationResult Result;
  int Order = 0;         ///< current scattering order
  bool Shining = false;  ///< the source is not zero
  Rgb Scattered = {};    ///< W, scattered in the last order
  Rgb OnTheWay = {};     ///< W that wraps around periodic axes in the next sweep
  Rgb WasOnTheWay = {};  ///< W, the same before the last sweep
  Rgb Reflected = {};    ///< W reflected by faces, incident in the next sweep
  Rgb Stranded = {};     ///< W of uncollided light that wraps around without end
  Rgb Escaped = {};      ///< W, by EscapeCorrection
  Rgb AllScattered = {}; ///< W, scattered in all orders so far
  std::array<RestOfOrders, 3> Rest;
  double Residual = 1.0;
};
}
