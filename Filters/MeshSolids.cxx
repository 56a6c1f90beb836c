#include "MeshSolids.h"

#include "Device/Errors.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTriangleFilter.h"

#include <cmath>
#include <map>

namespace tyndall
{
namespace
{
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
  vtkNew<vtkPolyData> input; // A filter must not be put between the mesh and its own pipeline.
  input->ShallowCopy(mesh);
  vtkNew<vtkTriangleFilter> filter;
  filter->PassVertsOff();
  filter->PassLinesOff();
  filter->SetInputData(input);
  filter->Update();
  return filter->GetOutput();
}

/// Collects the triangles of a solid, and of the points those that they have.
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

vtkDataArray* NumbersOf(vtkPolyData* mesh, const std::string& array)
{
  vtkDataArray* numbers = mesh->GetCellData()->GetArray(array.c_str());
  if (numbers && numbers->GetNumberOfComponents() != 1)
  {
    throw InvalidInput("Array '" + array + "' has " + std::to_string(numbers->GetNumberOfComponents()) +
      " components; the numbers of materials must have 1.");
  }
  return numbers;
}
}

std::vector<Solid> SolidsOf(vtkPolyData* given, const std::string& name, const std::string& array, int otherwise,
  const std::function<Material(int)>& materialOf)
{
  const vtkSmartPointer<vtkPolyData> mesh = Triangulated(given);
  vtkDataArray* const numbers = NumbersOf(mesh, array);
  std::map<int, SolidBuilder> builders;
  const auto cells = vtkSmartPointer<vtkCellArrayIterator>::Take(mesh->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(count, corners);
    if (count == 3)
    {
      const int number =
        numbers ? static_cast<int>(std::lround(numbers->GetComponent(cells->GetCurrentCellId(), 0))) : otherwise;
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
    solids.push_back({ name, {}, materialOf(otherwise) }); // the kernels say that it is empty
  }
  return solids;
}
}
