#pragma once

#include <cstddef>

/// The inner loops of the control (Control.h): the fused sweep in C++ for one processor, compiled once for each set of
/// vector instructions. ControlSweep.cxx includes no header of the standard library but this one's: an inline function
/// compiled for AVX could become the one that the linker keeps for the whole program.
namespace control
{
constexpr int MaxMembers = 8;
constexpr int MaxChannels = 3;
constexpr int RingRows = 4; ///< of rays between two stages, of which there are two rings a bundle

/// (1 - exp(-t)) / t = 1 + t (MeanLength[0] + t (MeanLength[1] + ...)), to 2e-8 for 0 <= t < Thin; a minimax
/// polynomial.
constexpr int Terms = 6;
constexpr double MeanLength[Terms - 1] = { -0.499999036, 0.166648826, -0.0415578957, 0.0080387554, -0.00101435666 };
constexpr float Thin = 0.75f;

/// As tyndall::Bundle; where its maps, rows outside, columns beside and rings begin, in floats.
struct Bundle
{
  int members;
  float power; ///< that a ray carries at radiance 1, W
  std::size_t map, outside, beside, ring;
  int move[MaxMembers][4]; ///< u from u, u from v, v from u, v from v
};

struct Segment
{
  int moveU, moveV;
  float length;       ///< in planes
  float terms[Terms]; ///< mean length, in planes, as a polynomial of a plane's optical thickness
};

struct Crossing
{
  int stages;
  Segment segments[3];
};

/// The medium's own light in the voxel where it starts: sums over all segments of a plane.
struct OwnLight
{
  float lengths[4];       ///< of power times l, l^2 / 2, l^3 / 6, l^4 / 24
  float terms[Terms - 1]; ///< in thin voxels it is a polynomial of a plane's optical thickness
};

/// One thread's march, one way along an axis.
struct March
{
  // The volume, [channel][stride], x fastest, each size a multiple of 16.
  const float* sigma;
  const float* source; ///< null: the medium is dark
  float* path;
  std::size_t stride;
  int channels;
  int sizeU, sizeV, sizeP;
  std::size_t stepU, stepV, stepP;
  float spacing; ///< of planes

  int bundles;
  const Bundle* bundle;
  const Crossing* crossings; ///< [plane from where rays start][bundle]
  const OwnLight* ownLight;  ///< [plane from where rays start]
  float* maps;
  const float* outside;
  const float* beside; ///< null: nothing comes in
  float* scratch;
  double* escaped; ///< [-u, +u, -v, +v][channel] W, added to
  int tile;        ///< rows that all bundles cross before the next rows are begun
  float thin;      ///< Thin, or 0: exponentials everywhere
  bool backward;

  int begin, end; ///< planes, counted from where rays start
};

/// A part of the volume whose path integrals become light. `sums` are absorbed and scattered W of a channel, added to.
struct Collect
{
  const float *sigma, *scattering; ///< 1/length
  float *path, *fluence, *source;
  float perVolume;
  std::size_t begin, end; ///< multiples of 16
  double* sums;
};

struct Kernels
{
  const char* name;
  int width;                            ///< floats of a vector
  std::size_t (*scratch)(const March&); ///< floats
  void (*march)(const March&);
  void (*collect)(const Collect&);
};

/// Floats of a row of `width` rays: an odd number of vectors, so that rows do not fall on the same cache lines. A
/// vector of border comes before the rays; the one before the next row's is the border behind them.
constexpr int RowFloats(int rays, int width)
{
  return (rays / width + 1 + rays / width % 2) * width;
}

Kernels Avx2();   ///< vectors of 8; only where the processor has AVX2 and FMA
Kernels Avx512(); ///< vectors of 16; AVX512F and AVX512DQ
}
