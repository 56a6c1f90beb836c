#pragma once

#include "Refraction/Index/RefractiveMedium.h"

#include <functional>
#include <string>
#include <vector>

class vtkPolyData;

/// From VTK's meshes to those of the kernels.
namespace tyndall
{
/// A number of a material.
/// @param what  the value is, for messages
/// @throws InvalidInput where it is not a whole number that an int can hold
int MaterialNumber(double value, const std::string& what);

/// The solids of a mesh: one for each number in a cell array, in ascending order, or one for the whole mesh. Polygons
/// and strips become triangles; vertices, lines, and points that no triangle has are left behind.
/// @param name        of the mesh, for messages, e.g. "Mesh 2"
/// @param numbers     name of the cell array; where it is not there, all cells have the number `otherwise`
/// @param materialOf  the material of a number
/// @throws InvalidInput where the array has not one whole number for each cell
std::vector<Solid> SolidsOf(vtkPolyData* mesh, const std::string& name, const std::string& numbers, int otherwise,
  const std::function<Material(int number)>& materialOf);
}
