#include "Control.h"

#include "LightPropagation/Angular/RayBundles.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <thread>

namespace control
{
namespace
{
using namespace tyndall;

constexpr double Pi = 3.14159265358979323846;
constexpr int Threads = 2;
constexpr int Tile = 16; ///< rows; of larger planes than SmallPlane, which do not stay in the cache
constexpr int SmallPlane = 64;

/// Floats at the border of a cache line, zero.
class Floats
{
public:
  Floats() = default;
  explicit Floats(std::size_t count)
    : Count(count)
    , Memory(static_cast<float*>(std::aligned_alloc(64, (count * sizeof(float) + 63) / 64 * 64)), std::free)
  {
    std::fill(this->Memory.get(), this->Memory.get() + count, 0.0f);
  }
  float* Get() const { return this->Memory.get(); }
  std::size_t Size() const { return this->Count; }

private:
  std::size_t Count = 0;
  std::unique_ptr<float, void (*)(void*)> Memory{ nullptr, std::free };
};

/// Two threads that do the same thing, each with its number, and wait for each other.
class Pair
{
public:
  Pair()
    : Other([this] { this->Serve(); })
  {
  }
  ~Pair()
  {
    this->Hand({});
    this->Other.join();
  }

  void Do(const std::function<void(int)>& work)
  {
    this->Hand(work);
    work(0);
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Changed.wait(lock, [this] { return !this->Busy; });
  }

private:
  void Hand(const std::function<void(int)>& work)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Work = work;
      this->Busy = true;
    }
    this->Changed.notify_all();
  }

  void Serve()
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (true)
    {
      this->Changed.wait(lock, [this] { return this->Busy; });
      if (!this->Work)
      {
        return;
      }
      lock.unlock();
      this->Work(1);
      lock.lock();
      this->Busy = false;
      this->Changed.notify_all();
    }
  }

  std::mutex Mutex;
  std::condition_variable Changed;
  std::function<void(int)> Work;
  bool Busy = false;
  std::thread Other; // last: it runs as soon as it is made
};

/// All rays along one axis, both ways: what AxisSweep is for the OpenCL kernels.
struct Axis
{
  PlaneAxes axes;
  std::vector<tyndall::Bundle> patterns;
  std::vector<Bundle> bundles;
  std::vector<Crossing> crossings; ///< [plane][bundle]
  std::vector<OwnLight> ownLight;  ///< [plane]
  std::size_t mapFloats = 0, outsideFloats = 0, besideFloats = 0, ringFloats = 0;
  Floats maps[Threads], outside[Threads], beside[Threads], scratch[Threads];
};

class Solver
{
public:
  Solver(const Kernels& kernels, bool polynomials, const tyndall::Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings)
    : TheKernels(kernels)
    , Polynomials(polynomials)
    , TheMedium(medium)
    , TheGrid(medium.grid)
    , Settings(settings)
    , Directions(EquiangularDirections(settings.directionsPerFace))
    , Sky(illumination.sky)
    , Channels(medium.Channels())
    , Voxels(medium.grid.VoxelCount())
  {
  }

  LightField Run(const Monitor& monitor)
  {
    this->Start = std::chrono::steady_clock::now();
    this->Load();
    for (int axis = 0; axis < 3; ++axis)
    {
      this->MakeAxis(axis);
    }
    for (int order = 0; order < this->Settings.maximumOrders; ++order)
    {
      for (Axis& axis : this->Axes)
      {
        this->Sweep(axis, order);
      }
      Report(monitor, (order + 1.0) / this->Settings.maximumOrders);
      this->CollectOrder(order);
    }
    this->Light.channels = this->Channels;
    this->Light.fluence = this->Interleaved(this->Fluence);
    this->Light.device = this->TheKernels.name;
    return std::move(this->Light);
  }

private:
  void Load();
  void MakeAxis(int axis);
  void LayBundles(Axis& axis) const;
  void LayCrossings(Axis& axis) const;
  void Enter(Axis& axis, int way);
  void EnterMember(Axis& axis, int way, std::size_t b, int m);
  void CountEntered(const Axis& axis, const tyndall::Bundle& bundle, const Member& member, const Rgb& power);
  March MarchOf(Axis& axis, int way, int order, double* escaped) const;
  void Sweep(Axis& axis, int order);
  void CountFarEnds(const Axis& axis);
  void CollectOrder(int order);
  std::vector<float> Interleaved(const Floats& planar) const;
  int RowOf(const Axis& axis) const { return RowFloats(this->TheGrid.size[axis.axes.u], this->TheKernels.width); }

  const Kernels& TheKernels;
  bool Polynomials;
  const tyndall::Medium& TheMedium;
  const Grid& TheGrid;
  const PropagationSettings& Settings;
  DirectionSet Directions;
  Rgb Sky;
  int Channels;
  std::size_t Voxels;

  Floats Extinction, Scattering, Source, Path, Fluence;
  std::vector<Axis> Axes;
  Pair Workers;
  LightField Light;
  std::chrono::steady_clock::time_point Start;
};

void Solver::Load()
{
  const std::size_t all = this->Voxels * this->Channels;
  this->Extinction = Floats(this->Voxels);
  this->Scattering = Floats(all);
  this->Source = Floats(all);
  this->Path = Floats(all);
  this->Fluence = Floats(all);
  for (std::size_t i = 0; i < this->Voxels; ++i)
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      this->Scattering.Get()[c * this->Voxels + i] = this->TheMedium.sigma_s.At(i, c);
    }
    this->Extinction.Get()[i] = this->TheMedium.sigma_a.At(i, 0) + this->TheMedium.sigma_s.At(i, 0);
  }
}

void Solver::MakeAxis(int index)
{
  Axis axis;
  axis.axes = AcrossAxis(index);
  axis.patterns = BundlesAlong(index, this->TheGrid, {}, this->Directions, this->Settings.mapResolution);
  this->LayBundles(axis);
  this->LayCrossings(axis);
  for (int way = 0; way < Threads; ++way)
  {
    axis.maps[way] = Floats(axis.mapFloats);
    axis.outside[way] = Floats(axis.outsideFloats);
    axis.beside[way] = Floats(axis.besideFloats);
    axis.scratch[way] = Floats(this->TheKernels.scratch(this->MarchOf(axis, way, 0, nullptr)));
  }
  this->Axes.push_back(std::move(axis));
}

void Solver::LayBundles(Axis& axis) const
{
  const std::size_t row = this->RowOf(axis);
  for (const tyndall::Bundle& pattern : axis.patterns)
  {
    Bundle bundle = {};
    bundle.members = static_cast<int>(pattern.members.size());
    bundle.power = static_cast<float>(pattern.power);
    bundle.map = axis.mapFloats;
    bundle.outside = axis.outsideFloats;
    bundle.beside = axis.besideFloats;
    bundle.ring = axis.ringFloats;
    for (int m = 0; m < bundle.members; ++m)
    {
      const Member& member = pattern.members[m];
      const int move[4] = { member.uFromU, member.uFromV, member.vFromU, member.vFromV };
      std::copy(move, move + 4, bundle.move[m]);
    }
    const std::size_t rows = static_cast<std::size_t>(bundle.members) * this->Channels;
    axis.mapFloats += rows * row * this->TheGrid.size[axis.axes.v] + this->TheKernels.width;
    axis.outsideFloats += rows * row + this->TheKernels.width;
    axis.besideFloats += rows;
    axis.ringFloats += 2 * RingRows * rows * row + this->TheKernels.width;
    axis.bundles.push_back(bundle);
  }
}

void Solver::LayCrossings(Axis& axis) const
{
  const double spacing = this->TheGrid.spacing[axis.axes.axis];
  for (int k = 0; k < this->TheGrid.size[axis.axes.axis]; ++k)
  {
    double lengths[4] = {};
    double terms[Terms - 1] = {};
    for (const tyndall::Bundle& pattern : axis.patterns)
    {
      const PlaneCrossing from = pattern.Crossing(k);
      Crossing crossing = {};
      crossing.stages = from.count;
      for (int s = 0; s < from.count; ++s)
      {
        const double length = from.segments[s].length / spacing;
        const double power = pattern.power * static_cast<double>(pattern.members.size());
        Segment& segment = crossing.segments[s];
        segment = { from.segments[s].moveU, from.segments[s].moveV, static_cast<float>(length), {} };
        segment.terms[0] = segment.length;
        double term = power;
        for (int i = 0; i < 4; ++i)
        {
          term *= length / (i + 1);
          lengths[i] += term;
        }
        double factor = length;
        for (int i = 0; i + 1 < Terms; ++i)
        {
          factor *= length;
          segment.terms[i + 1] = static_cast<float>(MeanLength[i] * factor);
          terms[i] -= power * MeanLength[i] * factor;
        }
      }
      axis.crossings.push_back(crossing);
    }
    OwnLight own = {};
    std::copy(lengths, lengths + 4, own.lengths);
    std::copy(terms, terms + Terms - 1, own.terms);
    axis.ownLight.push_back(own);
  }
}

/// Write the light that comes in into the maps, the rows outside and the columns beside, and add up its power.
void Solver::Enter(Axis& axis, int way)
{
  for (std::size_t b = 0; b < axis.bundles.size(); ++b)
  {
    for (int m = 0; m < axis.bundles[b].members; ++m)
    {
      this->EnterMember(axis, way, b, m);
    }
  }
}

void Solver::EnterMember(Axis& axis, int way, std::size_t b, int m)
{
  const Bundle& bundle = axis.bundles[b];
  const std::size_t row = this->RowOf(axis);
  const int width = this->TheKernels.width;
  const int sizeU = this->TheGrid.size[axis.axes.u];
  Rgb power = {};
  for (int c = 0; c < this->Channels; ++c)
  {
    const float value = static_cast<float>(this->Sky[c] * axis.patterns[b].power);
    power[c] = value;
    const std::size_t inBlock = static_cast<std::size_t>(m * this->Channels + c) * row + width;
    for (int v = 0; v < this->TheGrid.size[axis.axes.v]; ++v)
    {
      float* rays = axis.maps[way].Get() + bundle.map +
        v * static_cast<std::size_t>(bundle.members) * this->Channels * row + inBlock;
      std::fill(rays, rays + sizeU, value);
    }
    float* outside = axis.outside[way].Get() + bundle.outside + inBlock;
    std::fill(outside - 1, outside + sizeU + 1, value);
    axis.beside[way].Get()[bundle.beside + m * this->Channels + c] = value;
  }
  this->CountEntered(axis, axis.patterns[b], axis.patterns[b].members[m], power);
}

/// Rays come in where others leave: one a row for each move along u, one a column for each along v; one that does both
/// comes in through u's face in the corner.
void Solver::CountEntered(const Axis& axis, const tyndall::Bundle& bundle, const Member& member, const Rgb& power)
{
  const double u = this->TheGrid.size[axis.axes.u];
  const double v = this->TheGrid.size[axis.axes.v];
  double rays = u * v;
  for (int k = 0; k < this->TheGrid.size[axis.axes.axis]; ++k)
  {
    const PlaneCrossing crossing = bundle.Crossing(k);
    for (int s = 1; s < crossing.count; ++s)
    {
      const tyndall::Segment& segment = crossing.segments[s];
      const int moveU = std::abs(member.uFromU * segment.moveU + member.uFromV * segment.moveV);
      const int moveV = std::abs(member.vFromU * segment.moveU + member.vFromV * segment.moveV);
      rays += moveU * v + moveV * u - moveU * moveV;
    }
  }
  for (int c = 0; c < this->Channels; ++c)
  {
    this->Light.balance.entered[c] += power[c] * rays;
  }
}

March Solver::MarchOf(Axis& axis, int way, int order, double* escaped) const
{
  const std::size_t step[3] = { 1, static_cast<std::size_t>(this->TheGrid.size[0]),
    static_cast<std::size_t>(this->TheGrid.size[0]) * this->TheGrid.size[1] };
  const PlaneAxes& axes = axis.axes;
  March march = {};
  march.sigma = this->Extinction.Get();
  march.source = order > 0 ? this->Source.Get() : nullptr;
  march.path = this->Path.Get();
  march.stride = this->Voxels;
  march.channels = this->Channels;
  march.sizeU = this->TheGrid.size[axes.u];
  march.sizeV = this->TheGrid.size[axes.v];
  march.sizeP = this->TheGrid.size[axes.axis];
  march.stepU = step[axes.u];
  march.stepV = step[axes.v];
  march.stepP = step[axes.axis];
  march.spacing = static_cast<float>(this->TheGrid.spacing[axes.axis]);
  march.bundles = static_cast<int>(axis.bundles.size());
  march.bundle = axis.bundles.data();
  march.crossings = axis.crossings.data();
  march.ownLight = axis.ownLight.data();
  march.maps = axis.maps[way].Get();
  march.outside = axis.outside[way].Get();
  march.beside = order == 0 ? axis.beside[way].Get() : nullptr;
  march.scratch = axis.scratch[way].Get();
  march.escaped = escaped;
  march.tile = march.sizeV <= SmallPlane ? 2 * SmallPlane : Tile;
  march.thin = this->Polynomials ? Thin : 0.0f;
  march.backward = way == 1;
  return march;
}

/// Both ways at once: each to the middle of the axis, and when both are there, on to the end. So they never meet in a
/// plane.
void Solver::Sweep(Axis& axis, int order)
{
  if (order == 0)
  {
    this->Enter(axis, 0);
    this->Enter(axis, 1);
  }
  double escaped[Threads][4 * MaxChannels] = {};
  for (int half = 0; half < 2; ++half)
  {
    this->Workers.Do([&](int way) {
      March march = this->MarchOf(axis, way, order, escaped[way]);
      if (half == 0 && order > 0)
      {
        std::fill(march.maps, march.maps + axis.mapFloats, 0.0f);
        std::fill(axis.outside[way].Get(), axis.outside[way].Get() + axis.outsideFloats, 0.0f);
      }
      march.begin = half * march.sizeP / 2;
      march.end = (half + 1) * march.sizeP / 2;
      this->TheKernels.march(march);
    });
  }
  for (int side = 0; side < 4; ++side)
  {
    const int face = 2 * (side < 2 ? axis.axes.u : axis.axes.v) + side % 2;
    for (int c = 0; c < this->Channels; ++c)
    {
      const double power = escaped[0][side * this->Channels + c] + escaped[1][side * this->Channels + c];
      this->Light.facePowerOut[face][c] += power;
      this->Light.balance.escaped[c] += power;
    }
  }
  this->CountFarEnds(axis);
}

/// What is left in the maps leaves at the far end of the axis.
void Solver::CountFarEnds(const Axis& axis)
{
  const std::size_t row = this->RowOf(axis);
  double power[Threads][MaxChannels] = {};
  this->Workers.Do([&](int way) {
    for (const Bundle& bundle : axis.bundles)
    {
      const std::size_t rows =
        static_cast<std::size_t>(bundle.members) * this->Channels * this->TheGrid.size[axis.axes.v];
      for (std::size_t i = 0; i < rows; ++i)
      {
        const float* rays = axis.maps[way].Get() + bundle.map + i * row + this->TheKernels.width;
        float sums[16] = {};
        for (int x = 0; x < this->TheGrid.size[axis.axes.u]; ++x)
        {
          sums[x % 16] += rays[x];
        }
        power[way][i % this->Channels] += std::accumulate(sums, sums + 16, 0.0);
      }
    }
  });
  for (int way = 0; way < Threads; ++way)
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      this->Light.facePowerOut[2 * axis.axes.axis + 1 - way][c] += power[way][c];
      this->Light.balance.escaped[c] += power[way][c];
    }
  }
}

void Solver::CollectOrder(int order)
{
  double sums[Threads][2 * MaxChannels] = {};
  this->Workers.Do([&](int thread) {
    const std::size_t half = this->Voxels / 32 * 16;
    for (int c = 0; c < this->Channels; ++c)
    {
      const std::size_t first = c * this->Voxels;
      this->TheKernels.collect({ this->Extinction.Get(), this->Scattering.Get() + first, this->Path.Get() + first,
        this->Fluence.Get() + first, this->Source.Get() + first, static_cast<float>(1.0 / this->TheGrid.VoxelVolume()),
        thread == 0 ? 0 : half, thread == 0 ? half : this->Voxels, sums[thread] + 2 * c });
    }
  });
  double absorbed = 0.0;
  EnergyBalance& balance = this->Light.balance;
  for (int c = 0; c < this->Channels; ++c)
  {
    balance.absorbed[c] += sums[0][2 * c] + sums[1][2 * c];
    balance.leftOver[c] = sums[0][2 * c + 1] + sums[1][2 * c + 1];
    absorbed += balance.absorbed[c];
  }
  if (order == 0)
  {
    this->Light.fluenceDirect = this->Interleaved(this->Fluence);
  }
  this->Light.convergence.push_back(
    { order, std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count(), 0.0, 0.0, absorbed,
      balance.escaped[0] + balance.escaped[1] + balance.escaped[2],
      balance.leftOver[0] + balance.leftOver[1] + balance.leftOver[2] });
}

std::vector<float> Solver::Interleaved(const Floats& planar) const
{
  std::vector<float> values(planar.Size());
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t i = 0; i < this->Voxels; ++i)
    {
      values[i * this->Channels + c] = planar.Get()[c * this->Voxels + i];
    }
  }
  return values;
}
}

std::vector<Kernels> KernelsHere()
{
  std::vector<Kernels> kernels;
#ifdef TYNDALL_CONTROL
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
  {
    kernels.push_back(Avx2());
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
  {
    kernels.push_back(Avx512());
  }
#endif
  return kernels;
}

LightField Solve(const Kernels& kernels, bool polynomials, const tyndall::Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  return Solver(kernels, polynomials, medium, illumination, settings).Run(monitor);
}
}
