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
/// Source iteration: one scattering order after the other. Each sweep carries what the one before scattered; the
/// fluence is their sum (numerics.md, section 6). Made and run collectively.
class SourceIteration : public Iteration
{
public:
  /// @param parts  must stay
  /// @param kept  light of the last solve (WarmStart.h), must stay; null, on all ranks: none, and none is to be kept
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
  /// Of the first order, where much of the outside is dark and the medium too; else null.
  std::unique_ptr<SweepOperator> Lit;
  /// Of the orders after it, where the medium leaves much of the volume empty; else null.
  std::unique_ptr<SweepOperator> Filled;
  std::optional<EscapeCorrection> Escaping;
  std::optional<OrdersByCells> Cells;   ///< none: orders are added up one by one
  std::optional<OctantSources> AtFaces; ///< where voxels are thick
  WarmStart Warm;
  std::vector<float> Direct; ///< W / length^2, [channel][stride], where light is to be kept
  Buffer<float> Moments;     ///< of scattered light of all orders, W length, where they are to be kept
  double LitPart = 1.0;      ///< of all rays, in the first order

  IterationResult Result;
  int Order = 0;         ///< that is under way
  bool Shining = false;  ///< the source is not zero
  Rgb Scattered = {};    ///< W, by the order just done
  Rgb OnTheWay = {};     ///< W, rays that go round a periodic axis in the next sweep
  Rgb WasOnTheWay = {};  ///< W, the same before the last sweep
  Rgb Reflected = {};    ///< W, by faces, that come in with the next sweep
  Rgb Stranded = {};     ///< W, of uncollided light whose rays go round a periodic axis without end
  Rgb Escaped = {};      ///< W, by the correction
  Rgb AllScattered = {}; ///< W, by all orders so far
  std::array<RestOfOrders, 3> Rest;
  double Residual = 1.0;
};
}
