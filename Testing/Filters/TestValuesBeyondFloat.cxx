// What is beyond floats, or no number, is refused where it comes in, or told where it comes out: one error, an empty
// output.
#include "MediumScene.h"

#include "vtkCellArray.h"
#include "vtkEnvironmentReader.h"
#include "vtkIntArray.h"
#include "vtkLightRig.h"
#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkMeshVoxelizer.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSphereSource.h"
#include "vtkTestUtilities.h"

#include <fstream>
#include <limits>

namespace
{
/// Whether an update gave one error with `part` in it, and an empty output.
bool Refuses(vtkAlgorithm* filter, const std::string& part)
{
  test::Errors errors(filter);
  filter->Update();
  const bool one = errors.WasOneWith(part);
  return one && filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT) == 0;
}

/// A sun as a user's own data, which no property's range holds back.
vtkSmartPointer<vtkPolyData> Sun(double power)
{
  auto lights = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.0, 0.0, 0.0);
  lights->SetPoints(points);
  test::AddValues<vtkIntArray>(lights->GetPointData(), "light_type", 1, 1, [](vtkIdType, int) { return 0.0; });
  test::AddValues<vtkDoubleArray>(lights->GetPointData(), "power", 1, 3, [=](vtkIdType, int) { return power; });
  test::AddValues<vtkDoubleArray>(
    lights->GetPointData(), "direction", 1, 3, [](vtkIdType, int c) { return c == 2 ? -1.0 : 0.0; });
  return lights;
}

/// Photons of a sun or a sky through an empty box.
struct March
{
  explicit March(std::array<double, 3> spacing = { 1.0, 1.0, 1.0 }, double sigma = 0.0)
  {
    const auto medium = test::MakeMedium({ { 4, 4, 4 }, spacing }, sigma, 0.0);
    this->emitter->SetInputDataObject(medium);
    this->emitter->SetPhotonCount(20000);
    this->marcher->SetInputDataObject(medium);
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
  }

  /// Errors come from the emitter, the marcher is silent then, or from the marcher.
  bool RefusedAtEmitter(const std::string& part)
  {
    test::Errors ofMarcher(this->marcher);
    return Refuses(this->emitter, part) && (this->marcher->Update(), ofMarcher.None());
  }

  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
};

void PhotonsAreRefused(test::Claims& claims)
{
  {
    March march;
    march.emitter->SetSkyColor(1e38, 1e38, 1e38);
    march.emitter->Update();
    claims.That(Refuses(march.marcher, "'fluence' would be infinite in voxel (0, 0, 0)"), "a sky of 1e38");
    march.emitter->SetSkyColor(1e36, 1e36, 1e36);
    test::Errors errors(march.marcher);
    march.marcher->Update();
    claims.That(errors.None(), "a sky of 1e36 is light");
  }
  {
    March march;
    march.emitter->SetSkyColor(1e308, 1e308, 1e308);
    claims.That(march.RefusedAtEmitter("SkyColor is (1e+308, 1e+308, 1e+308)"), "a sky of 1e308");
  }
  for (const double power : { 1e39, 1e307, 1e308 })
  {
    March march;
    march.emitter->SetLightsData(Sun(power));
    claims.That(march.RefusedAtEmitter("Light 0 has power 1e+3"), "a sun beyond float");
  }
  {
    March march;
    march.emitter->SetLightsData(Sun(3e38));
    march.emitter->SetPhotonCount(4);
    claims.That(march.RefusedAtEmitter("A photon of light 0 would carry more power than 3.4e+38 W"), "bright photons");
  }
  {
    March march({ 1e-22, 1e-22, 1e-22 });
    march.emitter->SetLightsData(Sun(1.0));
    claims.That(march.RefusedAtEmitter("A photon of light 0 would carry less power than 1.2e-38 W"), "spacing 1e-22");
    march.emitter->SetLightsData(Sun(1e10));
    march.marcher->Update();
    auto* const lit = vtkImageData::SafeDownCast(march.marcher->GetOutputDataObject(0));
    claims.That(test::Deviation(lit, "fluence", 1e10) < 0.2e10, "more power in a small box is light");
  }
  {
    March march({ 1e-160, 1.0, 1.0 });
    march.emitter->SetLightsData(Sun(1.0));
    claims.That(march.RefusedAtEmitter("The grid's spacing along x is 1e-160"), "spacing (1e-160, 1, 1)");
  }
  {
    March march({ 1e-12, 1.0, 1.0 });
    march.emitter->SetLightsData(Sun(1.0));
    claims.That(march.RefusedAtEmitter("one is more than 1e+09 times another"), "voxels a trillion times as wide");
  }
}

void PropagationIsRefused(test::Claims& claims)
{
  const auto medium = test::MakeMedium({ { 3, 3, 3 } }, 0.1, 0.1);
  for (const int algorithm : { vtkLightPropagationMaps::SEQUENTIAL, vtkLightPropagationMaps::PARALLEL })
  {
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputDataObject(medium);
    maps->SetScheme(vtkLightPropagationMaps::PUBLISHED);
    maps->SetAlgorithm(algorithm);
    maps->SetSkyColor(1e38, 1e38, 1e38);
    claims.That(Refuses(maps, "would be "), "the published scheme under a sky of 1e38");
  }
  vtkNew<vtkLPMPropagate> propagate;
  propagate->SetInputDataObject(medium);
  propagate->SetSkyColor(1e38, 1e38, 1e38);
  vtkNew<vtkLPMCollect> collect;
  collect->SetInputConnection(propagate->GetOutputPort());
  test::Errors ofPropagate(propagate);
  propagate->Update();
  claims.That(ofPropagate.None() ? Refuses(collect, "would be infinite") : ofPropagate.WasOneWith("would be "),
    "LPMCollect under a sky of 1e38");
}

void MediaAreRefused(test::Claims& claims)
{
  const auto density = test::MakeImage({ { 2, 2, 2 } });
  test::AddCells(density, "density", 2.0);
  density->GetCellData()->SetActiveScalars("density");
  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputDataObject(density);
  medium->SetExtinctionScale(1e39);
  claims.That(Refuses(medium, "ExtinctionScale is 1e+39"), "ExtinctionScale 1e39");
  medium->SetExtinctionScale(3e38);
  claims.That(Refuses(medium, "'sigma_s' would be infinite in voxel (0, 0, 0)"), "3e38 times a density of 2");
  medium->SetExtinctionScale(1.0);
  medium->SetMaximumDensity(1e-320);
  claims.That(Refuses(medium, "raise MaximumDensity"), "MaximumDensity 1e-320");

  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkMeshVoxelizer> voxelizer;
  voxelizer->SetInputConnection(sphere->GetOutputPort());
  voxelizer->SetSampleDimensions(8, 8, 8);
  voxelizer->SetInsideAbsorption(1e308, 1e308, 1e308);
  claims.That(Refuses(voxelizer, "InsideAbsorption is (1e+308"), "InsideAbsorption 1e308");
  voxelizer->SetInsideAbsorption(0.0, 0.0, 0.0);
  voxelizer->SetInsideIndex(1e308);
  claims.That(Refuses(voxelizer, "InsideIndex is 1e+308"), "InsideIndex 1e308");
}

void PicturesAreRefused(test::Claims& claims, const std::string& folder)
{
  const std::string path = folder + "/beyond_float.hdr";
  std::ofstream file(path, std::ios::binary);
  file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
  for (int pixel = 0; pixel < 8; ++pixel)
  {
    file << "\x80\x80\x80" << static_cast<char>(pixel == 5 ? 0xf0 : 0x81); // 2^111 and 1
  }
  file.close();
  vtkNew<vtkEnvironmentReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetExposure(std::numeric_limits<double>::quiet_NaN());
  claims.That(Refuses(reader, "Exposure is nan; it must be at least -64 and at most 64"), "an exposure of NaN");
  reader->SetExposure(40.0);
  claims.That(Refuses(reader, "'radiance' would be infinite in pixel (1, 0) from below"), "2^151");
  reader->SetExposure(0.0);
  reader->Update();
  claims.That(reader->GetOutput()->GetNumberOfPoints() == 8, "a conservative exposure heals it");
}
}

int TestValuesBeyondFloat(int argc, char* argv[])
{
  test::Claims claims;
  char* const folder = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "VTK_TEMP_DIR", "Testing/Temporary");
  PicturesAreRefused(claims, folder);
  delete[] folder;
  return test::WithDevice(
    [](test::Claims& claims) {
      MediaAreRefused(claims);
      PhotonsAreRefused(claims);
      PropagationIsRefused(claims);
    },
    claims);
}
