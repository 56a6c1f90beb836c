// From angular moments of the light that was found to those of what is scattered of it, but for the first, which is
// fluence: IsotropicScattering.cl. A work-item a value of a channel (or of all channels) and an angular function from
// the second on.
//   sigma_s  1/length, [degree][channel][stride]
//   path     W length, [function][channel][stride]
//   source   W / (length^3 sr), the same

// Degree of an angular function.
static int degree_of(int function)
{
  int l = 1;
  while ((l + 1) * (l + 1) <= function)
  {
    ++l;
  }
  return l;
}

// One order: replaces the source, clears the path.
__kernel void scatter_moments(
  __global float* path, __global float* source, const __global float* sigma_s, ulong stride, float per_path)
{
  const int q = get_global_id(1) + 1;
  const ulong i = get_global_id(0);
  const ulong at = q * stride + i;
  source[at] = sigma_s[degree_of(q) * stride + i] * path[at] * per_path;
  path[at] = 0.0f;
}

__kernel void add_scattered_moments(
  const __global float* path, __global float* source, const __global float* sigma_s, ulong stride, float per_path)
{
  const int q = get_global_id(1) + 1;
  const ulong i = get_global_id(0);
  const ulong at = q * stride + i;
  source[at] += sigma_s[degree_of(q) * stride + i] * path[at] * per_path;
}

// One channel, which begins at `first`: what is given and what is scattered.
__kernel void scatter_given_moments(const __global float* path, const __global float* given, __global float* source,
  const __global float* sigma_s, ulong stride, ulong first, float per_path)
{
  const int q = get_global_id(1) + 1;
  const ulong i = first + get_global_id(0);
  const ulong at = q * stride + i;
  source[at] = given[at] + sigma_s[degree_of(q) * stride + i] * path[at] * per_path;
}

__kernel void add_moments(const __global float* path, __global float* to, ulong stride)
{
  const ulong at = (get_global_id(1) + 1) * stride + get_global_id(0);
  to[at] += path[at];
}

// All moments: what one order shines, and `part` of what others did.
__kernel void add_to_shown(const __global float* source, __global float* shown, float part)
{
  const ulong at = get_global_id(0);
  shown[at] = source[at] + part * shown[at];
}

// Moments in functions of an AngularBasis as those in spherical harmonics, of voxels side by side. A work-item a voxel,
// a channel, and a harmonic.
//   basis      [function][harmonic]
//   functions  of the basis; harmonics are as many or fewer
//   moments    [function][channel][stride]
//   scale      [channel][stride]
//   out        [voxel][harmonic][channel]
__kernel void to_harmonics(const __global float* basis, int functions, const __global float* moments,
  const __global float* scale, ulong stride, __global float* out)
{
  const ulong i = get_global_id(0);
  const ulong c = get_global_id(1);
  const ulong j = get_global_id(2);
  const ulong channels = get_global_size(1);
  float sum = 0.0f;
  for (int q = j; q < functions; ++q)
  {
    const float part = basis[q * functions + j];
    sum += part != 0.0f ? part * moments[(q * channels + c) * stride + i] : 0.0f;
  }
  out[(i * get_global_size(2) + j) * channels + c] = scale[c * stride + i] * sum;
}

// A beam's own source, in voxels of the highest degree: the others scatter it in moments alone.
__kernel void scatter_beam(const __global float* path, __global float* source, const __global float* sigma_s,
  ulong stride, int slot, int degree, float per_path)
{
  const ulong i = get_global_id(0);
  source[slot * stride + i] += sigma_s[degree * stride + i] != 0.0f ? sigma_s[i] * path[i] * per_path : 0.0f;
}

// Net flux, W length, [channel][x, y, z], added to, from the moments of degree 1, which are sqrt(3) times y, z, x. A
// work-item a voxel and channel.
__kernel void add_flux_of_moments(const __global float* path, __global float* flux, ulong voxels, ulong stride)
{
  const ulong i = get_global_id(0);
  const ulong c = get_global_id(1);
  const ulong from = c * voxels + i;
  __global float* to = flux + 3 * c * voxels + i;
  to[0] += 0.57735027f * path[3 * stride + from];
  to[voxels] += 0.57735027f * path[stride + from];
  to[2 * voxels] += 0.57735027f * path[2 * stride + from];
}
