// Functions shared by the lattice kernels. The host defines
//   DIRECTIONS  18 or 6
//   PASSES_ALL  1: no link reflects light, except at reflecting faces
//   BENDS       1: the refractive index varies
//   REFLECTS    1: a face of the box reflects light
//   PUBLISHED   1: collisions as in the paper
//   ENDLESS     1: some lines of links close around periodic axes and have almost no extinction, so that light
//               on them would never end; no light is sent along these endless lines
//
// Densities are [direction][voxel], W / length^2, with `stride` values per direction: light that leaves a voxel along
// the link of the direction in a step. Their sum over directions is the fluence. The halo around the box holds incident
// light.
#pragma once
#include "LatticeBoltzmann/LatticeShared.h"

#define WEIGHT(i) (DIRECTIONS == 6 ? 1.0f / 6.0f : (i) < 6 ? 1.0f / 12.0f : 1.0f / 24.0f)
#define FOR_DIRECTIONS(i) _Pragma("unroll") for (int i = 0; i < DIRECTIONS; ++i)

// 1: all links transmit all light and reflect none.
#define PLAIN (PASSES_ALL && !BENDS && !REFLECTS)

__constant char Ways[18][3] = LATTICE_WAYS;

// Light that arrives along a link: the transmitted fraction of the neighbour's density plus the reflected fraction of
// the voxel's own density (numerics.md, Eqs. (L3), (L5)).
//   sent, back  densities: the neighbour's along the link, and the voxel's own in the opposite direction
//   own, other  resistance of voxel and neighbour: inverse of the fraction that a link between two such voxels
//               transmits
//   here, there n^2 of voxel and neighbour. there = 0: outside the box; n^2 is then the voxel's, and the incident
//               light is `sent` times n^2
//   albedo      albedo of the face between them; 0 inside the box
#define DEFINE_ARRIVING(name, type)                                                                                \
  static type name(type sent, type back, type own, type other, type here, type there, type albedo)                 \
  {                                                                                                                \
    type part = PASSES_ALL ? (type)(1.0f) : 2.0f / (own + other);                                                  \
    type returns = part;                                                                                           \
    if (BENDS)                                                                                                     \
    {                                                                                                              \
      const type by_here = 1.0f / here;                                                                            \
      const type lower = select(fmin(here, there), here, there == 0.0f); /* n^2 without total reflection */        \
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

// Total weight of the open directions of a voxel, along which it emits isotropic light. All other directions are
// closed: along them the voxel lies on an endless line of links, which closes around periodic axes and has almost no
// extinction (LatticeVoxels::endless). DEFINE_SENT: weight of direction i in isotropic light, relative to the open
// directions.
//   closed  bit mask of the direction pairs whose line is endless
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
//   weight  of the direction, relative to the open directions
//   before  light that arrived along the direction, plus half the source of a step
//   sum     of `before` over all directions
#define DEFINE_COLLIDED(name, type)                                                                                \
  static type name(type weight, type before, type sum, type even, type stays)                                      \
  {                                                                                                                \
    return PUBLISHED ? before * stays + even * (weight * sum) : (before + even * (weight * sum - before)) * stays; \
  }
