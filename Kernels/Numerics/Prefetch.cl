// PREFETCH loads a cache line before it is read (write: 0) or written (write: 1); `locality`, 0 to 3, selects the cache
// level as in GCC's builtin. On GPUs it has no effect: NVIDIA's compiler has the builtin, but not for OpenCL pointers.
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
