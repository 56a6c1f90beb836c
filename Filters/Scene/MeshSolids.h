#pragma once

#include "Refraction/Index/RefractiveMedium.h"

#include <functional>
#include <string>
#include <vector>

class vtkPolyData;

/// Converts VTK meshes to meshes of the kernels.
namespace tyndall
{
/// Converts a material's number to an int.
/// @param what  name of the value, for messages
/// @throws InvalidInput if it is not a whole number within the range of int
int MaterialNumber(double value, const std::string& what);

/// Converts a mesh to solids: one for each number in a cell array, in ascending order, or one for the complete mesh.
/// Polygons and strips become triangles; vertices, lines, and points without triangles are dropped.
/// @param name        of the mesh, for messages, e.g. "Mesh 2"
/// @param numbers     name of the cell array of material numbers; without this array all cells have the number
///   `otherwise`
/// @param materialOf  returns the material for a number
/// @throws InvalidInput unless the array has one whole number for each cell
std::vector<Solid> SolidsOf(vtkPolyData* mesh, const std::string& name, const std::string& numbers, int otherwise,
  const std::function<Material(int number)>& materialOf);
}
