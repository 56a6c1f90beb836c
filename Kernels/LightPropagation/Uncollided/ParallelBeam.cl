// Kernel that follows the sweep of a parallel beam: adds the beam's path integrals to a deposit, and computes its first
// moments.

#include "LightPropagation/Sweep/BeyondFacesShared.h"
#include "LightPropagation/Uncollided/ParallelBeamShared.h"

// Mean distance of collisions from the voxel's centre towards the entry face, in voxels, for light that enters through
// one face and is attenuated exponentially over the optical length tau.
static float distance_to_face(float tau)
{
  return tau < 0.05f ? tau / 12.0f : 0.5f - 1.0f / tau + (tau < 80.0f ? 1.0f / expm1(tau) : 0.0f);
}

// Adds the beam's path, and its first moments computed from the powers through the faces (numerics.md, Eq. (39)), to
// the deposit. The first moments are exact if as much power leaves through the lateral faces as enters there. They
// never exceed the first moments of light that enters through one face only.
// path, currents           path integral, W length, and partial currents, W, of the beam (Deposit,
//                          Sweep/SweepOperator.h)
// beyond                   power that enters voxels beyond a block's faces, W
// channel                  index of this group's first channel in `beyond`
// all_path, first_moments  arrays of the deposit, to which the kernel adds
__kernel void add_beam(BeamInfo beam, const __global float* sigma, ulong sigma_first, const __global float* path,
  const __global float* currents, const __global float* beyond, ulong channel, __global float* all_path,
  __global float* first_moments, ulong first, ulong stride)
{
  const ulong i = get_global_id(0);
  const ulong begin = first + get_global_id(1) * stride;
  const float length = path[begin + i];
  all_path[begin + i] += length;
  const float s = sigma[sigma_first + i];
  currents += 6 * begin;
  beyond += (channel + get_global_id(1)) * beam.beyond.stride;
  first_moments += 6 * begin;
  const int at[3] = { i % beam.size[0], i / beam.size[0] % beam.size[1], i / ((ulong)beam.size[0] * beam.size[1]) };
  float in[3], out[3], rest = -s * length, leaving = 0.0f;
  bool border[3];
  for (int a = 0, step = 1; a < 3; step *= beam.size[a++])
  {
    const __global float* through = currents + (2 * a + 1 - beam.up[a]) * stride;
    const int last = beam.up[a] ? beam.size[a] - 1 : 0;
    const int next = at[a] != last ? (beam.up[a] ? step : -step) : (beam.size[a] - 1) * (beam.up[a] ? -step : step);
    const long elsewhere = place_beyond(&beam.beyond, beam.size, at, 2 * a + beam.up[a]);
    border[a] = at[a] == last && !beam.periodic[a] && elsewhere < 0;
    in[a] = through[i];
    out[a] = border[a] ? 0.0f : elsewhere >= 0 ? beyond[elsewhere] : through[(long)i + next];
    rest += in[a] - out[a];
    leaving += border[a] ? in[a] : 0.0f;
  }
  for (int a = 0; a < 3; ++a)
  {
    const float tau = s * beam.lengths[a];
    if (s * beam.spacing[a] < beam.thin || length <= 0.0f)
    {
      continue;
    }
    out[a] = border[a] && leaving > 0.0f ? fmax(rest, 0.0f) * in[a] / leaving : out[a];
    const float onwards = (length / beam.lengths[a] - 0.5f * (in[a] + out[a])) / s;
    const float most = length * distance_to_face(tau);
    const int ahead = 2 * a + beam.up[a];
    first_moments[ahead * stride + i] += clamp(onwards, 0.0f, most);
    first_moments[(ahead ^ 1) * stride + i] += clamp(-onwards, 0.0f, most);
  }
}
