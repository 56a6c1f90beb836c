// What a run of `chunk` (a multiple of RunStep) values holds, a work-item per run. Sums carry what they lost (Kahan),
// those of three components one by one.

#include "Reconstruction/ArrayRangeShared.h"

#define IN_SUMS (1.0f / RangeSumUnit)

typedef float16 __attribute__((aligned(4))) float16_anywhere;

inline void add(float16* sum, float16* lost, float16 value)
{
  const float16 y = value - *lost;
  const float16 t = *sum + y;
  *lost = (t - *sum) - y;
  *sum = t;
}

//   low, high  that values may have
__kernel void range_of_runs(
  const __global float* values, ulong count, int chunk, int components, float low, float high, __global RunRange* runs)
{
  const size_t first = get_global_id(0) * (size_t)chunk;
  const size_t rest = count - first;
  const int number = rest < (size_t)chunk ? (int)rest : chunk;
  const __global float* from = values + first;
  float16 sum[3] = { 0.0f, 0.0f, 0.0f }, lost[3] = { 0.0f, 0.0f, 0.0f };
  float16 largest = 0.0f;
  int16 fit = -1;
  int i = 0;
  for (; i + RunStep <= number; i += RunStep)
  {
#pragma unroll
    for (int k = 0; k < 3; ++k)
    {
      const float16 value = *(const __global float16_anywhere*)(from + i + 16 * k);
      const float16 magnitude = fabs(value);
      fit &= (value >= low) & (value <= high);
      largest = magnitude > largest ? magnitude : largest;
      add(&sum[k], &lost[k], value * IN_SUMS);
    }
  }
  float kept[RunStep];
  vstore16(sum[0] - lost[0], 0, kept);
  vstore16(sum[1] - lost[1], 1, kept);
  vstore16(sum[2] - lost[2], 2, kept);
  float sums[3] = { 0.0f, 0.0f, 0.0f };
  for (int k = 0; k < RunStep; ++k)
  {
    sums[k % components] += kept[k];
  }
  float most[16];
  vstore16(largest, 0, most);
  float magnitude = 0.0f;
  for (int k = 0; k < 16; ++k)
  {
    magnitude = most[k] > magnitude ? most[k] : magnitude;
  }
  int good = all(fit);
  for (; i < number; ++i)
  {
    const float value = from[i];
    good &= value >= low && value <= high;
    magnitude = fabs(value) > magnitude ? fabs(value) : magnitude;
    sums[i % components] += value * IN_SUMS;
  }
  __global RunRange* run = runs + get_global_id(0);
  run->unfit = !good;
  run->largest = magnitude;
  run->total[0] = sums[0];
  run->total[1] = sums[1];
  run->total[2] = sums[2];
}
