// Entry and exit of a lamp's beams through the faces of the box. Options as for LampBeams.cl.
#pragma once
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "Numerics/FixedPoint.cl"

#define INSIDE 0
#define BEFORE 1 // the voxel is outside the box, and the beam approaches the box
#define AFTER 2

// Returns where the voxel with index i along an axis is relative to the box: INSIDE it, or BEFORE or AFTER it on the
// way of a beam with this tangent along the axis. On a periodic axis, wraps i around.
static int place(const LampInfo* lamp, int axis, float tangent, int* i)
{
  const int n = lamp->size[axis];
  if (lamp->periodic[axis])
  {
    *i = (*i % n + n) % n;
    return INSIDE;
  }
  if (*i >= 0 && *i < n)
  {
    return INSIDE;
  }
  return (*i < 0) == (tangent < 0.0f) ? AFTER : BEFORE;
}

// Index of a voxel in the arrays over LampInfo::stored. On a periodic axis, the halo in these arrays may hold voxels of
// the opposite side of the grid.
static ulong place_in_arrays(const LampInfo* lamp, const int* voxel)
{
  ulong place = 0;
  for (int a = 2; a >= 0; --a)
  {
    const int i = voxel[a] - lamp->first[a];
    const int beyond = i < 0 ? -1 : i >= lamp->stored[a] ? 1 : 0;
    place = place * lamp->stored[a] + (ulong)(i - beyond * lamp->size[a]);
  }
  return place;
}

typedef struct
{
  float entered, escaped[6], stranded;
  bool counts;          // whether the beam has reached the layers in which it deposits light and is tallied
  int along;            // current layer, not wrapped around periodic axes
  __global long* cells; // escaped power per cell (BoxFaces.h) in fixed point, as a fraction of the traced power
} lamp_tally;

static float square_distance(const LampInfo* lamp, const int* voxel, const float* place)
{
  float sum = 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    const float way = (voxel[a] + 0.5f - place[a]) * lamp->spacing[a];
    sum += way * way;
  }
  return sum;
}

// Whether light that has wrapped around a periodic axis by `around` voxels comes from the rectangle or from one of its
// nearest periodic images.
static bool is_image(const LampInfo* lamp, int axis, int around)
{
  return abs(around) <= (uint)(lamp->images[axis] * lamp->size[axis]);
}

// Whether a part of a rectangular lamp illuminates a voxel (coordinates not wrapped around). Nearer voxels are
// illuminated by the smaller parts into which this part is divided, and farther voxels by the larger part that contains
// it.
static bool is_lit(const LampInfo* lamp, const BeamRow* row, const int* voxel)
{
  return !VACUUM ||
    (square_distance(lamp, voxel, row->part) >= row->partFrom &&
      square_distance(lamp, voxel, row->whole) < row->wholeFrom);
}

// Tallies power that leaves the box from a voxel through one face: for the whole face, and for its cell at this voxel.
static void leave_box(const LampInfo* lamp, int face, const int* voxel, float power, lamp_tally* tally)
{
  if (!tally->counts)
  {
    return;
  }
  tally->escaped[face] += power;
  if (!FACE_OUT)
  {
    return;
  }
  long cell = lamp->faceFirst[face];
  for (int a = 0; a < 3; ++a)
  {
    cell += (long)clamp(voxel[a], 0, lamp->size[a] - 1) * lamp->faceStep[face / 2][a];
  }
  add_units(tally->cells + cell, convert_long_sat_rte(power * LampPowerUnits));
}

// Index of the first voxel that the interval `edges` overlaps, and the fraction of the interval in that voxel.
static void overlap(float2 edges, int* voxel, float* part)
{
  *voxel = (int)floor(edges.x);
  *part = edges.y > edges.x ? clamp((*voxel + 1 - edges.x) / (edges.y - edges.x), 0.0f, 1.0f) : 1.0f;
}

// Clips a beam's cross-section along u (k = 0) or v (k = 1) at faces of the box: at the face that the beam approaches
// and, unless the lamp is outside the box along this axis, at the opposite face.
// @param up  set to whether light leaves through the upper face
// @return fraction of the cross-section between the faces
static float cut_at_face(const LampInfo* lamp, const BeamRow* row, int k, float tangent, float2* edges, int* up)
{
  const int axis = (row->axis + 1 + k) % 3;
  const float n = lamp->size[axis], all = edges->y - edges->x;
  const bool beside = (row->beside >> k) & 1;
  *up = beside ? tangent >= 0.0f : edges->y - n > -edges->x;
  if (lamp->periodic[axis] || (*up ? edges->y <= n : edges->x >= 0.0f))
  {
    return 1.0f;
  }
  if (!beside || tangent < 0.0f)
  {
    edges->x = clamp(edges->x, 0.0f, fmax(edges->y, 0.0f));
    edges->y = fmax(edges->y, edges->x);
  }
  if (!beside || tangent >= 0.0f)
  {
    edges->y = clamp(edges->y, fmin(edges->x, n), n);
    edges->x = fmin(edges->x, edges->y);
  }
  const float inside = edges->y - edges->x;
  // An empty interval is moved to the middle of the outermost voxel. At the upper face, rounding could otherwise give
  // the coordinate n, which belongs to a voxel outside the box.
  *edges = inside > 0.0f ? *edges : (float2)(*up ? n - 0.5f : 0.5f);
  return all > 0.0f ? clamp(inside / all, 0.0f, 1.0f) : 0.0f;
}

// Tallies the power that left through a lateral face between the middle of the previous step and the middle of the
// current one. Half of it is tallied where the beam was a quarter of a step ago, half where the beam was three quarters
// of a step ago.
//   at    current lateral position, voxels
//   here  middle of the current step, in layers from the beam's start
static void leave_aside(const LampInfo* lamp, const BeamRow* row, int face, float2 tangent, float2 at, float here,
  float step, float power, lamp_tally* tally)
{
  if (!FACE_OUT)
  {
    tally->escaped[face] += tally->counts ? power : 0.0f;
    return;
  }
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  for (int part = 0; part < 2; ++part)
  {
    const float ago = (0.25f + 0.5f * part) * step;
    const float along = row->from + (row->up ? here - ago : ago - here);
    int voxel[3];
    voxel[row->axis] = (int)floor(along);
    voxel[u] = (int)floor(at.x - tangent.x * ago);
    voxel[v] = (int)floor(at.y - tangent.y * ago);
    for (int a = 0; a < 3; ++a)
    {
      place(lamp, a, 0.0f, &voxel[a]);
    }
    leave_box(lamp, face, voxel, 0.5f * power, tally);
  }
}

// Removes the power of a beam that has left through the lateral faces since the last step. The remaining power is
// distributed uniformly over the cross-section inside the box, to which the edges are clipped.
//   first  whether the beam reaches the box in this step; the part outside the box has then never been inside
static void leave_sides(const LampInfo* lamp, const BeamRow* row, bool first, float2 tangent, float2 way,
  float2* edges_u, float2* edges_v, BeamOnItsWay* beam, lamp_tally* tally)
{
  const float tangents[2] = { tangent.x, tangent.y };
  int up[2];
  const float within[2] = { cut_at_face(lamp, row, 0, tangent.x, edges_u, &up[0]),
    cut_at_face(lamp, row, 1, tangent.y, edges_v, &up[1]) };
  if (within[0] >= beam->stays[0] && within[1] >= beam->stays[1])
  {
    return;
  }
  float goes[2];
  for (int k = 0; k < 2; ++k)
  {
    goes[k] = within[k] < beam->stays[k] ? 1.0f - within[k] / beam->stays[k] : 0.0f;
    beam->stays[k] = fmin(beam->stays[k], within[k]);
  }
  // The power left between the middle of the previous step and the middle of the current one, on average half way
  // between them.
  const float ago = 0.5f * fmin(way.y - way.x, 0.5f * (way.x + way.y));
  for (int k = 0; k < 2; ++k)
  {
    if (!(goes[k] > 0.0f))
    {
      continue;
    }
    // Of the power that leaves at an edge of the box, along both lateral axes, half is counted at each of the two
    // faces.
    const float power = beam->left * goes[k] * (1.0f - 0.5f * goes[1 - k]);
    const int axis = (row->axis + 1 + k) % 3, other = (row->axis + 2 - k) % 3;
    const float moved = tangents[1 - k] * ago;
    int beside;
    float part;
    overlap((k == 0 ? *edges_v : *edges_u) - moved, &beside, &part);
    for (int q = 0; q < 2; ++q)
    {
      const float through = power * (q ? 1.0f - part : part);
      int voxel = beside + q;
      const bool comes = place(lamp, other, tangents[1 - k], &voxel) == BEFORE;
      if (first || comes)
      {
        tally->entered -= tally->counts ? through : 0.0f;
      }
      else if (through > 0.0f)
      {
        const float gone = up[k] ? lamp->size[axis] + 0.5f : -0.5f, at = beside + q + 0.5f + moved;
        int last[3];
        last[row->axis] = tally->along;
        last[axis] = up[k] ? lamp->size[axis] - 1 : 0;
        last[other] = beside + q;
        if (is_lit(lamp, row, last))
        {
          leave_aside(lamp, row, 2 * axis + up[k], tangent, k == 0 ? (float2)(gone, at) : (float2)(at, gone),
            0.5f * (way.x + way.y), way.y - way.x, through, tally);
        }
      }
    }
  }
  beam->left *= (1.0f - goes[0]) * (1.0f - goes[1]);
  beam->free *= (1.0f - goes[0]) * (1.0f - goes[1]);
}
