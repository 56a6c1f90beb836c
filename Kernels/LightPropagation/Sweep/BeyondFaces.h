#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

#include <functional>

namespace tyndall
{
/// Of an array by faces of voxels, as Deposit::partialCurrents, of a block of a grid: what the voxels beyond the
/// block's faces have at their faces that touch it.
struct BeyondFaces
{
  const Buffer<float>* values = nullptr; ///< [channel][face][cell, x before y before z]; null: the block is the whole
  BeyondFacesInfo info = { { -1, -1, -1, -1, -1, -1 }, 0 };
};

/// Fetches that from the ranks that have it. All ranks call it; what it found lasts until the next time.
using FetchBeyondFaces = std::function<BeyondFaces(const Buffer<float>& byFaces)>;
}
