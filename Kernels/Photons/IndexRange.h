#pragma once

#include "../Medium/Medium.h"

namespace tyndall
{
/// @throws InvalidInput where the index is not finite and positive, naming the first such voxel
void CheckIndex(const Field& ior, const Grid& grid);

/// Whether the index varies by more than rounding does. Null values are 1 everywhere.
bool IndexVaries(const Field& ior, const Grid& grid);
}
