#pragma once

#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"

#include <array>
#include <optional>
#include <vector>

namespace tyndall
{
/// Request of vtkLitVolumeMapper to its ray caster for one picture.
struct AskedView
{
  Camera camera;                  ///< replaces the filter's own camera
  std::array<int, 2> size = {};   ///< pixels, replaces ImageSize
  std::vector<float> ends;        ///< length at which each ray ends, see MediumRayCaster::Render
  double exposure = 0.0;          ///< of the display, to convert BackgroundColor to radiance; 0: not known yet
  std::optional<GridBlock> block; ///< the block of a larger grid that the medium is, see MediumRayCaster::Render
};
}
