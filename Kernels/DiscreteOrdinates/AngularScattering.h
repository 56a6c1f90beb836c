#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/OrdinatesShared.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// How the sum over pairs of directions is computed.
enum class PairSums
{
  Terms,  ///< by the terms of the separable phase function: N + N operations per direction
  Matrix, ///< by the full matrix, eight directions and eight voxels at once
  Passes  ///< by the full matrix, one pass over the volume per direction, as published without factorisation
};

/// Fluence of one order, and fluence and flux of all orders so far.
struct OrdinatesLight
{
  Buffer<float> order;   ///< W / length^2, fluence of the last order that was scattered
  Buffer<float> fluence; ///< W / length^2, added to
  Buffer<float> flux;    ///< W / length^2, [x, y, z][voxel], added to; empty: not requested
};

/// Scatters the radiance of each voxel from each direction into all directions.
class AngularScattering
{
public:
  /// @param positive  negative sources, which N terms can produce, are set to 0, and the rest reduced to conserve
  ///   power; false: sources are as the terms give them
  AngularScattering(Device& device, const OrdinateGroups& groups, const SeparablePhaseFunction& phase, PairSums sums,
    bool positive, bool netFlux, std::size_t voxels);

  /// Floats of a radiance or source array: all voxels and directions, plus padding that vector loads may read.
  static std::size_t Floats(const OrdinateGroups& groups, std::size_t voxels);
  /// Bytes of device memory that an instance needs.
  static std::size_t Bytes(const OrdinateGroups& groups, int terms, PairSums sums, std::size_t voxels);
  /// Whether source and radiance may be the same array.
  bool WorksInPlace() const { return this->Sums == PairSums::Terms; }

  /// Adds the moments of `radiance` to `light`, and writes its scattering source.
  /// @param scale  a factor by voxel for all sources
  void Scatter(const Buffer<float>& radiance, const Buffer<float>& sigma_s, const Buffer<float>& source,
    const Buffer<float>& scale, const OrdinatesLight& light, const Monitor& monitor) const;
  /// Only adds the moments of `radiance` to `light`.
  void Gather(const Buffer<float>& radiance, const OrdinatesLight& light, const Monitor& monitor) const;

private:
  void LoadTables(const OrdinateGroups& groups, const SeparablePhaseFunction& phase);
  void LoadPhase(const OrdinateGroups& groups, const SeparablePhaseFunction& phase);
  void ScatterByPasses(const Buffer<float>& radiance, const Buffer<float>& sigma_s, const Buffer<float>& source,
    const Monitor& monitor) const;
  cl::Kernel Kernel(const char* name) const;
  ScatteringVoxels VoxelsFrom(std::size_t item) const;

  Device& TheDevice;
  PairSums Sums;
  bool Positive, NetFlux;
  int GroupCount, TermCount, Width, Rows;
  std::size_t Voxels;
  std::vector<std::array<int, 2>> Lanes; ///< group and lane of each direction
  Buffer<float> Moments, Weights, Spread, Angles;
  std::vector<Buffer<float>> MatrixRows; ///< for PairSums::Passes
};
}
