#include "Refraction/Voxelization/TriangleMesh.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"
#include "Refraction/Voxelization/SampleLattice.h"
#include "Refraction/Voxelization/Voxelization.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace tyndall
{
namespace
{
using Point = std::array<double, 3>;

void CheckPoint(const TriangleMesh& mesh, std::size_t number)
{
  const Point& p = mesh.points[number];
  if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
  {
    const std::size_t known = number < mesh.pointNumbers.size() ? mesh.pointNumbers[number] : number;
    throw InvalidInput("Point " + std::to_string(known) + " of the mesh is at (" + Text("%g", p[0]) + ", " +
      Text("%g", p[1]) + ", " + Text("%g", p[2]) + "), which is not finite. Clean the mesh.");
  }
}

void CheckNumbers(const TriangleMesh& mesh)
{
  Require(!mesh.triangles.empty(), "The mesh is empty: it has 0 triangles, and 0 boundary edges.");
  const int points = static_cast<int>(mesh.points.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    for (int corner : mesh.triangles[t])
    {
      if (corner < 0 || corner >= points)
      {
        throw InvalidInput("Triangle " + std::to_string(t) + " of the mesh has the corner " + std::to_string(corner) +
          ", but the mesh has " + std::to_string(points) + " points.");
      }
      CheckPoint(mesh, static_cast<std::size_t>(corner));
    }
  }
}

std::uint64_t Hash(const Point& point)
{
  std::uint64_t hash = 0;
  for (double coordinate : point)
  {
    const double positiveZero = coordinate + 0.0; // -0.0 and 0.0 are the same coordinate
    std::uint64_t bits;
    std::memcpy(&bits, &positiveZero, sizeof(bits));
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

/// For each point, the lowest index of a point that coincides with it.
std::vector<int> MergedPoints(const std::vector<Point>& points)
{
  std::size_t slots = 16;
  while (slots < 2 * points.size())
  {
    slots *= 2;
  }
  std::vector<int> table(slots, -1);
  std::vector<int> merged(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::size_t slot = Hash(points[i]) & (slots - 1);
    while (table[slot] >= 0 && points[static_cast<std::size_t>(table[slot])] != points[i])
    {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] < 0)
    {
      table[slot] = static_cast<int>(i);
    }
    merged[i] = table[slot];
  }
  return merged;
}

/// An edge as one triangle uses it. Only the end with the higher point index is stored; EdgeUses groups the uses by the
/// other end.
struct EdgeUse
{
  int higher;   ///< point index of the edge's other end, the higher one of the two
  bool upwards; ///< whether the triangle traverses the edge from its lower to its higher index
};

/// Uses of all edges by triangles, sorted by the lower of the point indices of the edge's two ends.
struct EdgeUses
{
  /// Element i: index in `uses` of the first use of an edge whose lower end is point i. One more element at the end:
  /// number of uses.
  std::vector<std::size_t> begin;
  std::vector<EdgeUse> uses;
};

template <class Act>
void ForEachEdge(const TriangleMesh& mesh, const std::vector<int>& merged, Act&& act)
{
  for (const std::array<int, 3>& triangle : mesh.triangles)
  {
    for (int side = 0; side < 3; ++side)
    {
      const int from = merged[static_cast<std::size_t>(triangle[side])];
      const int to = merged[static_cast<std::size_t>(triangle[(side + 1) % 3])];
      if (from != to)
      {
        act(std::min(from, to), EdgeUse{ std::max(from, to), from < to });
      }
    }
  }
}

EdgeUses SortedEdges(const TriangleMesh& mesh, const std::vector<int>& merged)
{
  EdgeUses sorted;
  sorted.begin.assign(mesh.points.size() + 2, 0);
  ForEachEdge(mesh, merged, [&](int lower, const EdgeUse&) { ++sorted.begin[static_cast<std::size_t>(lower) + 2]; });
  for (std::size_t i = 2; i < sorted.begin.size(); ++i)
  {
    sorted.begin[i] += sorted.begin[i - 1];
  }
  sorted.uses.resize(sorted.begin.back());
  ForEachEdge(mesh, merged,
    [&](int lower, const EdgeUse& use) { sorted.uses[sorted.begin[static_cast<std::size_t>(lower) + 1]++] = use; });
  sorted.begin.pop_back();
  return sorted;
}

void CountEdges(const TriangleMesh& mesh, EdgeUses& edges, MeshTopology& topology)
{
  const auto note = [&](std::size_t& count, MeshTopology::Edge& first, std::size_t lower, int higher) {
    if (count++ == 0)
    {
      first = { mesh.points[lower], mesh.points[static_cast<std::size_t>(higher)] };
    }
  };
  for (std::size_t lower = 0; lower + 1 < edges.begin.size(); ++lower)
  {
    EdgeUse* const begin = edges.uses.data() + edges.begin[lower];
    EdgeUse* const end = edges.uses.data() + edges.begin[lower + 1];
    std::sort(begin, end, [](const EdgeUse& a, const EdgeUse& b) { return a.higher < b.higher; });
    for (EdgeUse* use = begin; use != end;)
    {
      const int higher = use->higher;
      int count = 0;
      int upwards = 0;
      for (; use != end && use->higher == higher; ++use)
      {
        ++count;
        upwards += use->upwards;
      }
      if (count % 2 != 0)
      {
        note(topology.boundaryEdges, topology.firstBoundaryEdge, lower, higher);
      }
      else if (2 * upwards != count)
      {
        note(topology.disagreeingEdges, topology.firstDisagreeingEdge, lower, higher);
      }
    }
  }
}

/// Computes areas of triangles and the enclosed volume. Coordinates are relative to a point of the mesh, so that a mesh
/// far from the origin loses no digits.
void MeasureTriangles(const TriangleMesh& mesh, MeshTopology& topology)
{
  const Point centre = mesh.points[static_cast<std::size_t>(mesh.triangles[0][0])];
  const auto from = [](const Point& a, const Point& b) { return Point{ b[0] - a[0], b[1] - a[1], b[2] - a[2] }; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const Point& a = mesh.points[static_cast<std::size_t>(mesh.triangles[t][0])];
    const Point ab = from(a, mesh.points[static_cast<std::size_t>(mesh.triangles[t][1])]);
    const Point ac = from(a, mesh.points[static_cast<std::size_t>(mesh.triangles[t][2])]);
    const Point n = { ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0] };
    if (n == Point{} && topology.degenerateTriangles++ == 0)
    {
      topology.firstDegenerateTriangle = t;
    }
    const Point r = from(centre, a);
    topology.enclosedVolume += (r[0] * n[0] + r[1] * n[1] + r[2] * n[2]) / 6.0;
  }
}
}

void CheckPoints(const TriangleMesh& mesh)
{
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    CheckPoint(mesh, i);
  }
}

MeshTopology Examine(const TriangleMesh& mesh)
{
  CheckNumbers(mesh);
  MeshTopology topology;
  EdgeUses edges = SortedEdges(mesh, MergedPoints(mesh.points));
  CountEdges(mesh, edges, topology);
  MeasureTriangles(mesh, topology);
  return topology;
}

namespace
{
std::string PlaceText(const std::array<double, 3>& point)
{
  return "(" + Text("%.6g", point[0]) + ", " + Text("%.6g", point[1]) + ", " + Text("%.6g", point[2]) + ")";
}

std::string Along(const MeshTopology::Edge& edge)
{
  return "from " + PlaceText(edge[0]) + " to " + PlaceText(edge[1]);
}

std::string Counted(std::size_t count, const char* thing)
{
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// Text of the warning for a mesh that intersects itself.
std::string OfWindings(const WindingNumbers& windings, const Grid& grid, int samples)
{
  const int ofVoxel = samples * samples * samples;
  const std::string volume = Text("%.3g", static_cast<double>(windings.oddSamples) * grid.VoxelVolume() / ofVoxel);
  return "intersects itself, or has parts inside out or within each other: about " +
    Counted(windings.oddSamples, "sample") + " (" + std::to_string(ofVoxel) + " a voxel; a volume of " + volume +
    ") it winds neither 0 times nor once but from " + std::to_string(windings.lowest) + " to " +
    std::to_string(windings.highest) + " times, the first at " + PlaceText(windings.firstOddSample) +
    ". What it encloses an even number of times counts as outside.";
}
}

MeshTopology CheckClosed(const TriangleMesh& mesh, const std::string& name, const Grid& grid, int samples)
{
  MeshTopology topology;
  try
  {
    topology = Examine(mesh);
  }
  catch (const InvalidInput& error)
  {
    throw InvalidInput(name + " cannot be used. " + error.what());
  }
  Require(topology.degenerateTriangles != mesh.triangles.size(),
    name + " has no volume: " + Counted(mesh.triangles.size(), "triangle") + ", all without area (degenerate), and " +
      Counted(topology.boundaryEdges, "boundary edge") + ".");
  if (topology.boundaryEdges > 0 && !SampleLattice(grid, samples, { &mesh }).Closes(mesh))
  {
    throw InvalidInput(name + " is open: it has " + Counted(topology.boundaryEdges, "boundary edge") +
      " (edges of an odd number of triangles), the first " + Along(topology.firstBoundaryEdge) +
      ". Only a closed mesh has an inside: fill its holes.");
  }
  return topology;
}

int Orientation(const MeshTopology& topology)
{
  return topology.disagreeingEdges > 0 ? 0 : topology.enclosedVolume < 0.0 ? -1 : 1;
}

std::vector<std::string> Oddities(
  const MeshTopology& topology, const WindingNumbers& windings, const std::string& name, const Grid& grid, int samples)
{
  std::vector<std::string> oddities;
  const auto say = [&](const std::string& what) { oddities.push_back(name + " " + what); };
  if (topology.degenerateTriangles > 0)
  {
    say("has " + Counted(topology.degenerateTriangles, "triangle") +
      " without area (degenerate), the first is number " + std::to_string(topology.firstDegenerateTriangle) +
      "; they make no difference.");
  }
  if (topology.disagreeingEdges > 0)
  {
    say("has triangles that disagree about which side is outside, at " + Counted(topology.disagreeingEdges, "edge") +
      ", the first " + Along(topology.firstDisagreeingEdge) +
      ". What it encloses an odd number of times is taken for inside; whether it intersects itself is not known.");
  }
  if (Orientation(topology) < 0)
  {
    say("is inverted: its normals point inwards. What it encloses is taken for inside all the same.");
  }
  if (windings.oddSamples > 0)
  {
    say(OfWindings(windings, grid, samples));
  }
  return oddities;
}
}
