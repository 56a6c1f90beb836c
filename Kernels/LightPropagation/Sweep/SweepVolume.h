#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Channels of a grid that share one sigma_t, and the device arrays of their sources and deposit during a solve. Every
/// array has the layout of VolumeLayout.
struct SweepVolume
{
  Grid grid;
  /// Region of the grid that is swept; empty: the whole grid. Rays start at the region's faces, at the positions where
  /// rays that start at the grid's faces would arrive
  VoxelBox box;
  int channels = 1; ///< number of channels that share one sigma_t: 1 or 3
  std::size_t stride = 0;
  /// Values of the angular functions, as SweepRequest::angular; null: fluence only
  const AngularValues* angular = nullptr;
  const Buffer<float>* sigma_t = nullptr; ///< extinction, 1/length
  std::size_t sigma_t_first = 0;          ///< index of the first channel's first value in sigma_t
  const Buffer<float>* source = nullptr;  ///< source, W / (length^3 sr); null: no source
  Deposit deposit;                        ///< output arrays; no flux if there are angular moments, which include it
  /// Index of the first channel's first value in source and path. In flux it is three times this index, in
  /// partialCurrents and firstMoments six times.
  std::size_t first = 0;
  /// Incident radiance per cell of the box's faces, SweepRequest::faceIn; null: none
  const Buffer<float>* faceIn = nullptr;
  /// Additional source per octant of directions, SweepRequest::octantSource; null: none
  const Buffer<float>* octantSource = nullptr;
  std::size_t faceFirst = 0; ///< index of the first channel's first cell in faceIn and faceOut
  int firstChannel = 0;
  bool skipsEmpty = false;   ///< SweepRequest::skipsEmpty
  MomentPlaces moments = {}; ///< memory layout of source and path, if these have angular moments
};

/// Volume of a group of channels, without a source.
SweepVolume GroupVolume(
  const VolumeLayout& layout, const ChannelGroup& group, const Buffer<float>& sigma_t, const Deposit& deposit);

/// Arrays of a volume as kernel arguments. An array that does not exist is replaced by another one, which the kernels
/// do not access.
struct VolumeArrays
{
  const Buffer<float>&sigma_t, &source, &octants, &path, &lost, &flux, &currents;
};

/// Arrays of `volume`, as kernel arguments.
/// @param lost  rounding errors of the path integral (compensated summation); null: rays do not wrap around the
/// marching axis
VolumeArrays ArraysOf(const SweepVolume& volume, const Buffer<float>* lost);

/// Arrays of a volume in host memory that are copied to the device slice by slice.
enum class SlotArray
{
  SigmaT,
  Source,
  Path,
  Lost,
  Flux,
  PartialCurrents,
  OctantSource,
  Count
};
using SlotSizes = std::array<std::size_t, static_cast<std::size_t>(SlotArray::Count)>;

/// Enlarges `buffer` to at least `floats` floats, in device memory as far as it is available. A buffer that is too
/// small is freed first, so no work that uses it may be in progress.
void ReserveOnDevice(Device& device, Buffer<float>& buffer, std::size_t floats, const char* what);

/// Scratch memory shared by sweeps along different axes. Its contents are undefined between sweeps.
struct SweepWorkspace
{
  Buffer<float> maps; ///< power of the rays of an open (not periodic) axis, W
  /// Source, path integral and other quantities of the planes that are being crossed (SweepShared.h)
  Buffer<float> scratch;
  Buffer<float> lost; ///< rounding errors of `path` (compensated summation), in sweeps along a periodic axis
  /// Slots of streamed volumes: device buffers that hold a few planes (SliceStream.h)
  std::array<Buffer<float>, SlotSizes().size()> slots;

  /// Enlarges `maps` and `scratch` to these sizes. No sweep may be in progress, because buffers that are too small are
  /// freed first.
  void Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats);
  void ReserveLost(Device& device, std::size_t floats);
  void ReserveSlots(Device& device, const SlotSizes& floats);
};

/// Sweep that treats the groups of channels of a volume (VolumeLayout::Groups) one after another.
class SweepByGroups : public SweepOperator
{
public:
  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;

protected:
  /// @param sigma_t  extinction, 1/length; must outlive the sweep
  SweepByGroups(const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request)
    : Layout(layout)
    , SigmaT(sigma_t)
    , Request(request)
  {
  }

  /// Sweeps one group of channels.
  /// @param boundary  incident light of the group's channels (OfGroup)
  virtual SweepTally ApplyGroup(
    std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor) = 0;
  SweepVolume VolumeOf(std::size_t group, const Buffer<float>* source = nullptr) const;

  const VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  const SweepRequest Request;
};
}
