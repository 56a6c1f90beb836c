#pragma once

#include "LightPropagation/PlaneParallel/IsPlaneParallel.h"
#include "LightPropagation/PlaneParallel/LayerStack.h"

#include <array>

namespace tyndall
{
/// A plane-parallel scene. Layers are stacked along one axis; "top" is the side of the lowest coordinate. Azimuth is
/// measured about this axis, from the next axis in cyclic order.
class SlabScene
{
public:
  /// @param medium, illumination  IsPlaneParallel must hold; must outlive this
  SlabScene(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

  int Along() const { return this->Axis; }
  std::size_t Count() const { return static_cast<std::size_t>(this->TheMedium.grid.size[this->Axis]); }
  double Height() const { return this->TheMedium.grid.spacing[this->Axis]; } ///< of a layer
  double Across() const;                                                     ///< area of the slab
  std::size_t VoxelOf(std::size_t layer) const;                              ///< in the first column
  std::size_t LayerOf(std::size_t voxel) const;
  bool IsIsotropic() const { return this->Isotropic; }
  bool HasSlantingBeams() const;

  /// @param degree  of the moments of scattering; scattering beyond it is treated as unscattered
  LayerStack StackOf(int channel, int degree) const;
  /// The same without scattering, with the full extinction.
  LayerStack UnscatteredStackOf(int channel) const;
  StackLight LightOf(int channel) const;
  /// The beams only, each multiplied by cos or sin of `order` times its azimuth.
  StackLight BeamsOf(int channel, int order, bool sine) const;
  double Absorbing(std::size_t layer, int channel) const; ///< sigma_a times the height of the layer
  /// Net flux along the two axes parallel to the layers, for irradiance 1 of a beam.
  std::array<double, 2> Sideways(std::size_t beam) const;

private:
  DeltaM PhaseOf(std::size_t voxel, int channel, int degree) const;

  const Medium& TheMedium;
  const Illumination& Shining;
  int Axis = 0;
  bool Isotropic = true;
  std::vector<std::array<double, 3>>
    Directions;                      ///< unit vectors of the incident lights: along the axis and the next two axes
  std::vector<std::size_t> Entering; ///< indices of the incident lights
};
}
