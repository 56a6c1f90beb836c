// A level of the pyramid for each voxel, after LightRows.cl. A work-item a voxel. Compiled with
//   ESTIMATOR   0 published, 1 constant radius, 2 nearest photons
//   CHANNELS, DIRECTIONS  of the light; fields of its pyramid are its channels, then the mean direction

typedef struct
{
  int4 size[9];
  ulong offset[9];
} pyramid;

// Trilinear interpolation between the cells of a level where voxel (x, y, z) is: getInterpolatedValue of listing B.3.
inline float sample(const __global float* values, const __global pyramid* where, int level, int field, int4 voxel)
{
  const int4 size = where->size[level];
  const float cell = 1.0f / (float)(1 << level);
  const float4 at = (convert_float4(voxel) + 0.5f) * cell - 0.5f;
  const float4 low = floor(at);
  const float4 part = at - low;
  const int4 i = convert_int4(low);
  const __global float* of = values + where->offset[level];
  float sum[2][2];
  for (int z = 0; z < 2; ++z)
  {
    for (int y = 0; y < 2; ++y)
    {
      const __global float* row = of + row_of(size, field, i.y + y, i.z + z);
      const float left = row[within(i.x, size.x)], right = row[within(i.x + 1, size.x)];
      sum[z][y] = left + part.x * (right - left);
    }
  }
  const float low_z = sum[0][0] + part.y * (sum[0][1] - sum[0][0]);
  const float high_z = sum[1][0] + part.y * (sum[1][1] - sum[1][0]);
  return low_z + part.z * (high_z - low_z);
}

inline float light_at(const __global float* values, const __global pyramid* where, int level, int4 voxel)
{
  float sum = 0.0f;
  for (int c = 0; c < CHANNELS; ++c)
  {
    sum += sample(values, where, level, c, voxel);
  }
  return sum;
}

// The first level at which `least` photons are found; the top where none has so many.
inline int populated(const __global float* counts, const __global pyramid* where, int top, float least, int4 voxel)
{
  int level = 0;
  while (level < top && sample(counts, where, level, 0, voxel) < least)
  {
    ++level;
  }
  return level;
}

// Up as long as the difference of two levels does not grow (listing B.3).
inline int by_surround(const __global float* light, const __global pyramid* where, int top, int4 voxel)
{
  if (top < 2)
  {
    return 0;
  }
  int level = 0;
  float surround = light_at(light, where, 1, voxel);
  float difference = fabs(light_at(light, where, 0, voxel) - surround);
  float next = light_at(light, where, 2, voxel);
  float next_difference = fabs(surround - next);
  while (next_difference <= difference && level + 2 < top)
  {
    ++level;
    surround = next;
    next = light_at(light, where, level + 2, voxel);
    difference = next_difference;
    next_difference = fabs(surround - next);
  }
  return level;
}

__kernel void choose_level(const __global float* light, const __global pyramid* where, const __global float* counts, const __global float* weights,
  const __global pyramid* where_counts, int top, float parameter, __global float* fluence, __global float* direction, __global float* chosen)
{
  const int4 size = where->size[0];
  const int4 voxel = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  const size_t at = ((size_t)voxel.z * size.y + voxel.y) * size.x + voxel.x;
#if ESTIMATOR == 0
  const int found = populated(counts, where_counts, top, 1.0f, voxel);
  const float steps = sample(weights, where_counts, found, 0, voxel) / parameter;
  const int by_weight = (int)(steps < (float)top ? steps : (float)top);
  const int level = min(by_weight, by_surround(light, where, top, voxel));
#elif ESTIMATOR == 1
  const int level = top;
#else
  const int level = populated(counts, where_counts, top, parameter, voxel);
#endif
  for (int c = 0; c < CHANNELS; ++c)
  {
    fluence[at * CHANNELS + c] = sample(light, where, level, c, voxel);
  }
#if DIRECTIONS
  const float x = sample(light, where, level, CHANNELS, voxel);
  const float y = sample(light, where, level, CHANNELS + 1, voxel);
  const float z = sample(light, where, level, CHANNELS + 2, voxel);
  const float square = x * x + y * y + z * z;
  const float cut = square > 1.0f ? 1.0f / sqrt(square) : 1.0f;
  direction[3 * at] = x * cut;
  direction[3 * at + 1] = y * cut;
  direction[3 * at + 2] = z * cut;
#endif
  chosen[at] = (float)level;
}

// Light so that each channel's total is what it was.
__kernel void scale_light(__global float* fluence, float4 factors)
{
  const size_t at = get_global_id(0);
#if CHANNELS == 3
  fluence[3 * at] *= factors.x;
  fluence[3 * at + 1] *= factors.y;
  fluence[3 * at + 2] *= factors.z;
#else
  fluence[at] *= factors.x;
#endif
}
