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
/// Photon density of one channel on a device, which moves from voxel to voxel in steps.
class Lattice
{
public:
  /// @param voxels  the known ones of the box
  Lattice(Device& device, const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Queues so many steps, from darkness but for incident light.
  /// @param writes  whether the last one writes Fluence()
  void Step(int steps, bool writes);
  std::vector<float> Fluence() const { return this->Shown.Read(); } ///< W / length^2, by voxel
  /// At these voxels only.
  std::vector<float> FluenceAt(const Buffer<cl_int>& voxels) const;

  /// From now on steps are queued on this queue instead of the device's.
  void StepOn(const cl::CommandQueue& queue) { this->Queue = queue; }
  void SetSource(const std::vector<float>& source); ///< by known voxel, as LatticeVoxels has it
  /// Sets the source to what is scattered of a fluence on the device, and what is emitted. Queued.
  /// @param scatters  by place of the lattice: part of the fluence that a step's way through a voxel scatters, times
  ///   what its units are in the lattice's
  /// @param emits     by place: the source without that light
  /// @param fluence   [voxel][channels], of which `channel` is used
  void SetSourceOf(
    const Buffer<float>& scatters, const Buffer<float>& emits, const Buffer<float>& fluence, int channels, int channel);

  /// [direction][stride]
  const Buffer<float>& Densities() const { return this->Now; }
  const LatticeInfo& Info() const { return this->TheInfo; }

  /// W / length^2 that escape in a step, [face][voxel].
  std::vector<float> Leaving();
  /// The same for fluence 1 everywhere and black faces. Overwrites scratch of the next step, but not Densities().
  std::vector<float> LeavingOfOne();
  /// W / length^2, [x, y, z][voxel].
  std::vector<float> NetFlux();

  /// Values by known voxel on the device, by place of the lattice; 0 outside.
  Buffer<float> Placed(const std::vector<float>& values, const char* what) const;
  /// A value of each place of the lattice: inside(known voxel), or outside(face).
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
  cl::CommandQueue Queue; ///< of steps
  const LatticeBox Box;
  const std::array<int, 3> Size;
  const LatticeSettings& Settings;
  LatticeInfo TheInfo = {};
  std::string Options;
  Buffer<float> Resistance, Turning, Kept, Squared, Albedo, Source, Endless, Shown;
  Buffer<float> Now, Next; ///< densities; with blocks, `Next` is what they exchange
  Buffer<float> Sends;     ///< with blocks: what they send next
};
}
