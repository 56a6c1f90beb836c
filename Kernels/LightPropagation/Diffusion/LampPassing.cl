// First-scattered light of lamps in optically thick voxels: lamp light is first scattered near the
// faces through which it enters, and a fraction of the scattered light leaves through these faces without another
// collision.

#include "LightPropagation/Diffusion/BoxBorders.cl"
#include "LightPropagation/Sweep/FallOfLight.cl"

// Fraction of a voxel's first-scattered light that returns to the face through which lamp light enters (`back` of
// numerics.md, Eq. (69)), if the density of first collisions decreases as exp(-b t) with the optical depth t < tau
// behind that face, and light is attenuated by exp(-k t) on its way back. The constant b follows from depth = 2 t_mean
// / tau, where t_mean is the mean optical depth of first collisions: 1 if it is that of the voxel's centre, 0 if it is
// that of the face.
static float comes_back(float tau, float depth, float k)
{
  const float x = fall_behind(fmax(depth, 1e-6f)), y = x + k * tau;
  const float shone = x < 1e-3f ? 1.0f - 0.5f * x : -expm1(-x) / x;
  const float back = y < 1e-3f ? 1.0f - 0.5f * y : -expm1(-y) / y;
  return back / shone;
}

// Fraction of a voxel's first-scattered light that crosses an inner face, minus the fraction that would cross it if all
// light scattered at the voxel's centre; without the factor way_i / (way_i + way_j) of numerics.md, Eqs. (66) and (69).
static float passes_inside(float tau, float depth, float k)
{
  if (k * tau < 0.02f)
  {
    return 1.0f - depth;
  }
  const float even = -expm1(-k * tau) / (k * tau);
  return fmax((comes_back(tau, depth, k) - even) / (1.0f - even), 0.0f);
}

// Mean of Hopf's function with the weight exp(-t / depth): H(depth) / sqrt(3) - depth, to 0.5% (numerics.md, Eq. (67)).
static float hopf(float depth)
{
  const float c = 0.34f - 0.17f / (1.0f + 4.0f * depth);
  return 0.57735f + 0.13310f * depth / (depth + c);
}

// Factor that corrects the fraction of first-scattered light that crosses a face; it differs from 1 in voxels that are
// neither optically thin nor thick, and was fitted to slabs (numerics.md, Eq. (68)).
static float beside_sweeps(float tau)
{
  const float transport_weight = 1.0f / (1.0f + 0.25f * tau * tau);
  return 1.0f + transport_weight * (0.02f + 0.17f * transport_weight);
}

// Fraction of a voxel's first-scattered light that crosses a face of the box, minus the fraction that would cross it if
// all light scattered at the voxel's centre (numerics.md, Eqs. (66), (69)).
static float passes_border(float tau, float depth, float k)
{
  const float mean = 0.5f * depth * tau;
  const float q = mix(hopf(mean), 2.0f / 3.0f, depth);
  if (k * tau < 0.02f)
  {
    return fmax(1.0f - (mean + q) / (0.5f * tau + 2.0f / 3.0f), 0.0f);
  }
  const float even = -expm1(-k * tau) / (k * tau * (1.0f + k * (2.0f / 3.0f)));
  const float kept = 1.0f - comes_back(tau, depth, k) / (1.0f + k * q);
  return fmax(1.0f - kept / (1.0f - even), 0.0f);
}

// Adds the power of a lamp's first-scattered light that leaves its voxel through each face without another collision
// (numerics.md, Eqs. (66) to (69)).
//   path           path integrals of the lamp, W length
//   swept          sigma_t of the sweeps: larger than sigma_t if scattering is solved in angular moments
// first_moments  first moments of the lamp's deposit: where in each voxel light collides first, W length,
//                [channel][face][voxel] (Deposit::firstMoments)
// passed         power of first-scattered light through voxel faces, W, [channel][face][voxel]; added to
// all_path       path integrals of all lamps, W length; added to
__kernel void pass_lamp_light(DiffusionLayout layout, const __global float* sigma_t, const __global float* sigma_a,
  const __global float* sigma_s, const __global float* swept, const __global float* path,
  const __global float* first_moments, __global float* passed, __global float* all_path)
{
  VOXEL(layout.size)
  const int at[3] = { x, y, z };
  int next[6];
  find_neighbours(layout.size, x, y, z, i, next);
  const ulong stride = layout.stride;
  sigma_t += layout.firstT;
  swept += layout.firstT;
  sigma_a += layout.first;
  first_moments += 6 * (ulong)layout.first;
  passed += 6 * (ulong)layout.first;
  const float length = path[layout.first + i];
  const float k = sigma_t[i] > 0.0f ? sqrt(3.0f * fmin(sigma_a[i] / sigma_t[i], 1.0f)) : 0.0f;
  // isotropic part of the scattered light: 1 - 3 g, with the mean cosine g = 1 - sigma_t / swept of scattering in
  // sweeps
  const float even = swept[i] > 0.0f ? 1.0f - 3.0f * (1.0f - fmin(sigma_t[i] / swept[i], 1.0f)) : 1.0f;
  float part[6], sum = 0.0f;
  for (int d = 0; d < 6; ++d)
  {
    const int axis = d / 2;
    const float h = layout.spacing[axis];
    const float tau = sigma_t[i] * h;
    const float moment = first_moments[d * stride + i];
    const float depth = length > 0.0f ? fmax((length - 2.0f * moment) / length, 0.0f) : 1.0f; // 1 - r, Eq. (66)
    part[d] = 0.0f;
    // Where sweeps use more extinction than the diffusion system, angular moments represent forward scattering, which
    // does not send light back through its entry face.
    if (tau <= 0.0f || moment <= 0.0f || depth >= 1.0f || even <= 0.0f)
    {
      continue;
    }
    if (is_border(&layout, at, d))
    {
      part[d] = even * passes_border(tau, depth, k) * beside_sweeps(tau);
    }
    else if (layout.size[axis] > 1)
    {
      const int j = next[d];
      const float way = way_to_boundary(&layout, tau, sigma_t[i], sigma_a[i]);
      const float beyond = way_to_boundary(&layout, sigma_t[j] * h, sigma_t[j], sigma_a[j]);
      part[d] = even * passes_inside(tau, depth, k) * way / (way + beyond) * beside_sweeps(tau);
    }
    sum += part[d];
  }
  // limits the sum over faces to the scattered power, in voxels lit through several faces
  const float power = sigma_s[layout.first + i] * length / fmax(sum, 1.0f);
  for (int d = 0; d < 6; ++d)
  {
    passed[d * stride + i] += part[d] * power;
  }
  all_path[layout.first + i] += length;
}
