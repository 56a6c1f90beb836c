#pragma once

#include "Device/Device.h"
#include "Distribution/Domain.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// A scene as a lattice solves it: in units that floats hold well, in as many channels as it needs, and of this rank's
/// block with two layers of ghost voxels, for what a lamp's light does in a voxel depends on its neighbours'
/// neighbours. On one rank the block is the grid, without ghost voxels.
class LatticeProblem
{
public:
  /// Collective. All that is given must outlive it.
  /// @param medium, ior, illumination  of the rank's block, checked (CheckLattice); not read where that has no voxels
  LatticeProblem(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const Illumination& illumination, const LatticeSettings& settings);
  ~LatticeProblem();
  LatticeProblem(const LatticeProblem&) = delete; // the medium refers to arrays that this owns
  LatticeProblem& operator=(const LatticeProblem&) = delete;

  const Domain& TheDomain() const { return *this->Solved; } ///< in the problem's unit of length
  const LatticeBox& Box() const { return *this->OwnBox; }
  // Of the known voxels.
  const Medium& TheMedium() const;
  const Field& Index() const; ///< refractive index; null values: 1
  const Illumination& TheIllumination() const;
  int Channels() const; ///< 1 or 3
  /// Whether the medium, of all ranks, scatters unevenly. Collective.
  bool IsAnisotropic() const;

  /// Values of the block's voxels with those of its ghost voxels. Collective.
  std::vector<float> WithGhosts(std::vector<float> own, int components) const;

  /// To the user's units and channels; adds to leftOut.
  void Undo(LightField& light) const;

private:
  struct Serial;
  struct Block;

  std::unique_ptr<const Serial> OfGrid; ///< on one rank
  std::unique_ptr<const Block> OfBlock; ///< on several
  std::unique_ptr<const Domain> Solved;
  std::unique_ptr<const LatticeBox> OwnBox;
};
}
