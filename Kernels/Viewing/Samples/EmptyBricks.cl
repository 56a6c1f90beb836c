// Finds empty bricks, which rays may skip. A separate program, because it needs few of the options with which samples
// are packed.
//
// Macros set by the host:
//   COLOURED, GREY, BRICKED  as in Sampling.cl
//   GLOW   1: emission is packed separately
//   BENDS  1: the refractive index varies
//   SHOWN  nonzero: samples were packed by ShownSamples.cl, and only the extinction tells whether they are empty

#include "Viewing/Samples/SampleLayout.cl"
#include "Viewing/Scene/ViewShared.h"

// Whether a packed sample has extinction or a source.
//   place  index of the sample; -1: there is none
static int is_filled(
  int place, __global const float4* samples, __global const float4* extinctions, __global const float4* glow)
{
  if (place < 0)
  {
    return 0;
  }
#if GREY
  int filled = any(samples[place].xy != (float2)(0.0f));
#else
  int filled = SHOWN ? samples[place].w != 0.0f : any(samples[place] != (float4)(0.0f));
#endif
#if COLOURED
  filled |= any(extinctions[place] != (float4)(0.0f));
#endif
#if GLOW
  filled |= any(glow[place] != (float4)(0.0f));
#endif
  return filled;
}

// Index of a packed sample; -1 if it belongs to an empty brick, which has no record (no samples of its own).
//   x, y, z  position of the sample in the grid with its border
//   records  with BRICKED: index of the first sample of each brick's record, 0 for empty bricks
static int place_of(int x, int y, int z, int4 size, __global const int* records)
{
#if BRICKED
  const int i = min(x, size.x) / BrickEdge, j = min(y, size.y) / BrickEdge, k = min(z, size.z) / BrickEdge;
  const int first = records[(k * (size.y / BrickEdge + 1) + j) * (size.x / BrickEdge + 1) + i];
  const int row = (z - k * BrickEdge) * SAMPLE_ROWS + min(y - j * BrickEdge, SAMPLE_ROWS - 1);
  return first == 0 ? -1 : first + row * SampleEdge + x - i * BrickEdge;
#else
  return z * SLICE_LENGTH(size) + y * ROW_LENGTH(size) + x;
#endif
}

// Classifies each brick of voxels: 1 if it is empty, -1 if a sample that is interpolated inside it has extinction or a
// source, 0 with BENDS if rays bend in it. Bricks that are not in SeenBricks::seen (ViewTraits.h) are empty.
__kernel void find_empty_bricks(PackInfo info, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const float4* restrict glow,
  __global const float4* restrict bending, __global const uchar* restrict seen, __global const int* restrict records,
  __global char* restrict bricks)
{
  const int4 size = info.size, brick_count = info.bricks;
  const int i = get_global_id(0), j = get_global_id(1), k = get_global_id(2);
  if (i >= brick_count.x)
  {
    return;
  }
  const int brick = (k * brick_count.y + j) * brick_count.x + i;
  if (!seen[brick])
  {
    bricks[brick] = 1;
    return;
  }
  const int x0 = i * BrickEdge, x1 = min(x0 + BrickEdge + 1, size.x + 1);
  const int y0 = j * BrickEdge, y1 = min(y0 + BrickEdge + 1, size.y + 1);
  const int z0 = k * BrickEdge, z1 = min(z0 + BrickEdge + 1, size.z + 1);
  int filled = 0;
  int bends = 0;
#if BENDS
#define LOOK_ON (!filled || !bends)
#else
#define LOOK_ON (!filled)
#endif
  for (int z = z0; z <= z1 && LOOK_ON; ++z)
  {
    for (int y = y0; y <= y1 && LOOK_ON; ++y)
    {
      for (int x = x0; x <= x1; ++x)
      {
        filled |= is_filled(place_of(x, y, z, size, records), samples, extinctions, glow);
#if BENDS
        const int there =
          ((z + info.before.z) * (info.known.y + 2) + y + info.before.y) * (info.known.x + 2) + x + info.before.x;
        bends |= any(bending[there].xyz != (float3)(0.0f));
#endif
      }
    }
  }
#undef LOOK_ON
  bricks[brick] = bends ? 0 : filled ? -1 : 1;
}
