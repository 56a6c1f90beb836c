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
/// A cell is the cube between eight neighbouring samples. The grid has a border of one voxel; cell (i, j, k) has its
/// sample (i, j, k) as lower corner, so an axis of n voxels has n + 1 cells. A brick is a cube of 8^3 cells. It has a
/// record: all samples at its cells' corners, x fastest. Samples on the upper faces of a brick are also in the next
/// brick's record, so that interpolation reads one record only. All empty bricks have record 0, which is zero.
struct SampleBricks
{
  std::array<int, 3> count = { 0, 0, 0 }; ///< number of bricks of 8^3 cells along each axis
  /// Number of samples of a record (the samples of one brick) along each axis.
  std::array<int, 3> edges = { 0, 0, 0 };
  /// For each brick, x fastest, the index of its record's first sample; 0 for empty bricks.
  std::vector<cl_int> first;
  /// For each record, the index of the brick that it belongs to; -1 for record 0, which empty bricks share.
  std::vector<cl_int> bricks;

  std::size_t SamplesEach() const
  {
    return static_cast<std::size_t>(this->edges[0]) * static_cast<std::size_t>(this->edges[1]) *
      static_cast<std::size_t>(this->edges[2]);
  }
  std::size_t SampleCount() const { return this->bricks.size() * this->SamplesEach(); }
};

/// Layout for the filled bricks of a medium.
/// @param paired  whether each sample also holds the next sample along y; records then omit the samples on the upper y
///   faces
SampleBricks SampleBricksOf(const FilledBricks& filled, const Grid& grid, bool paired);

/// Purpose for which samples are packed.
enum class Packing
{
  ForShadowRays,
  Scattered,  ///< camera rays that accumulate scattered and emitted light
  Unscattered ///< camera rays through the unlit medium: transmittance for light that is not scattered at all
};

/// Source and extinction of every voxel with a border of one voxel, in the layout that the marching kernels read, and
/// the map of empty bricks. Arrays that the scene does not need are empty. Voxels that no ray samples are not packed:
/// their samples are zero, and on a CPU they use no memory. (A packet advances as long as one of its rays has not
/// ended, so other rays of the packet may read such zeros.)
class PackedSamples
{
public:
  /// Allocates the samples, and packs the gradient of n^2.
  /// @param traits  must outlive this object
  /// @param block   position of the medium in a larger grid; null: the medium is the whole domain
  /// @throws DeviceError if the samples do not fit the device
  PackedSamples(Device& device, const FilledBricks& filled, const SceneOnDevice& scene, const ViewTraits& traits,
    const BlockOfScene* block);

  /// Packs samples of the medium and its light for one purpose: shadow rays, or camera rays.
  /// @param direct, diffuse  light from SeenSources; read if `what` is for camera rays
  void Pack(Packing what, const SceneOnDevice& scene, const Buffer<float>& direct, const Buffer<float>& diffuse);

  // The following functions describe what the last call of Pack packed.
  Packing PackedFor() const { return this->For; }
  /// Compiler options that define SHOWN and BEAMS, by which kernels know what the samples hold.
  std::string ShownOptions() const;
  bool HasEmptyBricks() const { return this->EmptyBricks; }

  /// Source and grey extinction of each sample. Layout: ScatteredLight.cl; for angular moments ShownSamples.cl.
  const cl::Buffer& Samples() const { return this->Sources.Handle(); }
  const cl::Buffer& Extinctions() const { return this->ColouredExtinctions.Handle(); }
  /// The array of samples that holds the extinction: coloured extinctions, or sources with grey extinction.
  const cl::Buffer& Sigma() const { return this->Traits.coloured ? this->Extinctions() : this->Samples(); }
  /// Per sample: the light's mean direction, multiplied by g if ViewTraits::FlowHasG; with angular moments the lamps'
  /// light instead (ShownSamples.cl).
  const cl::Buffer& Flow() const { return this->Directions.Handle(); }
  const cl::Buffer& Glow() const { return this->Emission.Handle(); } ///< emission, if ViewTraits::GlowsApart
  /// mean cosine g by voxel for red, green, blue
  const cl::Buffer& Cosines() const { return this->ColouredG.Handle(); }
  /// Half the gradient of n^2 (x, y, z), and n^2 (w).
  const Buffer<cl_float4>& Bending() const { return this->Gradients; }
  /// For each brick, the distance in bricks to the nearest brick of another class: above 0 for empty bricks, below 0
  /// for filled ones, at most 127; 0 where rays bend.
  const Buffer<cl_char>& Bricks() const { return this->Distances; }
  /// For each brick, the index of the first of its samples; 0 for empty bricks. Empty if samples are not stored in
  /// bricks.
  const Buffer<cl_int>& Records() const { return this->First; }
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
  std::array<int, 3> KnownSize; ///< number of voxels along each axis whose gradient of n^2 is stored
  /// Along each axis, how many of the KnownSize voxels precede the first voxel of the medium's arrays.
  std::array<int, 3> KnownBefore = {};
  SampleBricks InBricks; ///< layout in bricks, if ViewTraits::bricked
  Packing For = Packing::ForShadowRays;
  bool EmptyBricks = false;
  ZeroedBuffer<cl_float4> Sources, ColouredExtinctions, Directions, ColouredG, Emission;
  Buffer<cl_float4> Gradients;
  Buffer<cl_char> Distances;
  Buffer<cl_uchar> Seen;       ///< for each brick, 1 if rays must sample it, else 0 (SeenBricks::seen)
  Buffer<cl_uchar> SeenGroups; ///< for each work-group, whether it packs voxels that rays see (SampleLayout.cl)
  Buffer<cl_int> First, BricksOfRecords; ///< SampleBricks::first and SampleBricks::bricks on the device
};
}
