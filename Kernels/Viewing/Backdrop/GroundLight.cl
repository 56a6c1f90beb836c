// Reflecting faces of the box, seen from inside: matt ground, snow, a table.

#pragma once
#include "Viewing/Backdrop/BoxFacePlaces.cl"

// Radiance that rays see behind the medium: that of a reflecting face if they leave through one, else `behind`.
//   ground  radiance, see BackdropTables.h
//   faces   bit mask of the reflecting faces, -x to +z
//   p       a point, in voxels, from which the ray leaves the box in a straight line
inline rgb ground_or_behind(
  __global const float4* ground, int faces, real3 p, real3 direction, integer leaves, int4 size, rgb behind)
{
  const real3 back = { -direction.x, -direction.y, -direction.z };
  const face_place to = face_behind(p, back, size);
  const integer is_ground = leaves & (((integer)faces >> to.face & (integer)1) != (integer)0);
#if SHOWN == 2
  const rgb seen = { (real)0.0f, (real)0.0f, (real)0.0f }; // it is in the picture already
#else
  const rgb seen = between_four(ground, to.at, to.at + to.row, to.a, to.b);
#endif
  const rgb light = { is_ground ? seen.r : behind.r, is_ground ? seen.g : behind.g, is_ground ? seen.b : behind.b };
  return light;
}
