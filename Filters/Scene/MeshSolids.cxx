#include "MeshSolids.h"

#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTriangleFilter.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace tyndall
{
namespace
{
bool IsMaterialNumber(double value)
{
  return value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max() &&
    value == std::trunc(value);
}

bool HasOnlyTriangles(vtkPolyData* mesh)
{
  return mesh->GetNumberOfCells() == mesh->GetNumberOfPolys() && mesh->GetPolys()->GetMaxCellSize() <= 3;
}

vtkSmartPointer<vtkPolyData> Triangulated(vtkPolyData* mesh)
{
  if (HasOnlyTriangles(mesh))
  {
    return mesh;
  }
  // vtkTriangleFilter gets polygons and strips only: since VTK 9.3 it mixes cell data of vertices and lines with those
  // of triangles.
  vtkNew<vtkPolyData> input;
  input->SetPoints(mesh->GetPoints());
  input->SetPolys(mesh->GetPolys());
  input->SetStrips(mesh->GetStrips());
  input->GetCellData()->CopyAllocate(mesh->GetCellData(), input->GetNumberOfCells());
  input->GetCellData()->CopyData(
    mesh->GetCellData(), 0, input->GetNumberOfCells(), mesh->GetNumberOfVerts() + mesh->GetNumberOfLines());
  vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(input);
  filter->Update();
  return filter->GetOutput();
}

/// Collects those triangles of a mesh that make up one solid (closed surface of one material), with only the points
/// that these triangles use, renumbered from 0.
class SolidBuilder
{
public:
  explicit SolidBuilder(vtkPolyData* mesh)
    : Points(mesh->GetPoints())
    , NewNumbers(static_cast<std::size_t>(mesh->GetNumberOfPoints()), -1)
  {
  }

  void Add(const vtkIdType* corners)
  {
    std::array<int, 3> triangle;
    for (int c = 0; c < 3; ++c)
    {
      int& number = this->NewNumbers[static_cast<std::size_t>(corners[c])];
      if (number < 0)
      {
        number = static_cast<int>(this->Mesh.points.size());
        this->Mesh.points.emplace_back();
        this->Mesh.pointNumbers.push_back(static_cast<std::size_t>(corners[c]));
        this->Points->GetPoint(corners[c], this->Mesh.points.back().data());
      }
      triangle[static_cast<std::size_t>(c)] = number;
    }
    this->Mesh.triangles.push_back(triangle);
  }

  TriangleMesh Mesh;

private:
  vtkPoints* Points;
  std::vector<int> NewNumbers;
};

/// Checks the cell array of material numbers, if the mesh has it. To be called before triangulation, which renumbers
/// the cells that messages name. Vertices and lines are ignored.
/// @param name  name of the mesh, for messages
/// @throws InvalidInput that names the array and the error
void CheckNumbers(vtkPolyData* mesh, const std::string& name, const std::string& array)
{
  vtkAbstractArray* const found = mesh->GetCellData()->GetAbstractArray(array.c_str());
  if (!found)
  {
    return;
  }
  const std::string which = name + "'s cell array '" + array + "'";
  auto* const numbers = vtkArrayDownCast<vtkDataArray>(found);
  if (!numbers)
  {
    throw InvalidInput(which + " is text; the numbers of materials must be whole numbers.");
  }
  if (numbers->GetNumberOfComponents() != 1)
  {
    throw InvalidInput(which + " has " + std::to_string(numbers->GetNumberOfComponents()) +
      " components; the numbers of materials must have 1.");
  }
  Require(numbers->GetNumberOfTuples() == mesh->GetNumberOfCells(),
    which + " has " + std::to_string(numbers->GetNumberOfTuples()) + " values where the mesh has " +
      std::to_string(mesh->GetNumberOfCells()) + " cells.");
  for (vtkIdType cell = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines(); cell < mesh->GetNumberOfCells(); ++cell)
  {
    const double number = numbers->GetComponent(cell, 0);
    if (!IsMaterialNumber(number))
    {
      MaterialNumber(number, which + " in cell " + std::to_string(cell));
    }
  }
}
}

int MaterialNumber(double value, const std::string& what)
{
  if (!IsMaterialNumber(value))
  {
    throw InvalidInput(what + " is " + Text("%.15g", value) +
      "; the number of a material must be a whole number from " + std::to_string(std::numeric_limits<int>::min()) +
      " to " + std::to_string(std::numeric_limits<int>::max()) + ".");
  }
  return static_cast<int>(value);
}

std::vector<Solid> SolidsOf(vtkPolyData* given, const std::string& name, const std::string& array, int otherwise,
  const std::function<Material(int)>& materialOf)
{
  CheckNumbers(given, name, array);
  const vtkSmartPointer<vtkPolyData> mesh = Triangulated(given);
  vtkDataArray* const numbers = mesh->GetCellData()->GetArray(array.c_str());
  std::map<int, SolidBuilder> builders;
  const auto cells = vtkSmartPointer<vtkCellArrayIterator>::Take(mesh->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(count, corners);
    if (count == 3)
    {
      const int number = numbers ? static_cast<int>(numbers->GetComponent(cells->GetCurrentCellId(), 0)) : otherwise;
      builders.try_emplace(number, mesh).first->second.Add(corners);
    }
  }

  std::vector<Solid> solids;
  for (auto& [number, builder] : builders)
  {
    const std::string part = numbers ? ", material " + std::to_string(number) + "," : "";
    solids.push_back({ name + part, std::move(builder.Mesh), materialOf(number) });
  }
  if (solids.empty())
  {
    solids.push_back({ name, {}, materialOf(otherwise) }); // an empty solid, for which the voxelizer throws
  }
  return solids;
}
}
