#pragma once

#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"

#include <array>
#include <optional>
#include <vector>

namespace tyndall
{
/// A picture that vtkLitVolumeMapper asks its ray caster for.
struct AskedView
{
  Camera camera;                ///< instead of the filter's own
  std::array<int, 2> size = {}; ///< pixels, instead of ImageSize
  std::vector<float> ends;      ///< of rays, see MediumRayCaster::Render
  double exposure = 0.0; ///< with which the picture will be shown, for BackgroundColor's radiance; 0: none is known
  std::optional<GridBlock> block; ///< of which the medium is a part, see MediumRayCaster::Render
};
}
