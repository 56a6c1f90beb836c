// Real spherical harmonics of a unit vector, (DEGREE + 1)^2 values ordered as in Numerics/Legendre.h and scaled so that
// the square of each averages to 1 over all directions. The host defines DEGREE, the highest degree.

#pragma once

inline void find_harmonics(float3 omega, float* values)
{
  float cosine = 1.0f, sine = 0.0f, diagonal = 1.0f, first = 1.0f;
  for (int m = 0; m <= DEGREE; ++m)
  {
    float before = 0.0f, p = diagonal, ratio = first;
    for (int l = m; l <= DEGREE; ++l)
    {
      const float scale = sqrt((2 * l + 1) * (m == 0 ? 1.0f : 2.0f) * ratio) * p;
      values[l * l + l + m] = scale * cosine;
      if (m > 0)
      {
        values[l * l + l - m] = scale * sine;
      }
      const float next = ((2 * l + 1) * omega.z * p - (l + m) * before) / (l - m + 1);
      before = p;
      p = next;
      ratio *= (float)(l - m + 1) / (l + m + 1);
    }
    const float turned = cosine * omega.x - sine * omega.y;
    sine = cosine * omega.y + sine * omega.x;
    cosine = turned;
    diagonal *= 2 * m + 1;
    first /= (2 * m + 1) * (2 * m + 2);
  }
}
