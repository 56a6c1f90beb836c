// Compiled with -DCONTROL=<name> -DCONTROL_WIDTH=8 or 16 and the compiler's options for that set of instructions.
#include "ControlSweep.h"
#include "ControlVectors.h"

namespace control
{
namespace
{
/// Rows that a stage stays behind the one before: it reads rows y - 1 to y + 1 while y + 2 is written.
constexpr int Lag = 2;

/// Fraction extinguished over an optical length, 1 - exp(-tau), and the fraction that is left, as in Numerics.cl.
inline Vector Extinguished(Vector tau, Vector& left)
{
  const Vector t = Least(tau, All(87.0f));
  const Vector magic = All(12582912.0f);
  const Vector n = (t * All(-1.44269504f) + magic) - magic;
  const Vector r = MultiplyAdd(n, All(2.12194440e-4f), MultiplyAdd(n, All(-0.693359375f), -t));
  Vector p = MultiplyAdd(r, All(1.98412698e-4f), All(1.38888889e-3f));
  p = MultiplyAdd(p, r, All(8.33333333e-3f));
  p = MultiplyAdd(p, r, All(4.16666667e-2f));
  p = MultiplyAdd(p, r, All(1.66666667e-1f));
  p = MultiplyAdd(p, r, All(0.5f));
  const Vector q = MultiplyAdd(p * r, r, r);
  const Vector power = PowerOfTwo(n);
  left = MultiplyAdd(power, q, power);
  return NegativeMultiplyAdd(power, q, All(1.0f) - power);
}

/// A plane that is being crossed, every quantity [row][Row].
struct Plane
{
  float* sigma;   ///< optical thickness of the plane
  float* inverse; ///< of that, and `taken`: the power times mean length of all rays; of thick rows alone
  float* taken;
  float* source; ///< [channel], W / (length^2 sr) of a plane
  float* path;   ///< [channel], W planes
  bool* thin;    ///< [row] no segment in it is longer than Thin
};

struct State
{
  const March* march;
  int row;              ///< floats of a row
  std::size_t quantity; ///< floats of a quantity of a plane
  Plane plane;
};

/// What a ray meets in one segment, the same for all rays of a bundle.
struct Medium
{
  Vector mean; ///< mean length, (1 - exp(-tau)) / sigma
  Vector keep; ///< a ray L becomes keep L - change L
  Vector change;
};

template <bool AllThin>
inline Medium MediumOf(const State& state, std::size_t at, const Segment& segment)
{
  const Vector sigma = Load(state.plane.sigma + at);
  if (AllThin)
  {
    Vector mean = All(segment.terms[Terms - 1]);
    for (int i = Terms - 2; i >= 0; --i)
    {
      mean = MultiplyAdd(mean, sigma, All(segment.terms[i]));
    }
    return { mean, All(1.0f), sigma * mean };
  }
  const Vector tau = sigma * segment.length;
  Vector left;
  const Vector lost = Extinguished(tau, left);
  const Vector one = All(1.0f);
  return { lost * Load(state.plane.inverse + at), WhereLess(tau, one, one, All(0.0f)),
    WhereLess(tau, one, lost, -left) };
}

/// All rays of a bundle in a row through one segment each (Eq. 3 of Gruson et al., conservative).
template <int Members, int Channels, bool Source, bool AllThin>
inline void CrossRow(const State& state, int y, const float* const* in, float* out, const Segment& segment, float power)
{
  const int row = state.row;
  const Plane& plane = state.plane;
  for (int x = 0; x < state.march->sizeU; x += Width)
  {
    const std::size_t at = static_cast<std::size_t>(y) * row + x;
    const Medium medium = MediumOf<AllThin>(state, at, segment);
    if (Source && !AllThin)
    {
      Store(plane.taken + at, MultiplyAdd(medium.mean, All(power * Members), Load(plane.taken + at)));
    }
    const Vector shine = medium.mean * All(power);
    for (int c = 0; c < Channels; ++c)
    {
      const std::size_t atChannel = at + c * state.quantity;
      Vector gain = All(0.0f);
      if (Source)
      {
        gain = shine * Load(plane.source + atChannel);
      }
      Vector sum = All(0.0f);
      for (int m = 0; m < Members; ++m)
      {
        const Vector ray = Load(in[m] + c * row + x);
        sum += ray;
        const Vector kept =
          AllThin ? (Source ? ray + gain : ray) : (Source ? MultiplyAdd(ray, medium.keep, gain) : ray * medium.keep);
        Store(out + (m * Channels + c) * row + x, NegativeMultiplyAdd(ray, medium.change, kept));
      }
      Store(plane.path + atChannel, MultiplyAdd(medium.mean, sum, Load(plane.path + atChannel)));
    }
  }
}

/// Power of the rays of one member that leave row y of `rays` by a move of (du, dv), through u first.
template <int Channels>
inline void CountEscaped(const State& state, const float* rays, int y, int du, int dv)
{
  const March& march = *state.march;
  const bool throughV = (dv < 0 && y == 0) || (dv > 0 && y == march.sizeV - 1);
  for (int c = 0; c < Channels; ++c, rays += state.row)
  {
    const float corner = du == 0 ? 0.0f : rays[du > 0 ? march.sizeU - 1 : 0];
    if (du != 0)
    {
      march.escaped[(du > 0 ? 1 : 0) * Channels + c] += corner;
    }
    if (throughV)
    {
      Vector sum = All(0.0f);
      for (int x = 0; x < march.sizeU; x += Width)
      {
        sum += Load(rays + x);
      }
      march.escaped[(dv > 0 ? 3 : 2) * Channels + c] += static_cast<double>(Sum(sum)) - corner;
    }
  }
}

/// Rows [begin, end) of the pipeline of a bundle's stages; stage s is Lag rows behind the one before.
template <int Members, int Channels, bool Source>
void CrossRows(const State& state, const Bundle& bundle, const Crossing& crossing, int begin, int end)
{
  const March& march = *state.march;
  const int row = state.row;
  const int height = march.sizeV;
  const std::size_t block = static_cast<std::size_t>(Members) * Channels * row;
  float* map = march.maps + bundle.map;
  float* ring = march.scratch + bundle.ring;
  const auto ringRow = [=](int stage, int y) { return ring + ((stage & 1) * RingRows + (y & (RingRows - 1))) * block; };
  for (int r = begin; r < end; ++r)
  {
    for (int s = 0; s < crossing.stages; ++s)
    {
      const int y = r - Lag * s;
      if (y < 0 || y >= height)
      {
        continue;
      }
      const Segment& segment = crossing.segments[s];
      const float* in[Members];
      for (int m = 0; m < Members; ++m)
      {
        const int* move = bundle.move[m];
        const int du = move[0] * segment.moveU + move[1] * segment.moveV;
        const int dv = move[2] * segment.moveU + move[3] * segment.moveV;
        const int from = y - dv;
        const std::size_t first = static_cast<std::size_t>(m) * Channels * row + Width;
        const float* rays = s == 0 ? map + y * block : ringRow(s - 1, from);
        if (s > 0)
        {
          CountEscaped<Channels>(state, ringRow(s - 1, y) + first, y, du, dv);
        }
        if (from < 0 || from >= height)
        {
          rays = march.outside + bundle.outside;
        }
        in[m] = rays + first - du;
      }
      float* out = (s == crossing.stages - 1 ? map + y * block : ringRow(s, y)) + Width;
      if (state.plane.thin[y])
      {
        CrossRow<Members, Channels, Source, true>(state, y, in, out, segment, bundle.power);
      }
      else
      {
        CrossRow<Members, Channels, Source, false>(state, y, in, out, segment, bundle.power);
      }
    }
  }
}

template <int Channels, bool Source>
void CrossPlane(const State& state, const Crossing* crossings)
{
  const March& march = *state.march;
  const int rows = march.sizeV + 2 * Lag;
  for (int begin = 0; begin < rows; begin += march.tile)
  {
    for (int b = 0; b < march.bundles; ++b)
    {
      const Bundle& bundle = march.bundle[b];
      const int last = march.sizeV + Lag * (crossings[b].stages - 1);
      const int end = begin + march.tile < last ? begin + march.tile : last;
      switch (bundle.members)
      {
        case 1: CrossRows<1, Channels, Source>(state, bundle, crossings[b], begin, end); break;
        case 2: CrossRows<2, Channels, Source>(state, bundle, crossings[b], begin, end); break;
        case 4: CrossRows<4, Channels, Source>(state, bundle, crossings[b], begin, end); break;
        case 8: CrossRows<8, Channels, Source>(state, bundle, crossings[b], begin, end); break;
      }
    }
  }
}

/// Light that comes in sideways within a row: the columns beside it, on both ends of every row of the ring.
void FillColumns(const March& march, int row)
{
  for (int b = 0; b < march.bundles; ++b)
  {
    const int rows = march.bundle[b].members * march.channels;
    for (int i = 0; i < 2 * RingRows * rows; ++i)
    {
      float* rays = march.scratch + march.bundle[b].ring + static_cast<std::size_t>(i) * row + Width;
      rays[-1] = rays[march.sizeU] = march.beside ? march.beside[march.bundle[b].beside + i % rows] : 0.0f;
    }
  }
}

/// Copy one quantity of a block of planes from the volume, times `factor`.
void Pack(
  const March& march, float* to, std::size_t plane, int row, int first, int block, const float* volume, float factor)
{
  for (int v = 0; v < march.sizeV; ++v)
  {
    for (int u = 0; u < march.sizeU; u += Width)
    {
      const float* from = volume + u * march.stepU + v * march.stepV + first * march.stepP;
      float* row0 = to + static_cast<std::size_t>(v) * row + u;
      if (block == 1)
      {
        Store(row0, Load(from) * factor);
        continue;
      }
      Vector rows[Width];
      for (int i = 0; i < Width; ++i)
      {
        rows[i] = Load(from + i * march.stepU) * factor;
      }
      Transpose(rows);
      for (int j = 0; j < Width; ++j)
      {
        Store(row0 + j * plane, rows[j]);
      }
    }
  }
}

/// Add one quantity of a block of planes to the volume, times `factor`.
void Unpack(
  const March& march, const float* from, std::size_t plane, int row, int first, int block, float* volume, float factor)
{
  for (int v = 0; v < march.sizeV; ++v)
  {
    for (int u = 0; u < march.sizeU; u += Width)
    {
      float* to = volume + u * march.stepU + v * march.stepV + first * march.stepP;
      const float* row0 = from + static_cast<std::size_t>(v) * row + u;
      if (block == 1)
      {
        Store(to, MultiplyAdd(Load(row0), All(factor), Load(to)));
        continue;
      }
      Vector rows[Width];
      for (int j = 0; j < Width; ++j)
      {
        rows[j] = Load(row0 + j * plane);
      }
      Transpose(rows);
      for (int i = 0; i < Width; ++i)
      {
        Store(to + i * march.stepU, MultiplyAdd(rows[i], All(factor), Load(to + i * march.stepU)));
      }
    }
  }
}

float LongestSegment(const March& march, int k)
{
  float longest = 0.0f;
  for (int b = 0; b < march.bundles; ++b)
  {
    const Crossing& crossing = march.crossings[k * march.bundles + b];
    for (int s = 0; s < crossing.stages; ++s)
    {
      const float length = crossing.segments[s].length;
      longest = length > longest ? length : longest;
    }
  }
  return longest;
}

/// Find the thin rows of a plane, and make the others ready.
void BeginPlane(const State& state, float longest)
{
  const March& march = *state.march;
  const Plane& plane = state.plane;
  for (int v = 0; v < march.sizeV; ++v)
  {
    const std::size_t begin = static_cast<std::size_t>(v) * state.row;
    Vector largest = All(0.0f);
    for (int u = 0; u < march.sizeU; u += Width)
    {
      largest = Most(largest, Load(plane.sigma + begin + u));
      for (int c = 0; c < march.channels; ++c)
      {
        Store(plane.path + c * state.quantity + begin + u, All(0.0f));
      }
    }
    plane.thin[v] = Largest(largest) * longest < march.thin;
    for (int u = 0; u < march.sizeU && !plane.thin[v]; u += Width)
    {
      const Vector sigma = Most(Load(plane.sigma + begin + u), All(1e-30f));
      Store(plane.sigma + begin + u, sigma);
      Store(plane.inverse + begin + u, All(1.0f) / sigma);
      Store(plane.taken + begin + u, All(0.0f));
    }
  }
}

/// Mean length of the medium's own light in the voxel where it starts, summed over all rays with their power, per unit
/// of source: the sum of power (l - mean) / sigma, by series where that would cancel.
inline Vector OwnLength(const Plane& plane, std::size_t at, const OwnLight& own, bool thin)
{
  const Vector sigma = Load(plane.sigma + at);
  if (thin)
  {
    Vector sum = All(own.terms[Terms - 2]);
    for (int i = Terms - 3; i >= 0; --i)
    {
      sum = MultiplyAdd(sum, sigma, All(own.terms[i]));
    }
    return sum;
  }
  const Vector closed = (All(own.lengths[0]) - Load(plane.taken + at)) * Load(plane.inverse + at);
  const Vector series =
    MultiplyAdd(MultiplyAdd(All(own.lengths[3]), sigma, All(-own.lengths[2])), sigma, All(own.lengths[1]));
  return WhereLess(sigma * own.lengths[1], All(0.01f * own.lengths[0]), series, closed);
}

void EndPlane(const State& state, const OwnLight& own)
{
  const March& march = *state.march;
  for (int v = 0; v < march.sizeV; ++v)
  {
    for (int u = 0; u < march.sizeU; u += Width)
    {
      const std::size_t at = static_cast<std::size_t>(v) * state.row + u;
      const Vector length = OwnLength(state.plane, at, own, state.plane.thin[v]);
      for (int c = 0; c < march.channels; ++c)
      {
        float* path = state.plane.path + c * state.quantity + at;
        Store(path, MultiplyAdd(length, Load(state.plane.source + c * state.quantity + at), Load(path)));
      }
    }
  }
}

int QuantitiesPerPlane(const March& march)
{
  return 3 + 2 * march.channels;
}

std::size_t RingFloats(const March& march)
{
  std::size_t end = 0;
  for (int b = 0; b < march.bundles; ++b)
  {
    const Bundle& bundle = march.bundle[b];
    const std::size_t floats =
      std::size_t{ 2 } * RingRows * bundle.members * march.channels * RowFloats(march.sizeU, Width);
    end = bundle.ring + floats > end ? bundle.ring + floats : end;
  }
  return end + Width;
}

std::size_t ScratchFloats(const March& march)
{
  const std::size_t plane = static_cast<std::size_t>(march.sizeV) * RowFloats(march.sizeU, Width);
  const int block = march.stepU == 1 ? 1 : Width;
  return RingFloats(march) + block * (QuantitiesPerPlane(march) * plane + march.sizeV) + 2 * Width;
}

Plane PlaneAt(const State& state, float* planes, int index)
{
  const std::size_t quantities = QuantitiesPerPlane(*state.march);
  float* first = planes + index * quantities * state.quantity;
  return { first, first + state.quantity, first + 2 * state.quantity, first + 3 * state.quantity,
    first + (3 + state.march->channels) * state.quantity, nullptr };
}

template <int Channels, bool Source>
void MarchPlanes(const March& march)
{
  State state = { &march, RowFloats(march.sizeU, Width), 0, {} };
  state.quantity = static_cast<std::size_t>(march.sizeV) * state.row;
  float* planes = march.scratch + RingFloats(march);
  const int block = march.stepU == 1 ? 1 : Width;
  bool* thin = reinterpret_cast<bool*>(planes + block * QuantitiesPerPlane(march) * state.quantity);
  const std::size_t perPlane = QuantitiesPerPlane(march) * state.quantity;
  FillColumns(march, state.row);
  for (int begin = march.begin; begin < march.end; begin += block)
  {
    const int first = march.backward ? march.sizeP - begin - block : begin;
    const Plane blockStart = PlaneAt(state, planes, 0);
    Pack(march, blockStart.sigma, perPlane, state.row, first, block, march.sigma, march.spacing);
    for (int c = 0; Source && c < Channels; ++c)
    {
      Pack(march, blockStart.source + c * state.quantity, perPlane, state.row, first, block,
        march.source + c * march.stride, march.spacing);
    }
    for (int k = begin; k < begin + block; ++k)
    {
      const int inBlock = march.backward ? block - 1 - (k - begin) : k - begin;
      state.plane = PlaneAt(state, planes, inBlock);
      state.plane.thin = thin;
      BeginPlane(state, LongestSegment(march, k));
      CrossPlane<Channels, Source>(state, march.crossings + static_cast<std::size_t>(k) * march.bundles);
      if (Source)
      {
        EndPlane(state, march.ownLight[k]);
      }
    }
    for (int c = 0; c < Channels; ++c)
    {
      Unpack(march, blockStart.path + c * state.quantity, perPlane, state.row, first, block,
        march.path + c * march.stride, march.spacing);
    }
  }
}

void MarchOneWay(const March& march)
{
  if (march.channels == 1)
  {
    march.source ? MarchPlanes<1, true>(march) : MarchPlanes<1, false>(march);
  }
  else
  {
    march.source ? MarchPlanes<3, true>(march) : MarchPlanes<3, false>(march);
  }
}

void CollectPart(const Collect& part)
{
  constexpr std::size_t chunk = 4096; // floats that are added as floats
  for (std::size_t begin = part.begin; begin < part.end; begin += chunk)
  {
    const std::size_t end = begin + chunk < part.end ? begin + chunk : part.end;
    Vector absorbed = All(0.0f);
    Vector scattered = All(0.0f);
    for (std::size_t i = begin; i < end; i += Width)
    {
      const Vector path = Load(part.path + i);
      const Vector scattering = Load(part.scattering + i);
      absorbed = MultiplyAdd(Most(Load(part.sigma + i) - scattering, All(0.0f)), path, absorbed);
      scattered = MultiplyAdd(scattering, path, scattered);
      Store(part.fluence + i, MultiplyAdd(path, All(part.perVolume), Load(part.fluence + i)));
      Store(part.source + i, scattering * path * All(part.perVolume * 0.0795774715f));
      Store(part.path + i, All(0.0f));
    }
    part.sums[0] += Sum(absorbed);
    part.sums[1] += Sum(scattered);
  }
}
}

Kernels CONTROL()
{
  return { Width == 16 ? "AVX-512" : "AVX2", Width, ScratchFloats, MarchOneWay, CollectPart };
}
}
