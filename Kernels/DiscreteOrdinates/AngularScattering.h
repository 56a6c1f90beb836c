#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// How the sum over pairs of directions is done.
enum class PairSums
{
  Terms,  ///< by the terms of the separable phase function: N + N a direction
  Matrix, ///< by the full matrix, eight directions and eight voxels at once
  Passes  ///< by the full matrix, one pass over the volume a direction, as published without factorisation
};

/// Light of one order, or of all so far.
struct OrdinatesLight
{
  Buffer<float> order;   ///< W / length^2, fluence of the last light that was scattered
  Buffer<float> fluence; ///< W / length^2, added to
  Buffer<float> flux;    ///< W / length^2, [x, y, z][voxel], added to; empty: not wanted
};

/// Scatters the radiance along each direction in each voxel into all directions.
class AngularScattering
{
public:
  /// @param positive  sources that N terms make negative are 0, and the others smaller, so that the power is right;
  /// false: as the terms have it
  AngularScattering(Device& device, const OrdinateGroups& groups, const SeparablePhaseFunction& phase, PairSums sums,
    bool positive, bool netFlux, std::size_t voxels);

  /// Floats of radiance and source: voxels of all directions, with what vectors may read beyond them.
  static std::size_t Floats(const OrdinateGroups& groups, std::size_t voxels);
  /// Bytes that this takes on the device.
  static std::size_t Bytes(const OrdinateGroups& groups, int terms, PairSums sums, std::size_t voxels);
  /// Source may be radiance itself.
  bool WorksInPlace() const { return this->Sums == PairSums::Terms; }

  /// Counts the light that radiance is, and scatters it.
  /// @param scale  a factor of all sources of a voxel
  void Scatter(const Buffer<float>& radiance, const Buffer<float>& sigma_s, const Buffer<float>& source,
    const Buffer<float>& scale, const OrdinatesLight& light, const Monitor& monitor) const;
  /// Counts it only.
  void Gather(const Buffer<float>& radiance, const OrdinatesLight& light, const Monitor& monitor) const;

private:
  void LoadTables(const OrdinateGroups& groups, const SeparablePhaseFunction& phase);
  void LoadPhase(const OrdinateGroups& groups, const SeparablePhaseFunction& phase);
  void ScatterByPasses(const Buffer<float>& radiance, const Buffer<float>& sigma_s, const Buffer<float>& source,
    const Monitor& monitor) const;
  cl::Kernel Kernel(const char* name) const;

  Device& TheDevice;
  PairSums Sums;
  bool Positive, NetFlux;
  int GroupCount, TermCount, Width, Rows;
  std::size_t Voxels;
  std::vector<std::array<int, 2>> Lanes; ///< group and lane of each direction
  Buffer<float> Moments, Weights, Spread, Angles;
  std::vector<Buffer<float>> MatrixRows; ///< for passes
};
}
