#pragma once

#include "LpmTables.h"

namespace bench
{
/// Targets for speed, memory and agreement, each with what was measured and whether it is met.
void PrintTargets(const std::vector<Case>& cases);
}
