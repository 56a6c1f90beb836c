#pragma once

#include "Device/Buffer.h"
#include "Device/ZeroedBuffer.h"
#include "Viewing/Samples/SampleBricks.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/ViewTraits.h"

#include <array>
#include <string>

namespace tyndall
{
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
  Buffer<cl_uchar> SeenGroups;           ///< Border.cl
  Buffer<cl_int> First, BricksOfRecords; ///< of InBricks
};
}
