#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/OrdinatesShared.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Method by which the scattering sum over pairs of directions is computed.
enum class PairSums
{
  Terms,  ///< by the N terms of the separable phase function: N + N multiplications per direction
  Matrix, ///< by the full matrix, eight directions and eight voxels at once
  Passes  ///< by the full matrix, one pass over the volume per outgoing direction, as published without factorisation
};

/// Fluence of one scattering order, and fluence and net flux of all orders so far, by voxel.
struct OrdinatesLight
{
  Buffer<float> order;   ///< fluence of the last order, W / length^2
  Buffer<float> fluence; ///< fluence summed over all scattering orders, W / length^2
  Buffer<float> flux;    ///< net flux summed over all orders, W / length^2, [x, y, z][voxel]; empty: not requested
};

/// Scattering operator of discrete ordinates: computes the source in all directions from the radiance along all
/// directions, voxel by voxel (numerics.md, Eqs. (D7), (D8)).
class AngularScattering
{
public:
  static constexpr std::size_t VoxelsAtATime = OrdinateBlock; ///< voxels per work-item

  /// @param positive  true: negative sources, which N terms can produce, are set to 0, and the positive ones of the
  ///   voxel are scaled to conserve power (Eq. (D8)); false: sources are not changed
  /// @param skips  whether Scatter() skips blocks of VoxelsAtATime voxels in which no voxel scatters
  AngularScattering(Device& device, const OrdinateGroups& groups, const SeparablePhaseFunction& phase, PairSums sums,
    bool positive, bool netFlux, std::size_t voxels, bool skips = false);

  /// Number of floats of a radiance or source array: all voxels and directions, plus padding for vector loads that read
  /// beyond the last voxel.
  static std::size_t Floats(const OrdinateGroups& groups, std::size_t voxels);
  /// Bytes of device memory that an instance needs.
  static std::size_t Bytes(const OrdinateGroups& groups, int terms, PairSums sums, std::size_t voxels);
  /// Whether `source` and `radiance` of Scatter() may be the same array.
  bool WorksInPlace() const { return this->Sums == PairSums::Terms; }

  /// Adds fluence and net flux of `radiance` to `light`, and writes the scattering source.
  /// @param source  W / (length^3 sr), to be multiplied by `scale`
  /// @param scale  factor by voxel for the sources of all directions; written if `positive`
  /// @param empty  for each block of voxels, whether `radiance` holds only sums over directions there
  ///   (OrdinateArrays::empty); null: nowhere
  /// @param lit  box of the grid that contains all light: outside of it the radiance is 0 before and after scattering;
  ///   null: the whole grid. Only with WorksInPlace(). The fluence of the last order, OrdinatesLight::order, is then
  ///   undefined outside of it
  void Scatter(const Buffer<float>& radiance, const Buffer<float>& sigma_s, const Buffer<float>& source,
    const Buffer<float>& scale, const OrdinatesLight& light, const Monitor& monitor,
    const Buffer<cl_uchar>* empty = nullptr, const Grid* grid = nullptr, const VoxelBox* lit = nullptr) const;
  /// Adds fluence and net flux of `radiance` to `light`, without scattering.
  void Gather(const Buffer<float>& radiance, const OrdinatesLight& light, const Monitor& monitor) const;

private:
  void LoadTables(const OrdinateGroups& groups, const SeparablePhaseFunction& phase);
  void LoadPhase(const OrdinateGroups& groups, const SeparablePhaseFunction& phase);
  void ScatterByPasses(const Buffer<float>& radiance, const Buffer<float>& sigma_s, const Buffer<float>& source,
    const Monitor& monitor) const;
  cl::Kernel Kernel(const char* name) const;
  ScatteringVoxels VoxelsFrom(std::size_t voxel, const Grid* grid = nullptr, const VoxelBox* lit = nullptr) const;

  Device& TheDevice;
  PairSums Sums;
  bool Positive, NetFlux, Skips;
  int GroupCount, TermCount, Width, Rows;
  std::size_t Voxels;
  /// For each direction, the index of its group and its place among the eight directions of the group.
  std::vector<std::array<int, 2>> Lanes;
  Buffer<float> Moments, Weights, Spread, Angles;
  /// Rows of the phase function's matrix, one per outgoing direction; only for PairSums::Passes.
  std::vector<Buffer<float>> MatrixRows;
};
}
