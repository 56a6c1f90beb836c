#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Viewing/Backdrop/Backdrop.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Rows [begin, end) of a picture.
struct PixelRows
{
  int begin, end;
};

/// Marches straight or bent rays through every pixel of a picture, and accumulates the packed sources and the
/// background.
class RayCasting
{
public:
  /// All arguments must outlive this object.
  /// @param part  the medium's place in a larger grid; null: the medium is the whole domain
  RayCasting(Device& device, const SceneOnDevice& scene, const PackedSamples& samples, const Backdrop& backdrop,
    const ViewTraits& traits, const ViewSettings& settings, const BlockOfScene* part)
    : TheDevice(device)
    , Scene(scene)
    , Samples(samples)
    , Behind(backdrop)
    , Traits(traits)
    , Settings(settings)
    , Part(part)
    , Limits(device, 0, "where rays end")
  {
  }

  /// @param block  set if the picture is that of a block of a larger grid
  /// @param sharp  the pass for unscattered light, which alone shows a sharp background, and which gives the picture's
  ///   alpha and depth (numerics.md, section 14.7)
  /// @throws InvalidInput for a degenerate camera or one too far away
  RayPass PassOf(const Camera& camera, const GridBlock* block, bool sharp) const;

  /// Renders a picture from the current samples.
  /// @param ends    depths at which rays end (MediumRayCaster::Render)
  /// @param starts  transmittance of the blocks in front, 3 per pixel; empty: 1
  /// @param from, to  progress that is reported at the begin and the end, in [0, 1]
  /// @throws InvalidInput if `ends` does not have one value per pixel; DeviceError if memory does not suffice; Aborted
  Picture Cast(RayPass pass, const std::vector<float>& ends, const std::vector<float>& starts, double from, double to,
    const Monitor& monitor);

  // For bent rays, and rays that meet a table or a surface, through a block of a larger grid: they travel from block to
  // block.
  /// Number of primary rays, with all rays that may be split off them, that fit into a quarter of the device's free
  /// memory; at least 1.
  std::size_t CountThatFits() const;
  /// @param rows  rows up to the picture's end, or a multiple of four rows
  /// @return the rays through these pixels that enter the domain in this block, or that miss it and show the background
  ///   here
  std::vector<RayOnItsWay> Start(RayPass pass, const PixelRows& rows) const;
  /// Marches each ray to the block's boundary or to its end.
  /// @return rays that were split off on the way
  /// @throws Aborted
  std::vector<RayOnItsWay> March(RayPass pass, std::vector<RayOnItsWay>& rays, const Monitor& monitor) const;

private:
  ViewInfo ViewOf(const Camera& camera, const GridBlock* block) const;
  OpticsInfo OpticsOf() const;
  std::string Options(const std::string& ofKernel) const;
  std::string BentOptions(bool rounds) const;
  void Reserve(std::size_t values, const std::vector<float>& ends, const std::vector<float>& starts);
  Picture Read(const ViewInfo& view, bool missing) const;
  std::size_t MostSplitOff() const;
  cl::Kernel Kernel(bool ofBlock) const;

  Device& TheDevice;
  const SceneOnDevice& Scene;
  const PackedSamples& Samples;
  const Backdrop& Behind;
  const ViewTraits& Traits;
  const ViewSettings& Settings;
  const BlockOfScene* Part;
  Buffer<float> Pixels; ///< the picture, see View.cl
  Buffer<float> Limits; ///< ends of rays, and transmittance of the blocks in front of each
};
}
