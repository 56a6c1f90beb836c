#pragma once

#include "LightPropagation/Conservative/Acceleration/EscapeCorrection.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/Balance/OrdersByCellsInBlocks.h"
#include "LightPropagation/Distributed/Balance/OrdersOverRanks.h"
#include "LightPropagation/Distributed/BlockOnDevice.h"
#include "LightPropagation/Distributed/IncidentLight.h"
#include "LightPropagation/Distributed/UncollidedOverRanks.h"
#include "LightPropagation/Scattering/BeamsInSource.h"
#include "LightPropagation/ThickVoxels/OctantSources.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
/// Source iteration on one rank's block, in step with the others: one scattering order after the other, as
/// SourceIteration of the whole (numerics.md, section 6).
class IterationInBlocks : public Iteration
{
public:
  /// @param block, incident, uncollided  must stay
  /// @param orders  one by one or by cells, as all ranks decided
  /// @param kept  light of the last solve (WarmStart.h), must stay; null, on all ranks: none, and none is to be kept
  /// @throws DeviceError if the array of light that is shown does not fit
  IterationInBlocks(BlockOnDevice& block, const IncidentLight& incident, UncollidedOverRanks& uncollided,
    const OrdersOverRanks& orders, const KeptLight* kept = nullptr);
  /// All ranks call it.
  IterationResult Run(const Monitor& monitor) override;

private:
  void MakeWarm();
  void MakeCells();
  void MakeAtFaces();
  std::unique_ptr<SweepOperator> MakeSweep();
  BeamsInSource BeamsOfSource();
  void AddUncollided(const Monitor& monitor);
  void FindEscaping(const Monitor& monitor);
  void SweepOrder(SweepOperator& sweep, BeamsInSource& beams, const Monitor& monitor);
  void LetEscape();
  void Reflect();
  void TakeDirect(const Buffer<float>& fluence, double scale);
  void Scatter();
  void ShineByOctant();
  std::vector<double> ScatterOwn();
  void ScatterByCells();
  void EstimateResidual();
  void BeginWarm();
  void GoOnWarm();
  void Leave();
  bool Done() const;
  void Finish();

  BlockOnDevice& Block;
  const IncidentLight& Incident;
  UncollidedOverRanks& Uncollided;
  const OrdersOverRanks Orders;
  const KeptLight* const Kept;
  std::optional<WarmStart> Warm; ///< made first in Run
  std::vector<float> Direct;     ///< W / length^2, [channel][stride], where light is to be kept
  Buffer<float> Moments;         ///< of scattered light of all orders, W length, where they are to be kept
  std::optional<EscapeCorrection> Escaping;
  std::optional<OrdersByCellsInBlocks> Cells; ///< none: orders are added up one by one
  std::optional<OctantSources> AtFaces;       ///< where voxels are thick, on any rank
  std::vector<std::string> NotByOctant;       ///< words for that, where it was asked for

  IterationResult Result;
  int Order = 0;         ///< that is under way
  bool Shining = false;  ///< the source is not zero, on any rank
  Rgb Scattered = {};    ///< W of all ranks, as those that follow, by the order just done
  Rgb OnTheWay = {};     ///< rays that go round a periodic axis in the next sweep
  Rgb WasOnTheWay = {};  ///< the same before the last sweep
  Rgb Reflected = {};    ///< by faces, that come in with the next sweep
  Rgb Stranded = {};     ///< of uncollided light whose rays go round a periodic axis without end
  Rgb Escaped = {};      ///< by the correction
  Rgb AllScattered = {}; ///< by all orders so far
  std::array<RestOfOrders, 3> Rest;
  double Residual = 1.0;
};
}
