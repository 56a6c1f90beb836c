// Intersection of rays with the emitting box, and the radiance along them, in a scene whose axes may be permuted and
// reflected. Options:
//   CHANNELS  1, or 3 that share sigma_t

#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "Numerics/Numerics.cl"

// A voxel, or a face of a voxel, for which light is gathered.
typedef struct
{
  int at[3];
  int across;  // axis perpendicular to the receiving face; 3: the voxel receives, not a face
  int up;      // 1: the face at the upper end of axis `across`; 0: at the lower end
  bool inside; // whether the voxel lies in the emitting box
} lit_voxel;

// A medium and its emitting box with axes permuted, and some of them reflected, so that the box lies in the same octant
// of directions from every voxel. The computed light then has the symmetries of the scene.
typedef struct
{
  float spacing[3];
  int sourceFirst[3], sourceSize[3];
  int strides[3], base; // strides of the array sigma_t by axis, and index of voxel (0, 0, 0) in it
  // Strides along the axes in the array of emission, and index of the box's lowest voxel in that array.
  int sourceStrides[3], sourceBase;
  int last, sourceLast; // highest index of sigma_t and of emission
  int axis[3];          // the original axis that corresponds to each permuted axis
  float sign[3];
} turned_scene;

static void turn_scene(const EmissionInfo* s, const lit_voxel* voxel, const int* order, int turned, turned_scene* to,
  lit_voxel* turned_voxel)
{
  const int strides[3] = { 1, s->size[0], s->size[0] * s->size[1] };
  const int source_strides[3] = { 1, s->sourceSize[0], s->sourceSize[0] * s->sourceSize[1] };
  to->base = to->sourceBase = 0;
  to->last = s->size[2] * strides[2] - 1;
  to->sourceLast = s->sourceSize[2] * source_strides[2] - 1;
  turned_voxel->across = 3;
  turned_voxel->up = 0;
  turned_voxel->inside = voxel->inside;
  for (int k = 0; k < 3; ++k)
  {
    const int a = order[k];
    const bool round = (turned >> a & 1) != 0;
    const int size = s->size[a], source_size = s->sourceSize[a];
    to->axis[k] = a;
    to->sign[k] = round ? -1.0f : 1.0f;
    to->spacing[k] = s->spacing[a];
    to->sourceSize[k] = source_size;
    to->sourceFirst[k] = round ? size - s->sourceFirst[a] - source_size : s->sourceFirst[a];
    to->strides[k] = round ? -strides[a] : strides[a];
    to->base += round ? (size - 1) * strides[a] : 0;
    to->sourceStrides[k] = round ? -source_strides[a] : source_strides[a];
    to->sourceBase += round ? (source_size - 1) * source_strides[a] : 0;
    turned_voxel->at[k] = round ? size - 1 - voxel->at[a] : voxel->at[a];
    if (a == voxel->across)
    {
      turned_voxel->across = k;
      turned_voxel->up = round ? 1 - voxel->up : voxel->up;
    }
  }
}

typedef float2 __attribute__((aligned(4))) float2_anywhere;

#if REAL_WIDTH == 1
#define any_of(condition) (condition)
#define take(from, index) ((from)[index])
#else
#define any_of(condition) any(condition)
static inline real take(const __global float* from, integer i)
{
#if REAL_WIDTH == 4
  return (real)(from[i.s0], from[i.s1], from[i.s2], from[i.s3]);
#elif REAL_WIDTH == 8
  return (real)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7]);
#else
  return (real)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7],
    from[i.s8], from[i.s9], from[i.sa], from[i.sb], from[i.sc], from[i.sd], from[i.se], from[i.sf]);
#endif
}
#endif

// Loads the values at indices i and i + 1, with one load per pair instead of two.
static inline void take_pairs(const __global float* from, integer i, real* first, real* second)
{
#if REAL_WIDTH == 1
  *first = from[i];
  *second = from[i + 1];
#else
#define PAIR(lane) const float2 p##lane = *(const __global float2_anywhere*)(from + i.s##lane)
  PAIR(0);
  PAIR(1);
  PAIR(2);
  PAIR(3);
#if REAL_WIDTH >= 8
  PAIR(4);
  PAIR(5);
  PAIR(6);
  PAIR(7);
#endif
#if REAL_WIDTH == 16
  PAIR(8);
  PAIR(9);
  PAIR(a);
  PAIR(b);
  PAIR(c);
  PAIR(d);
  PAIR(e);
  PAIR(f);
  *first = (real)(p0.x, p1.x, p2.x, p3.x, p4.x, p5.x, p6.x, p7.x, p8.x, p9.x, pa.x, pb.x, pc.x, pd.x, pe.x, pf.x);
  *second = (real)(p0.y, p1.y, p2.y, p3.y, p4.y, p5.y, p6.y, p7.y, p8.y, p9.y, pa.y, pb.y, pc.y, pd.y, pe.y, pf.y);
#elif REAL_WIDTH == 8
  *first = (real)(p0.x, p1.x, p2.x, p3.x, p4.x, p5.x, p6.x, p7.x);
  *second = (real)(p0.y, p1.y, p2.y, p3.y, p4.y, p5.y, p6.y, p7.y);
#else
  *first = (real)(p0.x, p1.x, p2.x, p3.x);
  *second = (real)(p0.y, p1.y, p2.y, p3.y);
#endif
#undef PAIR
#endif
}

// Mean transmittance over a segment of optical length tau, phi1 of numerics.md, Eq. (1); `left` receives exp(-tau).
static real mean_left(real tau, real* left)
{
  const real lost = extinguished(tau, left);
  return select((real)1.0f, lost / fmax(tau, (real)1e-6f), tau > (real)1e-6f);
}

// State of a ray from a point in a voxel to the emitting box. Positions on the ray are distances from that point, in
// units of length.
typedef struct
{
  real rate[3];       // voxels crossed along each axis per length of the ray
  real step[3];       // distance along the ray between successive planes of voxel faces perpendicular to each axis
  real next[3];       // position of the next plane of voxel faces perpendicular to each axis
  integer up[3];      // whether the ray propagates towards increasing index along each axis
  real enter, leave;  // positions at which the ray enters and leaves the emitting box
  real ahead, behind; // distance from the point to its voxel's border, forward and backward
} box_ray;

// Sets `crossed` to the axes whose next plane of voxel faces lies at or before position `end` on the ray, and advances
// `next` beyond these planes. `crossed` is set to no axis if the ray ends at `end`, i.e. `end` is at least `way_ends`.
static void cross_planes(box_ray* ray, real end, real way_ends, integer* crossed)
{
  for (int a = 0; a < 3; ++a)
  {
    crossed[a] = ray->next[a] <= end && end < way_ends;
    ray->next[a] += select((real)0.0f, ray->step[a], crossed[a]);
  }
}

static integer index_step(const box_ray* ray, const integer* crossed, const int* strides)
{
  integer step = 0;
  for (int a = 0; a < 3; ++a)
  {
    step += select((integer)0, select((integer)-strides[a], (integer)strides[a], ray->up[a]), crossed[a]);
  }
  return step;
}

// Positions the ray at its entry into the emitting box. Sets the voxel's index in sigma_t (`index`) and in emission
// (`shining`).
static void enter_box(const turned_scene* s, const real* point, box_ray* ray, integer* index, integer* shining)
{
  *shining = s->sourceBase;
  *index = s->base;
  for (int a = 0; a < 3; ++a)
  {
    const int first = s->sourceFirst[a];
    const real at = point[a] + ray->rate[a] * ray->enter;
    const integer cell = clamp(to_integer(floor(at)), (integer)first, (integer)(first + s->sourceSize[a] - 1));
    const real x = at - to_real(cell);
    ray->next[a] = ray->enter + fmax(select(x, 1.0f - x, ray->up[a]), (real)0.0f) * ray->step[a];
    *index += cell * s->strides[a];
    *shining += (cell - first) * s->sourceStrides[a];
  }
}

// Integrates emission, attenuated on the path to the point, along the ray through the emitting box.
//   radiance  W / (length^2 sr), [CHANNELS]
//   received  transmittance from the emitting box to the point
//   clear     null, or receives the integral without extinction
static void see_box(const turned_scene* s, const real* point, box_ray* ray, real received, const __global float* sigma,
  const __global float* emission, real* radiance, real* clear)
{
  const int source_voxels = s->sourceLast + 1;
  integer index, shining, crossed[3];
  enter_box(s, point, ray, &index, &shining);
  for (int c = 0; c < CHANNELS; ++c)
  {
    radiance[c] = 0.0f;
    if (clear)
    {
      clear[c] = 0.0f;
    }
  }
  real now = ray->enter, left;
  integer under_way = now < ray->leave;
  while (any_of(under_way))
  {
    const real end = fmin(fmin(ray->next[0], fmin(ray->next[1], ray->next[2])), ray->leave);
    const real length = fmax(end - now, (real)0.0f);
    const real seen = received * length * mean_left(take(sigma, index) * length, &left);
    for (int c = 0; c < CHANNELS; ++c)
    {
      const real shines = take(emission + c * source_voxels, shining);
      radiance[c] += seen * shines;
      if (clear)
      {
        clear[c] += length * shines;
      }
    }
    received *= left;
    cross_planes(ray, end, ray->leave, crossed);
    index += index_step(ray, crossed, s->strides);
    shining += index_step(ray, crossed, s->sourceStrides);
    index = clamp(index, (integer)0, (integer)s->last); // rounding may step beyond the last voxel
    shining = clamp(shining, (integer)0, (integer)s->sourceLast);
    now = end;
    under_way = now < ray->leave && (clear ? (integer)-1 : received > (real)1e-35f);
  }
}
