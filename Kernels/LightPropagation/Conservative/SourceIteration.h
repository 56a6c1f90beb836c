#pragma once

#include "LightPropagation/Conservative/Acceleration/EscapeCorrection.h"
#include "LightPropagation/Conservative/Acceleration/OrdersByCells.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/OrderSweeps.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/ThickVoxels/OctantSources.h"

#include <algorithm>
#include <array>
#include <optional>

namespace tyndall
{
/// Power that is still under way after a scattering order, W by channel, and the estimate of the orders to come.
struct OrdersToCome
{
  Rgb scattered = {};    ///< scattered in the last order
  Rgb onTheWay = {};     ///< wraps around periodic axes in the next sweep
  Rgb wasOnTheWay = {};  ///< the same before the last sweep
  Rgb reflected = {};    ///< reflected by faces, incident in the next sweep
  Rgb stranded = {};     ///< uncollided light that wraps around without end
  Rgb allScattered = {}; ///< scattered in all orders so far
  std::array<RestOfOrders, 3> rest;
  double residual = 1.0; ///< estimated remainder relative to allScattered, of the worst channel

  /// Includes a channel in `residual`, which the caller sets to 0 before the first.
  /// @param now  power that goes on, or its magnitude, W
  void Expect(int channel, double now)
  {
    if (now != 0.0 && this->allScattered[channel] > 0.0)
    {
      this->residual = std::max(this->residual, this->rest[channel].After(now, this->allScattered[channel]));
    }
  }
};

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
  void AddUncollided(const Monitor& monitor);
  void ShowLamps();
  void PrepareEscape(const Monitor& monitor);
  SweepTally AddLamp(const UncollidedSource& lamp, const Buffer<float>& firstMoments, const Monitor& monitor);
  SweepTally AddSwept(const UncollidedSource& source, const SweptDirections& along, const Monitor& monitor);
  Deposit DepositOfSweep() const;
  void SweepOrder(const Monitor& monitor);
  void ReflectOrder();
  void ScatterOrder();
  void FindOctantSources();
  ScatteringOperator::Powers ScatterSwept();
  void ScatterByCells();
  void LookAtDirect(const Buffer<float>& fluence, double scale);
  void BeginWarm();
  void GoOnWarm();
  void GatherMoments();
  void Leave();
  bool Done() const;
  std::vector<std::string> LeftOut() const;

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  std::optional<OrderSweeps> Sweeps; ///< always set after construction
  std::optional<EscapeCorrection> Escaping;
  std::optional<OrdersByCells> Cells;   ///< coarse-mesh DSA; none: plain source iteration
  std::optional<OctantSources> AtFaces; ///< sources by octant of optically thick voxels
  WarmStart Warm;
  std::vector<float> Direct; ///< W / length^2, [channel][stride], if light is kept for the next solve
  Buffer<float> Moments;     ///< of scattered light, summed over orders, W length, if kept

  IterationResult Result;
  int Order = 0;        ///< current scattering order
  bool Shining = false; ///< the source is not zero
  Rgb Escaped = {};     ///< W, by EscapeCorrection
  OrdersToCome ToCome;
};
}
