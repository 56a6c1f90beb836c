#pragma once

#include "Distribution/Domain.h"
#include "Distribution/Halo.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// A scene prepared for a lattice solve, in units suited to floats and with the channels that it needs
/// (PropagationProblem). On several ranks it includes a halo of two layers around this rank's block, since the source
/// of a voxel depends on its neighbours' neighbours (numerics.md, Eq. (L13)). On one rank the block is the grid,
/// without a halo.
class LatticeProblem
{
public:
  /// Collective. All arguments must outlive this.
  /// @param medium, ior, illumination  of the rank's block; not read if the block has no voxels
  /// @throws InvalidInput  as PropagationProblem
  LatticeProblem(const Domain& domain, const Medium& medium, const Field& ior, const Illumination& illumination,
    const LatticeSettings& settings);
  LatticeProblem(const LatticeProblem&) = delete; // the medium refers to arrays that this object owns
  LatticeProblem& operator=(const LatticeProblem&) = delete;

  const Domain& TheDomain() const { return this->Scene.TheDomain(); } ///< domain in the problem's unit of length
  const LatticeBox& Box() const { return *this->OwnBox; }
  const Medium& OwnMedium() const { return this->Scene.TheMedium(); } ///< medium of this rank's block, without a halo
  // Fields over the known voxels: the block and its halo of ghost voxels.
  const Medium& TheMedium() const { return this->Known; }
  const Field& Index() const { return this->KnownIndex; } ///< refractive index; null values: 1
  const Illumination& TheIllumination() const { return this->Shining; }
  int Channels() const { return this->Scene.Channels(); } ///< 1 or 3
  /// Whether the medium scatters anisotropically on any rank.
  bool IsAnisotropic() const { return !this->Scene.IsIsotropic() && this->Scene.Traits().scatters; }

  /// Extends an array over the block's voxels by the values of its ghost voxels, copied from the ranks that own them.
  /// Collective.
  std::vector<float> WithGhosts(std::vector<float> own, int components) const;

  /// Converts `light` to the user's units and channels, and adds entries to its leftOut. Collective.
  void Undo(LightField& light) const;

private:
  Field WithGhosts(const Field& own);

  const PropagationProblem Scene; ///< scene of this rank's block
  std::optional<Halo> Ghosts;     ///< halo of the block; unset on one rank
  std::vector<std::vector<float>> GhostValues;
  Medium Known;
  Field KnownIndex;
  Illumination Shining;
  std::optional<LatticeBox> OwnBox;
};
}
