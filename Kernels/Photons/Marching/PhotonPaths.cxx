#include "Photons/Marching/PhotonPaths.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Distribution/MessageTags.h"
#include "Distribution/Rounds.h"
#include "Photons/Marching/MarchRun.h"
#include "Photons/Marching/PhotonPacking.h"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// The path of a packed photon.
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

/// Corners of a photon's path in a rank's block: where it starts, changes direction and ends.
struct PathPart
{
  cl_ulong photon = 0; ///< mark that identifies the photon
  std::vector<cl_float4> corners;
};

/// Traces the paths of photons through a rank's block of a grid.
class PathRun
{
public:
  /// @param medium  must outlive this
  PathRun(const MarchMedium& medium, int channels)
    : Medium(medium)
    , Channels(channels)
    , Kernel(medium.MarchKernel("trace_paths", channels, false,
        Define("REAL_WIDTH", 1) + Define("ATOMICS", 0) + Define("WORKERS", 0) + Define("PATHS", 1) +
          Define("COUNTS", 0) + Define("CELLS", 0)))
  {
  }

  /// Traces photons that start here, or have arrived from other blocks. @return those that continue in other blocks
  std::vector<PhotonOnItsWay> Start(
    const PackedPhotons& photons, const std::vector<cl_ulong>& marks, std::vector<PathPart>& parts)
  {
    return this->Trace(PhotonsOnDevice(this->Medium.device, photons, marks), marks, parts);
  }
  std::vector<PhotonOnItsWay> Resume(const std::vector<PhotonOnItsWay>& arrived, std::vector<PathPart>& parts)
  {
    std::vector<cl_ulong> marks;
    for (const PhotonOnItsWay& photon : arrived)
    {
      marks.push_back(photon.mark);
    }
    return this->Trace(PhotonsOnDevice(this->Medium.device, arrived, 1, this->Channels), marks, parts);
  }

private:
  std::vector<PhotonOnItsWay> Trace(
    const PhotonsOnDevice& photons, const std::vector<cl_ulong>& marks, std::vector<PathPart>& parts);

  const MarchMedium& Medium;
  int Channels;
  cl::Kernel Kernel;
};

/// Runs the kernel twice: it counts corners, then writes them.
std::vector<PhotonOnItsWay> PathRun::Trace(
  const PhotonsOnDevice& photons, const std::vector<cl_ulong>& marks, std::vector<PathPart>& parts)
{
  std::vector<PhotonOnItsWay> into;
  if (marks.empty())
  {
    return into;
  }
  const MarchMedium& medium = this->Medium;
  Device& device = medium.device;
  const Buffer<cl_int> none(device, 0, "cells of the voxels");
  const Buffer<PhotonOnItsWay> gone(device, medium.IsBlock() ? marks.size() : 0, "photons into other blocks");
  Buffer<cl_int> counters(device, 1, "number of photons into other blocks");
  Buffer<cl_int> places(device, marks.size(), "places of paths");
  MarchLaunch launch = {};
  launch.resumes = cl_int(photons.resumes);
  const auto trace = [&](const Buffer<cl_float4>& corners) {
    counters.Fill(0);
    With(this->Kernel, medium.Describe(), launch, medium.sigma, medium.coefficients, medium.nodes,
      medium.bricks.AreThere() ? medium.bricks.First() : none, photons.Handle(), photons.marks, photons.ends, places,
      corners, counters);
    if (medium.IsBlock())
    {
      SetFrom(this->Kernel, 12, gone);
    }
    medium.Launch(this->Kernel, cl::NDRange(marks.size()), GroupOfLargeItems(device));
  };
  trace(Buffer<cl_float4>(device, 0, "paths"));
  const std::vector<cl_int> lengths = places.Read();
  std::vector<cl_int> begin(lengths.size() + 1, 0);
  std::partial_sum(lengths.begin(), lengths.end(), begin.begin() + 1);
  places.Write(begin.data());
  const Buffer<cl_float4> corners(device, static_cast<std::size_t>(begin.back()), "paths");
  launch.writes = 1;
  trace(corners);
  const std::vector<cl_float4> all = corners.Read();
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    parts.push_back({ marks[i], { all.begin() + begin[i], all.begin() + begin[i + 1] } });
  }
  if (medium.IsBlock())
  {
    AppendPhotons(gone, counters.Read().front(), into);
  }
  return into;
}

/// Identifies a part of a path: its photon's mark, and the round in which it was traced.
using PartKey = std::pair<cl_ulong, cl_ulong>;

/// The parts on one rank.
struct PathParts
{
  std::vector<cl_ulong> keys; ///< photon, round and number of corners of each
  std::vector<cl_float4> corners;

  void Add(const std::vector<PathPart>& parts, int round)
  {
    for (const PathPart& part : parts)
    {
      this->keys.insert(
        this->keys.end(), { part.photon, static_cast<cl_ulong>(round), static_cast<cl_ulong>(part.corners.size()) });
      this->corners.insert(this->corners.end(), part.corners.begin(), part.corners.end());
    }
  }
  void PutInto(std::map<PartKey, std::vector<cl_float4>>& all) const
  {
    auto corner = this->corners.begin();
    for (std::size_t i = 0; i < this->keys.size(); i += 3)
    {
      const auto end = corner + static_cast<std::ptrdiff_t>(this->keys[i + 2]);
      all[{ this->keys[i], this->keys[i + 1] }].assign(corner, end);
      corner = end;
    }
  }
};

/// Traces the parts of all paths in this rank's block. Collective.
/// @param packed  the same on all ranks
PathParts TraceParts(const Domain& domain, const MarchMedium* through, const PackedPhotons& packed)
{
  PathParts found;
  std::unique_ptr<PathRun> block;
  Rounds rounds(domain.Comm(), domain.Partition());
  rounds.UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor&) {
      std::vector<PhotonOnItsWay> gone;
      std::vector<PathPart> parts;
      if (through && round == 0)
      {
        const PackedPhotons starting = ThoseIn(domain.Own(), domain.Whole(), packed);
        block = std::make_unique<PathRun>(*through, packed.channels);
        gone = block->Start(starting, { starting.numbers.begin(), starting.numbers.end() }, parts);
      }
      else if (through)
      {
        gone = block->Resume(arrived, parts);
      }
      found.Add(parts, round);
      return gone;
    },
    {});
  return found;
}
}

std::vector<PhotonPath> TracePaths(const Domain& domain, const MarchMedium* through, const std::vector<Photon>& photons,
  const std::vector<std::size_t>& numbers, int eventLimit)
{
  PackedPhotons packed;
  domain.Comm().Collective([&] { packed = Pack(photons, domain.Whole(), true, eventLimit); });
  const PathParts own = TraceParts(domain, through, packed);
  if (domain.Comm().Rank() > 0)
  {
    domain.Comm().Send(0, MessageTag::CornersOfPaths, own.keys);
    domain.Comm().Send(0, MessageTag::CornersOfPaths, own.corners);
    return {};
  }
  std::map<PartKey, std::vector<cl_float4>> all;
  own.PutInto(all);
  for (int rank = 1; rank < domain.Comm().Ranks(); ++rank)
  {
    PathParts others;
    others.keys = domain.Comm().Receive<cl_ulong>(rank, MessageTag::CornersOfPaths);
    others.corners = domain.Comm().Receive<cl_float4>(rank, MessageTag::CornersOfPaths);
    others.PutInto(all);
  }
  std::vector<PhotonPath> paths;
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    const cl_ulong photon = packed.numbers[i];
    std::vector<cl_float4> corners;
    for (auto part = all.lower_bound({ photon, 0 }); part != all.end() && part->first.first == photon; ++part)
    {
      corners.insert(corners.end(), part->second.begin(), part->second.end());
    }
    paths.push_back(PathOf(domain.Whole(), packed, i, corners));
    paths.back().photon = numbers[paths.back().photon];
  }
  std::sort(paths.begin(), paths.end(), [](const PhotonPath& a, const PhotonPath& b) { return a.photon < b.photon; });
  return paths;
}
}
