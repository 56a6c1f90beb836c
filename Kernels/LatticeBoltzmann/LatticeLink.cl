// What the kernels of the lattice share. The host gives
//   DIRECTIONS  18 or 6
//   PASSES_ALL  1: no link gives back light, but at reflecting faces
//   BENDS       1: the refractive index varies
//   REFLECTS    1: a face of the box gives back light
//   PUBLISHED   1: collisions as printed
//   ENDLESS     1: along some lines no light is sent
//
// Densities are what leaves a voxel along each of its links, [direction][stride]. Their sum is fluence, W / length^2.
// The layer of voxels around the box holds incident light.
#pragma once
#include "LatticeBoltzmann/LatticeShared.h"

#define WEIGHT(i) (DIRECTIONS == 6 ? 1.0f / 6.0f : (i) < 6 ? 1.0f / 12.0f : 1.0f / 24.0f)
#define FOR_DIRECTIONS(i) _Pragma("unroll") for (int i = 0; i < DIRECTIONS; ++i)

// Links pass what is sent, and add nothing.
#if PASSES_ALL && !BENDS && !REFLECTS
#define PLAIN 1
#else
#define PLAIN 0
#endif

__constant char Ways[18][3] = LATTICE_WAYS;

// What arrives along a link in voxels: what the neighbour sends, as far as the link lets it through, and what the link
// gives back (numerics.md, Eqs. (L3), (L5)).
//   sent, back  densities of the neighbour along the link, and of the voxel itself against it
//   own, other  resistance of both: inverse of the part that a link lets through between two like them
//   here, there n^2 of both; there 0: outside, where n^2 is the voxel's, times which `sent` is incident
//   albedo      of the face between; 0 inside
#define DEFINE_ARRIVING(name, type)                                                                                \
  static type name(type sent, type back, type own, type other, type here, type there, type albedo)                 \
  {                                                                                                                \
    type part = PASSES_ALL ? (type)(1.0f) : 2.0f / (own + other);                                                  \
    type returns = part;                                                                                           \
    if (BENDS)                                                                                                     \
    {                                                                                                              \
      const type by_here = 1.0f / here;                                                                            \
      const type lower = select(fmin(here, there), here, there == 0.0f); /* n^2 of which all goes on */            \
      const type by_there = select(1.0f / there, by_here, there == 0.0f);                                          \
      const type both = PASSES_ALL ? lower : 2.0f / (own * by_here + other * by_there + fabs(by_here - by_there)); \
      part = select(both * by_there, both, there == 0.0f);                                                         \
      returns = fmin(both * by_here, (type)(1.0f));                                                                \
    }                                                                                                              \
    if (REFLECTS)                                                                                                  \
    {                                                                                                              \
      returns -= returns * albedo;                                                                                 \
    }                                                                                                              \
    return PLAIN ? sent : part * sent + (1.0f - returns) * back;                                                   \
  }

// Voxels send none of their even light along endless lines (LatticeVoxels.h), and all of it along the other lines.
//   closed  bits of the pairs of directions of endless lines
#define DEFINE_OPEN(name, type, whole)                                                    \
  static type name(whole closed)                                                          \
  {                                                                                       \
    type open = (type)(1.0f);                                                             \
    for (int i = 0; ENDLESS && i < DIRECTIONS; i += 2)                                    \
    {                                                                                     \
      open -= select((type)(0.0f), (type)(2.0f * WEIGHT(i)), (closed >> i / 2 & 1) != 0); \
    }                                                                                     \
    return fmax(open, (type)(WEIGHT(DIRECTIONS - 1)));                                    \
  }
#define DEFINE_SENT(name, type, whole)                                                                               \
  static type name(int i, whole closed, type open)                                                                   \
  {                                                                                                                  \
    return ENDLESS ? select((type)(WEIGHT(i)) / open, (type)(0.0f), (closed >> i / 2 & 1) != 0) : (type)(WEIGHT(i)); \
  }

// Density along a direction after a collision (Eqs. (L1), (L6)).
//   weight  of the direction, among those that light is sent along
//   before  what arrived, with half of the source of a step
//   sum     of those of all directions
#define DEFINE_COLLIDED(name, type)                                                                                \
  static type name(type weight, type before, type sum, type even, type stays)                                      \
  {                                                                                                                \
    return PUBLISHED ? before * stays + even * (weight * sum) : (before + even * (weight * sum - before)) * stays; \
  }
