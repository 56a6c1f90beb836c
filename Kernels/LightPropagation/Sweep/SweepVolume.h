#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/BoxFaces.h"
#include "Medium/VoxelBox.h"

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
  Deposit deposit;
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
inline SweepVolume GroupVolume(
  const VolumeLayout& layout, const ChannelGroup& group, const Buffer<float>& sigma_t, const Deposit& deposit)
{
  SweepVolume volume;
  volume.grid = layout.grid;
  volume.channels = group.count;
  volume.stride = layout.Stride();
  volume.sigma_t = &sigma_t;
  volume.sigma_t_first = layout.ExtinctionFirst(group.first);
  volume.deposit = deposit;
  volume.first = group.first * layout.Stride();
  volume.faceFirst = group.first * BoxFaceCellCount(layout.grid);
  volume.firstChannel = group.first;
  return volume;
}
}
