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
/// Rows of pixels [begin, end) of a picture.
struct PixelRows
{
  int begin, end;
};

/// Renders a picture: marches a straight or bent ray through every pixel and accumulates the packed sources and the
/// background.
class RayCasting
{
public:
  /// All arguments must outlive this object.
  /// @param part  position of the medium in a larger grid; null: the medium is the whole domain
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

  /// Kernel parameters of a picture.
  /// @param camera  camera of the picture
  /// @param block  block of a larger grid that the picture shows; null: the picture shows the whole domain
  /// @param sharp  whether this is the pass for unscattered light of a picture made of angular moments. This pass shows
  ///   the environment's peaks and determines the picture's alpha and depth (numerics.md, section 14.7)
  /// @throws InvalidInput for a degenerate camera or one too far away
  RayPass PassOf(const Camera& camera, const GridBlock* block, bool sharp) const;

  /// Renders a picture from the current samples.
  /// @param pass  parameters from PassOf
  /// @param ends  depths at which opaque surfaces end the rays, one per pixel (MediumRayCaster::Render); empty: no ray
  ///   ends
  /// @param starts  transmittance of the blocks in front, 3 per pixel; empty: 1
  /// @param from, to  progress that is reported at the start and at the end, in [0, 1]
  /// @throws InvalidInput if `ends` does not have one value per pixel; DeviceError if memory does not suffice; Aborted
  Picture Cast(RayPass pass, const std::vector<float>& ends, const std::vector<float>& starts, double from, double to,
    const Monitor& monitor);

  // The following functions march bent rays, and rays that meet a table or a surface, through a block of a larger grid;
  // such rays travel from block to block.

  /// Number of primary rays that fit into a quarter of the device's free memory, together with all rays that may be
  /// split off them; at least 1.
  std::size_t CountThatFits() const;
  /// Creates the primary rays that enter the domain in this block, and those that miss the domain if this block shows
  /// the background.
  /// @param rows  rows of pixels: a multiple of four, or all rows up to the picture's upper edge
  /// @return these rays
  std::vector<RayOnItsWay> Start(RayPass pass, const PixelRows& rows) const;
  /// Marches each ray to the block's boundary or to its end.
  /// @param rays  rays in this block; receive their new states
  /// @return rays that were split off in this block: reflected by the surface, or mirrored by the table
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
  Buffer<float> Pixels; ///< the picture on the device, in the layout of View.cl
  Buffer<float> Limits; ///< depths at which rays end, then transmittances of the blocks in front
};
}
