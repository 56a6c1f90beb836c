#pragma once

#include "Device/Device.h"

namespace bench
{
/// Slabs that scatter forwards and backwards: light propagation maps in angular moments and by the similarity relation,
/// and other people's programs, against adding-doubling.
void PrintForwardSlabs(tyndall::Device& device, bool quick);
}
