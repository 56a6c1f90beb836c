#pragma once

#include "Refraction/Index/RefractiveMedium.h"

#include <functional>
#include <string>
#include <vector>

class vtkPolyData;

/// Meshes as the solids that kernels voxelise.
namespace tyndall
{
/// Converts a material's number to an int.
/// @param what  description of the value, for messages
/// @throws InvalidInput if the value is not a whole number within the range of int
int MaterialNumber(double value, const std::string& what);

/// Converts a mesh to solids: one for each material number in a cell array, in ascending order, or one for the complete
/// mesh. Polygons and strips become triangles; vertices, lines, and points without triangles are dropped.
/// @param name        name of the mesh, for messages, e.g. "Mesh 2"
/// @param array       name of the cell array of material numbers; without it all cells have the number `otherwise`
/// @param materialOf  returns the material for a number
/// @throws InvalidInput unless the array has one whole number for each cell
std::vector<Solid> SolidsOf(vtkPolyData* given, const std::string& name, const std::string& array, int otherwise,
  const std::function<Material(int)>& materialOf);
}
