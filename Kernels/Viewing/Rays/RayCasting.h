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
/// Rows of a picture: from begin on, before end.
struct PixelRows
{
  int begin, end;
};

/// Rays through every pixel of a picture, straight or bent: they gather what samples shine and what is behind.
class RayCasting
{
public:
  /// What is given must stay.
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

  /// The picture and its camera as the kernels have them, seen against the backdrop.
  /// @throws InvalidInput for a camera that looks nowhere or is too far away
  ViewInfo ViewOf(const Camera& camera, const ViewSettings& settings, const GridBlock* block) const;

  /// Takes the memory of a picture, and where its rays end (MediumRayCaster::Render); keeps it for the next of that
  /// size.
  /// @param starts  of a block's rays: what comes through blocks before it, 3 per pixel; empty: all
  /// @throws InvalidInput for ends of another number than pixels; DeviceError if it does not fit
  void Reserve(
    const ViewSettings& settings, const std::vector<float>& ends, bool ofBlock, const std::vector<float>& starts = {});

  /// A picture of what was packed, and of what of the environment belongs to that.
  /// @param from, to  fractions done that are reported
  /// @throws Aborted
  void Cast(const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, double from, double to,
    const Monitor& monitor);

  // Rays that bend, or meet a table or a surface, through a block of a larger grid, where they go from block to block.
  // A view and optics of OfRounds.
  static void OfRounds(ViewInfo& view);
  /// Rays of pixels that may be here at once, with all that may be split off them, for a quarter of the memory that the
  /// device has left; at least one.
  std::size_t CountThatFits(const ViewSettings& settings) const;
  /// @param rows  to the picture's end, or multiples of four
  /// @return those through their pixels that enter the whole here, or show the background beside it.
  std::vector<RayOnItsWay> Start(
    const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, const PixelRows& rows) const;
  /// Takes each as far as the block goes, or to its end.
  /// @return those that were split off on the way
  /// @throws Aborted
  std::vector<RayOnItsWay> March(const ViewSettings& settings, const ViewInfo& view, const OpticsInfo& optics,
    std::vector<RayOnItsWay>& rays, const Monitor& monitor) const;

  // What was cast last, see Picture.
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
