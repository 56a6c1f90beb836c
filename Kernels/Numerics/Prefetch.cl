// PREFETCH asks for a line of memory before it is read (write: 0) or written (1), into a cache as near as `locality`
// says (0 to 3, as GCC's builtin has it). On GPUs it does nothing: NVIDIA's compiler has that builtin, but not for
// pointers of OpenCL.
//
// The host gives FOR_CPU with every kernel (Device.cxx).

#pragma once

#if FOR_CPU && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define PREFETCH(address, write, locality) __builtin_prefetch((const void*)(uintptr_t)(address), write, locality)
#endif
#endif
#ifndef PREFETCH
#define PREFETCH(address, write, locality)
#endif
