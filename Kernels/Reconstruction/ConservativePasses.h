#pragma once

#include "Reconstruction/Reconstruction.h"
#include "Reconstruction/WholeRows.h"

#include <array>
#include <vector>

namespace tyndall
{
/// What the device keeps of a level of the pyramid, from level 1 on.
struct ConservativeLevel
{
  LightRows light;            ///< each batch's, then what is smoothed
  LightRows results;          ///< what is smoothed, level, squared error
  LightRows gains;            ///< with which the level below adds its details
  LightRows measured, across; ///< to find them
};

/// The light of the grid's voxels: the host's own, or a copy batch by batch, with rows that are whole vectors.
class BatchedLight
{
public:
  BatchedLight(const RowKernels& kernels, const HostMappedBuffer<float>& given, const NoisyLight& light);

  const cl::Buffer& Handle() const { return this->Apart.Size() > 0 ? this->Apart.Handle() : this->Given.Handle(); }

private:
  const HostMappedBuffer<float>& Given;
  Buffer<float> Apart;
};

/// The passes of the conservative estimator over the levels of a pyramid (numerics.md, Eqs. (101) to (104)): up with
/// Build, Begin at the top, and down again. Done one after the other over all levels they are the whole of it. A grid
/// in blocks has them in two parts: some levels of each block, and those above of all.
class ConservativePasses
{
public:
  /// @param task    whose levels go up to task.levels; must stay
  /// @param result  arrays of the grid's voxels; must stay
  /// @param first   level at which the pyramid begins; above 0 there are no voxels: batchFluence is null, and
  ///   meanDirection only says whether there are directions
  ConservativePasses(const Reconstruction& task, ReconstructedLight& result, int first = 0);

  void Build();                      ///< all levels, from the voxels or from Light of the first level
  void Begin();                      ///< results of the top level
  void Refine(int from, int downTo); ///< results of these levels, from those of the level above
  std::array<double, 3> Totals();    ///< of the voxels' light, before it is scaled; it is on the host then
  void Finish(const std::array<float, 3>& factors);

  /// Of a level, to read or to write instead of what makes it.
  LightRows& LightOf(int level) { return this->At(level).light; }
  LightRows& ResultsOf(int level) { return this->At(level).results; }

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
  ReconstructedLight& Result;
  const std::array<int, 3>& Size;
  RowKernels Kernels;
  float Scale;
  cl_int4 Voxels;
  HostMappedBuffer<float> FluenceOut, DirectionOut, MipLevelOut, ErrorOut;
  BatchedLight Light;
  WholeRows Direction, Fluence, MeanDirection, MipLevel, Error;
  int First; ///< level that Levels begin with
  std::vector<ConservativeLevel> Levels;
};
}
