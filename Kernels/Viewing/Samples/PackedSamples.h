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
/// What samples are packed for.
enum class Packing
{
  ForShadowRays,
  Scattered,  ///< what the camera's rays meet
  Unscattered ///< the same in the dark: how much of what is behind comes through without being scattered at all
};

/// What rays meet: source and extinction by voxel, with a border of one voxel around, and bricks in which there is
/// nothing. Arrays that the scene does not need are empty. Of voxels that rays do not see nothing is packed: those
/// samples are zero (packets step as long as one of their rays sees something), and on a CPU they take no memory.
class PackedSamples
{
public:
  /// Takes the memory, and packs how rays bend.
  /// @param traits  must stay
  /// @param block   of which the medium is one; null: of none
  /// @throws DeviceError if the samples do not fit
  PackedSamples(Device& device, const FilledBricks& filled, const SceneOnDevice& scene, const ViewTraits& traits,
    const BlockOfScene* block);

  /// @param direct, diffuse  see SeenSources.h; read where `what` is for the camera's rays
  void Pack(Packing what, const SceneOnDevice& scene, const Buffer<float>& direct, const Buffer<float>& diffuse);

  // Of the last packing.
  Packing PackedFor() const { return this->For; }
  std::string ShownOptions() const; ///< SHOWN and BEAMS of the kernels
  bool HasEmptyBricks() const { return this->EmptyBricks; }

  const cl::Buffer& Samples() const { return this->Sources.Handle(); } ///< source, grey extinction: ScatteredLight.cl
  const cl::Buffer& Extinctions() const { return this->ColouredExtinctions.Handle(); }
  /// Mean direction, times g where ViewTraits::FlowHasG; of ShownSamples.cl lamps' light.
  const cl::Buffer& Flow() const { return this->Directions.Handle(); }
  const cl::Buffer& Glow() const { return this->Emission.Handle(); }     ///< where ViewTraits::GlowsApart
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
  std::array<int, 3> KnownSize;        ///< voxels of which it is known how rays bend
  std::array<int, 3> KnownBefore = {}; ///< how many of them are before the first of the samples
  SampleBricks InBricks;               ///< where ViewTraits::bricked
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
