#include "Photons/Marching/PhotonPaths.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Photons/Marching/MarchLaunch.h"

#include <algorithm>
#include <numeric>

namespace tyndall
{
namespace
{
std::vector<PhotonPath> Unpack(const Grid& grid, const PackedPhotons& packed, const std::vector<std::size_t>& chosen,
  const std::vector<cl_float4>& vertices, const std::vector<cl_int>& begin)
{
  std::vector<PhotonPath> paths(packed.Count());
  for (std::size_t i = 0; i < paths.size(); ++i)
  {
    paths[i].photon = chosen[packed.numbers[i]];
    for (cl_int v = begin[i]; v < begin[i + 1]; ++v)
    {
      std::array<double, 3> point;
      for (int a = 0; a < 3; ++a)
      {
        point[a] = grid.origin[a] + vertices[v].s[a] * grid.spacing[a];
      }
      paths[i].points.push_back(point);
      paths[i].left.push_back(vertices[v].s[3]);
    }
  }
  std::sort(paths.begin(), paths.end(), [](const PhotonPath& a, const PhotonPath& b) { return a.photon < b.photon; });
  return paths;
}
}

std::vector<PhotonPath> TracePaths(
  const MarchMedium& medium, const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen)
{
  std::vector<Photon> some;
  for (const std::size_t i : chosen)
  {
    some.push_back(photons.at(i));
  }
  const PackedPhotons packed = Pack(some, medium.grid, true, medium.EventLimit());
  if (packed.Count() == 0)
  {
    return {};
  }
  cl::Kernel trace = medium.MarchKernel("trace_paths", packed.channels, false,
    Define("REAL_WIDTH", 1) + Define("ATOMICS", 0) + Define("WORKERS", 0) + Define("PATHS", 1) + Define("COUNTS", 0) +
      Define("CELLS", 0));
  Device& device = medium.device;
  const PhotonsOnDevice onDevice(device, packed);
  const Buffer<cl_int> none(device, 0, "cells of the voxels");
  const Buffer<cl_int>& cells = medium.bricks.AreThere() ? medium.bricks.First() : none;
  Buffer<cl_int> offsets(device, packed.Count(), "offsets of paths");
  const Buffer<cl_int> counts(device, packed.Count(), "lengths of paths");
  const auto run = [&](bool counting, const Buffer<cl_float4>& vertices) {
    With(trace, medium.Describe(), medium.sigma, medium.coefficients, medium.nodes, onDevice.values, cells,
      onDevice.ends, cl_int(counting), offsets, vertices, counts);
    medium.Launch(trace, cl::NDRange(packed.Count()), GroupOfLargeItems(device));
    device.Finish();
  };
  run(true, Buffer<cl_float4>(device, 0, "paths"));
  const std::vector<cl_int> lengths = counts.Read();
  std::vector<cl_int> begin(lengths.size() + 1, 0);
  std::partial_sum(lengths.begin(), lengths.end(), begin.begin() + 1);
  offsets.Write(begin.data());
  const Buffer<cl_float4> vertices(device, static_cast<std::size_t>(begin.back()), "paths");
  run(false, vertices);
  return Unpack(medium.grid, packed, chosen, vertices.Read(), begin);
}
}
