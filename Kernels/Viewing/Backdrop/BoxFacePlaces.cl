// Finds the point at which a ray crosses a face of the box, in tables over the face cells: [face][row][cell of the
// row], faces -x to +z, each with a border of one cell that repeats the outermost cells.

#pragma once
#include "Viewing/Samples/Sampling.cl"

typedef struct
{
  integer by_x, by_y; // whether the face's normal is along x, along y; neither: along z
  integer face;       // -x, +x, -y, +y, -z, +z
  integer at, row;    // index of the cell below and to the left, and cells per row
  real a, b;          // interpolation weights of the next cell along the row, and of the next row
} face_place;

// Finds the face that a ray through point p, traced back against its direction, meets first.
inline face_place face_behind(real3 p, real3 direction, int4 size)
{
  // The face with the shortest time since the ray crossed its plane.
#define SINCE(c) \
  ((direction.c > (real)0.0f ? p.c : (real)(float)size.c - p.c) / greater(fabs(direction.c), (real)1e-20f))
  const real x = SINCE(x), y = SINCE(y), z = SINCE(z);
#undef SINCE
  face_place to;
  to.by_x = (x <= y) & (x <= z);
  to.by_y = (to.by_x == 0) & (y <= z);
  const integer back = (to.by_x ? direction.x : to.by_y ? direction.y : direction.z) < (real)0.0f;
  const integer one = (integer)1, none = (integer)0;
  to.face = (to.by_x ? none : to.by_y ? (integer)2 : (integer)4) + (back ? one : none);

  const int cells_x = (size.y + 2) * (size.z + 2), cells_y = (size.x + 2) * (size.z + 2),
            cells_z = (size.x + 2) * (size.y + 2);
  const integer first = to.by_x ? (back ? (integer)cells_x : (integer)0)
    : to.by_y                   ? (back ? (integer)(2 * cells_x + cells_y) : (integer)(2 * cells_x))
              : (back ? (integer)(2 * cells_x + 2 * cells_y + cells_z) : (integer)(2 * cells_x + 2 * cells_y));
  to.row = to.by_x ? (integer)(size.y + 2) : (integer)(size.x + 2);
  const real u = (to.by_x ? p.y : p.x) + (real)0.5f;
  const real v = (to.by_x | to.by_y ? p.z : p.y) + (real)0.5f;
  const integer i = to_integer(u);
  const integer j = to_integer(v);
  to.at = first + j * to.row + i;
  to.a = u - to_real(i);
  to.b = v - to_real(j);
  return to;
}
