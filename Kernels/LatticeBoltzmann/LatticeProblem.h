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
/// A scene prepared for a lattice solve: rescaled to units suited to floats, reduced to the channels it needs, and
/// restricted to this rank's block with a halo of two layers, since first moments in a voxel depend on its neighbours'
/// neighbours. On one rank the block is the grid, without a halo.
class LatticeProblem
{
public:
  /// Collective. All arguments must outlive this.
  /// @param medium, ior, illumination  of the rank's block, checked (CheckLattice); not read if the block has no voxels
  LatticeProblem(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const Illumination& illumination, const LatticeSettings& settings);
  ~LatticeProblem();
  LatticeProblem(const LatticeProblem&) = delete; // the medium refers to arrays that this owns
  LatticeProblem& operator=(const LatticeProblem&) = delete;

  const Domain& TheDomain() const { return *this->Solved; } ///< in the problem's unit of length
  const LatticeBox& Box() const { return *this->OwnBox; }
  // Fields over the known voxels:
  const Medium& TheMedium() const;
  const Field& Index() const; ///< refractive index; null values: 1
  const Illumination& TheIllumination() const;
  int Channels() const; ///< 1 or 3
  /// Whether the medium scatters anisotropically on any rank. Collective.
  bool IsAnisotropic() const;

  /// Extends values of the block's voxels to its ghost voxels. Collective.
  std::vector<float> WithGhosts(std::vector<float> own, int components) const;

  /// Converts light to the user's units and channels; adds to leftOut.
  void Undo(LightField& light) const;

private:
  struct Serial;
  struct Block;

  std::unique_ptr<const Serial> OfGrid; ///< set on one rank
  std::unique_ptr<const Block> OfBlock; ///< set on several ranks
  std::unique_ptr<const Domain> Solved;
  std::unique_ptr<const LatticeBox> OwnBox;
};
}
