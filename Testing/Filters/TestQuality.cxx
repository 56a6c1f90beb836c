#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkMediumRayCaster.h"
#include "vtkRectangleLight.h"
#include "vtkStringArray.h"

#include <cmath>
#include <string>

namespace
{
/// The lines of field data settings_used; empty where there are none.
std::string Used(vtkDataObject* output)
{
  auto* lines = vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("settings_used"));
  std::string text;
  for (vtkIdType i = 0; lines && i < lines->GetNumberOfValues(); ++i)
  {
    text += lines->GetValue(i) + "\n";
  }
  return text;
}

bool Has(const std::string& text, const std::string& line)
{
  return text.find(line + "\n") != std::string::npos;
}

/// -2 where there is no such line.
int NumberOf(const std::string& text, const std::string& name)
{
  const std::size_t at = ("\n" + text).find("\n" + name + " = ");
  return at == std::string::npos ? -2 : std::stoi(text.substr(at + name.size() + 3));
}

vtkSmartPointer<vtkImageData> Medium()
{
  return test::MakeMedium({ { 7, 5, 9 }, { 0.5, 0.5, 0.5 } }, 0.02, 0.3);
}

void SetsWhatNobodySet(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(Medium());
  maps->SetFaceRadiance(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
  maps->Update();
  const std::string usual = Used(maps->GetOutputDataObject(0));
  claims.That(maps->GetQuality() == vtkLightPropagationMaps::USUAL, "default by default");
  claims.That(
    Has(usual, "DirectionsPerFace = 25") && Has(usual, "Tolerance = 0.0001") && Has(usual, "MapResolution = 1"),
    "by default properties stand for themselves: " + usual);
  claims.That(NumberOf(usual, "UncollidedDirections") > 25, "automatic ones are told as they were: " + usual);
  const std::string shown = maps->GetSettingsUsed();
  claims.That(shown + "\n" == usual, "the panel shows the same as the field data");

  maps->SetQuality(vtkLightPropagationMaps::FINE);
  maps->Update();
  const std::string fine = Used(maps->GetOutputDataObject(0));
  claims.That(!Has(fine, "DirectionsPerFace = 25") && NumberOf(fine, "UncollidedDirections") > 25, "fine: " + fine);
  claims.That(maps->GetDirectionsPerFace() == 25, "the property keeps its value");
  maps->SetDirectionsPerFace(16);
  maps->SetTolerance(0.02);
  maps->Update();
  const std::string chosen = Used(maps->GetOutputDataObject(0));
  claims.That(Has(chosen, "DirectionsPerFace = 16") && Has(chosen, "Tolerance = 0.02"), "set by hand wins: " + chosen);
  claims.That(errors.None(), "without complaint");
}

/// What goes on for ever along two axes takes 36 directions where 25 are asked for, and that is what is told.
template <class Solver>
void TellsWhatASlabTook(test::Claims& claims, const std::string& which)
{
  for (const int decomposition : { Solver::WHOLE, Solver::BLOCKS })
  {
    vtkNew<Solver> solver;
    const auto medium = Medium();
    medium->GetCellData()->GetArray("sigma_s")->SetComponent(11, 0, 0.5); // else only the layers are solved
    solver->SetInputDataObject(medium);
    solver->SetDecomposition(decomposition);
    solver->PeriodicXOn();
    solver->PeriodicYOn();
    solver->SetFaceRadiance(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    solver->Update();
    const std::string used = Used(solver->GetOutputDataObject(0));
    const std::string leftOut = solver->GetLeftOut();
    claims.That(
      leftOut.find("solved with 36 a face") != std::string::npos, which + ": a slab of 36 directions: " + leftOut);
    claims.That(Has(used, "DirectionsPerFace = 36"), which + ": which the settings say: " + used);
  }
}

/// Layers that are solved in the cosine alone have no directions and no tolerance.
void TellsCosinesOfLayers(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(Medium());
  maps->PeriodicXOn();
  maps->PeriodicYOn();
  for (const double target : { 0.0, 0.05 })
  {
    maps->SetTargetError(target);
    maps->Update();
    const std::string used = Used(maps->GetOutputDataObject(0)), leftOut = maps->GetLeftOut();
    claims.That(leftOut.find("with 16 cosines up and as many down") != std::string::npos,
      "layers are solved in the cosine alone: " + leftOut);
    claims.That(Has(used, "PolarNodes = 16") && used.find("Directions") == std::string::npos &&
        used.find("Tolerance") == std::string::npos,
      "which the settings say: " + used);
  }
  claims.That(errors.None(), "without complaint");
}

/// Settings that play no part in a scene or a scheme are not told as if they did.
void TellsWhatWasUsed(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(Medium());
  maps->SetUncollidedDirections(100);
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->PeriodicXOn();
  maps->PeriodicYOn();
  maps->PeriodicZOn();
  maps->DefaultSkyOff();
  maps->Update();
  const std::string closed = Used(maps->GetOutputDataObject(0));
  claims.That(Has(closed, "UncollidedDirections = 0"), "no light comes in along finer directions: " + closed);
  maps->PeriodicXOff();
  maps->PeriodicYOff();
  maps->PeriodicZOff();
  maps->SetScheme(vtkLightPropagationMaps::PUBLISHED);
  maps->SetQuality(vtkLightPropagationMaps::REFERENCE);
  maps->SetDirectionsPerFace(9);
  for (const int algorithm : { vtkLightPropagationMaps::PARALLEL, vtkLightPropagationMaps::SEQUENTIAL })
  {
    maps->SetAlgorithm(algorithm);
    maps->Update();
    const std::string published = Used(maps->GetOutputDataObject(0));
    claims.That(Has(published, "DirectionsPerFace = 9") && Has(published, "Tolerance = 1e-05") &&
        Has(published, "MapResolution = 1") && NumberOf(published, "UncollidedDirections") == -2 &&
        NumberOf(published, "StaggeredRays") == -2 && published.find("EmissionError") == std::string::npos,
      "the published scheme has only some of the settings: " + published);
  }
}

void TellsDirectionsOfASpiral(test::Claims& claims)
{
  for (const int decomposition : { vtkDiscreteOrdinates::WHOLE, vtkDiscreteOrdinates::BLOCKS })
  {
    vtkNew<vtkDiscreteOrdinates> ordinates;
    ordinates->SetInputDataObject(Medium());
    ordinates->SetSkyColor(1.0, 1.0, 1.0);
    ordinates->SetDecomposition(decomposition);
    ordinates->SetSpiralDirections(40);
    ordinates->Update();
    const std::string spiral = Used(ordinates->GetOutputDataObject(0));
    claims.That(
      Has(spiral, "SpiralDirections = 40") && NumberOf(spiral, "DirectionsPerFace") == -2 && Has(spiral, "Terms = 25"),
      "directions of a spiral are none of a cube: " + spiral);
    ordinates->SetScattering(vtkDiscreteOrdinates::MATRIX);
    ordinates->Update();
    const std::string matrix = Used(ordinates->GetOutputDataObject(0));
    claims.That(NumberOf(matrix, "Terms") == -2, "a whole matrix has no terms: " + matrix);
    ordinates->SetInputDataObject(test::MakeMedium({ { 1, 1, 9 }, { 0.5, 0.5, 0.5 } }, 0.02, 0.3));
    ordinates->PeriodicXOn();
    ordinates->PeriodicYOn();
    ordinates->PreviewOn();
    ordinates->Update();
    const std::string preview = Used(ordinates->GetOutputDataObject(0)), leftOut = ordinates->GetLeftOut();
    claims.That(leftOut.find("solved with 144 a face") != std::string::npos && Has(preview, "DirectionsPerFace = 144"),
      "a preview of a slab: " + preview + leftOut);
  }
}

template <class Solver>
void SetsTolerance(test::Claims& claims, const std::string& which)
{
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(Medium());
  solver->SetSkyColor(1.0, 1.0, 1.0);
  solver->Update();
  claims.That(Has(Used(solver->GetOutputDataObject(0)), "Tolerance = 0.0001"), which + ": default");
  solver->SetQuality(Solver::DRAFT);
  solver->Update();
  claims.That(Has(Used(solver->GetOutputDataObject(0)), "Tolerance = 0.01"), which + ": draft");
  claims.That(errors.None(), which + ": without complaint");
  solver->SetQuality(4);
  solver->Update();
  claims.That(errors.WasOneWith("Quality is 4"), which + ": a level that there is not");
}

/// Root of the sum of squares of differences, of uncollided light.
double Apart(vtkImageData* first, vtkImageData* second)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < first->GetNumberOfCells(); ++i)
  {
    const auto at = [i](vtkImageData* of) { return of->GetCellData()->GetArray("fluence_direct")->GetComponent(i, 0); };
    sum += std::pow(at(first) - at(second), 2.0);
  }
  return std::sqrt(sum);
}

/// Light of a rectangle beside a medium.
template <class Solver>
vtkSmartPointer<vtkImageData> OfARectangle(test::Claims& claims, int quality)
{
  vtkNew<vtkRectangleLight> lamp;
  lamp->SetPosition(-0.4, 1.0, 2.0);
  lamp->SetDirection(1.0, 0.2, 0.0);
  lamp->SetSize(9.0, 4.0);
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(test::MakeMedium({ { 7, 5, 9 }, { 0.5, 0.5, 0.5 } }, 0.6, 0.0));
  solver->SetLightsConnection(lamp->GetOutputPort());
  solver->SetQuality(quality);
  solver->Update();
  claims.That(errors.None(), "a rectangle without complaint");
  return vtkImageData::SafeDownCast(solver->GetOutputDataObject(0));
}

/// It is divided the finer the better the quality is, in all solvers alike.
void DividesRectangles(test::Claims& claims)
{
  using Maps = vtkLightPropagationMaps;
  vtkSmartPointer<vtkImageData> light[4];
  for (int quality = Maps::DRAFT; quality <= Maps::REFERENCE; ++quality)
  {
    light[quality] = OfARectangle<Maps>(claims, quality);
  }
  const double draft = Apart(light[0], light[3]), usual = Apart(light[1], light[3]), fine = Apart(light[2], light[3]);
  claims.That(fine < 0.7 * usual && usual < 0.7 * draft && draft > 0.0,
    "finer rectangles: " + std::to_string(draft) + " " + std::to_string(usual) + " " + std::to_string(fine));
  const double alike = 0.1 * usual;
  claims.That(Apart(OfARectangle<vtkDiscreteOrdinates>(claims, Maps::FINE), light[2]) < alike, "those of ordinates");
  claims.That(Apart(OfARectangle<vtkLatticeBoltzmannLighting>(claims, Maps::FINE), light[2]) < alike, "of the lattice");
}

void SetsSteps(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(Medium());
  maps->SetSkyColor(1.0, 1.0, 1.0);
  vtkNew<vtkMediumRayCaster> caster;
  test::Errors errors(caster);
  caster->SetInputConnection(maps->GetOutputPort());
  caster->SetImageSize(16, 12);
  caster->SetQuality(vtkMediumRayCaster::REFERENCE);
  caster->Update();
  claims.That(Has(Used(caster->GetOutputDataObject(0)), "StepSize = 0.1"), "a picture's step");
  caster->SetStepSize(0.7);
  caster->Update();
  claims.That(Has(Used(caster->GetOutputDataObject(0)), "StepSize = 0.7"), "a step that was chosen");
  claims.That(errors.None(), "a picture without complaint");
}

void SolvesToATarget(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(Medium());
  maps->SetFaceRadiance(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
  maps->SetTargetError(0.03);
  maps->Update();
  const std::string used = Used(maps->GetOutputDataObject(0));
  claims.That(errors.None(), "a target that can be met, without complaint");
  claims.That(maps->GetEstimatedError() > 0.0 && maps->GetEstimatedError() <= 0.03, "its estimate is below the target");
  claims.That(maps->GetSolves() >= 3 && maps->GetSeconds() > 0.0, "says at what cost");
  claims.That(used.find("VoxelsDividedBy = ") != std::string::npos, "says by what: " + used);
  claims.That(maps->GetOutput()->GetCellData()->GetArray("fluence_error") != nullptr, "an error by voxel");

  maps->SetTargetError(1e-6);
  maps->Update();
  claims.That(errors.WasOneWith("TargetError 1e-06 is not met"), "one warning where it is missed");
  claims.That(maps->GetEstimatedError() > 1e-6, "and the estimate says so");
  maps->SetTargetError(-0.1);
  maps->Update();
  claims.That(errors.WasOneWith("TargetError is -0.1"), "no error below 0");
  maps->SetTargetError(0.03);
  maps->SetScheme(vtkLightPropagationMaps::PUBLISHED);
  maps->Update();
  claims.That(errors.WasOneWith("TargetError is for the conservative scheme"), "not as published");
  maps->SetScheme(vtkLightPropagationMaps::CONSERVATIVE);
  maps->Update();
  claims.That(errors.None(), "heals");
}

void OrdinatesSolveToATarget(test::Claims& claims)
{
  vtkNew<vtkDiscreteOrdinates> ordinates;
  test::Errors errors(ordinates);
  ordinates->SetInputDataObject(Medium());
  ordinates->SetFaceRadiance(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
  ordinates->EstimateErrorOn();
  ordinates->Update();
  const double error = ordinates->GetEstimatedError();
  claims.That(errors.None() && error > 1e-3 && error < 0.5, "ordinates estimate their error: " + std::to_string(error));
  claims.That(ordinates->GetOutput()->GetCellData()->GetArray("fluence_error") != nullptr, "by voxel, too");
  ordinates->EstimateErrorOff();
  ordinates->SetTargetError(0.9 * error);
  ordinates->Update();
  const std::string used = Used(ordinates->GetOutputDataObject(0));
  claims.That(errors.None() && ordinates->GetEstimatedError() <= 0.9 * error, "ordinates meet a target: " + used);
  claims.That(ordinates->GetSolves() >= 3 && used.find("VoxelsDividedBy = ") != std::string::npos, "and say how");
  ordinates->SetTargetError(1e-6);
  ordinates->Update();
  claims.That(errors.WasOneWith("TargetError 1e-06 is not met"), "one warning where ordinates miss it");
  ordinates->SetSpiralDirections(96);
  ordinates->Update();
  claims.That(errors.WasOneWith("SpiralDirections is 96"), "no target for directions on a spiral");
  ordinates->SetSpiralDirections(0);
  ordinates->SetScheme(vtkDiscreteOrdinates::PUBLISHED);
  ordinates->Update();
  claims.That(errors.WasOneWith("TargetError is for the conservative scheme"), "nor for ordinates as published");
  ordinates->SetTargetError(0.0);
  ordinates->EstimateErrorOn();
  ordinates->Update();
  claims.That(errors.WasOneWith("EstimateError is for the conservative scheme"), "which have no estimate either");
  ordinates->SetScheme(vtkDiscreteOrdinates::CONSERVATIVE);
  ordinates->Update();
  claims.That(errors.None(), "heals");
}

/// The error of the lattice is that of diffusion.
void LatticeNamesWhoReachesATarget(test::Claims& claims)
{
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  test::Errors errors(lattice);
  lattice->SetInputDataObject(Medium());
  lattice->SetFaceRadiance(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
  lattice->SetTargetError(0.5);
  lattice->Update();
  const double error = lattice->GetEstimatedError();
  claims.That(errors.None() && error > 1e-3 && error < 0.5, "diffusion has an error: " + std::to_string(error));
  claims.That(lattice->GetOutput()->GetCellData()->GetArray("fluence_error") != nullptr, "by voxel, too");
  lattice->SetTargetError(1e-3);
  lattice->Update();
  claims.That(errors.WasOneWith("Light Propagation Maps"), "one warning names the solver that reaches less");
  lattice->SetScheme(vtkLatticeBoltzmannLighting::PUBLISHED);
  lattice->Update();
  claims.That(errors.WasOneWith("TargetError is for the conservative scheme"), "as published there is no target");
  lattice->SetTargetError(0.0);
  lattice->EstimateErrorOn();
  lattice->Update();
  claims.That(errors.WasOneWith("EstimateError is for the conservative scheme"), "and no estimate");
  lattice->EstimateErrorOff();
  lattice->SetMaximumOrders(3);
  lattice->Update();
  claims.That(lattice->GetEstimatedError() == 0.0, "which is gone where it was not asked for");
}
}

int TestQuality(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    SetsWhatNobodySet(claims);
    TellsWhatASlabTook<vtkLightPropagationMaps>(claims, "maps");
    TellsWhatASlabTook<vtkDiscreteOrdinates>(claims, "ordinates");
    TellsCosinesOfLayers(claims);
    TellsWhatWasUsed(claims);
    TellsDirectionsOfASpiral(claims);
    SetsTolerance<vtkDiscreteOrdinates>(claims, "ordinates");
    SetsTolerance<vtkLatticeBoltzmannLighting>(claims, "lattice");
    DividesRectangles(claims);
    SetsSteps(claims);
    SolvesToATarget(claims);
    OrdinatesSolveToATarget(claims);
    LatticeNamesWhoReachesATarget(claims);
  });
}
