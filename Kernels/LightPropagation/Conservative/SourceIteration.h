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
/// Power still in flight after a scattering order, W by channel, and the estimated sum of the orders to come.
struct OrdersToCome
{
  Rgb scattered = {};    ///< power scattered in the last order
  Rgb onTheWay = {};     ///< power that wraps around periodic axes in the next sweep
  Rgb wasOnTheWay = {};  ///< power that wrapped around periodic axes in the last sweep
  Rgb reflected = {};    ///< power reflected by faces, incident in the next sweep
  Rgb stranded = {};     ///< power of uncollided light that wraps around periodic axes without end
  Rgb allScattered = {}; ///< power scattered in all orders so far
  std::array<RestOfOrders, 3> rest;
  double residual = 1.0; ///< estimated sum of the orders to come, relative to allScattered, largest over channels

  /// Updates `residual` with the estimated sum of the orders to come of a channel; the caller sets `residual` to 0
  /// before the first channel.
  /// @param now  power that the next order carries, or its magnitude if it may be negative, W
  /// @param reflected  part of `now` that faces reflect; its light, unlike that of the scattered part, is not in the
  ///   fluence yet
  void Expect(int channel, double now, double reflected = 0.0)
  {
    const double all = this->allScattered[channel];
    if (now != 0.0 && all > 0.0)
    {
      this->residual = std::max(this->residual, this->rest[channel].After(now, all) + reflected / all);
    }
  }
};

/// Source iteration: each sweep transports one scattering order, the light scattered in the previous sweep; the fluence
/// is the sum over orders (numerics.md, section 6). Optionally accelerated by coarse-mesh DSA. Construct and run
/// collectively.
class SourceIteration : public Iteration
{
public:
  /// @param parts  must outlive this
  /// @param kept  light of the previous solve (WarmStart.h), must outlive this object. Null, which it then is on all
  ///   ranks: the solve starts from zero and keeps no light
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
  void LimitLight();
  void Leave();
  bool Done() const;
  std::vector<std::string> LeftOut() const;

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  std::optional<OrderSweeps> Sweeps; ///< always set after construction
  std::optional<EscapeCorrection> Escaping;
  std::optional<OrdersByCells> Cells; ///< coarse-mesh DSA; unset for plain source iteration
  /// Sources by octant of directions in optically thick voxels; unset: every voxel has one source for all octants.
  std::optional<OctantSources> AtFaces;
  WarmStart Warm;
  /// Uncollided fluence, W / length^2, [channel][voxel], if light is kept for the next solve.
  std::vector<float> Direct;
  /// Angular moments of the scattered light, summed over orders, W length, if light is kept.
  Buffer<float> Moments;

  IterationResult Result;
  int Order = 0;        ///< current scattering order
  bool Shining = false; ///< whether the source of the next sweep is non-zero
  Rgb Escaped = {};     ///< power that EscapeCorrection added to the escaped power, W by channel
  OrdersToCome ToCome;
};
}
