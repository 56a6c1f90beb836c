// Evaluates 4 pi times the phase function for scattering towards the eye, averaged over the directions of light that is
// spread about a mean direction (numerics.md, section 14.1).
//
// Macros set by the host:
//   PHASE           0 isotropic, 1 Henyey-Greenstein, 2 Schlick, 3 two Henyey-Greenstein lobes, 4 Rayleigh, 5 tabulated
//   PHASE_CHANNELS  1, or 3: the phase function differs between red, green and blue

#pragma once
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

// Interpolates linearly in the table `rows` at `place`, which is clamped to [0, last]. The table has an additional
// entry after index `last`.
inline real between_rows(__global const float* rows, real place, int last)
{
  const real at = lesser(greater(place, (real)0.0f), (real)(float)last);
  const integer i = to_integer(at);
  const real part = at - to_real(i);
  real low, high;
#define LOOK(n)                    \
  LANE(low, n) = rows[LANE(i, n)]; \
  LANE(high, n) = rows[LANE(i, n) + 1];
  EACH_LANE(LOOK)
#undef LOOK
  return fma(part, high - low, low);
}

// Interpolates bilinearly in a table at row `spread` and at the column of a cosine c. The `columns` intervals of a row
// have equal width in sqrt(1 - c) for c > 0 and in 2 - sqrt(1 + c) else; each row has two additional entries.
inline real between_cosines(__global const float* rows, real spread, real cosine, int columns)
{
  const real c = lesser(greater(cosine, (real)(-1.0f)), (real)1.0f);
  const real aside = sqrt((real)1.0f - fabs(c)) * (real)(0.5f * columns);
  const real place = c > (real)0.0f ? aside : (real)(float)columns - aside;
  const integer row = to_integer(spread);
  const real part = spread - to_real(row);
  const integer column = to_integer(place);
  const real beside = place - to_real(column);
  real near_low, near_high, far_low, far_high;
#define LOOK(n)                                                                       \
  {                                                                                   \
    __global const float* at = rows + LANE(row, n) * (columns + 2) + LANE(column, n); \
    LANE(near_low, n) = at[0];                                                        \
    LANE(near_high, n) = at[1];                                                       \
    LANE(far_low, n) = at[columns + 2];                                               \
    LANE(far_high, n) = at[columns + 3];                                              \
  }
  EACH_LANE(LOOK)
#undef LOOK
  const real near = fma(beside, near_high - near_low, near_low);
  return fma(part, fma(beside, far_high - far_low, far_low) - near, near);
}

// 4 pi times the Henyey-Greenstein function of mean cosine |b|, numerics.md, Eq. (107).
//   square  b.b, b the light's mean direction times g
//   along   b.v, v the ray's direction, away from the eye
inline real henyey_greenstein(real square, real along)
{
  const real base = greater(fma((real)2.0f, along, (real)1.0f + square), (real)1e-8f);
  return ((real)1.0f - square) / (base * sqrt(base));
}

#if PHASE == 2
// 4 pi times Schlick's function of mean cosine |b|, numerics.md, Eq. (108).
//   square, along  as for henyey_greenstein
//   rows  table of k / |b| as a function of sqrt(1 - |b|), where k is the parameter of Schlick's function
inline real schlick(real square, real along, __global const float* rows)
{
  const real size = lesser(sqrt(square), (real)1.0f);
  const real k = between_rows(rows, sqrt((real)1.0f - size) * (real)(float)SchlickRows, SchlickRows);
  const real base = greater(fma(k, along, (real)1.0f), (real)1e-6f);
  return greater(fma(-square * k, k, (real)1.0f), (real)0.0f) / (base * base);
}
#endif

#if PHASE == 5
// 4 pi times a tabulated phase function, averaged over the light's directions and interpolated bilinearly.
//   square, along  m.m and m.v, m the light's mean direction, v the ray's direction away from the eye
//   rows  table with a row for each of equidistant values of sqrt(1 - |m|). The CosineRows + 2 entries of a row are at
//         equidistant values of a function of the cosine c of the scattering angle: sqrt(1 - c) for c > 0, else
//         2 - sqrt(1 + c)
inline real spread_rows(real square, real along, __global const float* rows)
{
  const real size = lesser(sqrt(square), (real)1.0f);
  return between_cosines(
    rows, sqrt((real)1.0f - size) * (real)(float)SpreadRows, -along / greater(size, (real)1e-10f), CosineRows);
}
#endif

// Parameters of the phase function in the voxels of a packet, for red, green and blue: mean cosine g (`first`) and,
// with two lobes, g of the second lobe and the fraction of light that is scattered in the first (`part`).
typedef struct
{
  rgb first, second, part; // as in PhaseInfo (ViewShared.h)
} phase_parameters;

// 4 pi times the phase function of one channel.
//   square  m.m, m the light's mean direction
//   along   m.v, v the ray's direction, away from the eye
//   first, second, part  g of the first and of the second lobe, and fraction of light scattered in the first
//                        (PhaseInfo)
//   rows    table of the phase function, with PHASE 2 and 5
inline real scattered_of_channel(
  real square, real along, real first, real second, real part, __global const float* rows)
{
#if PHASE == 1
  return henyey_greenstein(first * first * square, first * along);
#elif PHASE == 2
  return schlick(first * first * square, first * along, rows);
#elif PHASE == 3
  return fma(part, henyey_greenstein(first * first * square, first * along),
    ((real)1.0f - part) * henyey_greenstein(second * second * square, second * along));
#elif PHASE == 4
  return fma((real)0.75f * along, along, fma((real)(-0.25f), square, (real)1.0f));
#elif PHASE == 5
  return spread_rows(square, along, rows);
#else
  return (real)1.0f;
#endif
}

inline rgb scattered_of_channels(real square, real along, phase_parameters p, __global const float* rows)
{
  rgb f;
  f.r = scattered_of_channel(square, along, p.first.r, p.second.r, p.part.r, rows);
#if PHASE_CHANNELS == 3
  // Distance between the tables of two channels: with PHASE 5 each channel has a table.
  const int apart = PHASE == 5 ? (SpreadRows + 2) * (CosineRows + 2) : 0;
  f.g = scattered_of_channel(square, along, p.first.g, p.second.g, p.part.g, rows + apart);
  f.b = scattered_of_channel(square, along, p.first.b, p.second.b, p.part.b, rows + 2 * apart);
#else
  f.g = f.b = f.r;
#endif
  return f;
}

inline phase_parameters parameters_of(const PhaseInfo* info)
{
  const phase_parameters p = { { (real)info->first.x, (real)info->first.y, (real)info->first.z },
    { (real)info->second.x, (real)info->second.y, (real)info->second.z },
    { (real)info->part.x, (real)info->part.y, (real)info->part.z } };
  return p;
}
