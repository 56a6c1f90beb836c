#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkIntArray.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <limits>
#include <string>
#include <vector>

namespace
{
const double NotANumber = std::numeric_limits<double>::quiet_NaN();
const double Infinite = std::numeric_limits<double>::infinity();

vtkSmartPointer<vtkImageData> Good()
{
  return test::MakeMedium({ { 3, 4, 5 } }, 0.5, 1.0);
}

vtkSmartPointer<vtkImageData> With(const char* array, vtkIdType cell, double value)
{
  auto medium = Good();
  medium->GetCellData()->GetArray(array)->SetComponent(cell, 0, value);
  return medium;
}

vtkSmartPointer<vtkImageData> Without(const char* array)
{
  auto medium = Good();
  medium->GetCellData()->RemoveArray(array);
  return medium;
}

vtkSmartPointer<vtkPolyData> LightsOf(vtkLightRig* rig)
{
  rig->Update();
  auto lights = vtkSmartPointer<vtkPolyData>::New();
  lights->DeepCopy(rig->GetOutput());
  return lights;
}

/// A filter that is wrong in one thing at a time.
class Refusals
{
public:
  explicit Refusals(test::Claims& claims)
    : TheClaims(claims)
    , TheErrors(this->Maps)
  {
    this->Maps->SetSkyColor(1.0, 1.0, 1.0);
    this->Maps->SetInputDataObject(Good());
  }

  vtkLightPropagationMaps* operator->() { return this->Maps; }

  /// @param part  of the one error that is expected
  void Says(const std::string& part)
  {
    this->Maps->Update();
    vtkImageData* output = this->Maps->GetOutput();
    this->TheClaims.That(this->TheErrors.WasOneWith(part), "refused: " + part);
    this->TheClaims.That(output->GetNumberOfCells() == 0 && output->GetCellData()->GetNumberOfArrays() == 0 &&
        output->GetFieldData()->GetNumberOfArrays() == 1 && output->GetFieldData()->HasArray("failed"),
      "the output is empty: " + part);
    auto* convergence = vtkTable::SafeDownCast(this->Maps->GetOutputDataObject(1));
    this->TheClaims.That(convergence && convergence->GetNumberOfRows() == 0, "the table is empty: " + part);
    this->TheClaims.That(this->Maps->GetOrders() == 0, "no orders are reported: " + part);
  }

  void OfMedium(vtkImageData* medium, const std::string& part)
  {
    this->Maps->SetInputDataObject(medium);
    this->Says(part);
    this->Maps->SetInputDataObject(Good());
  }

  void OfLights(vtkPolyData* lights, const std::string& part)
  {
    this->Maps->SetLightsData(lights);
    this->Says(part);
    this->Maps->SetLightsData(nullptr);
  }

  void OfEnvironment(vtkImageData* environment, const std::string& part)
  {
    this->Maps->SetEnvironmentData(environment);
    this->Says(part);
    this->Maps->SetEnvironmentData(nullptr);
  }

  void None(const std::string& claim)
  {
    this->Maps->Update();
    this->TheClaims.That(this->TheErrors.None() && this->Maps->GetOutput()->GetNumberOfCells() == 60, claim);
  }

  bool WasOneWith(const std::string& part) { return this->TheErrors.WasOneWith(part); }

private:
  test::Claims& TheClaims;
  vtkNew<vtkLightPropagationMaps> Maps;
  test::Errors TheErrors;
};

void BadMedium(Refusals& refusals)
{
  refusals.OfMedium(Without("sigma_a"), "no array 'sigma_a'. Its cell arrays: 'sigma_s'; its point arrays: none");
  refusals.OfMedium(Without("sigma_s"), "no array 'sigma_s'");
  refusals.OfMedium(With("sigma_a", 0, NotANumber), "sigma_a is nan in voxel (0, 0, 0)");
  refusals.OfMedium(With("sigma_s", 16, Infinite), "sigma_s is inf in voxel (1, 1, 1)");
  refusals.OfMedium(With("sigma_s", 59, -0.5), "in voxel (2, 3, 4)");
  auto medium = Good();
  test::AddCells(medium, "emission", -1.0);
  refusals.OfMedium(medium, "emission is -1");
  medium = Good();
  test::AddCells(medium, "sigma_a", 1.0, 2);
  refusals.OfMedium(medium, "'sigma_a' has 2 components; it must have 1 or 3");
  medium = Good();
  medium->GetCellData()->GetArray("sigma_a")->Resize(7);
  refusals.OfMedium(medium, "'sigma_a' has 7 values where the dataset has 60");
  medium = Without("sigma_a");
  vtkNew<vtkStringArray> words;
  words->SetName("sigma_a");
  words->SetNumberOfValues(60);
  medium->GetCellData()->AddArray(words);
  refusals.OfMedium(medium, "'sigma_a' is text");
}

void BadGrid(Refusals& refusals)
{
  refusals.OfMedium(vtkSmartPointer<vtkImageData>::New(), "is empty");
  refusals.OfMedium(test::MakeMedium({ { 3, 0, 3 } }, 0.5, 1.0), "single layer of points along y");
  refusals.OfMedium(test::MakeMedium({ { 2, 2, 2 }, { 1.0, 0.0, 1.0 } }, 0.5, 1.0), "spacing 0");
  refusals.OfMedium(test::MakeMedium({ { 2, 2, 2 }, { NotANumber, 1.0, 1.0 } }, 0.5, 1.0), "along x");
  refusals.OfMedium(test::MakeMedium({ { 2, 2, 2 }, { 1.0, 1.0, 1.0 }, { Infinite, 0.0, 0.0 } }, 0.5, 1.0), "origin");
  auto medium = Good();
  medium->SetDirectionMatrix(1, 0.3, 0, 0, 1, 0, 0, 0, 1);
  refusals.OfMedium(medium, "sheared by its direction matrix");
}

void BadMeanCosine(Refusals& refusals)
{
  for (double g : { 1.0, -1.0, NotANumber })
  {
    auto medium = Good();
    test::AddValues<vtkDoubleArray>(medium->GetFieldData(), "g", 1, 1, [=](vtkIdType, int) { return g; });
    refusals.OfMedium(medium, "mean cosine");
  }
  auto medium = Good();
  test::AddValues<vtkDoubleArray>(medium->GetFieldData(), "g", 2, 1, [](vtkIdType, int) { return 0.1; });
  refusals.OfMedium(medium, "'g' has 2 numbers");
}

void BadLights(Refusals& refusals)
{
  vtkNew<vtkLightRig> rig;
  for (const char* array : { "light_type", "power" })
  {
    auto lights = LightsOf(rig);
    lights->GetPointData()->RemoveArray(array);
    refusals.OfLights(lights, "no point array '" + std::string(array) + "'");
  }
  auto lights = LightsOf(rig);
  lights->GetPointData()->RemoveArray("direction");
  refusals.OfLights(lights, "Light 0 has direction (0, 0, 0)");
  lights = LightsOf(rig);
  lights->GetPointData()->GetArray("light_type")->SetComponent(0, 0, 7.0);
  refusals.OfLights(lights, "Light 0 has light_type 7");
  lights = LightsOf(rig);
  lights->GetPointData()->GetArray("power")->SetComponent(0, 1, -2.0);
  refusals.OfLights(lights, "Light 0 has power -2");
  lights = LightsOf(rig);
  test::AddValues<vtkDoubleArray>(lights->GetPointData(), "power", 1, 2, [](vtkIdType, int) { return 1.0; });
  refusals.OfLights(lights, "'power' has 2 components");
}

/// A failure of the filter before has been said there.
void FailedBefore(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  test::Errors rigErrors(rig);
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(Good());
  maps->SetLightsConnection(rig->GetOutputPort());
  rig->AddSpotLight(0, 0, 1, 0, 0, -1, 1, 1, 1, 0);
  for (int update = 0; update < 2; ++update)
  {
    maps->Update();
  }
  claims.That(rigErrors.WasOneWith("angle"), "lights that fail are one error");
  claims.That(errors.None() && maps->GetOutput()->GetNumberOfCells() == 0, "and the solver is empty without a word");
  rig->RemoveAllLights();
  maps->Update();
  claims.That(
    errors.None() && rigErrors.None() && maps->GetOutput()->GetNumberOfCells() == 60, "good lights are solved");

  vtkNew<vtkLightPropagationMaps> second; // behind a medium that fails
  test::Errors secondErrors(second);
  second->SetInputConnection(maps->GetOutputPort());
  maps->SetDirectionsPerFace(24);
  second->Update();
  claims.That(errors.WasOneWith("24") && secondErrors.None() && second->GetOutput()->GetNumberOfCells() == 0,
    "a medium that fails is one error");
}

void BadEnvironment(Refusals& refusals)
{
  const auto environment = [](std::array<int, 3> cells) { return test::MakeImage({ cells }); };
  auto image = environment({ 3, 1, 0 });
  refusals.OfEnvironment(image, "no point array 'radiance'");
  test::AddPoints(image, "radiance", 1.0, 4);
  refusals.OfEnvironment(image, "'radiance' has 4 components");
  test::AddPoints(image, "radiance", 1.0, 3);
  image->GetPointData()->GetArray("radiance")->SetComponent(5, 1, NotANumber);
  refusals.OfEnvironment(image, "pixel (1, 1)");
  image = environment({ 3, 1, 1 });
  test::AddPoints(image, "radiance", 1.0, 3);
  refusals.OfEnvironment(image, "flat");
  refusals.OfEnvironment(vtkSmartPointer<vtkImageData>::New(), "flat");
}

void BadSettings(Refusals& refusals)
{
  refusals->SetDirectionsPerFace(24);
  refusals.Says("24");
  refusals->SetDirectionsPerFace(0);
  refusals.Says("0");
  refusals->SetDirectionsPerFace(4);
  refusals->SetEmissionError(-0.1);
  refusals.Says("EmissionError is -0.1");
  refusals->SetEmissionError(0.02);
  refusals->SetUncollidedDirections(24);
  refusals.Says("UncollidedDirections is 24");
  refusals->SetUncollidedDirections(0);
  refusals->SetMapResolution(0);
  refusals.Says("MapResolution");
  refusals->SetMapResolution(1);
  refusals->SetMaximumOrders(-1);
  refusals.Says("MaximumOrders");
  refusals->SetMaximumOrders(0);
  for (const double tolerance : { 0.0, 0.9e-9, 0.51, 1e300 })
  {
    refusals->SetTolerance(tolerance);
    refusals.Says("; it must be at least 1e-09 and at most 0.5");
  }
  refusals->SetTolerance(1e-4);
  refusals->SetStoredDirections(0);
  refusals.Says("StoredDirections");
  refusals->SetStoredDirections(1);
  refusals->SetSkyColor(1.0, -1.0, 1.0);
  refusals.Says("SkyColor is (1, -1, 1)");
  refusals->SetSkyColor(1.0, 1.0, 1.0);
  refusals->SetFaceRadiance(0.0, 0.0, NotANumber, 0.0, 0.0, 0.0);
  refusals.Says("FaceRadiance is (0, 0, nan, 0, 0, 0)");
  refusals->SetFaceRadiance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  refusals->SetFaceAlbedo(0.0, NotANumber, 0.0, 0.0, 0.0, 0.0);
  refusals.Says("FaceAlbedo is (0, nan, 0, 0, 0, 0)");
  refusals->SetFaceAlbedo(0.0, 0.0, 0.0, -0.1, 0.0, 0.0);
  refusals.Says("FaceAlbedo is (0, 0, 0, -0.1, 0, 0)");
  refusals->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 1.5, 0.0);
  refusals.Says("FaceAlbedo is (0, 0, 0, 0, 1.5, 0)");
  refusals->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 0.5, 0.0);
  refusals->SetScheme(vtkLightPropagationMaps::PUBLISHED);
  refusals.Says("set FaceAlbedo to 0");
  refusals->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  refusals->SetDecomposition(vtkLightPropagationMaps::BLOCKS);
  refusals.Says("(Decomposition: blocks) with Scheme as published");
  refusals->SetDecomposition(vtkLightPropagationMaps::AUTOMATIC_DECOMPOSITION);
  refusals->SetScheme(vtkLightPropagationMaps::CONSERVATIVE);
  refusals->SetEnvironmentAzimuth(Infinite);
  refusals.Says("EnvironmentAzimuth is inf; it must be finite");
  refusals->SetEnvironmentAzimuth(0.0);
  refusals->SetDevice("abacus");
  refusals.Says("abacus");
  refusals->SetDevice("");
}

/// A block, then a gap, then further blocks below another level.
vtkSmartPointer<vtkMultiBlockDataSet> Blocks(vtkDataObject* first, const std::vector<vtkDataObject*>& others = {})
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  vtkNew<vtkMultiBlockDataSet> below;
  blocks->SetBlock(0, first);
  blocks->SetBlock(2, below);
  for (vtkDataObject* other : others)
  {
    below->SetBlock(below->GetNumberOfBlocks(), other);
  }
  return blocks;
}

vtkSmartPointer<vtkPartitionedDataSetCollection> Partitions(vtkDataObject* first, vtkDataObject* second)
{
  auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  vtkNew<vtkPartitionedDataSet> partitions;
  partitions->SetPartition(0, first);
  partitions->SetPartition(1, second);
  collection->SetPartitionedDataSet(0, partitions);
  return collection;
}

/// VTK runs a filter for each block of its input, and the light that comes out is not that of all of them.
void WarnsOfBlocks(test::Claims& claims, vtkAlgorithm* filter)
{
  const std::string name = filter->GetClassName();
  test::Errors errors(filter);
  const auto medium = Good(), other = Good();
  filter->SetInputDataObject(0, Blocks(medium, { other, Good() }));
  filter->Update();
  claims.That(errors.WasOneWith("The input is a vtkMultiBlockDataSet of 3 blocks. Each is lit as if it were alone"),
    name + ": one warning of blocks");
  filter->Update();
  claims.That(errors.None(), name + ": once with each update");
  filter->SetInputDataObject(0, Partitions(medium, other));
  filter->Update();
  claims.That(errors.WasOneWith("vtkPartitionedDataSetCollection of 2 blocks"), name + ": one of partitions");
  filter->SetInputDataObject(0, Blocks(medium));
  filter->Update();
  claims.That(errors.None(), name + ": a block alone needs none");
  filter->SetInputDataObject(0, medium);
  filter->Update();
  claims.That(errors.None(), name + ": nor does an image");
}

void MediumOfBlocks(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  WarnsOfBlocks(claims, vtkNew<vtkLightPropagationMaps>());
  WarnsOfBlocks(claims, vtkNew<vtkDiscreteOrdinates>());
  WarnsOfBlocks(claims, vtkNew<vtkLatticeBoltzmannLighting>());
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetPhotonCount(64);
  emitter->SetLightsConnection(rig->GetOutputPort());
  WarnsOfBlocks(claims, emitter); // and is left with an image
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetPhotonsConnection(emitter->GetOutputPort());
  WarnsOfBlocks(claims, marcher);
}

void LightsOfBlocks(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(Good());
  maps->SetLightsData(Blocks(LightsOf(rig), { LightsOf(rig) }));
  maps->Update();
  claims.That(
    errors.WasOneWith("The input 1 is a vtkMultiBlockDataSet of 2 blocks. The light is computed once for each"),
    "lights in blocks are warned of");
}
}

int TestLightPropagationMapsBadInput(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    Refusals refusals(claims);
    BadMedium(refusals);
    BadGrid(refusals);
    BadMeanCosine(refusals);
    BadLights(refusals);
    BadEnvironment(refusals);
    BadSettings(refusals);
    FailedBefore(claims);
    MediumOfBlocks(claims);
    LightsOfBlocks(claims);
    refusals.None("good input after all the bad is solved");

    refusals->SetSkyColor(0.0, 0.0, 0.0);
    refusals->DefaultSkyOff();
    refusals->Update();
    claims.That(refusals.WasOneWith("Nothing shines"), "the dark is warned of");
    claims.That(test::Deviation(refusals->GetOutput(), "fluence", 0.0) == 0.0, "and dark");
  });
}
