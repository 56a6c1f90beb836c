// Fixed-point units of a lamp's sums, and solid angles of rectangles.

#pragma once

// Factor by which a path in a voxel is multiplied in fixed point (numerics.md, Eq. (35)): path lengths in optically
// thick voxels are small.
static float units_of(float sigma, float diagonal)
{
  return fmax(sigma * diagonal, 1.0f);
}

#define FIRST_OF_FLUX (1 + 3 * MOMENTS) // index of the first of these sums
#define FIRST_OF_VACUUM (FIRST_OF_FLUX + 3 * NET_FLUX)

static float corner_angle(float a, float b, float d)
{
  return atan2(a * b, d * sqrt(a * a + b * b + d * d));
}

static float solid_angle_nearby(float a, float b, float width, float height, float d)
{
  const float a0 = a - 0.5f * width, a1 = a + 0.5f * width, b0 = b - 0.5f * height, b1 = b + 0.5f * height;
  return corner_angle(a1, b1, d) - corner_angle(a0, b1, d) - corner_angle(a1, b0, d) + corner_angle(a0, b0, d);
}

// By a Gauss rule of 2 x 2 points.
static float solid_angle_far_away(float a, float b, float width, float height, float d)
{
  float sum = 0.0f;
  for (int i = 0; i < 4; ++i)
  {
    const float x = a + (i & 1 ? 0.288675135f : -0.288675135f) * width;
    const float y = b + (i & 2 ? 0.288675135f : -0.288675135f) * height;
    const float inverse = rsqrt(x * x + y * y + d * d);
    sum += inverse * inverse * inverse;
  }
  return 0.25f * sum * width * height * d;
}

// Solid angle of a rectangle of this width and height, centred at (a, b), at distance d: in closed form nearby, by
// quadrature far away, where the closed form is a small difference of large angles.
//   far  square of the distance between the two, in units of the longer edge
static float solid_angle(float a, float b, float width, float height, float d, float far)
{
  return a * a + b * b + d * d < far * fmax(width * width, height * height)
    ? solid_angle_nearby(a, b, width, height, d)
    : solid_angle_far_away(a, b, width, height, d);
}
