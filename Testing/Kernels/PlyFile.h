#pragma once

#include "Refraction/Voxelization/TriangleMesh.h"

#include <fstream>
#include <stdexcept>
#include <string>

/// Reads the triangles of a PLY file in text form whose points have nothing but three coordinates, as `./run` makes
/// them of CGAL's meshes.
inline tyndall::TriangleMesh ReadPly(const std::string& name)
{
  std::ifstream file(name);
  std::size_t points = 0;
  std::size_t faces = 0;
  for (std::string word; file >> word && word != "end_header";)
  {
    if (word == "element")
    {
      std::size_t count = 0;
      file >> word >> count;
      (word == "vertex" ? points : faces) = count;
    }
  }
  tyndall::TriangleMesh mesh;
  mesh.points.resize(points);
  mesh.triangles.resize(faces);
  for (auto& p : mesh.points)
  {
    file >> p[0] >> p[1] >> p[2];
  }
  int corners = 3;
  for (auto& t : mesh.triangles)
  {
    file >> corners >> t[0] >> t[1] >> t[2];
    if (corners != 3)
    {
      throw std::runtime_error(name + " has a face that is not a triangle");
    }
  }
  if (!file || points == 0)
  {
    throw std::runtime_error(name + " cannot be read");
  }
  return mesh;
}
