#pragma once

namespace tyndall
{
/// Memory that this process can still allocate, bytes: the smallest of three limits, which are the machine's free or
/// reclaimable memory, the allowance of its container (cgroup 2) and its remaining address space (RLIMIT_AS). Infinity
/// if none of them is known.
double AvailableMemory();
}
