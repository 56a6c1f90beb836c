// Kernels that compute the occupancy of voxels to a fraction of a sample, from the position of the surface between
// samples (numerics.md, section 11.1).
//
// Along a column of samples the crossing of a surface is known exactly, and so is the last sample before the crossing.
// The interval between the crossing and the border of this sample's fine voxel is added to the voxel that contains the
// interval, or subtracted from it. This removes the terraces of a plane across the columns, but not those of a plane
// along them. The correction is therefore computed for columns along x, y and z. Each crossing is weighted by how much
// the surface faces the columns, Eq. (87); the three weights of a surface add up to 1.
//
// Sums are in integers, and each term changes its sign if the mesh is mirrored: a rotated or mirrored mesh gives
// exactly the rotated or mirrored voxels.
//
// In addition to the macros of Voxelization.cl, the host defines AXIS, the axis of the columns in which crossings are
// measured, and BIT_AXIS, the axis of the columns of `bits`. As arguments they would cost 15% more time.

#include "Refraction/Voxelization/Voxelization.cl"

#define SAMPLES_OF_VOXEL (SAMPLES * SAMPLES * SAMPLES)
// Corrections of a voxel's volume are integers, in units of 1 / UNITS of a sample's volume. An int holds the
// corrections of 80 surfaces through a voxel of 16 samples per edge; with fewer samples it holds more.
#define UNITS 65536
// Output counts are integers, in units of 1 / UNITS_OF_COUNT of a sample; equal to UnitsOfSample in C++.
#define UNITS_OF_COUNT (65535 / SAMPLES_OF_VOXEL)
#define LEAST_WEIGHT (1.0f / 1024.0f)

inline uint is_set(__global const uint* bits, const SampleRows* rows, int3 sample)
{
  const int3 at = BY_COLUMNS(sample, BIT_AXIS);
  const ulong column = (ulong)(UP(at) - rows->firstRow) * rows->columns + ACROSS(at);
  return (bits[column * rows->words + ALONG(at) / BITS] >> (ALONG(at) % BITS)) & 1;
}

inline int3 place(int along, int across, int up, int axis)
{
  const int3 by_columns = (int3)(along, across, up);
  return FROM_COLUMNS(by_columns, axis);
}

// Weight of a surface for columns along `along`: the fourth power of its normal's component, relative to the sum of
// the fourth powers of all components (numerics.md, Eq. (87)). Terms are summed in the order of their size, so that
// rotating the surface does not change a bit.
inline float weight_along(long3 normal)
{
  float3 n = fabs(convert_float3(normal));
  n /= fmax(fmax(n.x, n.y), n.z);
  n *= n;
  n *= n;
  const float least = fmin(fmin(n.x, n.y), n.z);
  const float middle = fmax(fmin(n.x, n.y), fmin(fmax(n.x, n.y), n.z));
  return ALONG(n) / ((least + middle) + 1.0f);
}

// Whether a crossing is hidden, because the sample before or after it lies inside a later mesh, to which the sample
// belongs.
inline int is_hidden(__global const uint* claimed, const SampleRows* rows, int3 before, int3 after, int first, int last)
{
  return (!first && is_set(claimed, rows, before)) || (!last && is_set(claimed, rows, after));
}

// Returns 1 if a line along the column leaves the mesh at a crossing, -1 if it enters. If exactly one of the samples
// before and after the crossing is inside the mesh, this decides. Otherwise two or more crossings lie between the two
// samples, because the mesh is thinner there than their distance. The orientation of the triangle then decides.
//   turned   `leaving` of the triangle, -1 or 1, times the mesh's orientation; 0 if the orientation is unknown
//   first    whether the column has no sample before the crossing
//   last     whether the column has no sample after the crossing
inline int side_of(
  __global const uint* bits, const SampleRows* rows, int3 before, int3 after, int first, int last, int turned)
{
  const uint inBefore = first ? 1 - is_set(bits, rows, after) : is_set(bits, rows, before);
  const uint inAfter = last ? 1 - inBefore : is_set(bits, rows, after);
  return inBefore == inAfter ? turned : inBefore ? 1 : -1;
}

// Samples of a slab, the voxels that are processed at a time.
//   bits     one bit per sample: 1 inside the mesh that is measured
//   claimed  one bit per sample: 1 inside later meshes
//   taken    for each voxel, the number of samples (x) and the volume (y, in 1 / UNITS_OF_COUNT of a sample) inside
//            later meshes
// claimed and taken are read only if there are several meshes.
typedef struct
{
  const SampleRows* rows;
  __global const uint* bits;
  __global const uint* claimed;
  __global const ushort2* taken;
  int samples; // number of samples in a column
} mesh_samples;

// Correction of a voxel's volume by one crossing. Returns the index of the voxel in the slab, or -1 if it is outside,
// and the correction in 1 / UNITS of a sample.
//   excess      position of the crossing: ALONG(normal) times its distance from the column's first sample, plus s->tie
//   across, up  indices of the column
//   scale       factor that converts `twice`, below, to a correction
//   turned      1: lines along the column leave the mesh at this triangle; -1: they enter it; 0: not known
inline int2 correction_at(
  const mesh_samples* mesh, const sheet* s, long excess, int across, int up, float scale, int turned)
{
  const int number = samples_before(excess, s->step, mesh->samples);
  // Position of the crossing relative to the sample after it, <= 0. Distances are multiplied by ALONG(normal), so that
  // the distance of two samples is s->step.
  const long rest = excess - s->tie - number * s->step;
  // Twice the position of the crossing relative to the border between the fine voxels of the samples before and after.
  const long twice = 2 * rest + s->step;
  const int cell = number - (twice < 0 ? 1 : 0);
  if (rest < -s->step || rest > 0 || cell < 0 || cell >= mesh->samples)
  {
    return (int2)(-1, 0);
  }
  const int4 voxels = mesh->rows->voxels;
  const int3 voxel =
    place(cell / SAMPLES, across / SAMPLES, up / SAMPLES, AXIS) - place(0, 0, mesh->rows->firstVoxel, BIT_AXIS);
  if (any(voxel < 0) || any(voxel >= voxels.xyz))
  {
    return (int2)(-1, 0);
  }
  const int index = (voxel.z * voxels.y + voxel.y) * voxels.x + voxel.x;
  const int3 before = place(number - 1, across, up, AXIS), after = place(number, across, up, AXIS);
  const int first = number == 0, last = number == mesh->samples;
  // A hidden crossing still counts if all samples of its voxel belong to later meshes.
  const int counts = !mesh->rows->several || mesh->taken[index].x == SAMPLES_OF_VOXEL ||
    !is_hidden(mesh->claimed, mesh->rows, before, after, first, last);
  const int side = counts ? side_of(mesh->bits, mesh->rows, before, after, first, last, turned) : 0;
  return (int2)(index, side * convert_int_rte(scale * (float)twice));
}

// Corrects the volume of the mesh within each voxel of a slab, the layers of voxels that are processed together, where
// triangles of the mesh cross the voxel. The corrections of a voxel are summed.
//   tiles          pieces of triangles, one per work-item, as in mark_crossings
//   samples, bits, claimed, taken  as in mesh_samples
//   orientation    1 if the mesh's triangles are counterclockwise as seen from outside, -1 if clockwise, 0 if triangles
//                  disagree
//   corrections    output, one value per voxel of the slab, x fastest, in 1 / UNITS of a sample
__kernel void measure_crossings(int tileCount, __global const uint4* tiles, __global const int* points,
  __global const int* triangles, int pitch, int samples, SampleRows rows, __global const uint* bits,
  __global const uint* claimed, __global const ushort2* taken, int orientation, __global int* corrections)
{
  const int id = get_global_id(0);
  if (id >= tileCount)
  {
    return;
  }
  const uint4 tile = tiles[id];
  sheet s;
  const int crosses = start_sheet(&s, tile, points, triangles, AXIS, pitch);
  const float weight = crosses ? weight_along(s.normal) : 0.0f;
  if (weight < LEAST_WEIGHT)
  {
    return;
  }
  const mesh_samples mesh = { &rows, bits, claimed, taken, samples };
  const float scale = weight * (0.5f * UNITS) / (float)s.step;
  const int tileColumns = tile.w >> 16, tileRows = tile.w & 0xffff;
  int2 sum = (int2)(-1, 0); // index of the last voxel with crossings, and its correction that is still to be added
  for (int j = 0; j < tileRows; ++j)
  {
    long v0 = s.e0.value, v1 = s.e1.value, v2 = s.e2.value, excess = s.excess;
    for (int i = 0; i < tileColumns; ++i)
    {
      if ((v0 | v1 | v2) >= 0)
      {
        const int2 here = correction_at(&mesh, &s, excess, tile.y + i, tile.z + j, scale, s.leaving * orientation);
        if (here.x >= 0 && here.x != sum.x)
        {
          if (sum.y != 0)
          {
            atomic_add(corrections + sum.x, sum.y);
          }
          sum = (int2)(here.x, 0);
        }
        sum.y += here.y;
      }
      v0 += s.e0.across;
      v1 += s.e1.across;
      v2 += s.e2.across;
      excess -= s.excessAcross;
    }
    next_row(&s);
  }
  if (sum.y != 0)
  {
    atomic_add(corrections + sum.x, sum.y);
  }
}

// Number of a voxel's samples inside the mesh, including those that belong to later meshes.
inline int samples_in_voxel(__global const uint* bits, const SampleRows* rows, int3 voxel)
{
  int number = 0;
  for (int k = 0; k < SAMPLES_OF_VOXEL; ++k)
  {
    const int3 sample = (int3)(k % SAMPLES, k / SAMPLES % SAMPLES, k / (SAMPLES * SAMPLES));
    number += is_set(bits, rows, voxel * SAMPLES + sample);
  }
  return number;
}

// Quotient rounded to the nearest integer, with halves rounded away from 0.
inline long divided(long number, long by)
{
  return (number + (number < 0 ? -by : by) / 2) / by;
}

// Converts counts of samples to units of 1 / UNITS_OF_COUNT of a sample, and adds the corrections.
//
// With several meshes, a mesh can occupy only what later meshes leave of a voxel: a number of samples and a volume in
// units. This volume is not that of the samples left, because the counts of later meshes are corrected too. A mesh gets
// a share of the difference in proportion to its fraction of the samples left. If no sample is left but some volume is,
// the share is the mesh's fraction of all samples of the voxel.
//   taken    for each voxel, the samples and the units of later meshes; read only if there are several meshes. The
//            mesh's own are added
//   counts   counts of the slab's voxels: in samples on input, in units on output
__kernel void refine_counts(SampleRows rows, __global const int* corrections, __global ushort2* taken,
  __global const uint* bits, __global ushort* counts)
{
  const int id = get_global_id(0);
  const int4 voxels = rows.voxels;
  if (id >= voxels.x * voxels.y * voxels.z)
  {
    return;
  }
  const int number = counts[id];
  long units = (long)number * UNITS_OF_COUNT + divided((long)corrections[id] * UNITS_OF_COUNT, UNITS);
  long room = SAMPLES_OF_VOXEL * UNITS_OF_COUNT;
  if (rows.several)
  {
    const ushort2 later = taken[id];
    const int left = SAMPLES_OF_VOXEL - later.x;
    const int left_over = left * UNITS_OF_COUNT;
    room -= later.y;
    if (left > 0)
    {
      units += divided((room - left_over) * number, left);
    }
    else if (room > 0)
    {
      const int3 voxel = (int3)(id % voxels.x, id / voxels.x % voxels.y, id / voxels.x / voxels.y);
      const long own = samples_in_voxel(bits, &rows, voxel + place(0, 0, rows.firstVoxel, BIT_AXIS));
      units += own * UNITS_OF_COUNT - divided(own * later.y, SAMPLES_OF_VOXEL);
    }
    units = clamp(units, 0L, room);
    taken[id] = (ushort2)(later.x + number, later.y + (ushort)units);
  }
  counts[id] = (ushort)clamp(units, 0L, room);
}

// Adds the samples inside a mesh to those that later meshes have claimed, in words `first` to first + words.
__kernel void claim_samples(ulong first, int words, __global const uint* bits, __global uint* claimed)
{
  const int id = get_global_id(0);
  if (id < words)
  {
    claimed[first + id] |= bits[first + id];
  }
}
