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
/// Photon density of one channel on a device, that goes from voxel to voxel by steps.
class Lattice
{
public:
  /// @param voxels  the known ones of the box
  Lattice(Device& device, const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// So many steps, dark before the first but for what comes in. Queued, not waited for.
  /// @param writes  fluence of the last of them is to be there
  void Step(int steps, bool writes);
  std::vector<float> Fluence() const { return this->Shown.Read(); } ///< W / length^2, by voxel
  /// The same at these voxels alone.
  std::vector<float> FluenceAt(const Buffer<cl_int>& voxels) const;

  /// Steps are queued here from now on, and not on the device's own queue.
  void StepOn(const cl::CommandQueue& queue) { this->Queue = queue; }
  void Shine(const std::vector<float>& source); ///< by known voxel, as LatticeVoxels has it
  /// Light that has its fluence on the device is scattered, beside what the medium emits. Queued.
  /// @param scatters  by place of the lattice: part of the fluence that a step's way through a voxel scatters, times
  ///   what its units are in the lattice's
  /// @param glows     by place: what begins in a voxel without that light
  /// @param fluence   [voxel][channels], of which `channel` is taken
  void ShineBy(
    const Buffer<float>& scatters, const Buffer<float>& glows, const Buffer<float>& fluence, int channels, int channel);

  /// Densities, [direction][stride], for what leaves and flows.
  const Buffer<float>& Densities() const { return this->Now; }
  const LatticeInfo& Info() const { return this->TheInfo; }

  /// W / length^2 that leave in a step, [face][voxel].
  std::vector<float> Leaving();
  /// The same, of what would leave through black faces if there were fluence 1 everywhere. Overwrites what the next
  /// step would begin with elsewhere than in Densities().
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
  Buffer<float> Now, Next; ///< densities; of blocks `Next` is what they send each other
  Buffer<float> Sends;     ///< of blocks: what they are about to send
};
}
