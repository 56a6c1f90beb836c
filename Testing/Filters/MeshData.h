#pragma once

#include "../Kernels/MeshShapes.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace test
{
/// The shapes of the kernels' tests as VTK's meshes.
inline vtkSmartPointer<vtkPolyData> ToPolyData(const tyndall::TriangleMesh& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& point : mesh.points)
  {
    points->InsertNextPoint(point.data());
  }
  vtkNew<vtkCellArray> triangles;
  for (const auto& triangle : mesh.triangles)
  {
    const vtkIdType corners[3] = { triangle[0], triangle[1], triangle[2] };
    triangles->InsertNextCell(3, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(triangles);
  return data;
}
}
