#pragma once

#include "TargetScenes.h"

#include "Device/Device.h"

namespace bench
{
/// How errors of fluence fall with the number of directions, of all light, of scattered light alone and of unscattered
/// light alone, against 900 directions a face and 2500 of unscattered light on the same grid: what the table in
/// DirectionForecast.cxx was taken from.
void PrintFalls(tyndall::Device& device, const std::vector<TargetScene>& scenes);
}
