#pragma once

#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"

#include <vector>

namespace tyndall
{
/// The numbers of blocks of one grid, from front to back: no ray of the camera meets one of them after one that stands
/// later. Where blocks hide each other in a circle, which those of a tree of planes do not, that cannot be for all.
std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera);
}
