// Before the photons: the medium as they need it. After them: light from what they left. Read after Numerics.cl and
// SquaredIndex.cl; the host gives
//   CHANNELS, MEDIUM_CHANNELS, DIRECTIONS, BENDS, LEVELS, WORKERS  as PhotonMarch.cl wants them
//   A_CHANNELS, S_CHANNELS  components of sigma_a and sigma_s, 0: there is none
//   COLOURS  channels of what comes out: 3 also where one channel stands for three (CHANNELS 1)

#define OUTSIDE -3e38f
#define FLAT 2e-6f // of n^2: what rounding makes of a constant
#define RECORD (CHANNELS + 3 * DIRECTIONS)
#define COPIES (WORKERS > 1 ? WORKERS : 1)
#define component(values, count, voxel, c) ((count) == 0 ? 0.0f : (values)[(voxel) * (count) + ((count) == 3 ? (c) : 0)])

// sigma  [MEDIUM_CHANNELS][padded] extinction over `diagonal`, OUTSIDE in the padding; its sign bit says that n^2 varies
//        within the reach of interpolation (low, high: the range of coefficients, in their padding)
// nodes  [padded] 0: it does not vary; else 1 + the voxel's octree level
__kernel void pack_extinction(index_grid grid, float diagonal, const __global float* sigma_a, const __global float* sigma_s,
  const __global float* low, const __global float* high, const __global uchar* levels, __global float* sigma,
  __global uchar* nodes)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int row = grid.size[0] + 2, layer = row * (grid.size[1] + 2);
  const size_t copy = (size_t)layer * (grid.size[2] + 2), at = (size_t)z * layer + y * row + x;
  const bool inside = x > 0 && x <= grid.size[0] && y > 0 && y <= grid.size[1] && z > 0 && z <= grid.size[2];
  const size_t voxel = ((size_t)(z - 1) * grid.size[1] + y - 1) * grid.size[0] + x - 1;
  bool varies = false;
#if BENDS
  const size_t i = ((size_t)(z + 1) * (grid.size[1] + 4) + y + 1) * (grid.size[0] + 4) + x + 1;
  varies = inside && high[i] - low[i] > FLAT * high[i];
  nodes[at] = varies ? 1 + (LEVELS ? levels[voxel] : 0) : 0;
#endif
  for (int c = 0; c < MEDIUM_CHANNELS; ++c)
  {
    float s = OUTSIDE;
    if (inside)
    {
      const float extinction = component(sigma_a, A_CHANNELS, voxel, c) + component(sigma_s, S_CHANNELS, voxel, c);
      s = fmin(diagonal * extinction, 1e30f); // endless, and times no length, it would be no number
      s = varies ? -s : s;
    }
    sigma[c * copy + at] = s;
  }
}

typedef struct
{
  index_grid grid;
  float diagonal;  // of a voxel
  float fluence;   // W / length^2 of a unit of power that goes along a voxel's diagonal
  float colour[3]; // of what CHANNELS 1 stands for
} light_info;

// Row by row: the copies of the sums are added up, and are zero afterwards.
//   fluence         COLOURS a voxel
//   mean_direction  3 a voxel: sum of power times direction over sum of power, no longer than 1; 0 where it is dark
//   taken           [row][absorbed, scattered][CHANNELS] units of power
__kernel void finish_light(light_info info, const __global float* sigma_a, const __global float* sigma_s,
  const __global float* sigma, __global long* sums, ulong copyStride, __global float* fluence,
  __global float* mean_direction, __global long* taken)
{
  const int r = get_global_id(0);
  const int nx = info.grid.size[0], ny = info.grid.size[1];
  const size_t copy = (size_t)(nx + 2) * (ny + 2) * (info.grid.size[2] + 2);
  const size_t first = ((size_t)(r / ny + 1) * (ny + 2) + r % ny + 1) * (nx + 2) + 1;
  long absorbed[CHANNELS], scattered[CHANNELS];
  for (int c = 0; c < CHANNELS; ++c)
  {
    absorbed[c] = scattered[c] = 0;
  }
  for (int x = 0; x < nx; ++x)
  {
    const size_t voxel = (size_t)r * nx + x;
    long sum[RECORD];
    for (int c = 0; c < RECORD; ++c)
    {
      sum[c] = 0;
    }
    for (int w = 0; w < COPIES; ++w)
    {
      __global long* record = sums + w * copyStride + (first + x) * RECORD;
      long bits = 0;
      for (int c = 0; c < RECORD; ++c)
      {
        sum[c] += record[c];
        bits |= record[c];
      }
      if (bits != 0) // half of the memory need not be written
      {
        for (int c = 0; c < RECORD; ++c)
        {
          record[c] = 0;
        }
      }
    }
    float total = 0.0f;
    for (int c = 0; c < CHANNELS; ++c)
    {
      const int m = MEDIUM_CHANNELS == 1 ? 0 : c;
      const float weight = fmax(fabs(sigma[m * copy + first + x]), 1.0f);
      const float path = (float)sum[c] / weight; // power times diagonals
      total += sum[c];
#if CHANNELS == COLOURS
      fluence[voxel * COLOURS + c] = path * info.fluence;
#else
      for (int out = 0; out < COLOURS; ++out)
      {
        fluence[voxel * COLOURS + out] = path * info.fluence * info.colour[out];
      }
#endif
      absorbed[c] += (long)(path * (info.diagonal * component(sigma_a, A_CHANNELS, voxel, c)));
      scattered[c] += (long)(path * (info.diagonal * component(sigma_s, S_CHANNELS, voxel, c)));
    }
#if DIRECTIONS
    // Of a few units of power, whose fractions are lost, directions are coarse, and could be longer than the power.
    const float3 flow = (float3)(sum[CHANNELS], sum[CHANNELS + 1], sum[CHANNELS + 2]);
    const float most = fmax(total, length(flow));
    const float part = total > 0.0f ? 1.0f / most : 0.0f;
    for (int a = 0; a < 3; ++a)
    {
      mean_direction[voxel * 3 + a] = sum[CHANNELS + a] * part;
    }
#endif
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
    taken[(r * 2 + 0) * CHANNELS + c] = absorbed[c];
    taken[(r * 2 + 1) * CHANNELS + c] = scattered[c];
  }
}
