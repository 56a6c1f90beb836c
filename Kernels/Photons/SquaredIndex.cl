// The squared refractive index n^2 between voxel centres, and its gradient. Lengths are in voxels here.
//
// n^2 is a tricubic B-spline, so that its gradient is continuous and is that of one function: a symplectic integrator then
// keeps its order and its Hamiltonian |T|^2 - n^2. The coefficients c = f - (d_x^2 + d_y^2 + d_z^2) f / 6, second differences of
// the voxels' f = n^2, make the spline meet f to fourth order (quadratic fields exactly) without a recursive filter.
// Beyond the grid f goes on linearly. The coefficient of voxel (i, j, k) stands at (i + 2, j + 2, k + 2) of an array that is
// four longer along each axis.

typedef struct
{
  int size[3];
} index_grid;

// A voxel on the grid's border or beyond it goes on as the two last ones of its row do.
static float squared_index_of(const index_grid* grid, const __global float* ior, int i, int j, int k)
{
  const int voxel[3] = { i, j, k };
  const int stride[3] = { 1, grid->size[0], grid->size[0] * grid->size[1] };
  int nearest = 0;
  for (int a = 0; a < 3; ++a)
  {
    nearest += stride[a] * clamp(voxel[a], 0, grid->size[a] - 1);
  }
  const float n = ior[nearest];
  float value = n * n;
  for (int a = 0; a < 3; ++a)
  {
    const int beyond = voxel[a] < 0 ? -voxel[a] : max(voxel[a] - grid->size[a] + 1, 0);
    if (beyond > 0 && grid->size[a] > 1)
    {
      const float inner = ior[nearest + (voxel[a] < 0 ? stride[a] : -stride[a])];
      value += beyond * (n - inner) * (n + inner);
    }
  }
  return value;
}

__kernel void squared_index_coefficients(index_grid grid, const __global float* ior, __global float* coefficients)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int i = x - 2, j = y - 2, k = z - 2;
  float f, others;
  if (i > 0 && i < grid.size[0] - 1 && j > 0 && j < grid.size[1] - 1 && k > 0 && k < grid.size[2] - 1)
  {
    const int row = grid.size[0], layer = row * grid.size[1];
    const __global float* n = ior + (k * layer + j * row + i);
    f = n[0] * n[0];
    others = n[-1] * n[-1] + n[1] * n[1] + n[-row] * n[-row] + n[row] * n[row] + n[-layer] * n[-layer] + n[layer] * n[layer];
  }
  else
  {
    f = squared_index_of(&grid, ior, i, j, k);
    others = squared_index_of(&grid, ior, i - 1, j, k) + squared_index_of(&grid, ior, i + 1, j, k) +
      squared_index_of(&grid, ior, i, j - 1, k) + squared_index_of(&grid, ior, i, j + 1, k) +
      squared_index_of(&grid, ior, i, j, k - 1) + squared_index_of(&grid, ior, i, j, k + 1);
  }
  coefficients[(z * (grid.size[1] + 4) + y) * (grid.size[0] + 4) + x] = 2.0f * f - others / 6.0f;
}

// Least and largest coefficient within two of each along one axis; what is beyond the array's ends is not asked for.
__kernel void widen_range(int stride, const __global float* low, const __global float* high, __global float* low_out,
  __global float* high_out)
{
  const int i = get_global_id(0) + 2 * stride;
  low_out[i] = fmin(fmin(fmin(low[i - 2 * stride], low[i - stride]), fmin(low[i + stride], low[i + 2 * stride])), low[i]);
  high_out[i] =
    fmax(fmax(fmax(high[i - 2 * stride], high[i - stride]), fmax(high[i + stride], high[i + 2 * stride])), high[i]);
}

typedef struct
{
  float4 value, slope; // of the four basis functions, from the first coefficient's
} spline_weights;

static spline_weights weights_at(float f)
{
  const float g = 1.0f - f;
  spline_weights w;
  w.value.s0 = g * g * g * (1.0f / 6.0f);
  w.value.s1 = f * f * (0.5f * f - 1.0f) + (2.0f / 3.0f);
  w.value.s2 = g * g * (0.5f * g - 1.0f) + (2.0f / 3.0f);
  w.value.s3 = f * f * f * (1.0f / 6.0f);
  w.slope.s0 = -0.5f * g * g;
  w.slope.s1 = f * (1.5f * f - 2.0f);
  w.slope.s2 = -g * (1.5f * g - 2.0f);
  w.slope.s3 = 0.5f * f * f;
  return w;
}

typedef float4 __attribute__((aligned(4))) float4_anywhere;

// n^2 (w) and its gradient (x, y, z) at voxel coordinates `p`.
static float4 squared_index(const index_grid* grid, const __global float* coefficients, float3 p)
{
  const int row = grid->size[0] + 4, layer = row * (grid->size[1] + 4);
  const float3 q = p - 0.5f;
  const float3 base = clamp(
    floor(q), (float3)(-1.0f), (float3)(grid->size[0] - 1.0f, grid->size[1] - 1.0f, grid->size[2] - 1.0f));
  const spline_weights x = weights_at(q.x - base.x), y = weights_at(q.y - base.y), z = weights_at(q.z - base.z);
  const __global float* first = coefficients + ((int)base.z + 1) * layer + ((int)base.y + 1) * row + (int)base.x + 1;
  float4 value = 0.0f, along_y = 0.0f, along_z = 0.0f;
#define ADD_LAYER(k, s) \
  { \
    const __global float* at = first + (k) * layer; \
    const float4 c0 = *(const __global float4_anywhere*)at, c1 = *(const __global float4_anywhere*)(at + row); \
    const float4 c2 = *(const __global float4_anywhere*)(at + 2 * row), c3 = *(const __global float4_anywhere*)(at + 3 * row); \
    const float4 rows = y.value.s0 * c0 + y.value.s1 * c1 + y.value.s2 * c2 + y.value.s3 * c3; \
    along_y += z.value.s * (y.slope.s0 * c0 + y.slope.s1 * c1 + y.slope.s2 * c2 + y.slope.s3 * c3); \
    value += z.value.s * rows; \
    along_z += z.slope.s * rows; \
  }
  ADD_LAYER(0, s0)
  ADD_LAYER(1, s1)
  ADD_LAYER(2, s2)
  ADD_LAYER(3, s3)
  return (float4)(dot(value, x.slope), dot(along_y, x.value), dot(along_z, x.value), dot(value, x.value));
}
