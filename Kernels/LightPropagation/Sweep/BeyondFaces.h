#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

#include <functional>

namespace tyndall
{
/// Values of the neighbouring voxels just outside a block, at their faces that touch the block; taken from an array by
/// voxel face such as Deposit::partialCurrents.
struct BeyondFaces
{
  /// [channel][face][cell, x before y before z]; null: the block is the whole domain
  const Buffer<float>* values = nullptr;
  BeyondFacesInfo info = { { -1, -1, -1, -1, -1, -1 }, 0 };
};

/// Fetches these values from the ranks that own them. Collective. The result is valid until the next call.
using FetchBeyondFaces = std::function<BeyondFaces(const Buffer<float>& byFaces)>;
}
