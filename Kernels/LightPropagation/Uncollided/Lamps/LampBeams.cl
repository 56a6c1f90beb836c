// Traces beams from a point lamp through the box. Options:
//   ATOMICS        1: the device has 64-bit atomics; else one work-item does everything
//   LAMBERT, CONE  1 for a rectangle, a spot
//   MOMENTS        1: first moments of the deposit are wanted
//   NET_FLUX       1: net flux is wanted
//   FACE_OUT       1: the power that leaves through each cell of the box's faces is wanted
//   VACUUM         1: a rectangle in parts, each for some voxels; also sums the deposit that vacuum would have and, if
//                  an axis is periodic (AROUND 1), the deposit of beams before they wrap around it
//   THIN           optical length of a voxel below which loss is taken as uniform
//   IN_BLOCK       1: beams are traced in a block of the grid, and stop where they leave it
//
// Space around the lamp is divided into six pyramids, one for each direction along an axis. In a pyramid beams lie on a
// grid of tangents, fine enough that a beam is at most a voxel wide where it leaves the box. A beam advances layer by
// layer; its square cross-section overlaps up to four voxels, each of which takes its part (numerics.md, Eqs. (33),
// (34)). All values are fractions of the share of the lamp's power that may reach the box (LampOnGrid.h): the channels
// share sigma_t.

#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "LightPropagation/Uncollided/Lamps/LampUnits.cl"
#include "Numerics/FixedPoint.cl"
#include "Numerics/Numerics.cl"

#define STEPS 2 // steps per layer: a beam moves laterally by at most half a voxel per step

#define INSIDE 0
#define BEFORE 1 // outside, and approaching
#define AFTER 2

// Position of voxel i of an axis relative to the box, for a beam with this tangent along it; wraps i around on a
// periodic axis.
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

// Index of a voxel in the arrays, which on a periodic axis may hold voxels of the opposite side of the grid.
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
  bool counts; // the beam has reached the layers in which it is counted and deposited
  int along;   // current layer, without wrapping around periodic axes
#if FACE_OUT
  __global long* cells; // escaped power in fixed point, as a fraction of the traced power, [cell] (BoxFaces.h)
#endif
} lamp_tally;

#if VACUUM
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
#endif

#if VACUUM
// Whether light that has wrapped around an axis by this many voxels belongs to the rectangle or to its nearest images.
static bool is_image(const LampInfo* lamp, int axis, int around)
{
  return abs(around) <= (uint)(lamp->images[axis] * lamp->size[axis]);
}
#endif

// Whether a part of a rectangle illuminates a voxel (coordinates not wrapped): neither the larger part, which was
// divided into this one, nor the smaller parts of this one do.
static bool is_lit(const LampInfo* lamp, const BeamRow* row, const int* voxel)
{
#if VACUUM
  return square_distance(lamp, voxel, row->part) >= row->partFrom &&
    square_distance(lamp, voxel, row->whole) < row->wholeFrom;
#else
  return true;
#endif
}

// Counts power that leaves through one face of the box at a voxel.
static void leave_box(const LampInfo* lamp, int face, const int* voxel, float power, lamp_tally* tally)
{
  if (!tally->counts)
  {
    return;
  }
  tally->escaped[face] += power;
#if FACE_OUT
  long cell = lamp->faceFirst[face];
  for (int a = 0; a < 3; ++a)
  {
    cell += (long)clamp(voxel[a], 0, lamp->size[a] - 1) * lamp->faceStep[face / 2][a];
  }
  add_units(tally->cells + cell, convert_long_sat_rte(power * LampPowerUnits));
#endif
}

// The first voxel that the interval `edges` overlaps, and the fraction of the interval that lies in it.
static void overlap(float2 edges, int* voxel, float* part)
{
  *voxel = (int)floor(edges.x);
  *part = edges.y > edges.x ? clamp((*voxel + 1 - edges.x) / (edges.y - edges.x), 0.0f, 1.0f) : 1.0f;
}

// Clips the cross-section along u (k 0) or v (1) at the faces of the box: at the face that the beam approaches and,
// unless the lamp is beside the box along this axis, also at the opposite one.
// @param up  set to whether light leaves through the upper face
// @return the fraction of the cross-section between the faces
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
  *edges = inside > 0.0f ? *edges : (float2)(*up ? n - 0.5f : 0.5f); // floats cannot represent a voxel that ends at n
  return all > 0.0f ? clamp(inside / all, 0.0f, 1.0f) : 0.0f;
}

#if MOMENTS
// Adds first moments: the path in a voxel times the mean position of the loss relative to the voxel's centre, along the
// beam's axis and laterally (numerics.md, Eqs. (37), (38)).
//   way   start and end of the step, in layers from the beam's start
//   mean  centre of the cross-section's part in the voxel, half way through the step
static void add_moments(const LampInfo* lamp, const BeamRow* row, const int* voxel, float2 way, float2 mean,
  float2 tangent, float tau, float lost, float path, __global long* first_moments, ulong stride)
{
  const float part = tau < 0.05f ? 0.5f - tau / 12.0f : 1.0f / tau - (1.0f - lost) / lost;
  const float at = mix(way.x, way.y, part);
  const float aside = at - 0.5f * (way.x + way.y);
  float from_middle[3];
  const float along = row->from + (row->up ? at : -at);
  from_middle[0] = along - floor(along) - 0.5f; // removes laps around a periodic axis
  from_middle[1] = mean.x + aside * tangent.x - 0.5f;
  from_middle[2] = mean.y + aside * tangent.y - 0.5f;
  for (int a = 0; a < 3; ++a)
  {
    const float distance = clamp(from_middle[a], -0.5f, 0.5f);
    add_units(first_moments + ((row->axis + a) % 3) * stride, convert_long_sat_rte(path * distance * lamp->scale));
  }
}
#endif

#if NET_FLUX
// Adds path times direction, along x, y, z, for a step from way.x to way.y layers from the beam's start.
static void add_flux(const LampInfo* lamp, const BeamRow* row, float2 tangent, float2 way, float length, float path,
  __global long* flux, ulong stride)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  const float layers = path * lamp->scale * (way.y - way.x) / length;
  add_units(flux + row->axis * stride, convert_long_sat_rte((row->up ? layers : -layers) * lamp->spacing[row->axis]));
  add_units(flux + u * stride, convert_long_sat_rte(layers * tangent.x * lamp->spacing[u]));
  add_units(flux + v * stride, convert_long_sat_rte(layers * tangent.y * lamp->spacing[v]));
}
#endif

// Counts power that left through a lateral face since the middle of the previous step, at most one step ago, in two
// halves.
//   at    current lateral position, voxels
//   here  the middle of the step, in layers from the beam's start
static void leave_aside(const LampInfo* lamp, const BeamRow* row, int face, float2 tangent, float2 at, float here,
  float step, float power, lamp_tally* tally)
{
#if FACE_OUT
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
#else
  tally->escaped[face] += tally->counts ? power : 0.0f;
#endif
}

// State of a beam between two steps.
typedef struct
{
  int layer, step;
  float left, rest;
  float stays[2]; // fraction of its cross-section that has not left the box, along u and v
  float free;     // power that would remain in vacuum
#if IN_BLOCK
  int voxel[3];
#endif
} beam_state;

// Removes the power of a beam that has left through the lateral faces since the last step. The rest is spread over the
// rest of the cross-section, to which the edges are clipped.
//   first  the beam reaches the box here: the part outside the box has not entered
static void leave_sides(const LampInfo* lamp, const BeamRow* row, bool first, float2 tangent, float2 way,
  float2* edges_u, float2* edges_v, beam_state* beam, lamp_tally* tally)
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
  // It left between the step before and this one: in the mean half way between them.
  const float ago = 0.5f * fmin(way.y - way.x, 0.5f * (way.x + way.y));
  for (int k = 0; k < 2; ++k)
  {
    if (!(goes[k] > 0.0f))
    {
      continue;
    }
    // At an edge of the box: half through either face.
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

// Advances a beam by one step: each part of it crosses its voxel. Updates its remaining power and the rounding
// compensation.
// @return power that has not reached the box yet
static float step_beam(const LampInfo* lamp, const BeamRow* row, int layer, float2 tangent, float2 middle, float2 width,
  float2 way, float length, const __global float* sigma, __global long* path, ulong stride, beam_state* beam,
  lamp_tally* tally)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  float2 edges_u = (float2)(middle.x - 0.5f * width.x, middle.x + 0.5f * width.x);
  float2 edges_v = (float2)(middle.y - 0.5f * width.y, middle.y + 0.5f * width.y);
  leave_sides(lamp, row, false, tangent, way, &edges_u, &edges_v, beam, tally);
  int2 lowest;
  float part_u, part_v;
  int voxel[3];
  overlap(edges_u, &voxel[0], &part_u);
  overlap(edges_v, &voxel[1], &part_v);
  lowest = (int2)(voxel[0], voxel[1]);
  float after = 0.0f, taken = 0.0f, waiting = 0.0f;
  for (int q = 0; q < 4; ++q)
  {
    const float part = (q & 1 ? 1.0f - part_u : part_u) * (q & 2 ? 1.0f - part_v : part_v);
    const float power = beam->left * part;
#if VACUUM
    const bool is_dark = part <= 0.0f; // vacuum would have light here
#else
    const bool is_dark = power <= 0.0f;
#endif
    if (is_dark)
    {
      continue;
    }
    voxel[row->axis] = tally->along;
    voxel[u] = lowest.x + (q & 1);
    voxel[v] = lowest.y + (q >> 1);
    const bool counts = tally->counts && is_lit(lamp, row, voxel);
    voxel[row->axis] = layer;
    const int at_u = place(lamp, u, tangent.x, &voxel[u]);
    const int at_v = place(lamp, v, tangent.y, &voxel[v]);
    if (at_u != INSIDE || at_v != INSIDE)
    {
      after += power; // it enters later, or never
      waiting += power;
      continue;
    }
    const ulong index = place_in_arrays(lamp, voxel);
    const float tau = sigma[index] * length;
    float through;
    const float lost = extinguished(tau, &through);
    const float mean_length = tau > 1e-20f ? lost / sigma[index] : length;
    const float counted = counts ? power * (mean_length * units_of(sigma[index], lamp->diagonal)) : 0.0f;
    if (counted > 0.0f)
    {
      add_units(path + index, convert_long_sat_rte(counted * lamp->scale));
    }
#if VACUUM
    if (counts && is_image(lamp, row->axis, tally->along - layer) && is_image(lamp, u, lowest.x + (q & 1) - voxel[u]) &&
      is_image(lamp, v, lowest.y + (q >> 1) - voxel[v]))
    {
      __global long* in_vacuum = path + FIRST_OF_VACUUM * stride + index;
      add_units(in_vacuum, convert_long_sat_rte(beam->free * part * length * lamp->scale));
#if AROUND
      add_units(in_vacuum + stride, convert_long_sat_rte(counted * lamp->scale));
#endif
    }
#endif
#if NET_FLUX
    add_flux(lamp, row, tangent, way, length, counted, path + FIRST_OF_FLUX * stride + index, stride);
#endif
#if MOMENTS
    if (counts && tau > 0.5f * THIN)
    {
      const float2 mean = (float2)(q & 1 ? 0.5f * (edges_u.y - lowest.x - 1.0f)
                                         : 0.5f * (fmin(edges_u.y - lowest.x, 1.0f) + edges_u.x - lowest.x),
        q & 2 ? 0.5f * (edges_v.y - lowest.y - 1.0f)
              : 0.5f * (fmin(edges_v.y - lowest.y, 1.0f) + edges_v.x - lowest.y));
      add_moments(lamp, row, voxel, way, mean, tangent, tau, lost, counted, path + stride + index, stride);
    }
#endif
    const bool thick = lost < 0.5f * tau;
    after += thick ? power * through : power;
    taken += thick ? 0.0f : power * lost;
  }
  // Compensates rounding of small losses, which would accumulate over thousands of steps.
  const float change = beam->rest - taken;
  beam->left = after + change;
  beam->rest = change - (beam->left - after);
  return waiting;
}

// Edges of a beam's cross-section along u or v, t layers from its start.
static float2 edges_at(float start, float tangent, float open, float width, float t)
{
  const float middle = start + tangent * t, half_width = 0.5f * fmin(open + width * t, 1.0f);
  return (float2)(middle - half_width, middle + half_width);
}

// Handles a beam that starts outside the box, at the face of the box's first layer: the part that passes beside the box
// does not enter.
//   start  its centre there
static void enter_box(
  const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, beam_state* beam, lamp_tally* tally)
{
  float2 edges_u = edges_at(start.x, tangent.x, row->openU, row->widthU, 0.0f);
  float2 edges_v = edges_at(start.y, tangent.y, row->openV, row->widthV, 0.0f);
  leave_sides(lamp, row, true, tangent, (float2)(0.0f), &edges_u, &edges_v, beam, tally);
}

// Fraction of the cross-section along u (k 0) or v (1) that is inside the box; of the part that has not left it.
static float part_inside(const LampInfo* lamp, const BeamRow* row, int k, float tangent, float2 edges)
{
  int up, first;
  cut_at_face(lamp, row, k, tangent, &edges, &up);
  const int axis = (row->axis + 1 + k) % 3;
  float part;
  overlap(edges, &first, &part);
  int second = first + 1;
  return (place(lamp, axis, tangent, &first) == INSIDE ? part : 0.0f) +
    (place(lamp, axis, tangent, &second) == INSIDE ? 1.0f - part : 0.0f);
}

// Fraction of the cross-section that has not reached the box yet; of the part that has not left it.
static float part_to_come(const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, float t)
{
  const float2 edges_u = edges_at(start.x, tangent.x, row->openU, row->widthU, t);
  const float2 edges_v = edges_at(start.y, tangent.y, row->openV, row->widthV, t);
  return 1.0f - part_inside(lamp, row, 0, tangent.x, edges_u) * part_inside(lamp, row, 1, tangent.y, edges_v);
}

// Handles a beam that entered sideways, at the end of the box: in the last half step more of it reaches the box, and
// the remainder never enters.
//   waiting  power that had not reached the box in the middle of the last step, at `here`
static void miss_box(const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, float here, float end,
  float waiting, beam_state* beam, lamp_tally* tally)
{
  const float to_come = part_to_come(lamp, row, start, tangent, end);
  const float missed = fmin(waiting * to_come / part_to_come(lamp, row, start, tangent, here), beam->left);
  tally->entered -= tally->counts ? missed : 0.0f;
  beam->left -= missed;
}

#if VACUUM
#define BEYOND 1 // beyond the voxels that its part illuminates
#define SHORT_OF 2
#define AMID 0

// Position of a beam's centre relative to the voxels that its part of the rectangle illuminates.
static int stretch_of(const LampInfo* lamp, const BeamRow* row, int along, float2 middle)
{
  int voxel[3];
  voxel[row->axis] = along;
  voxel[(row->axis + 1) % 3] = (int)floor(middle.x);
  voxel[(row->axis + 2) % 3] = (int)floor(middle.y);
  return square_distance(lamp, voxel, row->part) < row->partSeen ? SHORT_OF
    : square_distance(lamp, voxel, row->whole) > row->wholeSeen  ? BEYOND
                                                                 : AMID;
}

// Advances a beam by one step, along its centre, where it illuminates no voxel.
// @return whether all of its cross-section is in the box
static bool pass_through(const LampInfo* lamp, const BeamRow* row, int layer, float2 middle, float2 width, float length,
  const __global float* sigma, beam_state* beam)
{
  const float at[2] = { middle.x, middle.y }, half_width[2] = { 0.5f * width.x, 0.5f * width.y };
  int voxel[3];
  voxel[row->axis] = layer;
  for (int k = 0; k < 2; ++k)
  {
    const int axis = (row->axis + 1 + k) % 3;
    voxel[axis] = (int)floor(at[k]);
    if (!lamp->periodic[axis] && (at[k] - half_width[k] < 0.0f || at[k] + half_width[k] > lamp->size[axis]))
    {
      return false;
    }
    place(lamp, axis, 0.0f, &voxel[axis]);
  }
  float through;
  extinguished(sigma[place_in_arrays(lamp, voxel)] * length, &through);
  beam->left *= through;
  return true;
}
#endif

// Counts the power of a beam that leaves at the far end of its axis, through up to four cells.
//   start  its centre at its start
static void leave_end(
  const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, float t, float left, lamp_tally* tally)
{
#if FACE_OUT || VACUUM
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  int voxel[3] = { 0, 0, 0 }, lowest[2];
  float part_u, part_v;
  float2 edges_u = edges_at(start.x, tangent.x, row->openU, row->widthU, t);
  float2 edges_v = edges_at(start.y, tangent.y, row->openV, row->widthV, t);
  int up;
  cut_at_face(lamp, row, 0, tangent.x, &edges_u, &up);
  cut_at_face(lamp, row, 1, tangent.y, &edges_v, &up);
  overlap(edges_u, &lowest[0], &part_u);
  overlap(edges_v, &lowest[1], &part_v);
  for (int q = 0; q < 4; ++q)
  {
    voxel[row->axis] = tally->along;
    voxel[u] = lowest[0] + (q & 1);
    voxel[v] = lowest[1] + (q >> 1);
    const float part = (q & 1 ? 1.0f - part_u : part_u) * (q & 2 ? 1.0f - part_v : part_v);
    const float leaving = is_lit(lamp, row, voxel) ? part * left : 0.0f;
    place(lamp, u, tangent.x, &voxel[u]);
    place(lamp, v, tangent.y, &voxel[v]);
    leave_box(lamp, 2 * row->axis + row->up, voxel, leaving, tally);
  }
#else
  tally->escaped[2 * row->axis + row->up] += left;
#endif
}

#if IN_BLOCK
// Finds the voxel that contains the beam's centre, or the nearest one of the grid. @return whether beams are traced
// there
static bool is_followed(const LampInfo* lamp, const BeamRow* row, int layer, float2 middle, int* voxel)
{
  voxel[row->axis] = layer;
  voxel[(row->axis + 1) % 3] = (int)floor(middle.x);
  voxel[(row->axis + 2) % 3] = (int)floor(middle.y);
  bool followed = true;
  for (int a = 0; a < 3; ++a)
  {
    place(lamp, a, 0.0f, &voxel[a]);
    voxel[a] = clamp(voxel[a], 0, lamp->size[a] - 1);
    followed = followed && voxel[a] >= lamp->followed[a] && voxel[a] < lamp->followedEnd[a];
  }
  return followed;
}
#endif

// Traces one beam from its entry into the box, or from its saved state, until it leaves.
// @param begin  its centre at its start
// @param power  its initial power
// @return whether it has ended; otherwise, if IN_BLOCK, it has left the block, with its state in `beam`
static bool follow_beam(const LampInfo* lamp, const BeamRow* row, float2 begin, float2 tangent, float power,
  const __global float* sigma, __global long* path, ulong stride, beam_state* beam, lamp_tally* tally)
{
  const int n = lamp->size[row->axis];
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  const float3 along = (float3)(lamp->spacing[row->axis], tangent.x * lamp->spacing[u], tangent.y * lamp->spacing[v]);
  const float per_layer = sqrt(dot(along, along));
  const float start = row->from;
  const int first =
    row->outside ? (row->up ? 0 : n - 1) : clamp((int)(row->up ? floor(start) : ceil(start) - 1.0f), 0, n - 1);
  const int layers = row->up ? n - first : first + 1;
  const int all = lamp->periodic[row->axis] ? row->layers : min(row->layers, layers);
#if VACUUM
  const int nearby = layers + lamp->images[row->axis] * n;
#else
  const int nearby = 0;
#endif
  // On a periodic axis beams continue until their power is negligible; on others they leave.
  const float least = lamp->periodic[row->axis] ? 1e-7f * power : 0.0f;
  const int before = beam->layer;
  float now = before == 0 ? 0.0f : row->up ? first + before - start : start - (first - (before - 1));
#if IN_BLOCK
  bool follows = true;
#endif
  float waiting = 0.0f, here = now;
  tally->counts = row->skipped == 0;
  if (before == 0 && beam->step == 0 && row->outside)
  {
    enter_box(lamp, row, begin, tangent, beam, tally);
  }
  for (int k = before; k < all && (beam->left > least || (k < nearby && beam->free > 0.0f)); ++k)
  {
    tally->counts = k >= row->skipped;
    tally->along = row->up ? first + k : first - k;
    const int layer = row->up ? (first + k) % n : ((first - k) % n + n) % n;
    const float end = row->up ? first + k + 1 - start : start - (first - k);
    for (int s = k == before ? beam->step : 0; s < STEPS; ++s)
    {
      const float t0 = now + (end - now) * s / STEPS;
      const float t1 = now + (end - now) * (s + 1) / STEPS;
      here = 0.5f * (t0 + t1);
      const float2 middle = begin + tangent * here;
#if IN_BLOCK
      // The rank that received the beam always takes its first step, so that it advances whatever rounding says about
      // its voxel.
      if (!is_followed(lamp, row, layer, middle, beam->voxel) && !follows)
      {
        beam->layer = k;
        beam->step = s;
        tally->counts = true;
        return false;
      }
      follows = false;
#endif
      const float2 width = fmin((float2)(row->openU, row->openV) + (float2)(row->widthU, row->widthV) * here, 1.0f);
      const float length = (t1 - t0) * per_layer;
#if VACUUM
      const int stretch = stretch_of(lamp, row, tally->along, middle);
      if (stretch == BEYOND)
      {
        return true;
      }
      if (stretch == SHORT_OF && pass_through(lamp, row, layer, middle, width, length, sigma, beam))
      {
        waiting = 0.0f;
        continue;
      }
#endif
      waiting =
        step_beam(lamp, row, layer, tangent, middle, width, (float2)(t0, t1), length, sigma, path, stride, beam, tally);
    }
    now = end;
  }
  if (row->beside && waiting > 0.0f && all >= layers)
  {
    miss_box(lamp, row, begin, tangent, here, now, waiting, beam, tally);
  }
  tally->counts = true;
  if (lamp->periodic[row->axis])
  {
    const float2 end = begin + tangent * now;
    int voxel[3];
    voxel[row->axis] = tally->along;
    voxel[u] = (int)floor(end.x);
    voxel[v] = (int)floor(end.y);
    tally->stranded += is_lit(lamp, row, voxel) ? beam->left : 0.0f;
  }
  else if (all == layers)
  {
    leave_end(lamp, row, begin, tangent, now, beam->left, tally);
  }
  return true;
}

#if LAMBERT
// Cosine of the angle between a ray and the lamp's direction.
static float cosine_at(const LampInfo* lamp, const BeamRow* row, float2 tangent)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  float way[3];
  way[row->axis] = row->up ? lamp->spacing[row->axis] : -lamp->spacing[row->axis];
  way[u] = tangent.x * lamp->spacing[u];
  way[v] = tangent.y * lamp->spacing[v];
  return (way[0] * lamp->direction[0] + way[1] * lamp->direction[1] + way[2] * lamp->direction[2]) *
    rsqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
}
#endif

#if CONE
#define SLICES 512 // slices of a beam that the border of the cone crosses

// Rays d = (ahead, u + x, v) of a pyramid at fixed v. Those in the cone satisfy a x^2 + 2 b x + c <= 0 and along + x
// slope >= 0 (numerics.md, Eq. (33a)).
typedef struct
{
  float ahead, u, v;
  float a, b, c, root;
  float along, slope;
} cone_slice;

// @param v  relative to the base of the pyramid, length
static cone_slice slice_at(const LampInfo* lamp, const BeamRow* row, float v)
{
  const int i = row->axis, j = (i + 1) % 3, k = (i + 2) % 3;
  const float c[3] = { lamp->direction[i], lamp->direction[j], lamp->direction[k] };
  const float m[3] = { row->crossing[0] - v * c[1], row->crossing[1] + v * c[0], row->crossing[2] };
  const float s2 = lamp->sineSquare, k2 = lamp->cosine * lamp->cosine;
  cone_slice slice;
  slice.ahead = row->up ? lamp->spacing[i] : -lamp->spacing[i];
  slice.u = row->baseU * lamp->spacing[j];
  slice.v = row->baseV * lamp->spacing[k] + v;
  const float plane = slice.ahead * slice.ahead + slice.v * slice.v, square = plane + slice.u * slice.u;
  slice.along = slice.ahead * c[0] + slice.u * c[1] + slice.v * c[2];
  slice.slope = c[1];
  if (s2 < 0.5f)
  {
    slice.a = c[0] * c[0] + c[2] * c[2] - s2;
    slice.b = m[0] * c[2] - m[2] * c[0] - s2 * slice.u;
    slice.c = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] - s2 * square;
  }
  else
  {
    slice.a = k2 - c[1] * c[1];
    slice.b = k2 * slice.u - slice.along * c[1];
    slice.c = k2 * square - slice.along * slice.along;
  }
  slice.root = k2 * (s2 * plane - m[1] * m[1]);
  return slice;
}

static bool is_in_cone(const cone_slice* slice, float x)
{
  return (slice->a * x + 2.0f * slice->b) * x + slice->c <= 0.0f && slice->along + slice->slope * x >= 0.0f;
}

// The part of the slice from edges.x to edges.y that is in the cone.
static float2 part_of_slice(const cone_slice* slice, float2 edges)
{
  const bool low = is_in_cone(slice, edges.x), high = is_in_cone(slice, edges.y);
  if (low && high)
  {
    return edges;
  }
  const float q = -(slice->b + copysign(sqrt(fmax(slice->root, 0.0f)), slice->b));
  const float r0 = slice->a != 0.0f ? q / slice->a : INFINITY, r1 = q != 0.0f ? slice->c / q : r0;
  if (low != high)
  {
    const float middle = 0.5f * (edges.x + edges.y);
    const float border = clamp(fabs(r0 - middle) < fabs(r1 - middle) ? r0 : r1, edges.x, edges.y);
    return low ? (float2)(edges.x, border) : (float2)(border, edges.y);
  }
  const float first = fmin(r0, r1), second = fmax(r0, r1);
  const bool within = slice->a > 0.0f && slice->root > 0.0f && first > edges.x && second < edges.y &&
    slice->along + slice->slope * 0.5f * (first + second) > 0.0f;
  return within ? (float2)(first, second) : edges.xx;
}

// Solid angle of a part of a slice, divided by the slice's height.
static float angle_of_slice(const cone_slice* slice, float2 part)
{
  const float x = slice->u + 0.5f * (part.x + part.y);
  const float inverse = rsqrt(slice->ahead * slice->ahead + x * x + slice->v * slice->v);
  return (part.y - part.x) * inverse * inverse * inverse;
}

// Fraction of a beam's solid angle that is in the cone.
//   middle  its centre, relative to the base of the pyramid
static float part_in_cone(const LampInfo* lamp, const BeamRow* row, float2 middle)
{
  const float2 spacing = (float2)(lamp->spacing[(row->axis + 1) % 3], lamp->spacing[(row->axis + 2) % 3]);
  const float2 low = (middle - 0.5f * (float2)(row->widthU, row->widthV)) * spacing;
  const float2 width = (float2)(row->widthU, row->widthV) * spacing, edges = (float2)(low.x, low.x + width.x);
  const cone_slice bottom = slice_at(lamp, row, low.y), top = slice_at(lamp, row, low.y + width.y);
  if (is_in_cone(&bottom, edges.x) && is_in_cone(&bottom, edges.y) && is_in_cone(&top, edges.x) &&
    is_in_cone(&top, edges.y)) // the cone is convex
  {
    return 1.0f;
  }
  float inside = 0.0f, all = 0.0f;
  for (int i = 0; i < SLICES; ++i)
  {
    const cone_slice slice = slice_at(lamp, row, low.y + (i + 0.5f) / SLICES * width.y);
    inside += angle_of_slice(&slice, part_of_slice(&slice, edges));
    all += angle_of_slice(&slice, edges);
  }
  return inside / all;
}
#endif

// Tangents of a beam's centre, relative to the base of its pyramid; below, relative to the pyramid's axis; and the
// beam's centre at its start.
static float2 tangent_from_base(const BeamRow* row, int beam)
{
  return (float2)(row->tangentU + beam * row->widthU, row->tangentV);
}

static float2 tangent_of(const BeamRow* row, int beam)
{
  return (float2)(row->baseU, row->baseV) + tangent_from_base(row, beam);
}

static float2 begin_of(const BeamRow* row, int beam)
{
  return (float2)(row->startU + beam * row->openU, row->startV);
}

// Initial power of a beam, as a fraction of the traced power.
static float power_of_beam(const LampInfo* lamp, const BeamRow* row, int beam)
{
  const float2 spacing = (float2)(lamp->spacing[(row->axis + 1) % 3], lamp->spacing[(row->axis + 2) % 3]);
  const float2 tangent = tangent_of(row, beam), size = (float2)(row->widthU, row->widthV) * spacing;
  float angle =
    solid_angle(tangent.x * spacing.x, tangent.y * spacing.y, size.x, size.y, lamp->spacing[row->axis], 64.0f);
#if LAMBERT
  angle *= fmax(cosine_at(lamp, row, tangent), 0.0f);
#elif CONE
  angle *= part_in_cone(lamp, row, tangent_from_base(row, beam));
#endif
  return angle > 0.0f ? row->share * lamp->intensity * angle : 0.0f;
}

static beam_state beam_of(float power)
{
  beam_state beam = { 0, 0, power, 0.0f, { 1.0f, 1.0f }, power };
  return beam;
}

static void clear_tally(lamp_tally* tally, __global long* cells)
{
  tally->entered = 0.0f;
  tally->stranded = 0.0f;
  tally->counts = true;
  tally->along = 0;
  for (int face = 0; face < 6; ++face)
  {
    tally->escaped[face] = 0.0f;
  }
#if FACE_OUT
  tally->cells = cells;
#endif
}

// [entered, escaped through -x to +z, stranded, emitted in the beams' directions], fractions of the power
static void write_sums(const lamp_tally* tally, float shone, __global float* sums)
{
  sums[0] = tally->entered;
  for (int face = 0; face < 6; ++face)
  {
    sums[1 + face] = tally->escaped[face];
  }
  sums[7] = tally->stranded;
  sums[8] = shone;
}

#if IN_BLOCK
static void follow_in_block(const LampInfo* lamp, const BeamRow* row, BeamOnItsWay* beam, const __global float* sigma,
  __global long* path, ulong stride, __global long* cells, __global float* sums)
{
  lamp_tally tally;
  clear_tally(&tally, cells);
  beam_state state = { beam->layer, beam->step, beam->left, beam->rest, { beam->stays[0], beam->stays[1] },
    beam->free };
  float shone = 0.0f, power = 0.0f;
  if (!beam->begun || lamp->periodic[row->axis])
  {
    power = power_of_beam(lamp, row, beam->beam);
  }
  if (!beam->begun)
  {
    shone = power;
    tally.entered = row->skipped > 0 ? 0.0f : shone;
    state = beam_of(shone);
  }
  // The remaining power of a beam that has already travelled may be negative by rounding.
  const bool is_there = beam->begun || shone > 0.0f;
  beam->begun = true;
  beam->ended = !is_there ||
    follow_beam(
      lamp, row, begin_of(row, beam->beam), tangent_of(row, beam->beam), power, sigma, path, stride, &state, &tally);
  beam->layer = state.layer;
  beam->step = state.step;
  beam->left = state.left;
  beam->rest = state.rest;
  beam->stays[0] = state.stays[0];
  beam->stays[1] = state.stays[1];
  beam->free = state.free;
  for (int a = 0; a < 3 && !beam->ended; ++a)
  {
    beam->voxel[a] = state.voxel[a];
  }
  write_sums(&tally, shone, sums);
}

// Traces beams through one block of a grid: those that start in it, and those that arrive from other blocks.
// sigma, path, stride, cells, rows  as in follow_lamp, for the stored voxels of LampInfo
// beams  replaced by their state when they have left the block, or ended
// sums   [beam], see write_sums()
__kernel void follow_lamp_in_block(LampInfo lamp, const __global float* sigma, ulong sigma_first, __global long* path,
  ulong stride, __global long* cells, const __global BeamRow* rows, __global BeamOnItsWay* beams, int count,
  __global float* sums)
{
#if ATOMICS
  const int b = get_global_id(0);
#else
  for (int b = 0; b < count; ++b)
#endif
  {
    BeamOnItsWay beam = beams[b];
    const BeamRow row = rows[beam.row];
    follow_in_block(&lamp, &row, &beam, sigma + sigma_first, path, stride, cells, sums + b * LampRowSums);
    beams[b] = beam;
  }
}
#else
static void follow_row(const LampInfo* lamp, const BeamRow* row, const __global float* sigma, __global long* path,
  ulong stride, __global long* cells, __global float* sums)
{
  float shone = 0.0f;
  lamp_tally tally;
  clear_tally(&tally, cells);
  for (int i = 0; i < row->count; ++i)
  {
    const float power = power_of_beam(lamp, row, i);
    if (power > 0.0f)
    {
      beam_state beam = beam_of(power);
      tally.entered += row->skipped > 0 ? 0.0f : power;
      shone += power;
      follow_beam(lamp, row, begin_of(row, i), tangent_of(row, i), power, sigma, path, stride, &beam, &tally);
    }
  }
  write_sums(&tally, shone, sums);
}

// Traces rows of beams.
// path  fraction of the power times length, in fixed point, [voxel], added to. MOMENTS: [path, path times distance
//       along x, y, z][stride]. NET_FLUX: then path times direction, [x, y, z][stride]. VACUUM: then the path in
//       vacuum of light before it wraps around an axis, [stride], and if AROUND the actual path of that light, [stride]
// cells power that leaves through the box's faces, in fixed point, [cell]; if FACE_OUT
// sums  [row], see write_sums()
__kernel void follow_lamp(LampInfo lamp, const __global float* sigma, ulong sigma_first, __global long* path,
  ulong stride, __global long* cells, const __global BeamRow* rows, int row_count, int first_row, __global float* sums)
{
#if ATOMICS
  const int r = first_row + get_global_id(0);
#else
  for (int r = first_row; r < first_row + row_count; ++r)
#endif
  {
    const BeamRow row = rows[r];
    follow_row(&lamp, &row, sigma + sigma_first, path, stride, cells, sums + r * LampRowSums);
  }
}
#endif
