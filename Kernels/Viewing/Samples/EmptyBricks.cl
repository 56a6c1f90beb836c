// Finds empty bricks, which rays may skip. One program serves all scenes: the argument SampleTraits describes what the
// samples hold.

#include "Viewing/Samples/SampleLayout.cl"
#include "Viewing/Scene/ViewShared.h"

// Whether a packed sample has extinction or a source.
//   place  index of the sample; -1: there is none
static int is_filled(const SampleTraits* of, int place, __global const float4* samples,
  __global const float4* extinctions, __global const float4* glow)
{
  if (place < 0)
  {
    return 0;
  }
  const float4 values = samples[place];
  int filled = of->shown ? values.w != 0.0f : any(values.xy != (float2)(0.0f));
  if (!of->shown && !of->grey)
  {
    filled |= any(values.zw != (float2)(0.0f));
  }
  if (of->coloured)
  {
    filled |= any(extinctions[place] != (float4)(0.0f));
  }
  if (of->glow)
  {
    filled |= any(glow[place] != (float4)(0.0f));
  }
  return filled;
}

// Index of a packed sample; -1 if it belongs to an empty brick, which has no record (no samples of its own).
//   x, y, z  position of the sample in the grid with its border
//   records  for samples in bricks: index of the first sample of each brick's record, 0 for empty bricks
static int place_of(const SampleTraits* of, int x, int y, int z, int4 size, __global const int* records)
{
  if (!of->bricked)
  {
    return (z * (size.y + 2) + y) * (size.x + 2) + x;
  }
  const int i = min(x, size.x) / BrickEdge, j = min(y, size.y) / BrickEdge, k = min(z, size.z) / BrickEdge;
  const int first = records[(k * (size.y / BrickEdge + 1) + j) * (size.x / BrickEdge + 1) + i];
  const int rows = SAMPLE_ROWS_OF(of->grey);
  const int row = (z - k * BrickEdge) * rows + min(y - j * BrickEdge, rows - 1);
  return first == 0 ? -1 : first + row * SampleEdge + x - i * BrickEdge;
}

// Classifies each brick of voxels. 0: rays bend in it; 1: it is empty; -1: some sample that is interpolated inside it
// has extinction or a source. Bricks that SeenBricks::seen (ViewTraits.h) does not mark count as empty.
__kernel void find_empty_bricks(PackInfo info, SampleTraits of, __global const float4* restrict samples,
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
  int filled = 0, bends = of.bends ? 0 : 1; // `bends` is 1 also if the scene bends no rays: the search ends
  for (int z = z0; z <= z1 && !(filled && bends); ++z)
  {
    for (int y = y0; y <= y1 && !(filled && bends); ++y)
    {
      for (int x = x0; x <= x1; ++x)
      {
        filled |= is_filled(&of, place_of(&of, x, y, z, size, records), samples, extinctions, glow);
        if (of.bends)
        {
          const int there =
            ((z + info.before.z) * (info.known.y + 2) + y + info.before.y) * (info.known.x + 2) + x + info.before.x;
          bends |= any(bending[there].xyz != (float3)(0.0f));
        }
      }
    }
  }
  bricks[brick] = of.bends && bends ? 0 : filled ? -1 : 1;
}
