#pragma once

#include "Viewing/Rays/Picture.h"

#include <array>
#include <cstdint>
#include <vector>

class vtkImageData;

namespace tyndall
{
/// Writes a picture as an image: point data `color` (red, green, blue, alpha), `radiance`, `alpha`, `depth`.
/// @param first  column and row of the picture's first pixel
/// @throws InvalidInput if a pixel is not finite; the message names it
void WritePicture(
  Picture&& picture, const std::array<int, 2>& first, std::vector<std::uint8_t>&& color, vtkImageData* output);
}
