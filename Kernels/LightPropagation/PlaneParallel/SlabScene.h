#pragma once

#include "LightPropagation/PlaneParallel/LayerStack.h"
#include "LightPropagation/PlaneParallel/PlaneParallelPropagation.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A plane-parallel scene, as layers and incident light. Layers are stacked along one axis; "top" is the side of the
/// lowest coordinate. Azimuth is measured about this axis, from the next axis in cyclic order.
class SlabScene
{
public:
  /// @param medium, illumination  scene for which IsPlaneParallel() holds; must outlive this object
  SlabScene(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

  int Along() const { return this->Axis; }
  std::size_t Count() const { return static_cast<std::size_t>(this->TheMedium.grid.size[this->Axis]); }
  double Height() const { return this->TheMedium.grid.spacing[this->Axis]; } ///< height of a layer, in units of length
  /// Area of the slab, normal to the axis of the layers, length^2.
  double Across() const;
  /// Index of a layer's voxel in the first column of voxels.
  std::size_t VoxelOf(std::size_t layer) const { return layer * this->TheMedium.grid.Strides()[this->Axis]; }
  std::size_t LayerOf(std::size_t voxel) const;
  bool IsIsotropic() const { return this->Isotropic; }
  bool HasSlantingBeams() const;

  /// Layers in one channel, with delta-M scattering.
  /// @param degree  highest degree of the phase function's moments; scattering beyond it is treated as unscattered
  LayerStack StackOf(int channel, int degree) const;
  /// Layers in one channel without delta-M: with the full extinction, for uncollided light.
  LayerStack UnscatteredStackOf(int channel) const;
  StackLight LightOf(int channel) const;
  /// Incident beams without other light, each irradiance multiplied by cos or sin of `order` times the beam's azimuth.
  StackLight BeamsOf(int channel, int order, bool sine) const;
  double Absorbing(std::size_t layer, int channel) const; ///< absorption optical thickness of a layer
  /// Net flux of a beam along the two axes parallel to the layers, for irradiance 1.
  std::array<double, 2> Sideways(std::size_t beam) const;

private:
  DeltaM PhaseOf(std::size_t voxel, int channel, int degree) const;

  const Medium& TheMedium;
  const Illumination& Shining;
  int Axis = 0;
  bool Isotropic = true;
  std::vector<std::array<double, 3>>
    Directions;                      ///< unit vectors of the incident lights: along the axis and the next two axes
  std::vector<std::size_t> Entering; ///< indices in Illumination::lights of the lights that `Directions` lists
};

/// Light of one column of voxels in one channel; all columns are equal. Arrays have one value per layer; powers are per
/// area of the layers, W / length^2.
class SlabColumn
{
public:
  /// @param orders  highest order of the Fourier series in azimuth that is solved; net flux along the layers needs 1
  SlabColumn(const SlabScene& scene, int channel, const HalfRangeQuadrature& nodes, int degree, int orders);

  std::vector<double> fluence, direct;          ///< fluence of all light and of uncollided light, W / length^2
  std::array<std::vector<double>, 3> flux;      ///< net flux along the axis of the layers and the next two axes
  std::array<double, 2> out = {}, entered = {}; ///< outgoing (before reflection) and incident power at top and bottom
  double absorbed = 0.0, emitted = 0.0;
  std::array<double, 2> escaped = {}; ///< power that leaves at top and bottom, without reflected power
  LayerStack stack;
  StackSolution even; ///< solution of azimuthal order 0
  /// Solutions of azimuthal orders 1, 2, ...; for each, the amplitudes of cos and of sin.
  std::vector<std::array<StackSolution, 2>> slanting;

private:
  void AddBeams(const SlabScene& scene, const StackLight& light, int channel);
  void AddDiffuse(const StackLight& light, const LayerStack& unscattered, const HalfRangeQuadrature& nodes);
  void SumUp(const SlabScene& scene, const StackLight& light, const HalfRangeQuadrature& nodes, int channel);
};

/// LightField::scatteredMoments of a column, [layer][(degree + 1)^2], from the radiance at the quadrature's nodes,
/// which excludes uncollided light of beams.
std::vector<double> ScatteredMoments(
  const SlabScene& scene, const SlabColumn& column, const HalfRangeQuadrature& nodes, int degree);
}
