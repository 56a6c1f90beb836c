#pragma once

#include <immintrin.h>

/// Vectors of CONTROL_WIDTH floats, 8 (AVX2) or 16 (AVX-512). They have the compiler's own signs for arithmetic; here
/// is what it has none for. All of it is local to the file, which is compiled for several processors (see
/// ControlSweep.h).
namespace control
{
namespace
{
constexpr int Width = CONTROL_WIDTH;

#if CONTROL_WIDTH == 16
#define CONTROL_INTRINSIC(name) _mm512_##name
using Vector = __m512;
inline Vector WhereLess(Vector a, Vector b, Vector yes, Vector no)
{
  return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ), no, yes);
}
inline Vector BitsAsFloats(__m512i bits)
{
  return _mm512_castsi512_ps(bits);
}
inline Vector InterleaveLow(Vector a, Vector b)
{
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
}
inline Vector InterleaveHigh(Vector a, Vector b)
{
  return __builtin_shufflevector(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
}
#else
#define CONTROL_INTRINSIC(name) _mm256_##name
using Vector = __m256;
inline Vector WhereLess(Vector a, Vector b, Vector yes, Vector no)
{
  return _mm256_blendv_ps(no, yes, _mm256_cmp_ps(a, b, _CMP_LT_OQ));
}
inline Vector BitsAsFloats(__m256i bits)
{
  return _mm256_castsi256_ps(bits);
}
inline Vector InterleaveLow(Vector a, Vector b)
{
  return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11);
}
inline Vector InterleaveHigh(Vector a, Vector b)
{
  return __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15);
}
#endif

inline Vector Load(const float* from)
{
  return CONTROL_INTRINSIC(loadu_ps)(from);
}
inline void Store(float* to, Vector x)
{
  CONTROL_INTRINSIC(storeu_ps)(to, x);
}
inline Vector All(float x)
{
  return CONTROL_INTRINSIC(set1_ps)(x);
}
inline Vector MultiplyAdd(Vector a, Vector b, Vector c)
{
  return CONTROL_INTRINSIC(fmadd_ps)(a, b, c);
}
inline Vector NegativeMultiplyAdd(Vector a, Vector b, Vector c) ///< c - a b
{
  return CONTROL_INTRINSIC(fnmadd_ps)(a, b, c);
}
inline Vector Least(Vector a, Vector b)
{
  return CONTROL_INTRINSIC(min_ps)(a, b);
}
inline Vector Most(Vector a, Vector b)
{
  return CONTROL_INTRINSIC(max_ps)(a, b);
}
inline Vector PowerOfTwo(Vector n) ///< of whole numbers from -126 to 127
{
  const auto exponent =
    CONTROL_INTRINSIC(add_epi32)(CONTROL_INTRINSIC(cvtps_epi32)(n), CONTROL_INTRINSIC(set1_epi32)(127));
  return BitsAsFloats(CONTROL_INTRINSIC(slli_epi32)(exponent, 23));
}

inline float Sum(Vector x)
{
  float values[Width];
  Store(values, x);
  for (int half = Width / 2; half > 0; half /= 2)
  {
    for (int i = 0; i < half; ++i)
    {
      values[i] += values[i + half];
    }
  }
  return values[0];
}
inline float Largest(Vector x)
{
  float values[Width];
  Store(values, x);
  float largest = values[0];
  for (int i = 1; i < Width; ++i)
  {
    largest = values[i] > largest ? values[i] : largest;
  }
  return largest;
}

/// Exchange rows and columns: interleave the halves as often as rows halve.
inline void Transpose(Vector (&rows)[Width])
{
  for (int halves = Width; halves > 1; halves /= 2)
  {
    Vector mixed[Width];
    for (int i = 0; i < Width / 2; ++i)
    {
      mixed[2 * i] = InterleaveLow(rows[i], rows[i + Width / 2]);
      mixed[2 * i + 1] = InterleaveHigh(rows[i], rows[i + Width / 2]);
    }
    for (int i = 0; i < Width; ++i)
    {
      rows[i] = mixed[i];
    }
  }
}
}
}
