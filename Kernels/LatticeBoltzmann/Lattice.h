#pragma once

#include "Device/Buffer.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeShared.h"
#include "LatticeBoltzmann/LatticeVoxels.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Photon densities of one channel on a device, and the steps that collide and stream them.
class Lattice
{
public:
  /// @param voxels  voxel data of all known voxels of the box
  Lattice(Device& device, const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Queues `steps` steps. Densities are zero before the first call, except for incident light.
  /// @param writes  whether the last step writes Fluence()
  void Step(int steps, bool writes);
  std::vector<float> Fluence() const { return this->Shown.Read(); } ///< W / length^2, by own voxel
  /// Fluence at the given voxels only.
  std::vector<float> FluenceAt(const Buffer<cl_int>& voxels) const;

  /// Queues later steps on this queue instead of the device's.
  void StepOn(const cl::CommandQueue& queue) { this->Queue = queue; }
  void SetSource(const std::vector<float>& source); ///< LatticeVoxels::source, by known voxel
  /// Sets the source to light scattered from a fluence on the device, plus emission. Queued.
  /// @param scatters  by lattice place: fraction of the fluence that is scattered in a step through a voxel, times the
  ///   conversion from the fluence's unit to the lattice's
  /// @param emits  by lattice place: the source without that scattered light
  /// @param fluence  [voxel][channels]; only `channel` is used
  void SetSourceOf(
    const Buffer<float>& scatters, const Buffer<float>& emits, const Buffer<float>& fluence, int channels, int channel);

  /// Densities, [direction][stride].
  const Buffer<float>& Densities() const { return this->Now; }
  const LatticeInfo& Info() const { return this->TheInfo; }

  /// Light that escapes in a step, W / length^2, [face][voxel].
  std::vector<float> Leaving();
  /// The same for a fluence of 1 everywhere and black faces. Overwrites scratch of the next step, but not Densities().
  std::vector<float> LeavingOfOne();
  /// Net flux, W / length^2, [x, y, z][voxel].
  std::vector<float> NetFlux();

  /// Uploads values by known voxel in the layout of the lattice; 0 outside.
  Buffer<float> Placed(const std::vector<float>& values, const char* what) const;
  /// Array in the layout of the lattice, with inside(known voxel) or outside(face) at each place.
  template <class Inside, class Outside>
  std::vector<float> Arrange(const Inside& inside, const Outside& outside) const;

private:
  void LayOut(const LatticeVoxels& voxels);
  void Load(const LatticeVoxels& voxels);
  void FillDensities();
  void Wrap(const Buffer<float>& densities);
  void StepTogether(bool writes);
  void StepBlocks(int steps);
  std::vector<float> Leaving(const Buffer<float>& densities, const LatticeInfo& info);
  cl::Kernel Kernel(const char* name) const;

  Device& TheDevice;
  cl::CommandQueue Queue; ///< queue on which steps run
  const LatticeBox Box;
  const std::array<int, 3> Size;
  const LatticeSettings& Settings;
  LatticeInfo TheInfo = {};
  std::string Options;
  Buffer<float> Resistance, Turning, Kept, Squared, Albedo, Source, Endless, Shown;
  Buffer<float> Now, Next; ///< densities; with blocks, `Next` holds what the blocks exchange
  Buffer<float> Sends;     ///< with blocks: what they send next
};
}
