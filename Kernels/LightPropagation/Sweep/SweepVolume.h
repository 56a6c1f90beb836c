#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// The channels that share one sigma_t, with the arrays of their light, on the device during a solve. Every array has
/// the layout of VolumeLayout.
struct SweepVolume
{
  Grid grid;
  /// The part that is swept; rays start at its faces, where they would have entered; empty: the whole grid
  VoxelBox box;
  int channels = 1; ///< 1 or 3 that share one sigma_t
  std::size_t stride = 0;
  const AngularValues* angular = nullptr; ///< as in SweepRequest
  const Buffer<float>* sigma_t = nullptr; ///< 1/length
  std::size_t sigma_t_first = 0;          ///< index of the channel's first value
  const Buffer<float>* source = nullptr;  ///< W / (length^3 sr); null: no source
  Deposit deposit;                        ///< without flux if there are angular moments, which include it
  /// Index of the first channel's first value in source and path (in flux three times this index, in partialCurrents
  /// and firstMoments six times).
  std::size_t first = 0;
  const Buffer<float>* faceIn = nullptr;       ///< as in SweepRequest
  const Buffer<float>* octantSource = nullptr; ///< as in SweepRequest
  std::size_t faceFirst = 0;                   ///< index of the first channel's first value in faceIn and faceOut
  int firstChannel = 0;
  MomentPlaces moments = {}; ///< layout of the moments of source and path, if there are angular moments
};

/// The volume of a group of channels, without source.
SweepVolume GroupVolume(
  const VolumeLayout& layout, const ChannelGroup& group, const Buffer<float>& sigma_t, const Deposit& deposit);

/// The arrays of a volume as kernel arguments. An array that does not exist is replaced by another one, which the
/// kernels do not access.
struct VolumeArrays
{
  const Buffer<float>&sigma_t, &source, &octants, &path, &lost, &flux, &currents;
};

/// @param lost  rounding errors of the path (compensated summation); null: rays do not wrap around the marching axis
VolumeArrays ArraysOf(const SweepVolume& volume, const Buffer<float>* lost);

/// Arrays of a streamed volume.
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

/// Makes `buffer` hold at least `floats` floats, in device memory while any is left. A buffer that is too small is
/// freed first, so no work that uses it may be in progress.
void ReserveOnDevice(Device& device, Buffer<float>& buffer, std::size_t floats, const char* what);

/// Scratch memory shared by sweeps along different axes. Contents are undefined between sweeps.
struct SweepWorkspace
{
  Buffer<float> maps;    ///< rays of an open (not periodic) axis
  Buffer<float> scratch; ///< planes being crossed
  Buffer<float> lost;    ///< rounding errors of `path` (compensated summation), in sweeps round a periodic axis
  std::array<Buffer<float>, SlotSizes().size()> slots; ///< slots of streamed volumes (SliceStream.h)

  /// Ensures these sizes. No sweep may be in progress: buffers that are too small are freed first.
  void Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats);
  void ReserveLost(Device& device, std::size_t floats);
  void ReserveSlots(Device& device, const SlotSizes& floats);
};

/// A sweep of a volume whose groups of channels (VolumeLayout::Groups) are swept one after the other.
class SweepByGroups : public SweepOperator
{
public:
  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;

protected:
  /// @param sigma_t  must outlive the sweep
  SweepByGroups(const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request)
    : Layout(layout)
    , SigmaT(sigma_t)
    , Request(request)
  {
  }

  /// @param boundary  incident light of the group's channels (OfGroup)
  virtual SweepTally ApplyGroup(
    std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor) = 0;
  SweepVolume VolumeOf(std::size_t group, const Buffer<float>* source = nullptr) const;

  const VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  const SweepRequest Request;
};
}
