#include "Refraction/Voxelization/MeshChecks.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"
#include "Refraction/Voxelization/SampleLattice.h"

namespace tyndall
{
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

/// The warning for a mesh that intersects itself.
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
  if (topology.degenerateTriangles == mesh.triangles.size())
  {
    throw InvalidInput(name + " has no volume: " + Counted(mesh.triangles.size(), "triangle") +
      ", all without area (degenerate), and " + Counted(topology.boundaryEdges, "boundary edge") + ".");
  }
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
