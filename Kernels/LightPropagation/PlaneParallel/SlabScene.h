#pragma once

#include "LightPropagation/PlaneParallel/IsPlaneParallel.h"
#include "LightPropagation/PlaneParallel/LayerStack.h"

#include <array>

namespace tyndall
{
/// A plane-parallel scene. Its layers lie along one axis, top to bottom by rising coordinate; azimuths are about it,
/// from the next axis on in cyclic order.
class SlabScene
{
public:
  /// @param medium, illumination  for which IsPlaneParallel holds; must stay
  SlabScene(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

  int Along() const { return this->Axis; }
  std::size_t Count() const { return static_cast<std::size_t>(this->TheMedium.grid.size[this->Axis]); }
  double Height() const { return this->TheMedium.grid.spacing[this->Axis]; } ///< of a layer
  double Across() const;                                                     ///< area of the slab
  std::size_t VoxelOf(std::size_t layer) const;                              ///< in the first column
  std::size_t LayerOf(std::size_t voxel) const;
  bool IsIsotropic() const { return this->Isotropic; }
  bool HasSlantingBeams() const;

  /// @param degree  of the moments in which light is scattered; what is beyond goes straight on
  LayerStack StackOf(int channel, int degree) const;
  /// The same without scattering: the whole extinction.
  LayerStack UnscatteredStackOf(int channel) const;
  StackLight LightOf(int channel) const;
  /// Only the beams, each by cos or sin of `order` times its azimuth.
  StackLight BeamsOf(int channel, int order, bool sine) const;
  double Absorbing(std::size_t layer, int channel) const; ///< sigma_a times its height
  /// Net flux of irradiance 1 along both axes of the layers.
  std::array<double, 2> Sideways(std::size_t beam) const;

private:
  DeltaM PhaseOf(std::size_t voxel, int channel, int degree) const;

  const Medium& TheMedium;
  const Illumination& Shining;
  int Axis = 0;
  bool Isotropic = true;
  std::vector<std::array<double, 3>>
    Directions;                      ///< of the lights that enter: along the axis, and the two next, length 1
  std::vector<std::size_t> Entering; ///< which lights
};
}
