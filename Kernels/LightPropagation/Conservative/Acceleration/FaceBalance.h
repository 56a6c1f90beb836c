#pragma once

#include "LightPropagation/Conservative/Acceleration/HostMixing.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Light by cells of the box's faces where scattering orders are added up by the balance of voxels (numerics.md,
/// section 7.12): what left in a sweep, what leaves by the diffusion systems' solution, and what the faces therefore
/// give back in the next sweep. On the host, of the whole box, [channel][cell], W: where the box is spread over ranks
/// all have the same, as long as each is told the same.
class FaceBalance
{
public:
  /// What has left so far is not swept: what comes back of it comes back in every sweep.
  /// @param faces  must stay
  explicit FaceBalance(FaceLight& faces);

  const Rgb& GivenBack() const { return this->PowerGivenBack; } ///< of what is not swept, by channel

  /// What left since the last call, in a sweep.
  void TakeSwept();
  /// Of a channel what its diffusion system needs, as DiffusionSystem::Arrays has it; nothing leaves by its solution.
  std::vector<float> RowsOf(int channel) const;
  /// What leaves through each cell by a channel's solution; until then nothing does.
  void SetLeaving(int channel, const std::vector<float>& leaves);

  /// Lets come in with the next sweep what the faces give back by the systems' solution.
  /// @param given  W of each channel that are emitted, first scattered, given back of what is not swept, or come in
  ///   from outside
  /// @return by how much it differs from what came in with the last one, over all light that is given
  double Reflect(int iteration, const Rgb& given);

  /// Counts what leaves for good; uncollided light that left is in the ledger already.
  void Count(EnergyLedger& ledger) const;

  /// What leaves through each cell, without the pattern in which the last sweep's rays go in and out through cells: in
  /// thin voxels the systems have it of the sweep. The sums over faces stay.
  /// @param incoming  W / length^2 through each face from outside
  /// @param tau  optical length of each cell's voxel along its longest edge, [channel][cell]
  /// @param spreads  sweeps spread what leaves aside (Deposit::spreadsAside)
  std::vector<double> LeftWithoutPattern(
    const std::array<Rgb, 6>& incoming, const std::vector<double>& tau, bool spreads) const;

private:
  std::vector<double> Left() const;

  FaceLight& Faces;
  const std::size_t Cells;
  Rgb PowerGivenBack = {};
  std::vector<double> CameBack, GivenBackByCell, LeftUncollided;
  std::vector<float> LeftSwept;        ///< in the last sweep
  std::vector<double> Leaves;          ///< by the solution
  std::vector<double> CameBackInSweep; ///< in the last sweep
  std::vector<HostMixing> BackMixing;  ///< of CameBack, by channel
};
}
