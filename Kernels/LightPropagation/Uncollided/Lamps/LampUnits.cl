// The sums of a lamp's beams in fixed point; solid angles.

#pragma once

// Factor of a path in a voxel in fixed point (numerics.md, Eq. (35)): light goes little path through what is thick.
static float units_of(float sigma, float diagonal)
{
  return fmax(sigma * diagonal, 1.0f);
}

#define FIRST_OF_FLUX (1 + 3 * MOMENTS) // of the sums
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

// By Gauss's rule of 2 x 2 points.
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

// Solid angle of the rectangle of this width and height about (a, b) at distance d: in closed form where it is near;
// far away that is a small difference of large angles.
//   far  square of a distance, in its longer edges
static float solid_angle(float a, float b, float width, float height, float d, float far)
{
  return a * a + b * b + d * d < far * fmax(width * width, height * height)
    ? solid_angle_nearby(a, b, width, height, d)
    : solid_angle_far_away(a, b, width, height, d);
}
