#include "Photons/Marching/PhotonPaths.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Photons/Marching/MarchLaunch.h"

#include <algorithm>
#include <numeric>

namespace tyndall
{
CornersOfWays TraceCorners(const MarchMedium& medium, std::size_t ways,
  const std::function<void(bool counting, const Buffer<cl_int>& offsets, const Buffer<cl_float4>& corners,
    const Buffer<cl_int>& counts)>& queue)
{
  Device& device = medium.device;
  Buffer<cl_int> offsets(device, ways, "offsets of paths");
  const Buffer<cl_int> counts(device, ways, "lengths of paths");
  queue(true, offsets, Buffer<cl_float4>(device, 0, "paths"), counts);
  const std::vector<cl_int> lengths = counts.Read();
  std::vector<cl_int> begin(lengths.size() + 1, 0);
  std::partial_sum(lengths.begin(), lengths.end(), begin.begin() + 1);
  offsets.Write(begin.data());
  const Buffer<cl_float4> corners(device, static_cast<std::size_t>(begin.back()), "paths");
  queue(false, offsets, corners, counts);
  const std::vector<cl_float4> all = corners.Read();
  CornersOfWays ofWays;
  for (std::size_t i = 0; i < ways; ++i)
  {
    ofWays.emplace_back(all.begin() + begin[i], all.begin() + begin[i + 1]);
  }
  return ofWays;
}

std::string PathOptions()
{
  return Define("REAL_WIDTH", 1) + Define("ATOMICS", 0) + Define("WORKERS", 0) + Define("PATHS", 1) +
    Define("COUNTS", 0) + Define("CELLS", 0);
}

PhotonPath PathOf(const Grid& grid, const PackedPhotons& packed, std::size_t i, const std::vector<cl_float4>& corners)
{
  const float* const power = packed.values.data() + i * static_cast<std::size_t>(packed.FloatsEach()) + 6;
  const float whole = std::accumulate(power, power + packed.channels, 0.0f);
  PhotonPath path;
  path.photon = packed.numbers[i];
  for (const cl_float4& corner : corners)
  {
    std::array<double, 3> point;
    for (int a = 0; a < 3; ++a)
    {
      point[a] = grid.origin[a] + corner.s[a] * grid.spacing[a];
    }
    path.points.push_back(point);
    path.left.push_back(whole > 0.0f ? corner.s[3] / whole : 1.0f);
  }
  return path;
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
  cl::Kernel trace = medium.MarchKernel("trace_paths", packed.channels, false, PathOptions());
  Device& device = medium.device;
  const PhotonsOnDevice onDevice(device, packed);
  const Buffer<cl_int> none(device, 0, "cells of the voxels");
  const Buffer<cl_int>& cells = medium.bricks.AreThere() ? medium.bricks.First() : none;
  const CornersOfWays corners = TraceCorners(medium, packed.Count(),
    [&](bool counting, const Buffer<cl_int>& offsets, const Buffer<cl_float4>& to, const Buffer<cl_int>& counts) {
      With(trace, medium.Describe(), medium.sigma, medium.coefficients, medium.nodes, onDevice.values, cells,
        onDevice.ends, cl_int(counting), offsets, to, counts);
      medium.Launch(trace, cl::NDRange(packed.Count()), GroupOfLargeItems(device));
    });
  std::vector<PhotonPath> paths;
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    paths.push_back(PathOf(medium.grid, packed, i, corners[i]));
    paths.back().photon = chosen[paths.back().photon];
  }
  std::sort(paths.begin(), paths.end(), [](const PhotonPath& a, const PhotonPath& b) { return a.photon < b.photon; });
  return paths;
}
}
