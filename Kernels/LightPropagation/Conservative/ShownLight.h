#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Conservative/TransportParts.h"

namespace tyndall
{
/// What a camera needs to show scattered light along any direction: LightField::scatteredMoments and straightOn, in the
/// solver's units and channels (numerics.md, section 14.7). Of degrees so many as fit a gigabyte; `leftOut` says where
/// that is fewer than light was scattered in.
/// @param shown  IterationResult::shown
/// @param parts  their Path is written over
void AddShownLight(TransportParts& parts, const Buffer<float>& shown, LightField& light);
}
