#include "Refraction/Octree/LevelPyramid.h"

#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
LevelPyramid::LevelPyramid(Device& device, const Grid& grid)
  : TheDevice(device)
  , Layout(grid.size)
  , Nodes(device, this->Layout.nodeCount, "the octree's pyramid of levels")
  , TheLevels(device, grid.VoxelCount(), "the octree's levels")
{
}

void LevelPyramid::Restrict(const MinMaxPyramid& ranges, const std::vector<float>& tolerances)
{
  const auto run = [&](const cl::Kernel& kernel, const std::array<int, 3>& size) {
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, PyramidRange(size), PyramidGroup());
  };
  const auto& sizes = this->Layout.sizes;
  const int top = this->Layout.Top();
  cl::Kernel ofNodes = this->TheDevice.Kernel("levels_of_nodes", kernel_source::LevelPyramid);
  for (int level = top; level >= 1; --level)
  {
    const int above = level < top ? level + 1 : level;
    run(
      With(ofNodes, ranges.Nodes(), this->Nodes, static_cast<cl_ulong>(this->Layout.offsets[level]), Int4(sizes[level]),
        static_cast<cl_ulong>(this->Layout.offsets[above]), Int4(sizes[above]), level, top, tolerances[level]),
      sizes[level]);
  }
  cl::Kernel ofVoxels = this->TheDevice.Kernel("levels_of_voxels", kernel_source::LevelPyramid);
  run(With(ofVoxels, this->Nodes, Int4(sizes[1]), this->TheLevels, Int4(sizes[0]), this->Restricted ? 1 : 0), sizes[1]);
  this->Restricted = true;
}
}
