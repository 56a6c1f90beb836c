// The light that photons left. The host gives
//   CHANNELS, MEDIUM_CHANNELS, DIRECTIONS, COUNTS  as PhotonMarch.cl wants them
//   COPIES, BATCHES         of the sums: copy c is for batch c modulo BATCHES
//   COUNT_SHIFT             of the bits of counts, above those of weights
//   A_CHANNELS, S_CHANNELS  components of sigma_a and sigma_s, 0: there is none
//   CARRIES                 where it is defined: what is less than a unit of a voxel's power counts in the next one
//                           of its row. Sums in large units need it: half a unit of each voxel would be lost
//   BRICKS                  1: the sums stand by bricks (PhotonBricks.h)
//   COLOURS                 channels of what comes out: 3 also where one channel stands for three (CHANNELS 1)

#include "Medium/BrickShared.h"
#include "Numerics/Numerics.cl"
#include "Photons/Marching/PhotonSumsShared.h"
#include "Refraction/Index/SquaredIndex.cl"

#define RECORD (CHANNELS + 3 * DIRECTIONS + COUNTS)
#define component(values, count, voxel, c) \
  ((count) == 0 ? 0.0f : (values)[(voxel) * (count) + ((count) == 3 ? (c) : 0)])

// Light of one channel's power times diagonals, in what stands for it.
static void put_fluence(const LightSumsInfo* info, __global float* voxel, int c, float path)
{
#if CHANNELS == COLOURS
  voxel[c] = ldexp(path * info->fluence, info->exponent);
#else
  for (int out = 0; out < COLOURS; ++out)
  {
    voxel[out] = ldexp(path * info->fluence * info->colour[out], info->exponent);
  }
#endif
}

// Units of power that a coefficient, which is part of the extinction, took of a voxel's sum. Of a thick voxel that is
// what the photons lost.
static long taken_by(const LightSumsInfo* info, float sum, float coefficient, float extinction, float* carried)
{
  const float thickness = info->diagonal * extinction;
  const float taken = sum * (thickness > 1.0f ? coefficient / extinction : info->diagonal * coefficient);
#ifdef CARRIES
  const float all = taken + *carried;
  *carried = all - trunc(all);
  return (long)all;
#else
  return (long)taken;
#endif
}

// The sum over a batch's copies of a voxel's record, which is zero afterwards.
static void take_batch(__global long* record, ulong copyStride, int batch, long* sum)
{
  for (int c = 0; c < RECORD; ++c)
  {
    sum[c] = 0;
  }
  for (int w = batch; w < COPIES; w += BATCHES)
  {
    __global long* here = record + w * copyStride;
    long bits = 0;
    for (int c = 0; c < RECORD; ++c)
    {
      sum[c] += here[c];
      bits |= here[c];
    }
    if (bits != 0) // half of the memory need not be written
    {
      for (int c = 0; c < RECORD; ++c)
      {
        here[c] = 0;
      }
    }
  }
}

#if DIRECTIONS
// Of a few units of power, whose fractions are lost, directions are coarse, and could be longer than the power.
static void put_direction(__global float* mean_direction, const long* sum, float total)
{
  const float3 flow = (float3)(sum[CHANNELS], sum[CHANNELS + 1], sum[CHANNELS + 2]);
  const float most = fmax(total, length(flow));
  const float part = total > 0.0f ? 1.0f / most : 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    mean_direction[a] = sum[CHANNELS + a] * part;
  }
}
#endif

// Row by row: the copies of the sums are added up, and are zero afterwards.
//   fluence         COLOURS a voxel
//   mean_direction  3 per voxel: sum of power times direction over sum of power, no longer than 1; 0 where it is dark
//   photon_count    of a voxel; photon_weight: their mean weight, 0 where there is none
//   batch_fluence   [voxel][batch][COLOURS] of each batch as if it was all the light
//   taken           [row][absorbed, scattered][CHANNELS] units of power
__kernel void finish_light(LightSumsInfo info, const __global float* sigma_a, const __global float* sigma_s,
  __global long* sums, ulong copyStride, __global float* fluence, __global float* mean_direction,
  __global float* photon_count, __global float* photon_weight, __global float* batch_fluence, __global long* taken)
{
  const int r = get_global_id(0);
  const int nx = info.grid.size[0], ny = info.grid.size[1];
  const size_t copy = (size_t)(nx + 2) * (ny + 2) * (info.grid.size[2] + 2);
  const size_t first = ((size_t)(r / ny + 1) * (ny + 2) + r % ny + 1) * (nx + 2) + 1;
  long absorbed[CHANNELS], scattered[CHANNELS];
  float carried[2][CHANNELS];
  for (int c = 0; c < CHANNELS; ++c)
  {
    absorbed[c] = scattered[c] = 0;
    carried[0][c] = carried[1][c] = 0.0f;
  }
  for (int x = 0; x < nx; ++x)
  {
    const size_t voxel = (size_t)r * nx + x;
    __global long* record = sums + (first + x) * RECORD;
    float extinction[CHANNELS], thickness[CHANNELS]; // the medium's own: photons met one cut to what they can follow
    for (int c = 0; c < CHANNELS; ++c)
    {
      extinction[c] = component(sigma_a, A_CHANNELS, voxel, c) + component(sigma_s, S_CHANNELS, voxel, c);
      thickness[c] = fmax(info.diagonal * extinction[c], 1.0f);
    }
    long sum[RECORD];
#if BATCHES == 1
    take_batch(record, copyStride, 0, sum);
#else
    for (int c = 0; c < RECORD; ++c)
    {
      sum[c] = 0;
    }
    for (int b = 0; b < BATCHES; ++b)
    {
      long part[RECORD];
      take_batch(record, copyStride, b, part);
      for (int c = 0; c < RECORD; ++c)
      {
        sum[c] += part[c];
      }
      __global float* to = batch_fluence + (voxel * BATCHES + b) * COLOURS;
      for (int c = 0; c < CHANNELS; ++c)
      {
        put_fluence(&info, to, c, (float)part[c] / thickness[c] * BATCHES);
      }
    }
#endif
    float total = 0.0f;
    for (int c = 0; c < CHANNELS; ++c)
    {
      const float path = (float)sum[c] / thickness[c]; // power times diagonals
      total += sum[c];
      put_fluence(&info, fluence + voxel * COLOURS, c, path);
      absorbed[c] += taken_by(&info, sum[c], component(sigma_a, A_CHANNELS, voxel, c), extinction[c], &carried[0][c]);
      scattered[c] += taken_by(&info, sum[c], component(sigma_s, S_CHANNELS, voxel, c), extinction[c], &carried[1][c]);
    }
#if DIRECTIONS
    put_direction(mean_direction + voxel * 3, sum, total);
#endif
#if COUNTS
    const ulong counted = sum[RECORD - 1], weights = counted & (((ulong)1 << COUNT_SHIFT) - 1);
    const float photons = counted >> COUNT_SHIFT;
    photon_count[voxel] = photons;
    photon_weight[voxel] = photons > 0.0f ? weights / photons * info.weight : 0.0f;
#endif
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
#ifdef CARRIES
    absorbed[c] += carried[0][c] >= 0.5f;
    scattered[c] += carried[1][c] >= 0.5f;
#endif
    taken[(r * 2 + 0) * CHANNELS + c] = absorbed[c];
    taken[(r * 2 + 1) * CHANNELS + c] = scattered[c];
  }
}

#if BRICKS
// Gives voxels in a row the light of one, which may be among them.
static void fill_row(
  const size_t first, int size, const size_t from, __global float* fluence, __global float* mean_direction)
{
  float light[COLOURS];
  for (int c = 0; c < COLOURS; ++c)
  {
    light[c] = fluence[from * COLOURS + c];
  }
  for (int i = 0; i < size * COLOURS; ++i)
  {
    fluence[first * COLOURS + i] = light[i % COLOURS];
  }
#if DIRECTIONS
  const float3 direction = vload3(from, mean_direction);
  for (int x = 0; x < size; ++x)
  {
    vstore3(direction, first + x, mean_direction);
  }
#endif
}

// Brick by brick: as finish_light, of records (PhotonBricks.h). One batch, and no counts.
//   sigma_a, sigma_s  by records
//   fluence, mean_direction  by voxels; all of an empty brick have the mean over it
//   taken             [brick][absorbed, scattered][CHANNELS] units of power
__kernel void finish_bricks(LightSumsInfo info, const __global int* bricks, const __global float* sigma_a,
  const __global float* sigma_s, __global long* sums, ulong copyStride, __global float* fluence,
  __global float* mean_direction, __global long* taken)
{
  const int brick = get_global_id(0), first = bricks[brick];
  const int nx = (info.grid.size[0] + BrickEdge - 1) / BrickEdge, ny = (info.grid.size[1] + BrickEdge - 1) / BrickEdge;
  const int place[3] = { brick % nx, brick / nx % ny, brick / (nx * ny) };
  int size[3];
  for (int a = 0; a < 3; ++a)
  {
    size[a] = min((int)BrickEdge, info.grid.size[a] - place[a] * BrickEdge);
  }
  const float voxels = first < 0 ? size[0] * size[1] * size[2] : 1;
  const size_t strideY = info.grid.size[0], strideZ = strideY * info.grid.size[1];
  const size_t low = place[2] * BrickEdge * strideZ + place[1] * BrickEdge * strideY + place[0] * BrickEdge;
  long absorbed[CHANNELS], scattered[CHANNELS];
  for (int c = 0; c < CHANNELS; ++c)
  {
    absorbed[c] = scattered[c] = 0;
  }
  for (int z = 0; z < (first < 0 ? 1 : size[2]); ++z)
  {
    for (int y = 0; y < (first < 0 ? 1 : size[1]); ++y)
    {
      for (int x = 0; x < (first < 0 ? 1 : size[0]); ++x)
      {
        const size_t voxel = low + z * strideZ + y * strideY + x;
        const size_t record = first < 0 ? -first : first + (z * BrickEdge + y) * BrickEdge + x;
        long sum[RECORD];
        take_batch(sums + record * RECORD, copyStride, 0, sum);
        float total = 0.0f;
        for (int c = 0; c < CHANNELS; ++c)
        {
          const float a = component(sigma_a, A_CHANNELS, record, c), s = component(sigma_s, S_CHANNELS, record, c);
          total += sum[c];
          put_fluence(
            &info, fluence + voxel * COLOURS, c, (float)sum[c] / (fmax(info.diagonal * (a + s), 1.0f) * voxels));
          absorbed[c] += taken_by(&info, sum[c], a, a + s, 0);
          scattered[c] += taken_by(&info, sum[c], s, a + s, 0);
        }
#if DIRECTIONS
        put_direction(mean_direction + voxel * 3, sum, total);
#endif
      }
    }
  }
  for (int row = 0; first < 0 && row < size[1] * size[2]; ++row)
  {
    fill_row(low + row / size[1] * strideZ + row % size[1] * strideY, size[0], low, fluence, mean_direction);
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
    taken[(brick * 2 + 0) * CHANNELS + c] = absorbed[c];
    taken[(brick * 2 + 1) * CHANNELS + c] = scattered[c];
  }
}
#endif

// Row by row: what voxels have gained so far, as finish_light gives it. The sums stay.
__kernel void show_light(LightSumsInfo info, const __global float* sigma_a, const __global float* sigma_s,
  const __global long* sums, ulong copyStride, __global float* fluence)
{
  const int r = get_global_id(0);
  const int nx = info.grid.size[0], ny = info.grid.size[1];
  const size_t first = ((size_t)(r / ny + 1) * (ny + 2) + r % ny + 1) * (nx + 2) + 1;
  for (int x = 0; x < nx; ++x)
  {
    const size_t voxel = (size_t)r * nx + x;
    for (int c = 0; c < CHANNELS; ++c)
    {
      long sum = 0;
      for (int w = 0; w < COPIES; ++w)
      {
        sum += sums[(first + x) * RECORD + c + w * copyStride];
      }
      const float extinction = component(sigma_a, A_CHANNELS, voxel, c) + component(sigma_s, S_CHANNELS, voxel, c);
      put_fluence(&info, fluence + voxel * COLOURS, c, (float)sum / fmax(info.diagonal * extinction, 1.0f));
    }
  }
}
