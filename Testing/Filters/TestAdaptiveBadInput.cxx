// What adaptive photons are told when a map, photons or light mean nothing: one error that says what, and empty
// outputs.

#include "AdaptiveScene.h"
#include "Numerics/NumberText.h"

#include <limits>

namespace
{
using Pipeline = test::Adaptive;

/// A map of squares.
vtkSmartPointer<vtkImageData> Map(const std::array<int, 3>& size, const test::Values& value)
{
  auto map = test::MakeImage({ size });
  test::AddValues<vtkFloatArray>(map->GetCellData(), "importance", map->GetNumberOfCells(), 1, value);
  return map;
}

const test::Values One = [](vtkIdType, int) { return 1.0; };

void AddLights(vtkImageData* map, const std::vector<double>& numbers)
{
  test::AddValues<vtkDoubleArray>(map->GetFieldData(), "light", static_cast<vtkIdType>(numbers.size()), 1,
    [&](vtkIdType i, int) { return numbers[static_cast<std::size_t>(i)]; });
}

void AMapThatMeansNothingIsRefused(test::Claims& claims)
{
  Pipeline scene(test::GlassBall(8));
  test::Errors errors(scene.emitter), ofMarcher(scene.marcher), ofReconstruction(scene.reconstruction);
  const auto refused = [&](vtkImageData* map, const std::string& part) {
    scene.emitter->SetImportanceMapData(map);
    scene.reconstruction->Update();
    claims.That(errors.WasOneWith(part), "a map is refused: " + part);
    claims.That(ofMarcher.None() && ofReconstruction.None(), "and nothing else is said after: " + part);
    claims.That(test::AreEmpty({ scene.emitter, scene.marcher, scene.reconstruction }), "outputs are empty: " + part);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused(Map({ 4, 4, 1 }, [](vtkIdType, int) { return 0.0; }), "importance of light 0 is 0 everywhere");
  refused(Map({ 4, 4, 1 }, [=](vtkIdType i, int) { return i == 6 ? nan : 1.0; }), "nan in column 2, row 1");
  refused(Map({ 4, 4, 1 }, [](vtkIdType i, int) { return i == 6 ? -1.0 : 1.0; }), "-1 in column 2, row 1");
  refused(Map({ 4, 4, 1 }, [](vtkIdType i, int) { return i == 6 ? 1e300 : 1.0; }), "inf in column 2, row 1");
  refused(Map({ 4, 5, 1 }, One), "4 x 5 cells");
  refused(Map({ 4, 4, 2 }, One), "lights that there are not: 1 ");
  const auto other = Map({ 4, 4, 3 }, One);
  AddLights(other, { 0.0, 7.0, -1.0 });
  refused(other, "lights that there are not: 7, -1 ");
  const auto twice = Map({ 4, 4, 2 }, One);
  AddLights(twice, { 0.0, 0.0 });
  refused(twice, "two layers of light 0");
  const auto few = Map({ 4, 4, 2 }, One);
  AddLights(few, { 0.0 });
  refused(few, "2 layers, and its field data 'light' 1");
  const auto half = Map({ 4, 4, 1 }, One);
  AddLights(half, { 0.5 });
  refused(half, "'light' has 0.5");
  const auto unnamed = test::MakeImage({ { 4, 4, 1 } });
  test::AddCells(unnamed, "density", 1.0);
  refused(unnamed, "no array 'importance'");
  const auto coloured = test::MakeImage({ { 4, 4, 1 } });
  test::AddCells(coloured, "importance", 1.0, 3);
  refused(coloured, "'importance' has 3 components");

  scene.emitter->SetImportanceMapData(Map({ 4, 4, 1 }, One));
  scene.reconstruction->Update();
  claims.That(errors.None() && scene.Smooth()->GetNumberOfCells() == 512, "a map that a user made is taken");
  scene.emitter->RemoveImportanceMap();
  scene.emitter->SetBatches(2);
  scene.reconstruction->Update();
  claims.That(errors.None() && scene.Smooth()->GetNumberOfCells() == 512, "and it comes off");
}

void SettingsThatMeanNothingAreRefused(test::Claims& claims)
{
  Pipeline scene(test::GlassBall(8));
  test::Errors errors(scene.importance), ofEmitter(scene.emitter);
  const auto refused = [&](const std::string& part) {
    scene.emitter->Update();
    claims.That(errors.WasOneWith(part), "a setting is refused: " + part);
    claims.That(ofEmitter.None() && test::AreEmpty({ scene.importance, scene.emitter }), "no photons after: " + part);
  };
  scene.importance->SetBackground(0.0);
  refused("Background is 0; it must be above 0 and at most 1");
  scene.importance->SetBackground(1.5);
  refused("Background is 1.5");
  scene.importance->SetBackground(0.4);
  scene.importance->SetPilotDimensions(16, 0, 16);
  refused("PilotDimensions is (16, 0, 16); each number must be at least 1");
  scene.importance->SetPilotDimensions(16, 16, 16);
  scene.importance->SetThresholds(vtkPhotonImportance::OWN);
  scene.importance->SetGradientThreshold(-1.0);
  refused("GradientThreshold is -1; it must be finite and at least 0");
  scene.importance->SetThresholds(vtkPhotonImportance::AUTOMATIC);
  refused("GradientThreshold is -1"); // whether it is needed or not
  scene.importance->SetGradientThreshold(0.0);
  scene.importance->SetSkyColor(-1.0, 0.0, 0.0);
  refused("SkyColor is (-1, 0, 0)");
  scene.importance->SetSkyColor(0.0, 0.0, 0.0);
  scene.emitter->Update();
  claims.That(errors.None() && scene.Photons()->GetNumberOfPoints() == 20000, "and works again");

  auto medium = test::GlassBall(8);
  medium->GetCellData()->GetArray("ior")->SetComponent(3, 0, 0.0);
  scene.SetMedium(medium);
  refused("a refractive index must be");
}

/// Photons beside one axis, all the same.
vtkSmartPointer<vtkPolyData> Beam(vtkIdType count, const std::function<double(vtkIdType)>& batch)
{
  vtkNew<vtkPoints> points;
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->InsertNextPoint(0.0, 3.5, 3.5);
  }
  auto photons = vtkSmartPointer<vtkPolyData>::New();
  photons->SetPoints(points);
  vtkPointData* data = photons->GetPointData();
  test::AddValues<vtkFloatArray>(data, "direction", count, 3, [](vtkIdType, int c) { return c == 0 ? 1.0 : 0.0; });
  test::AddValues<vtkFloatArray>(data, "power", count, 1, [](vtkIdType, int) { return 1e-3; });
  test::AddValues<vtkFloatArray>(data, "weight", count, 1, [](vtkIdType, int) { return 1.0; });
  test::AddValues<vtkFloatArray>(data, "batch", count, 1, [&](vtkIdType i, int) { return batch(i); });
  return photons;
}

void PhotonsThatMeanNothingAreRefused(test::Claims& claims)
{
  Pipeline scene(test::MakeMedium({ { 8, 8, 8 } }, 0.0, 0.1));
  test::Errors errors(scene.marcher);
  for (double batch : { -1.0, 0.5, 64.0, std::numeric_limits<double>::quiet_NaN() })
  {
    scene.marcher->SetPhotonsData(Beam(4, [=](vtkIdType i) { return i == 2 ? batch : 0.0; }));
    scene.marcher->Update();
    claims.That(errors.WasOneWith("Photon 2 has batch " + tyndall::Text("%g", batch)), "a batch that is none");
    claims.That(test::AreEmpty({ scene.marcher }), "and no light");
  }
  const auto heavy = Beam(4, [](vtkIdType) { return 0.0; });
  heavy->GetPointData()->GetArray("weight")->SetComponent(1, 0, std::numeric_limits<double>::quiet_NaN());
  scene.marcher->SetPhotonsData(heavy);
  scene.marcher->PhotonCountsOn();
  scene.marcher->Update();
  claims.That(errors.WasOneWith("weight"), "a weight that is no number");
  scene.marcher->SetPhotonsData(Beam(4, [](vtkIdType) { return 0.0; }));
  scene.marcher->SetScheme(vtkPhotonMarcher::PUBLISHED);
  scene.marcher->Update();
  claims.That(errors.WasOneWith("Choose the conservative scheme"), "the published scheme does not count");
  claims.That(test::AreEmpty({ scene.marcher }), "and gives no light");
}

/// Holes are most of it, but nothing of them is NaN.
void AllPhotonsInOneLineOfVoxelsGiveLight(test::Claims& claims)
{
  Pipeline scene(test::MakeMedium({ { 8, 8, 8 } }, 0.0, 0.1));
  scene.marcher->SetPhotonsData(Beam(1000, [](vtkIdType i) { return static_cast<double>(i % 2); }));
  scene.marcher->PhotonCountsOn();
  test::Errors errors(scene.reconstruction);
  for (int scheme = 0; scheme < 4; ++scheme)
  {
    scene.reconstruction->SetScheme(scheme);
    scene.reconstruction->SetConserveFluence(vtkPhotonReconstruction::ALWAYS);
    scene.reconstruction->Update();
    claims.That(errors.None(), "no error of photons at one place");
    vtkDataArray* fluence = test::FiniteCells(claims, scene.Smooth(), "fluence", 1);
    claims.Near(test::Total(fluence) / test::TotalCells(scene.Noisy(), "fluence"), 1.0, 1e-5, "their light");
    test::FiniteCells(claims, scene.Smooth(), "mean_direction", 3);
    test::FiniteCells(claims, scene.Smooth(), "mip_level", 1);
  }
}

void NoPhotonsGiveNoLight(test::Claims& claims)
{
  Pipeline scene(test::MakeMedium({ { 8, 8, 8 } }, 0.0, 0.1));
  scene.marcher->PhotonCountsOn();
  scene.marcher->SetPhotonsData(vtkSmartPointer<vtkPolyData>::New());
  test::Errors errors(scene.reconstruction);
  for (int scheme : { 0, 2, 3, 1 })
  {
    scene.reconstruction->SetScheme(scheme);
    scene.reconstruction->Update();
    claims.That(errors.None(), "no error where there are no photons");
    claims.Near(test::Total(test::FiniteCells(claims, scene.Smooth(), "fluence", 1)), 0.0, 0.0, "light of no photons");
  }
  claims.Near(test::Total(test::FiniteCells(claims, scene.Smooth(), "mean_direction", 3)), 0.0, 0.0, "its direction");
}

void LightThatMeansNothingIsRefused(test::Claims& claims)
{
  vtkNew<vtkPhotonReconstruction> reconstruction;
  test::Errors errors(reconstruction);
  const auto refused = [&](vtkImageData* light, int scheme, const std::string& part) {
    reconstruction->SetInputDataObject(light);
    reconstruction->SetScheme(scheme);
    reconstruction->Update();
    claims.That(errors.WasOneWith(part), "light is refused: " + part);
    claims.That(test::AreEmpty({ reconstruction }), "and there is none: " + part);
  };
  const auto light = test::MakeImage({ { 8, 8, 8 } });
  refused(light, 2, "no array 'fluence'");
  test::AddCells(light, "fluence", 1.0);
  refused(light, 0, "photon_count");
  refused(light, 1, "Batches");
  refused(light, 3, "photon_count");
  const auto odd = test::MakeImage({ { 8, 8, 8 } });
  test::AddCells(odd, "fluence", 1.0, 3);
  test::AddCells(odd, "fluence_batches", 1.0, 4);
  refused(odd, 1, "it must have 3 for each batch");
  light->GetCellData()->GetArray("fluence")->SetComponent(9, 0, std::numeric_limits<double>::quiet_NaN());
  refused(light, 2, "nan in voxel");
}
}

int TestAdaptiveBadInput(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    AMapThatMeansNothingIsRefused(claims);
    SettingsThatMeanNothingAreRefused(claims);
    PhotonsThatMeanNothingAreRefused(claims);
    AllPhotonsInOneLineOfVoxelsGiveLight(claims);
    NoPhotonsGiveNoLight(claims);
    LightThatMeansNothingIsRefused(claims);
  });
}
