// Ranges that filters leave in the information of their arrays are those that VTK would find, to the last bit, and go
// when an array is modified.

#include "Common/ArrayRanges.h"
#include "MediumScene.h"

#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkIntArray.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkPoints.h"
#include "vtkPointSet.h"
#include "vtkRefractionOctree.h"
#include "vtkUnsignedCharArray.h"

#include <limits>
#include <random>

namespace
{
bool KnowsRanges(vtkDataArray* array)
{
  vtkInformation* const information = array->GetInformation();
  return information->Has(vtkDataArray::PER_COMPONENT()) && information->Has(vtkDataArray::PER_FINITE_COMPONENT()) &&
    (array->GetNumberOfComponents() == 1 ||
      (information->Has(vtkDataArray::L2_NORM_RANGE()) && information->Has(vtkDataArray::L2_NORM_FINITE_RANGE())));
}

/// The values alone, of which nothing is known.
vtkSmartPointer<vtkDataArray> FreshCopy(vtkDataArray* array)
{
  auto copy = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
  copy->SetNumberOfComponents(array->GetNumberOfComponents());
  copy->SetNumberOfTuples(array->GetNumberOfTuples());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    copy->SetTuple(i, array->GetTuple(i));
  }
  return copy;
}

void CheckAsVtkFindsThem(test::Claims& claims, vtkDataArray* array, const std::string& what)
{
  claims.That(KnowsRanges(array), "ranges are left in " + what);
  const auto fresh = FreshCopy(array);
  claims.That(!KnowsRanges(fresh), "nothing is known of a fresh copy of " + what);
  for (int c = -1; c < array->GetNumberOfComponents(); ++c)
  {
    double left[2], found[2], leftFinite[2], foundFinite[2];
    array->GetRange(left, c);
    fresh->GetRange(found, c);
    array->GetFiniteRange(leftFinite, c);
    fresh->GetFiniteRange(foundFinite, c);
    claims.That(left[0] == found[0] && left[1] == found[1],
      "the range of component " + std::to_string(c) + " of " + what + " is VTK's");
    claims.That(leftFinite[0] == foundFinite[0] && leftFinite[1] == foundFinite[1],
      "the finite range of component " + std::to_string(c) + " of " + what + " is VTK's");
  }
}

template <class Array>
vtkSmartPointer<Array> RandomArray(vtkIdType tuples, int components, double least, double most, unsigned int seed)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(least, most);
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    array->SetValue(i, static_cast<typename Array::ValueType>(number(random)));
  }
  return array;
}

template <class Array>
void CheckRandom(test::Claims& claims, double least, double most)
{
  for (const int components : { 1, 2, 3, 4, 9, 33, 48 })
  {
    for (const vtkIdType tuples : { 1, 7, 1000, 100003 })
    {
      const auto array =
        RandomArray<Array>(tuples, components, least, most, static_cast<unsigned int>(7 * tuples + components));
      const std::string what = std::to_string(tuples) + " tuples of " + std::to_string(components) + " of " +
        array->GetDataTypeAsString() + " from " + std::to_string(least);
      tyndall::LeaveRanges(array);
      CheckAsVtkFindsThem(claims, array, what);
    }
  }
}

void CheckThatTheyAreUsedAndGo(test::Claims& claims)
{
  const auto array = RandomArray<vtkFloatArray>(1000, 3, -1.0, 1.0, 1);
  tyndall::ArrayRanges untrue;
  untrue.components = { { { 1.0, 2.0 }, { 3.0, 4.0 }, { 5.0, 6.0 } } };
  untrue.norm = { 7.0, 8.0 };
  tyndall::LeaveRanges(untrue, array);
  claims.That(array->GetRange(1)[1] == 4.0 && array->GetFiniteRange(2)[0] == 5.0 && array->GetRange(-1)[0] == 7.0 &&
      array->GetFiniteRange(-1)[1] == 8.0,
    "what is left is what VTK looks at");
  array->SetComponent(500, 1, 9.0);
  array->Modified();
  claims.That(!KnowsRanges(array), "ranges of a modified array are gone");
  claims.That(array->GetRange(1)[1] == 9.0 && array->GetFiniteRange(1)[1] == 9.0 && array->GetRange(-1)[1] >= 9.0,
    "ranges of a modified array are found anew");

  const auto copy = vtkSmartPointer<vtkFloatArray>::New();
  tyndall::LeaveRanges(array);
  copy->DeepCopy(array);
  copy->SetComponent(20, 0, -30.0);
  claims.That(copy->GetRange(0)[0] == -30.0, "a copy that is written to has ranges of its own");
}

void CheckNotFinite(test::Claims& claims)
{
  for (const vtkIdType at : { 0, 17, 250000, 299999 })
  {
    for (const float value : { std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN() })
    {
      const auto array = RandomArray<vtkFloatArray>(100000, 3, -1.0, 1.0, 2);
      array->SetValue(at, value);
      array->SetValue(299999, value);
      tyndall::LeaveRanges(array);
      claims.That(!KnowsRanges(array), "nothing is left where a value is not finite");
      claims.That(tyndall::RangesOf(array->GetPointer(0), 300000, 3).firstNotFinite == static_cast<std::size_t>(at),
        "the first value that is not finite is number " + std::to_string(at));
    }
  }
}

/// All arrays of numbers of an output.
void CheckOutput(test::Claims& claims, vtkAlgorithm* filter, int port)
{
  filter->Update();
  vtkDataObject* const output = filter->GetOutputDataObject(port);
  const std::string of = std::string(" of ") + filter->GetClassName() + ", port " + std::to_string(port);
  int seen = 0;
  for (const int attributes : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkFieldData* const data = output->GetAttributesAsFieldData(attributes);
    for (int i = 0; data && i < data->GetNumberOfArrays(); ++i)
    {
      if (vtkDataArray* const array = data->GetArray(i))
      {
        CheckAsVtkFindsThem(claims, array, "array " + std::string(array->GetName()) + of);
        ++seen;
      }
    }
  }
  if (auto* const points = vtkPointSet::SafeDownCast(output))
  {
    CheckAsVtkFindsThem(claims, points->GetPoints()->GetData(), "points" + of);
  }
  claims.That(seen > 0, "there are arrays" + of);
}

void CheckFilters(test::Claims& claims)
{
  auto image = test::MakeImage({ { 23, 17, 40 }, { 0.5, 1.0, 0.7 } });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  test::AddValues<vtkFloatArray>(
    image->GetCellData(), "density", image->GetNumberOfCells(), 1, [&](vtkIdType, int) { return number(random); });
  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputDataObject(image);
  medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "density");
  tyndall::LeaveRanges(image->GetCellData()->GetArray("density"));
  medium->SetAlbedo(0.9, 0.7, 0.5);
  medium->SetExtinctionScale(0.3);
  medium->Update();
  auto bent = vtkSmartPointer<vtkImageData>::New();
  bent->ShallowCopy(medium->GetOutputDataObject(0));
  test::AddValues<vtkFloatArray>(bent->GetCellData(), "ior", bent->GetNumberOfCells(), 1,
    [](vtkIdType i, int) { return 1.0 + 0.01 * static_cast<double>(i % 4); });
  tyndall::LeaveRanges(bent->GetCellData()->GetArray("ior"));
  vtkNew<vtkLightRig> lamps;
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputConnection(medium->GetOutputPort());
  maps->SetLightsConnection(lamps->GetOutputPort());
  maps->SetMaximumOrders(2);
  vtkNew<vtkRefractionOctree> octree;
  octree->SetInputDataObject(bent);
  vtkNew<vtkPhotonImportance> importance;
  importance->SetInputConnection(octree->GetOutputPort());
  importance->SetLightsConnection(lamps->GetOutputPort());
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(bent);
  emitter->SetLightsConnection(lamps->GetOutputPort());
  emitter->SetImportanceMapConnection(importance->GetOutputPort(0));
  emitter->SetPhotonCount(3000);
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetInputConnection(octree->GetOutputPort());
  marcher->SetPhotonsConnection(emitter->GetOutputPort());
  marcher->SetPhotonCounts(true);
  vtkNew<vtkPhotonReconstruction> reconstruction;
  reconstruction->SetInputConnection(marcher->GetOutputPort());
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputConnection(maps->GetOutputPort());
  caster->SetImageSize(70, 50);
  for (vtkAlgorithm* filter :
    std::initializer_list<vtkAlgorithm*>{ medium, maps, octree, importance, emitter, marcher, reconstruction, caster })
  {
    CheckOutput(claims, filter, 0);
  }
  CheckOutput(claims, importance, 1);
}
}

int TestArrayRanges(int, char*[])
{
  test::Claims claims;
  CheckRandom<vtkFloatArray>(claims, -1.0, 3.0);
  CheckRandom<vtkFloatArray>(claims, 1e30, 3e30);
  CheckRandom<vtkFloatArray>(claims, 5.0, 5.0);
  CheckRandom<vtkDoubleArray>(claims, -1e-3, 3.0);
  CheckRandom<vtkIntArray>(claims, -70.0, 30.0);
  CheckRandom<vtkUnsignedCharArray>(claims, 3.0, 250.0);
  CheckThatTheyAreUsedAndGo(claims);
  CheckNotFinite(claims);
  return test::WithDevice(CheckFilters, claims);
}
