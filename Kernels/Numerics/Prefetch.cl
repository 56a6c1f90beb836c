// PREFETCH loads a cache line ahead of its use. `write`: 0 before reading, 1 before writing. `locality`, 0 to 3,
// selects the cache level as in GCC's builtin. It has no effect on GPUs, because NVIDIA's compiler does not accept the
// builtin for OpenCL pointers.
//
// The host defines FOR_CPU with every kernel (Device.cxx).

#pragma once

#if FOR_CPU && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define PREFETCH(address, write, locality) __builtin_prefetch((const void*)(uintptr_t)(address), write, locality)
#endif
#endif
#ifndef PREFETCH
#define PREFETCH(address, write, locality)
#endif
