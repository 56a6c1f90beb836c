#include "MediumScene.h"

#include "vtkLightPropagationMaps.h"

#include "Numerics/Constants.h"

namespace
{
using tyndall::Pi;
constexpr double Radiance = 0.75; ///< of the walls, and of the medium in equilibrium with them

/// A box whose walls shine, filled with a medium that absorbs, scatters and emits in equilibrium: whatever its shape,
/// every voxel sees the same radiance from everywhere.
void Holds(test::Claims& claims, vtkImageData* medium, const std::string& which)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(medium);
  maps->SetFaceRadiance(Radiance, Radiance, Radiance, Radiance, Radiance, Radiance);
  maps->SetTolerance(1e-7);
  maps->SetNetFlux(true);
  maps->Update();
  claims.That(errors.None(), which + ": solved without complaint");
  const double fluence = 4.0 * Pi * Radiance;
  const auto deviation = [&](const char* name, double from) {
    return test::Deviation(maps->GetOutput(), name, from) / fluence;
  };
  claims.Near(deviation("fluence", fluence), 0.0, 1e-5, which + ": deviation from its radiance");
  claims.Near(deviation("net_flux", 0.0), 0.0, 1e-5, which + ": what flows");
  claims.That(maps->GetBalanceError() < 1e-5, which + ": power is conserved");
  claims.That(maps->GetOrders() > 0 && maps->GetResidual() <= 1e-7, which + ": says how far it came");

  const bool ofPoints = medium->GetCellData()->GetNumberOfArrays() == 0; // which are in the middle of voxels then
  int extent[6];
  medium->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis + 1] += ofPoints ? 1 : 0;
  }
  const int* out = maps->GetOutput()->GetExtent();
  claims.That(std::equal(extent, extent + 6, out), which + ": keeps its extent");
  const double before = ofPoints ? 0.5 * medium->GetSpacing()[0] : 0.0;
  claims.That(maps->GetOutput()->GetOrigin()[0] == medium->GetOrigin()[0] - before, which + ": keeps its place");
}

vtkSmartPointer<vtkImageData> Furnace(const test::Box& box, double sigma_a, double sigma_s)
{
  auto medium = test::MakeMedium(box, sigma_a, sigma_s);
  test::AddCells(medium, "emission", sigma_a * Radiance);
  return medium;
}

vtkSmartPointer<vtkImageData> OfPoints()
{
  auto medium = test::MakeImage({ { 5, 3, 4 } });
  test::AddPoints<vtkDoubleArray>(medium, "sigma_a", 0.5);
  test::AddPoints(medium, "sigma_s", 1.0);
  test::AddPoints(medium, "emission", 0.5 * Radiance);
  return medium;
}

vtkSmartPointer<vtkImageData> OfDoubles()
{
  auto medium = test::MakeImage({ { 5, 3, 4 } });
  test::AddCells<vtkDoubleArray>(medium, "sigma_a", 0.5, 3);
  test::AddCells<vtkDoubleArray>(medium, "sigma_s", 1.0);
  test::AddCells<vtkDoubleArray>(medium, "emission", 0.5 * Radiance);
  return medium;
}
}

int TestLightPropagationMapsFurnace(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    Holds(claims, Furnace({ { 1, 1, 1 } }, 0.5, 1.0), "one voxel");
    Holds(claims, Furnace({ { 1, 5, 9 } }, 0.5, 1.0), "one layer");
    Holds(claims, Furnace({ { 1, 1, 17 } }, 0.5, 1.0), "one row");
    Holds(claims, Furnace({ { 7, 13, 5 } }, 0.5, 1.0), "odd sizes");
    Holds(claims, Furnace({ { 6, 4, 5 }, { 0.1, 1.0, 3.0 } }, 0.5, 1.0), "unequal spacing");
    Holds(claims, Furnace({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { 1e7, -1e7, 3e6 } }, 0.5, 1.0), "far away");
    Holds(claims, Furnace({ { 4, 5, 6 }, { 1.0, 1.0, 1.0 }, { 0.0, 0.0, 0.0 }, { -7, 3, 100 } }, 0.5, 1.0),
      "an extent not from 0");
    Holds(claims, Furnace({ { 4, 4, 4 } }, 1e5, 0.0), "black and opaque");
    Holds(claims, Furnace({ { 4, 4, 4 } }, 1e-6, 0.0), "nearly vacuum");
    Holds(claims, OfPoints(), "arrays of points");
    Holds(claims, OfDoubles(), "arrays of doubles, one with three components");
  });
}
