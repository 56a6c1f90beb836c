// Lattice steps of the photon densities of all voxels together (numerics.md, section 10 c, Eq. (L1)). The host defines
// the options of LatticeLink.cl, and
//   STREAMS  1: densities exceed the caches; use streaming stores if the compiler has them
#include "LatticeBoltzmann/LatticeLink.cl"

#ifdef __has_builtin
#if __has_builtin(__builtin_nontemporal_store)
#define STORE_PAST_CACHES 1
#endif
#endif

#define WIDTH 16
DEFINE_ARRIVING(arriving, float16)
DEFINE_COLLIDED(collided, float16)
DEFINE_OPEN(open_weight, float16, int16)
DEFINE_SENT(sent_weight, float16, int16)

// Stores sixteen values from `at` on, but no more than `voxels`, the number of voxels to the end of the row.
static void store_some(float16 values, __global float* to, ulong at, int voxels)
{
  if (voxels >= WIDTH)
  {
    vstore16(values, 0, to + at);
    return;
  }
  float some[WIDTH];
  vstore16(values, 0, some);
  for (int k = 0; k < voxels; ++k)
  {
    to[at + k] = some[k];
  }
}

// Stores sixteen densities, whose rows are aligned, as store_some() does. A streaming store avoids reading the cache
// lines that it overwrites.
static void store_densities(float16 values, __global float* to, ulong at, int voxels)
{
#ifdef STORE_PAST_CACHES
  if (STREAMS && voxels >= WIDTH)
  {
    __builtin_nontemporal_store(values, (__global float16*)(to + at));
    return;
  }
#endif
  store_some(values, to, at, voxels);
}

// Properties of the medium at each place of the lattice:
//   resistance  inverse of the fraction that a link between two voxels like this one transmits; 1 outside
//   squared     n^2; 0 outside
//   albedo      albedo of the face, outside the box; 0 inside
#define LINKS const __global float *resistance, const __global float *squared, const __global float *albedo

// Light that arrives along direction i in the sixteen voxels from index `at` on, W / length^2.
static float16 arriving_along(LatticeInfo lattice, LINKS, const __global float* from, int i, ulong at)
{
  const ulong other = at - lattice.offset[i];
  const float16 one = (float16)(1.0f), zero = (float16)(0.0f);
  const float16 sent = vload16(0, from + i * lattice.stride + other);
  const float16 back = PLAIN ? zero : vload16(0, from + (i ^ 1) * lattice.stride + at);
  return arriving(sent, back, PASSES_ALL ? one : vload16(0, resistance + at),
    PASSES_ALL ? one : vload16(0, resistance + other), BENDS ? vload16(0, squared + at) : one,
    BENDS ? vload16(0, squared + other) : one, REFLECTS ? vload16(0, albedo + other) : zero);
}

// One lattice step. One work-item per row of voxels. Arrays have the layout of the lattice, except for the fluence:
//   turning   fraction of the density that collisions make isotropic
//   kept      fraction that is not absorbed in a step; published scheme: neither absorbed nor scattered
//   source    isotropic source, W / length^2 per step
//   endless   with ENDLESS: bit mask of the direction pairs along which nothing is sent
//   from, to  densities before and after the step
//   fluence   [voxel], written with `writes`
__kernel void step_lattice(LatticeInfo lattice, LINKS, const __global float* turning, const __global float* kept,
  const __global float* source, const __global float* endless, const __global float* from, __global float* to,
  __global float* fluence, int writes)
{
  const int y = get_global_id(0), z = get_global_id(1), nx = lattice.size[0];
  const ulong line = (ulong)(z + 1) * lattice.layer + (ulong)(y + 1) * lattice.row + LatticeFirst;
  for (int x = 0; x < nx; x += WIDTH)
  {
    const ulong at = line + x;
    const float16 half_source = 0.5f * vload16(0, source + at);
    float16 here[DIRECTIONS], sum = half_source;
    FOR_DIRECTIONS(i)
    {
      here[i] = arriving_along(lattice, resistance, squared, albedo, from, i, at);
      sum += here[i];
    }
    const float16 even = vload16(0, turning + at), stays = vload16(0, kept + at);
    const int16 closed = ENDLESS ? convert_int16(vload16(0, endless + at)) : (int16)(0);
    const float16 open = open_weight(closed);
    FOR_DIRECTIONS(i)
    {
      const float16 weight = sent_weight(i, closed, open), own = weight * half_source;
      store_densities(collided(weight, here[i] + own, sum, even, stays) + own, to + i * lattice.stride, at, nx - x);
    }
    if (writes)
    {
      store_some(sum, fluence, ((ulong)z * lattice.size[1] + y) * nx + x, nx - x);
    }
  }
}

// Computes source = emits + scatters times one channel of a fluence, [voxel][channel] (Lattice::SetSourceOf). One
// work-item per row of voxels.
__kernel void source_of_fluence(LatticeInfo lattice, const __global float* scatters, const __global float* emits,
  const __global float* fluence, int channels, int channel, __global float* source)
{
  const int y = get_global_id(0), z = get_global_id(1), nx = lattice.size[0];
  const ulong line = (ulong)(z + 1) * lattice.layer + (ulong)(y + 1) * lattice.row + LatticeFirst;
  const __global float* row = fluence + ((ulong)z * lattice.size[1] + y) * nx * channels + channel;
  for (int x = 0; x < nx; ++x)
  {
    source[line + x] = emits[line + x] + scatters[line + x] * row[x * channels];
  }
}

// Copies the fluence at the given voxels. One work-item per given voxel.
__kernel void look_at_lattice(const __global float* fluence, const __global int* voxels, __global float* seen)
{
  const int i = get_global_id(0);
  seen[i] = fluence[voxels[i]];
}

// Computes the net flux, W / length^2, [x, y, z][voxel]: the sum over links of the link's vector times the mean of its
// arriving and its leaving density. One work-item per row of voxels.
__kernel void flux_lattice(LatticeInfo lattice, LINKS, const __global float* from, __global float* flux)
{
  const int y = get_global_id(0), z = get_global_id(1), nx = lattice.size[0];
  const ulong line = (ulong)(z + 1) * lattice.layer + (ulong)(y + 1) * lattice.row + LatticeFirst;
  const ulong voxels = (ulong)nx * lattice.size[1] * lattice.size[2];
  for (int x = 0; x < nx; x += WIDTH)
  {
    float16 along[3] = { 0.0f, 0.0f, 0.0f };
    FOR_DIRECTIONS(i)
    {
      const float16 mean = 0.5f *
        (arriving_along(lattice, resistance, squared, albedo, from, i, line + x) +
          vload16(0, from + i * lattice.stride + line + x));
      for (int a = 0; a < 3; ++a)
      {
        along[a] += (float)Ways[i][a] * mean;
      }
    }
    for (int a = 0; a < 3; ++a)
    {
      store_some(along[a], flux + a * voxels, ((ulong)z * lattice.size[1] + y) * nx + x, nx - x);
    }
  }
}

// Copies densities to the halo across a periodic axis. One work-item per direction and value in a plane perpendicular
// to the axis.
//   u, v   strides within the plane
//   along  stride along the periodic axis
//   n      voxels along the periodic axis
__kernel void wrap_lattice(__global float* densities, ulong stride, int u, int v, int along, int n)
{
  __global float* at = densities + LatticeFirst - 1 + get_global_id(2) * stride + (ulong)get_global_id(0) * u +
    (ulong)get_global_id(1) * v;
  at[0] = at[(ulong)n * along];
  at[(ulong)(n + 1) * along] = at[along];
}

// Computes the light that each voxel sends through the box's faces in the next step, W / length^2, [face][voxel]. Light
// that leaves across an edge of the box is split equally between both faces. Periodic axes have no faces.
__kernel void leave_lattice(
  LatticeInfo lattice, const __global float* resistance, const __global float* densities, __global float* leaving)
{
  const int at[3] = { get_global_id(0), get_global_id(1), get_global_id(2) };
  const ulong place = (ulong)(at[2] + 1) * lattice.layer + (ulong)(at[1] + 1) * lattice.row + at[0] + LatticeFirst;
  const ulong voxel = ((ulong)at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
  const ulong voxels = (ulong)lattice.size[0] * lattice.size[1] * lattice.size[2];
  float through[6] = { 0.0f };
  for (int i = 0; i < DIRECTIONS; ++i)
  {
    int first = -1, second = -1;
    for (int a = 0; a < 3; ++a)
    {
      const int next = at[a] + Ways[i][a];
      const int face = 2 * a + (next < 0 ? 0 : 1);
      if (!(lattice.periodic >> a & 1) && !(lattice.inner >> face & 1) && (next < 0 || next >= lattice.size[a]))
      {
        second = face;
        first = first < 0 ? second : first;
      }
    }
    if (first >= 0)
    {
      const float black = 1.0f - 0.5f * (lattice.albedo[first] + lattice.albedo[second]);
      const float half_of = black / (resistance[place] + 1.0f) * densities[i * lattice.stride + place];
      through[first] += half_of;
      through[second] += half_of;
    }
  }
  for (int face = 0; face < 6; ++face)
  {
    leaving[face * voxels + voxel] = through[face];
  }
}
