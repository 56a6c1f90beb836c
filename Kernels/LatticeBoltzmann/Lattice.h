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
  /// @param voxels  coefficients of the box's own voxels and its ghost voxels
  Lattice(Device& device, const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Queues `steps` lattice steps. Before the first call densities are zero, except for incident light.
  /// @param writes  whether the last step writes the fluence
  void Step(int steps, bool writes);
  /// Fluence, W / length^2, by voxel of this rank's block (own voxel).
  std::vector<float> Fluence() const { return this->Shown.Read(); }
  /// Fluence at the voxels of this rank's block with the given indices, W / length^2.
  std::vector<float> FluenceAt(const Buffer<cl_int>& voxels) const;

  /// Makes Step() use `queue` instead of the device's queue.
  void StepOn(const cl::CommandQueue& queue) { this->Queue = queue; }
  /// replaces the isotropic source on the device (LatticeVoxels::source); values are by own and ghost voxel
  void SetSource(const std::vector<float>& source);
  /// Queues a kernel that sets the source to scatters times fluence plus `emits`. Arrays are in the layout of
  /// LatticeInfo (rows of voxels with a halo) unless stated otherwise.
  /// @param scatters  fraction of the fluence that is scattered in a step through a voxel, times the conversion from
  ///   the unit of `fluence` to that of the lattice
  /// @param emits  source without that scattered light, W / length^2 per step
  /// @param fluence  uncollided fluence, [voxel][channel], of which `channel` is used
  void SetSourceOf(
    const Buffer<float>& scatters, const Buffer<float>& emits, const Buffer<float>& fluence, int channels, int channel);

  /// Densities after the last step, W / length^2, [direction][voxel] in the layout of LatticeInfo, `stride` values per
  /// direction.
  const Buffer<float>& Densities() const { return this->Now; }
  const LatticeInfo& Info() const { return this->TheInfo; }

  /// Light that escapes through the box's faces in the next step, W / length^2, [face][voxel].
  std::vector<float> Leaving();
  /// Light that would escape in a step if the fluence were 1 everywhere and the faces were black, [face][voxel]. Does
  /// not change Densities().
  std::vector<float> LeavingOfOne();
  /// Computes the net flux, W / length^2, [x, y, z][voxel].
  std::vector<float> NetFlux();

  /// Copies values by own and ghost voxel to a device array in the layout of LatticeInfo; 0 outside the box.
  Buffer<float> Placed(const std::vector<float>& values, const char* what) const;
  /// Array in the layout of LatticeInfo: inside(index) at the own and ghost voxels, and outside(face) in the layer of
  /// values beyond the box's faces; at edges of the box the mean of outside() over the faces.
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
  /// Densities before (Now) and after a step (Next). If the lattice steps in blocks, Next holds the light that blocks
  /// receive from each other.
  Buffer<float> Now, Next;
  Buffer<float> Sends; ///< if the lattice steps in blocks: light that blocks send to each other
};
}
