#include "Reconstruction/Reconstruction.h"

#include "Device/Batches.h"
#include "Device/Device.h"
#include "Device/Sizes.h"
#include "Distribution/BoxExchange.h"
#include "Numerics/PyramidLayout.h"
#include "Reconstruction/LightPyramid.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tyndall
{
namespace
{
/// Buffers of one pyramid level on the device, for levels from 1 on.
struct ConservativeLevel
{
  /// Light of the level, in fields: the light of each batch, then the quantities to be smoothed (channels and flux of
  /// the mean light).
  LightRows light;
  /// Result of the level: smoothed quantities, source level (pyramid level from which the light is taken), squared
  /// error.
  LightRows results;
  /// Fraction of the details of the next finer level that is kept, and squared errors (fields GainField to ErrorField).
  /// The details are the finer level minus the interpolation of this level.
  LightRows gains;
  /// Intermediate results for the gains. `measured` (from measure_details): noise and squared light of the details of
  /// the next finer level. `across`: the same two quantities, smoothed along y and z.
  LightRows measured, across;
};

/// Light of all batches in the grid's voxels on the device. It is the host's own array [voxel][batch][channel] if
/// kernels can read that efficiently (AreWoven). Otherwise it is a copy [batch][voxel][channel] with rows padded to a
/// multiple of two vectors.
class BatchedLight
{
public:
  BatchedLight(const RowKernels& kernels, const NoisyLight& light);

  const cl::Buffer& Handle() const { return this->Apart.Size() > 0 ? this->Apart.Handle() : this->Given.Handle(); }

private:
  HostMappedBuffer<float> Given;
  Buffer<float> Apart;
};

/// Passes of the conservative estimator over the levels of a pyramid (numerics.md, Eqs. (101) to (104)): Build upwards,
/// Begin at the top, Refine downwards. The shared level is the coarsest one that ranks compute from their own boxes
/// (block and halo). One object covers the levels of this rank's box up to the shared level. A second object, on every
/// rank, covers the levels of the domain from the shared level on.
class ConservativePasses
{
public:
  /// Allocates the levels. All arguments are referenced and must outlive this object.
  /// @param light   light of the voxels in this rank's box; for the object with the domain's levels only the domain's
  ///   grid, with null arrays
  /// @param result  arrays must have the size of the light's
  /// @param first, top  lowest and highest level of this object
  ConservativePasses(
    const Reconstruction& task, const NoisyLight& light, ReconstructedLight& result, int first, int top);

  /// Computes the light of all levels: from the voxels or, for the domain's levels, from LightOf(first).
  void Build();
  void Begin();                      ///< computes the result of the top level
  void Refine(int from, int downTo); ///< computes results of levels `from` down to `downTo`, each from the level above
  /// Copies the light of the voxels to the host. To be called before Finish scales it.
  void FetchFluence() const { this->Fluence.Fetch(); }
  /// Scales the fluence by a factor per channel, and computes its standard error.
  void Finish(const std::array<float, 3>& factors);

  /// Light of a level. May be read, or set instead of being computed by Build.
  LightRows& LightOf(int level) { return this->At(level).light; }
  LightRows& ResultsOf(int level) { return this->At(level).results; } ///< result of a level, to be read or set

private:
  void FindGains(int level);
  void Blend(int level);
  cl::Kernel Kernel(const char* name, bool finest = false) const;
  ConservativeLevel& At(int level) { return this->Levels[static_cast<std::size_t>(level - this->First)]; }
  const cl::Buffer& LightAt(int level)
  {
    return level > 0 ? this->At(level).light.Values().Handle() : this->Light.Handle();
  }
  cl_int4 LayoutAt(int level) { return level > 0 ? this->At(level).light.Layout() : this->Voxels; }
  cl_float ScaleAt(int level) const { return level > 0 ? 1.0f : this->Scale; }
  void RunAbove(int below, const cl::Kernel& kernel, double from = 0.0, double to = 0.0);
  void SmoothAcross(ConservativeLevel& level, const LightRows& from, int first, int fields);

  const Reconstruction& Task;
  const std::array<int, 3>& Size;
  RowKernels Kernels;
  float Scale;
  cl_int4 Voxels;
  BatchedLight Light;
  WholeRows Direction, Fluence, MeanDirection, MipLevel, Error;
  int First, Top;  ///< numbers of the lowest and the highest level that this object has
  bool FromVoxels; ///< whether level 1 is computed from the voxels
  std::vector<ConservativeLevel> Levels;
};

/// The factor 0.4 of numerics.md, Eq. (104), where its fit is described: this fraction of the light that is removed
/// together with the noise counts as error.
constexpr float Honesty = 0.4f;

/// Number of voxels in the first launch of a kernel. Its run time determines the size of later launches.
constexpr std::size_t VoxelsOfFirstLaunch = std::size_t(1) << 22;

ConservativeLevel MakeLevel(const Reconstruction& task, const std::array<int, 3>& size, int width)
{
  Device& device = task.device;
  const int fields = task.light.batches + task.Fields();
  const char* what = "a level of the pyramid of light";
  return { LightRows(device, size, fields, width, what),
    LightRows(device, size, task.Fields() + BesideResults, width, what),
    LightRows(device, size, GainFields, width, what), LightRows(device, size, 2, width, what),
    LightRows(device, size, 2, width, what) };
}

/// Whether kernels read the light of batches in the host's layout [voxel][batch][channel]. They do for two batches and
/// rows that are a multiple of two vectors. With more batches they would have to gather single values.
bool AreWoven(const NoisyLight& light, int width)
{
  return light.batches == 2 && WholeVectors(light.grid.size[0], width) == light.grid.size[0];
}

/// Power of two that scales the light to about 1, so that squares neither overflow nor underflow.
float ScaleOf(float largest)
{
  return std::ldexp(1.0f, -std::clamp(largest > 0.0f ? std::ilogb(largest) : 0, -126, 126));
}

BatchedLight::BatchedLight(const RowKernels& kernels, const NoisyLight& light)
  : Given(kernels.On(), light.batchFluence,
      light.batchFluence ? light.grid.VoxelCount() * Count(light.batches * light.channels) : 0, "fluence")
{
  if (!light.batchFluence || AreWoven(light, kernels.Width()))
  {
    return;
  }
  const int pitch = WholeVectors(light.grid.size[0], kernels.Width());
  const std::size_t rows = Count(light.grid.size[1]) * Count(light.grid.size[2]);
  this->Apart =
    Buffer<float>(kernels.On(), rows * Count(pitch) * Count(light.batches * light.channels), "light of batches");
  cl::Kernel copy = kernels.Kernel("copy_rows", kernel_source::LightPyramid);
  const cl_int voxels = light.grid.size[0];
  With(copy, this->Given.Handle(), voxels, voxels, this->Apart, cl_int(pitch), cl_int(light.batches),
    cl_int(light.channels));
  kernels.On().Queue().enqueueNDRangeKernel(copy, cl::NullRange, cl::NDRange(rows), cl::NullRange);
}

ConservativePasses::ConservativePasses(
  const Reconstruction& task, const NoisyLight& light, ReconstructedLight& result, int first, int top)
  : Task(task)
  , Size(light.grid.size)
  , Kernels(task.device, RowWidth(task.device, task.domain.Whole()))
  , Scale(ScaleOf(task.largest))
  , Voxels(VoxelLayout(this->Size, this->Kernels.Width()))
  , Light(Kernels, light)
  , Direction(Kernels, light.meanDirection, Size, 3, "mean directions")
  , Fluence(Kernels, result.fluence, Size, light.channels, "fluence")
  , MeanDirection(Kernels, result.meanDirection, Size, 3, "mean directions")
  , MipLevel(Kernels, result.mipLevel, Size, 1, "levels")
  , Error(Kernels, result.fluenceError, Size, light.channels, "errors")
  , First(std::max(first, 1))
  , Top(top)
  , FromVoxels(light.batchFluence != nullptr)
{
  const PyramidLayout layout(light.grid.size);
  for (int level = this->First; level <= top; ++level)
  {
    const std::array<int, 3>& size = layout.sizes[std::min(level, layout.Top())];
    this->Levels.push_back(MakeLevel(task, size, this->Kernels.Width()));
  }
}

cl::Kernel ConservativePasses::Kernel(const char* name, bool finest) const
{
  const NoisyLight& light = this->Task.light;
  return this->Kernels.Kernel(name, kernel_source::ConservativeReconstruction,
    Define("BATCHES", light.batches) + Define("CHANNELS", light.channels) +
      Define("DIRECTIONS", this->Task.directions) + Define("FINEST", finest) +
      Define("WOVEN", finest && AreWoven(light, this->Kernels.Width())));
}

/// Enqueues a kernel that reads level `below`, with one work-item per row (or cell) of the level above it.
/// @param from, to  progress to report at the kernel's beginning and end, if it reads the voxels
void ConservativePasses::RunAbove(int below, const cl::Kernel& kernel, double from, double to)
{
  const std::array<int, 3>& cells = this->At(below + 1).light.Cells();
  if (below > 0)
  {
    this->Kernels.Run(kernel, cells);
    return;
  }
  Batches parts;
  parts.count = Count(cells[2]);
  parts.first = std::max<std::size_t>(VoxelsOfFirstLaunch / (8 * Count(cells[0]) * Count(cells[1])), 1);
  parts.from = from;
  parts.to = to;
  InBatches(this->Task.device, parts, this->Task.monitor,
    [&](std::size_t first, std::size_t count) { this->Kernels.Run(kernel, cells, first, count); });
}

void ConservativePasses::SmoothAcross(ConservativeLevel& level, const LightRows& from, int first, int fields)
{
  cl::Kernel smooth = this->Kernel("smooth_across");
  With(smooth, from.Values(), from.Layout(), level.across.Values(), cl_int(first), cl_int(fields));
  this->Kernels.Run(smooth, from.Cells());
}

void ConservativePasses::Build()
{
  if (this->FromVoxels)
  {
    const ConservativeLevel& first = this->At(1);
    cl::Kernel ofVoxels = this->Kernel("voxels_down", true);
    With(ofVoxels, this->Light.Handle(), this->Direction.Handle(), this->Voxels, first.light.Values(),
      first.light.Layout(), this->Scale);
    this->RunAbove(0, ofVoxels, 0.05, 0.3);
  }

  cl::Kernel down = this->Kernels.Kernel("smooth_down", kernel_source::LightPyramid);
  for (int level = this->First; level < this->Top; ++level)
  {
    const LightRows &fine = this->At(level).light, &coarse = this->At(level + 1).light;
    With(down, fine.Values(), fine.Layout(), coarse.Values(), coarse.Layout(), cl_int(fine.Fields()), 0.375f, 0.125f);
    this->Kernels.Run(down, coarse.Cells());
  }
}

void ConservativePasses::Begin()
{
  ConservativeLevel& top = this->At(this->Top);
  cl::Kernel begin = this->Kernel("begin_results");
  With(begin, top.light.Values(), top.light.Layout(), top.results.Values(), cl_float(this->Top), top.measured.Values());
  this->Kernels.Run(begin, top.light.Cells());
  this->SmoothAcross(top, top.measured, 0, 1);
  cl::Kernel errors = this->Kernel("begin_errors");
  With(errors, top.across.Values(), top.light.Layout(), top.results.Values());
  this->Kernels.Run(errors, top.light.Cells());
}

/// Computes the gains of a level (the fractions of its details that are kept) and the error of these details.
void ConservativePasses::FindGains(int level)
{
  ConservativeLevel& above = this->At(level + 1);
  const cl_int4 cells = above.light.Layout();
  cl::Kernel measure = this->Kernel("measure_details", level == 0);
  With(measure, this->LightAt(level), this->Direction.Handle(), this->LayoutAt(level), this->ScaleAt(level),
    above.light.Values(), cells, above.measured.Values());
  this->RunAbove(level, measure, 0.3, 0.5);

  this->SmoothAcross(above, above.measured, 0, 2);
  cl::Kernel gains = this->Kernel("find_gains");
  With(gains, above.across.Values(), cells, above.gains.Values());
  this->Kernels.Run(gains, above.light.Cells());

  this->SmoothAcross(above, above.gains, RemovedField, 1);
  cl::Kernel errors = this->Kernel("add_errors");
  With(errors, above.across.Values(), cells, Honesty, above.results.Values(), above.gains.Values());
  this->Kernels.Run(errors, above.light.Cells());
}

void ConservativePasses::Blend(int level)
{
  const ConservativeLevel& above = this->At(level + 1);
  cl::Kernel blend = this->Kernel("blend_level", level == 0);
  const cl::Buffer& to = level > 0 ? this->At(level).results.Values().Handle() : this->Fluence.Handle();
  With(blend, this->LightAt(level), this->Direction.Handle(), this->LayoutAt(level), this->ScaleAt(level),
    above.light.Values(), above.results.Values(), above.gains.Values(), above.light.Layout(), cl_float(level), to,
    this->MeanDirection.Handle(), this->MipLevel.Handle());
  this->RunAbove(level, blend, 0.5, 0.9);
}

void ConservativePasses::Refine(int from, int downTo)
{
  for (int level = from; level >= downTo; --level)
  {
    this->FindGains(level);
    this->Blend(level);
  }
}

void ConservativePasses::Finish(const std::array<float, 3>& factors)
{
  const ConservativeLevel& first = this->At(1);
  cl::Kernel finish = this->Kernel("finish_light");
  With(finish, first.gains.Values(), first.light.Layout(), cl_float4{ { factors[0], factors[1], factors[2], 0.0f } },
    cl_float(1.0f / this->Scale), this->Fluence.Handle(), this->Error.Handle(), this->Voxels);
  this->RunAbove(0, finish, 0.9, 1.0);
  this->Fluence.Fetch();
  this->Error.Fetch();
  this->MipLevel.Fetch();
  this->MeanDirection.Fetch();
}
}

void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result)
{
  const PyramidBlocks& blocks = task.blocks;
  std::optional<ConservativePasses> passes;
  std::vector<float> cells;
  task.OnVoxels([&] {
    passes.emplace(task, task.light, result, 0, blocks.Shared());
    passes->Build();
    cells = passes->LightOf(blocks.Shared()).Read();
  });
  cells = blocks.GatherCells(cells, task.light.batches + task.Fields());
  task.OnVoxels([&] {
    NoisyLight whole = task.light;
    whole.grid = task.domain.Whole();
    whole.batchFluence = whole.meanDirection = nullptr;
    ReconstructedLight none;
    ConservativePasses above(task, whole, none, blocks.Shared(), task.levels);
    above.LightOf(blocks.Shared()).Write(cells);
    above.Build();
    above.Begin();
    above.Refine(task.levels - 1, blocks.Shared());
    LightRows& results = passes->ResultsOf(blocks.Shared());
    results.Write(
      PartOf(above.ResultsOf(blocks.Shared()).Read(), blocks.AllCells(), blocks.BoxCells(), results.Fields()));
    passes->Refine(blocks.Shared() - 1, 0);
    passes->FetchFluence();
  });
  const std::array<float, 3> factors = task.Conserve(result);
  task.OnVoxels([&] { passes->Finish(factors); });
}
}
