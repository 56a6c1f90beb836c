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
/// Photon densities of one channel on a device (the light in each voxel along each link, W / length^2), and the lattice
/// steps that collide and stream them (numerics.md, section 10 c).
class Lattice
{
public:
  /// @param voxels  coefficients of all known voxels of the box
  Lattice(Device& device, const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Queues `steps` lattice steps. Before the first call densities are zero, except for incident light.
  /// @param writes  whether the last step writes the fluence
  void Step(int steps, bool writes);
  std::vector<float> Fluence() const { return this->Shown.Read(); } ///< fluence, W / length^2, by own voxel
  /// Fluence at the given own voxels, W / length^2.
  std::vector<float> FluenceAt(const Buffer<cl_int>& voxels) const;

  /// Makes Step() use `queue` instead of the device's queue.
  void StepOn(const cl::CommandQueue& queue) { this->Queue = queue; }
  /// replaces the array LatticeVoxels::source on the device; values are by known voxel
  void SetSource(const std::vector<float>& source);
  /// Sets the source to scatters times fluence plus `emits`. Queued. Arrays are in the layout of the lattice unless
  /// stated otherwise.
  /// @param scatters  fraction of the fluence that is scattered in a step through a voxel, times the conversion from
  ///   the unit of `fluence` to that of the lattice
  /// @param emits  source without that scattered light, W / length^2 per step
  /// @param fluence  uncollided fluence, [voxel][channels], of which `channel` is used
  void SetSourceOf(
    const Buffer<float>& scatters, const Buffer<float>& emits, const Buffer<float>& fluence, int channels, int channel);

  /// Densities after the last step, W / length^2, [direction][stride].
  const Buffer<float>& Densities() const { return this->Now; }
  const LatticeInfo& Info() const { return this->TheInfo; }

  /// Light that escapes through the box's faces in the next step, W / length^2, [face][voxel].
  std::vector<float> Leaving();
  /// Light that would escape in a step if the fluence were 1 everywhere and the faces were black, [face][voxel]. Does
  /// not change Densities().
  std::vector<float> LeavingOfOne();
  /// Computes the net flux, W / length^2, [x, y, z][voxel].
  std::vector<float> NetFlux();

  /// Copies values by known voxel to a device array in the layout of the lattice; 0 outside the box.
  Buffer<float> Placed(const std::vector<float>& values, const char* what) const;
  /// Array in the layout of the lattice: inside(known voxel) in the box and its ghost voxels, outside(face) beyond the
  /// box's faces, where at edges of the box the mean over faces is taken.
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
  cl::CommandQueue Queue; ///< command queue for steps
  const LatticeBox Box;
  const std::array<int, 3> Size;
  const LatticeSettings& Settings;
  LatticeInfo TheInfo = {};
  std::string Options;
  Buffer<float> Resistance, Turning, Kept, Squared, Albedo, Source, Endless, Shown;
  /// Densities before and after a step. If the lattice steps in blocks, Next holds the light that blocks receive from
  /// each other.
  Buffer<float> Now, Next;
  Buffer<float> Sends; ///< if the lattice steps in blocks: light that blocks send to each other
};
}
