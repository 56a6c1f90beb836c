#pragma once

#include "LightPropagation/Angular/AngularValues.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/BoxFaces.h"
#include "Medium/VoxelBox.h"

namespace tyndall
{
/// Channels that share one sigma_t, with the light that is found in them, on the device while a solver runs. Every
/// array is laid out as VolumeLayout says.
struct SweepVolume
{
  Grid grid;
  VoxelBox box;     ///< the part that is swept: rays start at its faces, where they would have come in; empty: all
  int channels = 1; ///< 1 or 3 that share one sigma_t
  std::size_t stride = 0;
  const AngularValues* angular = nullptr; ///< as in SweepRequest
  const Buffer<float>* sigma_t = nullptr; ///< 1/length
  std::size_t sigma_t_first = 0;          ///< where its channel begins
  const Buffer<float>* source = nullptr;  ///< W / (length^3 sr); null: the medium is dark
  Deposit deposit;
  /// Where the first channel of source and path begins (flux: three times that, partialCurrents and firstMoments: six
  /// times).
  std::size_t first = 0;
  const Buffer<float>* faceIn = nullptr;       ///< as in SweepRequest
  const Buffer<float>* octantSource = nullptr; ///< the same
  std::size_t faceFirst = 0;                   ///< where the first channel of faceIn and faceOut begins
  int firstChannel = 0;
  MomentPlaces moments = {}; ///< of source and path, where light has angular moments
};

/// The channels of a group as a sweep sees them, without source.
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
