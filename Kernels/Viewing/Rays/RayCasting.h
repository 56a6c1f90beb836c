#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Viewing/Backdrop/Backdrop.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/ViewSettings.h"
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
  RayCasting(Device& device, const SceneOnDevice& scene, const PackedSamples& samples, const Backdrop& backdrop,
    const ViewTraits& traits)
    : TheDevice(device)
    , Scene(scene)
    , Samples(samples)
    , Behind(backdrop)
    , Traits(traits)
    , Passed(device, 0, "what the block lets through")
    , Missing(device, 0, "light at the surface")
    , Ends(device, 0, "where rays end")
    , Starts(device, 0, "what comes through other blocks")
  {
  }

  /// Kernel parameters of the picture, its camera and the backdrop.
  /// @throws InvalidInput for a degenerate camera or one too far away
  ViewInfo ViewOf(const Camera& camera, const ViewSettings& settings, const GridBlock* block) const;

  /// Allocates a picture and uploads the depths at which rays end (MediumRayCaster::Render); reuses buffers of the same
  /// size.
  /// @param starts  transmittance of the blocks in front, 3 per pixel; empty: 1
  /// @throws InvalidInput if `ends` does not have one value per pixel; DeviceError if memory does not suffice
  void Reserve(
    const ViewSettings& settings, const std::vector<float>& ends, bool ofBlock, const std::vector<float>& starts = {});

  /// Renders a picture from the current samples, with the part of the environment that belongs to them.
  /// @param from, to  progress that is reported at the begin and the end, in [0, 1]
  /// @throws Aborted
  void Cast(const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, double from, double to,
    const Monitor& monitor);

  // For bent rays, and rays that meet a table or a surface, through a block of a larger grid: they travel from block to
  // block. These functions need a view that OfRounds has changed.
  static void OfRounds(ViewInfo& view);
  /// Number of primary rays, with all rays that may be split off them, that fit into a quarter of the device's free
  /// memory; at least 1.
  std::size_t CountThatFits(const ViewSettings& settings) const;
  /// @param rows  rows up to the picture's end, or a multiple of four rows
  /// @return the rays through these pixels that enter the domain in this block, or that miss it and show the background
  ///   here
  std::vector<RayOnItsWay> Start(
    const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, const PixelRows& rows) const;
  /// Marches each ray to the block's boundary or to its end.
  /// @return rays that were split off on the way
  /// @throws Aborted
  std::vector<RayOnItsWay> March(const ViewSettings& settings, const ViewInfo& view, const OpticsInfo& optics,
    std::vector<RayOnItsWay>& rays, const Monitor& monitor) const;

  // Results of the last call of Cast, see Picture.
  std::vector<float> ReadRadiance() const { return this->Radiance.Read(); }
  std::vector<float> ReadAlpha() const { return this->Alpha.Read(); }
  std::vector<float> ReadDepth() const { return this->Depth.Read(); }
  std::vector<float> ReadTransmittance() const { return this->Passed.Read(); }
  std::vector<float> ReadMissing() const { return this->Missing.Read(); }

private:
  std::string Options(const ViewSettings& settings) const;
  std::string BentOptions(const ViewSettings& settings) const;
  std::size_t MostSplitOff(const ViewSettings& settings) const;
  cl::Kernel Kernel(const ViewSettings& settings, bool ofBlock) const;
  const Buffer<cl_float4>& Environment() const;

  Device& TheDevice;
  const SceneOnDevice& Scene;
  const PackedSamples& Samples;
  const Backdrop& Behind;
  const ViewTraits& Traits;
  Buffer<float> Radiance, Alpha, Depth, Passed, Missing, Ends, Starts;
};
}
