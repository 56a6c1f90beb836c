#include "Photons/Marching/MarchRun.h"

#include "Device/Device.h"
#include "Distribution/Rounds.h"
#include "Photons/Marching/PhotonPacking.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// A vertex of a path: the photon starts, changes direction or ends there.
struct PathVertex
{
  cl_ulong photon = 0; ///< index of the photon among all photons; the kernel carries it along as the photon's mark
  /// Number, from 1, of the round in which this vertex was found. In a round, all ranks trace photons in their blocks,
  /// then exchange the photons that left.
  cl_ulong round = 0;
  /// Position in voxels (x, y, z), and remaining power (w: sum of channels, in units of PackedPhotons::unit watts).
  cl_float4 place = {};

  bool operator<(const PathVertex& other) const
  {
    return this->photon < other.photon || (this->photon == other.photon && this->round < other.round);
  }
};

/// Traces the paths of photons through a rank's block.
class PathRun
{
public:
  /// Compiles the kernel trace_paths.
  /// @param medium  medium of the block, referenced, not copied
  PathRun(const MarchMedium& medium, int channels)
    : Medium(medium)
    , Channels(channels)
    , Kernel(medium.MarchKernel("trace_paths", channels, false,
        Define("REAL_WIDTH", 1) + Define("ATOMICS", 0) + Define("WORKERS", 0) + Define("PATHS", 1) +
          Define("COUNTS", 0) + Define("CELLS", 0)))
  {
  }

  /// Traces photons that start in this block.
  /// @return photons that continue in other blocks
  std::vector<PhotonOnItsWay> Start(const PackedPhotons& photons)
  {
    const std::vector<cl_ulong> marks(photons.numbers.begin(), photons.numbers.end());
    return this->Trace(PhotonsOnDevice(this->Medium.device, photons, marks), marks);
  }
  std::vector<PhotonOnItsWay> Resume(const std::vector<PhotonOnItsWay>& arrived)
  {
    std::vector<cl_ulong> marks;
    for (const PhotonOnItsWay& photon : arrived)
    {
      marks.push_back(photon.mark);
    }
    return this->Trace(PhotonsOnDevice(this->Medium.device, arrived, 1, this->Channels), marks);
  }

  /// Vertices of all paths so far. Each round of tracing and exchange between ranks appends the vertices of a photon in
  /// order along its path.
  std::vector<PathVertex> vertices;

private:
  std::vector<PhotonOnItsWay> Trace(const PhotonsOnDevice& photons, const std::vector<cl_ulong>& marks);

  const MarchMedium& Medium;
  int Channels;
  cl::Kernel Kernel;
  cl_ulong Round = 0;
};

/// Traces photons through the block. Runs the kernel twice: the first run counts the vertices of each path, the second
/// writes them.
/// @param marks  index of each photon, which its vertices receive
std::vector<PhotonOnItsWay> PathRun::Trace(const PhotonsOnDevice& photons, const std::vector<cl_ulong>& marks)
{
  ++this->Round;
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
    for (cl_int k = begin[i]; k < begin[i + 1]; ++k)
    {
      this->vertices.push_back({ marks[i], this->Round, all[static_cast<std::size_t>(k)] });
    }
  }
  if (medium.IsBlock())
  {
    AppendPhotons(gone, counters.Read().front(), into);
  }
  return into;
}

/// Traces all paths through this rank's block, and returns their vertices. Collective.
/// @param through  medium of this rank's block; null if the rank has no voxels
/// @param packed  photons whose paths are traced, the same on all ranks
std::vector<PathVertex> TraceVertices(const Domain& domain, const MarchMedium* through, const PackedPhotons& packed)
{
  std::unique_ptr<PathRun> block;
  Rounds rounds(domain.Comm(), domain.Partition());
  rounds.UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor&) {
      if (through && round == 0)
      {
        block = std::make_unique<PathRun>(*through, packed.channels);
        return block->Start(ThoseIn(domain.Own(), domain.Whole(), packed));
      }
      return block ? block->Resume(arrived) : std::vector<PhotonOnItsWay>();
    },
    {});
  return block ? std::move(block->vertices) : std::vector<PathVertex>();
}

/// Builds the path of packed photon i from its vertices.
/// @param all  vertices of all paths, sorted by photon, then by the round of tracing in which they were found
PhotonPath PathOf(const Grid& grid, const PackedPhotons& packed, std::size_t i, const std::vector<PathVertex>& all)
{
  const float* const power = packed.values.data() + i * static_cast<std::size_t>(packed.FloatsEach()) + 6;
  const float whole = std::accumulate(power, power + packed.channels, 0.0f);
  const cl_ulong photon = packed.numbers[i];
  PhotonPath path;
  for (auto vertex = std::lower_bound(all.begin(), all.end(), PathVertex{ photon });
       vertex != all.end() && vertex->photon == photon; ++vertex)
  {
    std::array<double, 3> point;
    for (int a = 0; a < 3; ++a)
    {
      point[a] = grid.origin[a] + vertex->place.s[a] * grid.spacing[a];
    }
    path.points.push_back(point);
    path.left.push_back(whole > 0.0f ? vertex->place.s[3] / whole : 1.0f);
  }
  return path;
}
}

std::vector<PhotonPath> TracePaths(const Domain& domain, const MarchMedium* through, const std::vector<Photon>& photons,
  const std::vector<std::size_t>& numbers, int eventLimit)
{
  PackedPhotons packed;
  domain.Collective([&] { packed = Pack(photons, domain.Whole(), true, eventLimit); });
  std::vector<PathVertex> all = TraceVertices(domain, through, packed);
  if (domain.Rank() > 0)
  {
    domain.Comm().Send(0, MessageTag::CornersOfPaths, all);
    return {};
  }
  for (int rank = 1; rank < domain.Comm().Ranks(); ++rank)
  {
    const std::vector<PathVertex> more = domain.Comm().Receive<PathVertex>(rank, MessageTag::CornersOfPaths);
    all.insert(all.end(), more.begin(), more.end());
  }
  std::stable_sort(all.begin(), all.end());
  std::vector<PhotonPath> paths;
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    paths.push_back(PathOf(domain.Whole(), packed, i, all));
    paths.back().photon = numbers[packed.numbers[i]];
  }
  std::sort(paths.begin(), paths.end(), [](const PhotonPath& a, const PhotonPath& b) { return a.photon < b.photon; });
  return paths;
}
}
