#pragma once

namespace tyndall
{
/// Memory that this process can still allocate, bytes: the minimum of what the machine has free or can free, of what
/// its container (cgroup 2) still allows, and of what is left of its address space (RLIMIT_AS). Infinity if none of
/// these is known.
double AvailableMemory();
}
