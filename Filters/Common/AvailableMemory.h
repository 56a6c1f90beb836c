#pragma once

namespace tyndall
{
/// Bytes that this process could take now: the least of what the machine has free or can free, what its container
/// (cgroup 2) still allows, and what is left of its address space (RLIMIT_AS). Infinity where nothing of that is known.
double AvailableMemory();
}
