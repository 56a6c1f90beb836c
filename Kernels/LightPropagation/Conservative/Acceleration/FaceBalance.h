#pragma once

#include "LightPropagation/Conservative/Acceleration/HostMixing.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Light by cell of the box faces in a DSA solve (numerics.md, section 7.12): the power that left in the sweep, the
/// power that leaves in the diffusion solution, and the reflected power that therefore enters the next sweep. Held on
/// the host for the whole box, W, [channel][cell]. On several ranks all hold the same values, provided that they pass
/// the same arguments.
class FaceBalance
{
public:
  /// Takes the power that has left so far as uncollided. It is not swept again; its reflected part enters every sweep.
  /// @param faces  must outlive this
  explicit FaceBalance(FaceLight& faces);

  const Rgb& GivenBack() const { return this->PowerGivenBack; } ///< W of uncollided light reflected, by channel

  /// Takes the power that left in the last sweep.
  void TakeSwept();
  /// Input of the diffusion system of a channel, in the layout of DiffusionSystem::Arrays; its FaceLeaves row is 0.
  std::vector<float> RowsOf(int channel) const;
  /// Sets the power that leaves through each cell in the diffusion solution of a channel; initially 0.
  void SetLeaving(int channel, const std::vector<float>& leaves);

  /// Sets the incident light of the next sweep to the reflected power of the diffusion solution.
  /// @param given  by channel, W: emitted, first scattered, reflected uncollided and incident boundary power
  /// @return difference between this reflected power and that incident in the last sweep, relative to `given` plus the
  ///   reflected power; largest over channels
  double Reflect(int iteration, const Rgb& given);

  /// Adds the escaped power after reflection to the ledger, which already contains uncollided light that left.
  void Count(EnergyLedger& ledger) const;

  /// Power that leaves through each cell, W, without the uneven pattern in which the rays of the last sweep cross the
  /// cells. In optically thin voxels the diffusion systems inherit this pattern from the sweep. Sums over faces are
  /// unchanged.
  /// @param incoming  boundary irradiance of each face, W / length^2
  /// @param tau  optical length of the voxel at each cell along its longest edge, [channel][cell]
  /// @param spreads  sweeps spread outgoing power over neighbouring cells (Deposit::spreadsAside)
  std::vector<double> LeftWithoutPattern(
    const std::array<Rgb, 6>& incoming, const std::vector<double>& tau, bool spreads) const;

private:
  std::vector<double> Left() const;

  FaceLight& Faces;
  const std::size_t Cells;
  Rgb PowerGivenBack = {};
  std::vector<double> CameBack, GivenBackByCell, LeftUncollided;
  std::vector<float> LeftSwept;        ///< W that left in the last sweep
  std::vector<double> Leaves;          ///< W that leaves in the diffusion solution
  std::vector<double> CameBackInSweep; ///< W reflected into the last sweep
  std::vector<HostMixing> BackMixing;  ///< mixes CameBack, by channel
};
}
