#pragma once

#include "Device/Buffer.h"
#include "Device/HostMappedBuffer.h"
#include "Device/OpenCL.h"
#include "Medium/FilledBricks.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Memory layout of samples in bricks, for a medium that is mostly empty.
///
/// A cell is the cube between eight neighbouring samples: cell (i, j, k) has sample (i, j, k) of the grid with its
/// border of one voxel as its lower corner, so an axis of n voxels has n + 1 cells. A brick of 8^3 cells owns a record:
/// all samples at its cells' corners, x fastest, including those on its upper faces, which the next brick's record
/// repeats, so that interpolation reads one record only. Empty bricks share record 0, which is zero.
struct SampleBricks
{
  std::array<int, 3> count = { 0, 0, 0 }; ///< bricks of cells along each axis
  std::array<int, 3> edges = { 0, 0, 0 }; ///< samples of a record along each axis
  std::vector<cl_int> first;              ///< index of the first sample of each brick's record, bricks x fastest
  std::vector<cl_int> bricks;             ///< the brick that owns each record; -1: none

  std::size_t SamplesEach() const
  {
    return static_cast<std::size_t>(this->edges[0]) * static_cast<std::size_t>(this->edges[1]) *
      static_cast<std::size_t>(this->edges[2]);
  }
  std::size_t SampleCount() const { return this->bricks.size() * this->SamplesEach(); }
};

/// @param paired  each sample also holds the next one along y, so the samples on the upper y faces are left out
SampleBricks SampleBricksOf(const FilledBricks& filled, const Grid& grid, bool paired);

/// What the packed samples are used for.
enum class Packing
{
  ForShadowRays,
  Scattered,  ///< camera rays that collect scattered and emitted light
  Unscattered ///< camera rays through the unlit medium: transmittance for light that is not scattered at all
};

/// Source and extinction of every voxel as the marching kernels read them, with a border of one voxel, and the map of
/// empty bricks. Arrays that the scene does not need are empty. Voxels that no ray can see are not packed: their
/// samples stay zero, because a packet keeps stepping while one of its rays sees something; on a CPU they take no
/// memory.
class PackedSamples
{
public:
  /// Allocates the samples, and packs the gradient of n^2.
  /// @param traits  must outlive this object
  /// @param block   the medium's place in a larger grid; null: the medium is the whole domain
  /// @throws DeviceError if the samples do not fit
  PackedSamples(Device& device, const FilledBricks& filled, const SceneOnDevice& scene, const ViewTraits& traits,
    const BlockOfScene* block);

  /// @param direct, diffuse  see SeenSources.h; read if `what` is for camera rays
  void Pack(Packing what, const SceneOnDevice& scene, const Buffer<float>& direct, const Buffer<float>& diffuse);

  // State after the last call of Pack.
  Packing PackedFor() const { return this->For; }
  std::string ShownOptions() const; ///< compiler options SHOWN and BEAMS
  bool HasEmptyBricks() const { return this->EmptyBricks; }

  /// source and grey extinction, see ScatteredLight.cl
  const cl::Buffer& Samples() const { return this->Sources.Handle(); }
  const cl::Buffer& Extinctions() const { return this->ColouredExtinctions.Handle(); }
  /// Samples that hold the extinction: coloured, or with the source.
  const cl::Buffer& Sigma() const { return this->Traits.coloured ? this->Extinctions() : this->Samples(); }
  /// The light's mean direction, times g if ViewTraits::FlowHasG; with ShownSamples.cl, the lamps' light.
  const cl::Buffer& Flow() const { return this->Directions.Handle(); }
  const cl::Buffer& Glow() const { return this->Emission.Handle(); }     ///< emission, if ViewTraits::GlowsApart
  const cl::Buffer& Cosines() const { return this->ColouredG.Handle(); } ///< coloured g by voxel
  const Buffer<cl_float4>& Bending() const { return this->Gradients; }   ///< gradient of n^2, and n^2
  const Buffer<cl_char>& Bricks() const { return this->Distances; }      ///< see FindDistances
  const Buffer<cl_int>& Records() const { return this->First; }          ///< SampleBricks::first
  const std::array<int, 3>& BrickCount() const { return this->Count; }

private:
  void PackBending(const Grid& known, const Buffer<float>& ior);
  PackInfo InfoOf(const ViewedComponents& components) const;
  void PackSources(const SceneOnDevice& scene, const Buffer<float>& direct);
  void PackShown(const SceneOnDevice& scene, const Buffer<float>& direct, const Buffer<float>& diffuse);
  void Launch(cl::Kernel& kernel, const std::array<int, 3>& size);
  void FindBricks(bool bends, bool shown);

  Device& TheDevice;
  const ViewTraits& Traits;
  std::array<int, 3> Count;
  std::array<int, 3> KnownSize;        ///< voxels whose gradient of n^2 is stored
  std::array<int, 3> KnownBefore = {}; ///< how many of them precede the first sample, along each axis
  SampleBricks InBricks;               ///< used if ViewTraits::bricked
  Packing For = Packing::ForShadowRays;
  bool EmptyBricks = false;
  ZeroedBuffer<cl_float4> Sources, ColouredExtinctions, Directions, ColouredG, Emission;
  Buffer<cl_float4> Gradients;
  Buffer<cl_char> Distances;
  Buffer<cl_uchar> Seen;                 ///< SeenBricks::seen
  Buffer<cl_uchar> SeenGroups;           ///< SampleLayout.cl
  Buffer<cl_int> First, BricksOfRecords; ///< of InBricks
};
}
