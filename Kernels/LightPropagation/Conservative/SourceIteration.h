#pragma once

#include "LightPropagation/Conservative/EscapeCorrection.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <memory>
#include <optional>

namespace tyndall
{
/// Source iteration: one scattering order after the other. Each sweep carries what the one before scattered; the
/// fluence is their sum (numerics.md, section 6).
class SourceIteration : public Iteration
{
public:
  /// @param parts  must stay
  explicit SourceIteration(TransportParts& parts);
  IterationResult Run(const Monitor& monitor) override;

private:
  void MakeSweeps();
  void MakeLitSweep();
  void MakeFilledSweep();
  void AddUncollided(const Monitor& monitor);
  void SweepOrder(const Monitor& monitor);
  void ReflectOrder();
  void ScatterOrder();
  void EstimateResidual();
  void SweepEmptySlabs(const Monitor& monitor);
  void AddOutside(const VoxelBox& box);
  bool InFilledPart() const { return this->Filled && this->Order > 0; }
  std::array<std::size_t, 2> SweptValues() const;
  bool Done() const;
  std::vector<std::string> LeftOut() const;

  TransportParts& Parts;
  const PropagationSettings& Settings;
  std::unique_ptr<SweepOperator> Whole;
  /// Of the first order, where much of the outside is dark and the medium too; else null.
  std::unique_ptr<SweepOperator> Lit;
  /// Of the orders after it, where the medium leaves much of the volume empty; else null.
  std::unique_ptr<SweepOperator> Filled;
  std::optional<EscapeCorrection> Escaping;
  double LitPart = 1.0; ///< of all rays, in the first order

  IterationResult Result;
  int Order = 0;          ///< that is under way
  bool Shining = false;   ///< the source is not zero
  Rgb Scattered = {};     ///< W, by the order just done
  Rgb OnTheWay = {};      ///< W, rays that go round a periodic axis in the next sweep
  Rgb Reflected = {};     ///< W, by faces, that come in with the next sweep
  Rgb Stranded = {};      ///< W, of uncollided light whose rays go round a periodic axis without end
  Rgb Escaped = {};       ///< W, by the correction
  Rgb LastScattered = {}; ///< W, by the order before
  Rgb AllScattered = {};  ///< W, by all orders so far
  Rgb Ratio = {};         ///< of this order's scattered power to that of the one before
  double Residual = 1.0;
};
}
