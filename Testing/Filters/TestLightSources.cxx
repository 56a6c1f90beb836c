#include "MediumScene.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkPointData.h"
#include "vtkPointLight.h"
#include "vtkPolyData.h"
#include "vtkRectangleLight.h"
#include "vtkSpotLight.h"
#include "vtkSun.h"

#include <cmath>
#include <initializer_list>
#include <string>

namespace
{
const char* const Arrays[] = { "light_type", "direction", "power", "size", "angle" };

/// Whether light i of the first is light j of the second, to 1e-12; positions of directional lights have no meaning.
bool SameLight(vtkPolyData* first, vtkIdType i, vtkPolyData* second, vtkIdType j)
{
  double difference = 0.0;
  for (const char* name : Arrays)
  {
    vtkDataArray* const one = first->GetPointData()->GetArray(name);
    vtkDataArray* const other = second->GetPointData()->GetArray(name);
    for (int c = 0; c < one->GetNumberOfComponents(); ++c)
    {
      difference += std::abs(one->GetComponent(i, c) - other->GetComponent(j, c));
    }
  }
  const bool isSun = first->GetPointData()->GetArray("light_type")->GetComponent(i, 0) == vtkLightRig::DIRECTIONAL;
  for (int axis = 0; axis < 3 && !isSun; ++axis)
  {
    difference += std::abs(first->GetPoint(i)[axis] - second->GetPoint(j)[axis]);
  }
  return difference < 1e-12;
}

struct Sources
{
  vtkNew<vtkSun> Sun;
  vtkNew<vtkPointLight> Point;
  vtkNew<vtkSpotLight> Spot;
  vtkNew<vtkRectangleLight> Rectangle;

  Sources()
  {
    this->Sun->SetPosition(1, 2, 5);
    this->Sun->SetFocalPoint(1, 2, 3);
    this->Sun->SetPower(1, 2, 3);
    this->Point->SetPosition(4, 5, 6);
    this->Point->SetPower(7, 8, 9);
    this->Spot->SetPosition(1, 1, 1);
    this->Spot->SetFocalPoint(1, 4, 5);
    this->Spot->SetPower(2, 2, 2);
    this->Spot->SetAngle(30);
    this->Rectangle->SetPosition(0, 0, 4);
    this->Rectangle->SetDirection(3, 0, -4);
    this->Rectangle->SetPower(5, 4, 3);
    this->Rectangle->SetSize(2, 1);
  }
};

/// The same lights as rows of a rig.
void AddRows(vtkLightRig* rig)
{
  rig->SunOff();
  rig->AddDirectionalLight(0, 0, -1, 1, 2, 3);
  rig->AddPointLight(4, 5, 6, 7, 8, 9);
  rig->AddSpotLight(1, 1, 1, 0, 3, 4, 2, 2, 2, 30);
  rig->AddRectangleLight(0, 0, 4, 3, 0, -4, 5, 4, 3, 2, 1);
}

void EachIsARowOfARig(test::Claims& claims)
{
  Sources sources;
  vtkNew<vtkLightRig> rows;
  AddRows(rows);
  rows->Update();
  int row = 0;
  for (vtkLightSource* source :
    std::initializer_list<vtkLightSource*>{ sources.Sun, sources.Point, sources.Spot, sources.Rectangle })
  {
    source->Update();
    const std::string name = source->GetClassName();
    claims.That(source->GetOutput(0)->GetNumberOfPoints() == 1, name + " is one light");
    claims.That(source->GetOutput(0)->GetNumberOfVerts() == 1, name + " is a vertex");
    claims.That(SameLight(source->GetOutput(0), 0, rows->GetOutput(0), row++), name + " is the row of a rig");
    claims.That(source->GetOutput(1)->GetNumberOfCells() > 0, name + " can be seen");
  }
}

void TheRigGroupsThem(test::Claims& claims)
{
  Sources sources;
  vtkNew<vtkLightRig> rows;
  AddRows(rows);
  rows->Update();
  vtkNew<vtkLightRig> group;
  for (vtkAlgorithm* source :
    std::initializer_list<vtkAlgorithm*>{ sources.Sun, sources.Point, sources.Spot, sources.Rectangle })
  {
    group->AddInputConnection(source->GetOutputPort());
  }
  group->Update();
  if (claims.That(group->GetOutput(0)->GetNumberOfPoints() == 5, "a rig has its own sun and four that it was given"))
  {
    for (int i = 0; i < 4; ++i)
    {
      claims.That(SameLight(group->GetOutput(0), i + 1, rows->GetOutput(0), i), "a given light is what it was");
    }
  }
  group->SunOff();
  group->Update();
  claims.That(group->GetOutput(0)->GetNumberOfPoints() == 4, "the rig's own sun goes off");
  claims.That(group->GetOutput(1)->GetNumberOfCells() == 0, "lights of others are drawn by these");
  sources.Point->SetPosition(0, 0, 0);
  group->Update();
  claims.Near(group->GetOutput(0)->GetPoint(1)[0], 0.0, 0.0, "a light that was moved");
}

void Bounds(vtkPolyData* shape, double x0, double x1, double z0, double z1, const char* what, test::Claims& claims)
{
  double bounds[6];
  shape->GetBounds(bounds);
  claims.Near(bounds[0], x0, 1e-9, std::string(what) + ": least x");
  claims.Near(bounds[1], x1, 1e-9, std::string(what) + ": greatest x");
  claims.Near(bounds[4], z0, 1e-9, std::string(what) + ": least z");
  claims.Near(bounds[5], z1, 1e-9, std::string(what) + ": greatest z");
}

void ShapesAreWhereTheLightIs(test::Claims& claims)
{
  Sources sources;
  sources.Sun->Update();
  Bounds(sources.Sun->GetOutput(1), 1 - 0.06, 1 + 0.06, 4, 5, "arrow halfway down", claims);
  sources.Point->SetShapeSize(0.5);
  sources.Point->Update();
  Bounds(sources.Point->GetOutput(1), 3.5, 4.5, 5.5, 6.5, "ball", claims);
  sources.Spot->SetPosition(0, 0, 0);
  sources.Spot->SetFocalPoint(0, 0, 2);
  sources.Spot->SetAngle(60);
  sources.Spot->Update();
  Bounds(sources.Spot->GetOutput(1), -1, 1, 0, std::sqrt(3.0), "cone", claims);
  sources.Rectangle->SetPosition(0, 0, 4);
  sources.Rectangle->SetDirection(0, 0, -1);
  sources.Rectangle->Update();
  Bounds(sources.Rectangle->GetOutput(1), -1, 1, 4 - 0.35 * 2, 4, "rectangle and its arrow", claims);

  vtkDataArray* const color = sources.Rectangle->GetOutput(1)->GetPointData()->GetScalars();
  claims.That(color && color->GetNumberOfComponents() == 3, "a shape has a colour");
  claims.Near(color->GetComponent(0, 0), 255.0, 0.0, "its strongest channel is at full brightness");
  claims.That(color->GetComponent(0, 2) < color->GetComponent(0, 1), "the weaker one is darker");

  vtkNew<vtkLightRig> rig;
  rig->SetSunElevation(90);
  rig->SetShapeCenter(10, 0, 0);
  rig->SetShapeSize(4);
  rig->Update();
  Bounds(rig->GetOutput(1), 10 - 0.12, 10 + 0.12, 2, 4, "arrow of a rig's sun", claims);
}

void BadLightsAreErrors(test::Claims& claims)
{
  vtkNew<vtkSun> sun;
  test::Errors errors(sun);
  sun->SetFocalPoint(sun->GetPosition());
  sun->Update();
  claims.That(errors.WasOneWith("same place"), "a sun without direction is refused");
  claims.That(sun->GetOutput(0)->GetNumberOfPoints() == 0, "the output is empty after an error");
  claims.That(sun->GetOutput(1)->GetNumberOfPoints() == 0, "so is the shape");
  sun->SetFocalPoint(0, 0, 0);
  sun->SetPower(-1, 0, 0);
  sun->Update();
  claims.That(errors.WasOneWith("Power is (-1, 0, 0)"), "a sun that takes power is refused");
  sun->SetPower(1, 1, 1);
  sun->Update();
  claims.That(errors.None() && sun->GetOutput(0)->GetNumberOfPoints() == 1, "a good sun after a bad one");

  vtkNew<vtkRectangleLight> rectangle;
  test::Errors ofRectangle(rectangle);
  rectangle->SetDirection(0, 0, 0);
  rectangle->Update();
  claims.That(ofRectangle.WasOneWith("direction (0, 0, 0)"), "a rectangle without normal is refused");
  claims.That(rectangle->GetOutput(0)->GetNumberOfPoints() == 0, "the output is empty after an error");

  vtkNew<vtkLightRig> rig;
  test::Errors ofRig(rig);
  rig->AddInputConnection(sun->GetOutputPort(1));
  rig->Update();
  claims.That(ofRig.WasOneWith("light_type"), "a shape is no light");
}

/// One light with a solver that takes it directly, and by a rig.
void SolversTakeOne(test::Claims& claims)
{
  vtkNew<vtkImageData> medium;
  medium->SetDimensions(5, 5, 5);
  for (const char* name : { "sigma_a", "sigma_s" })
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfTuples(medium->GetNumberOfCells());
    array->Fill(0.1);
    medium->GetCellData()->AddArray(array);
  }
  Sources sources;
  vtkNew<vtkLightRig> rig;
  rig->SunOff();
  rig->AddPointLight(4, 5, 6, 7, 8, 9);
  double fluence[2] = { 0.0, 1.0 };
  int i = 0;
  for (vtkAlgorithm* lights : std::initializer_list<vtkAlgorithm*>{ sources.Point, rig })
  {
    vtkNew<vtkLightPropagationMaps> solver;
    test::Errors errors(solver);
    solver->SetInputDataObject(medium);
    solver->SetLightsConnection(lights->GetOutputPort());
    solver->Update();
    fluence[i++] = solver->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(0, 2);
  }
  claims.That(fluence[0] > 0.0 && fluence[0] == fluence[1], "a solver takes a source as it takes a rig");
}
}

int TestLightSources(int, char*[])
{
  test::Claims claims;
  EachIsARowOfARig(claims);
  TheRigGroupsThem(claims);
  ShapesAreWhereTheLightIs(claims);
  BadLightsAreErrors(claims);
  return test::WithDevice(SolversTakeOne, claims);
}
