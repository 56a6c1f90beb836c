#include "MediumScene.h"
#include "MeshData.h"
#include "Numerics/NumberText.h"

#include "vtkCubeSource.h"
#include "vtkMeshVoxelizer.h"
#include "vtkSphereSource.h"
#include "vtkStringArray.h"
#include "vtkStripper.h"

#include <cmath>
#include <limits>

namespace
{
vtkSmartPointer<vtkPolyData> Ball(double x, double radius)
{
  return test::ToPolyData(shapes::Sphere({ x, 0.0, 0.0 }, radius, 4));
}

vtkDataArray* Cells(vtkMeshVoxelizer* filter, const char* name)
{
  return filter->GetOutput()->GetCellData()->GetArray(name);
}

/// Of the voxel in which a place lies.
double At(vtkMeshVoxelizer* filter, const char* name, double x, double y, double z, int component = 0)
{
  int index[3];
  double within[3];
  const double place[3] = { x, y, z };
  vtkImageData* image = filter->GetOutput();
  vtkDataArray* array = Cells(filter, name);
  return array && image->ComputeStructuredCoordinates(place, index, within)
    ? array->GetComponent(image->ComputeCellId(index), component)
    : std::numeric_limits<double>::quiet_NaN();
}

std::string LeftOut(vtkMeshVoxelizer* filter)
{
  auto* fact = vtkArrayDownCast<vtkStringArray>(filter->GetOutput()->GetFieldData()->GetAbstractArray("left_out"));
  return fact && fact->GetNumberOfValues() > 0 ? fact->GetValue(0) : "";
}

void GlassBallInFog(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ball(2.0, 1.0));
  filter->SetSampleDimensions(40, 40, 30);
  filter->SetInsideAbsorption(0.0, 0.1, 0.2);
  filter->Update();
  claims.That(errors.None(), "a ball is taken");
  vtkImageData* image = filter->GetOutput();
  claims.That(image->GetNumberOfCells() == 40 * 40 * 30, "SampleDimensions are voxels");
  claims.Near(image->GetSpacing()[0], image->GetSpacing()[2], 0.0, "edge of a cubic voxel");
  claims.Near(image->GetCenter()[0], 2.0, 1e-6, "centre of the box");
  claims.Near(filter->GetOccupiedVolume(), 4.0 / 3.0 * vtkMath::Pi(), 0.03, "OccupiedVolume");
  claims.That(
    Cells(filter, "sigma_s")->GetNumberOfComponents() == 3, "one material with colour makes three components");
  claims.Near(At(filter, "occupancy", 2, 0, 0), 1.0, 0.0, "occupancy inside");
  claims.Near(At(filter, "ior", 2, 0, 0), 1.5, 1e-6, "n inside");
  claims.Near(At(filter, "sigma_a", 2, 0, 0, 2), 0.2, 1e-6, "blue sigma_a inside");
  claims.Near(At(filter, "sigma_s", 2, 0, 0), 0.0, 0.0, "sigma_s inside");
  claims.Near(At(filter, "ior", 0.1, -1.9, 1.4), 1.0, 0.0, "n outside");
  const double suiting = 0.5 / (image->GetBounds()[1] - image->GetBounds()[0]);
  claims.Near(At(filter, "sigma_s", 0.1, -1.9, 1.4), suiting, 1e-6 * suiting, "sigma_s outside");
  claims.That(At(filter, "ior_gradient", 1.0, 0, 0) > 1.0 && At(filter, "ior_gradient", 3.0, 0, 0) < -1.0,
    "n grows into the ball");
  claims.That(image->GetCellData()->GetScalars() == Cells(filter, "occupancy"), "occupancy is the active array");
  claims.That(LeftOut(filter).empty(), "nothing is left out");
  claims.That(filter->GetSeconds() > 0.0 && !std::string(filter->GetDeviceName()).empty(), "the panel has its results");
}

void MaterialsKeepTheirMeanCosines(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ball(0.0, 1.0));
  filter->SetSampleDimensions(16, 16, 16);
  filter->SetInsideScattering(0.5, 0.5, 0.5);
  filter->SetInsideMeanCosine(0.2);
  filter->SetOutsideMeanCosine(0.9);
  filter->Update();
  vtkFieldData* facts = filter->GetOutput()->GetFieldData();
  claims.That(errors.None() && !facts->HasArray("g") && facts->HasArray("phase_function"), "g is that of the voxel");
  claims.Near(At(filter, "g", 0.0, 0.0, 0.0), 0.2, 1e-7, "g inside");
  claims.Near(At(filter, "g", -1.2, -1.2, -1.2), 0.9, 1e-7, "g outside");
  claims.Near(At(filter, "sigma_s", 0.0, 0.0, 0.0), 0.5, 1e-7, "sigma_s inside is as it was given");
  filter->SetInsideMeanCosine(0.9);
  filter->Update();
  claims.That(!Cells(filter, "g") && facts->GetArray("g") && facts->GetArray("g")->GetTuple1(0) == 0.9,
    "one g of all materials is field data");
}

void UntouchedTheFogSuitsTheMesh(test::Claims& claims)
{
  const auto voxelize = [](vtkMeshVoxelizer* filter, double size) {
    filter->SetInputDataObject(Ball(0.0, size));
    filter->SetSampleDimensions(16, 16, 16);
    filter->Update();
    const double* bounds = filter->GetOutput()->GetBounds();
    return bounds[1] - bounds[0];
  };
  for (double size : { 0.005, 1.0, 75.0 })
  {
    vtkNew<vtkMeshVoxelizer> filter;
    const double edge = voxelize(filter, size);
    claims.Near(filter->GetUsedOutsideScattering()[1] * edge, 0.5, 1e-9, "optical length of the box");
    filter->SetIndexNoise(0.2); // of features that suit the mesh: it must vary within it
    voxelize(filter, size);
    const double step = edge / 16.0;
    claims.That(std::abs(At(filter, "ior", 0.5 * step, 0.5 * step, 0.5 * step) -
                  At(filter, "ior", 2.5 * step, 1.5 * step, 0.5 * step)) > 0.005,
      "noise shows");
  }
  vtkNew<vtkMeshVoxelizer> clear;
  clear->SetOutsideScattering(0.0, 0.0, 0.0);
  voxelize(clear, 1.0);
  claims.Near(clear->GetUsedOutsideScattering()[0], 0.0, 0.0, "clear air");
  clear->SetOutsideScattering(0.0, -1.0, 0.0);
  test::Errors errors(clear);
  clear->Update();
  claims.That(errors.WasOneWith("scatter"), "one channel below 0 is refused");
}

void ModelBoundsAreTheBox(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ball(0.0, 1.0));
  filter->SetSampleDimensions(10, 20, 30);
  filter->SetModelBounds(0.0, 2.0, -2.0, 2.0, -3.0, 3.0);
  filter->Update();
  double bounds[6];
  filter->GetOutput()->GetBounds(bounds);
  const double expected[6] = { 0.0, 2.0, -2.0, 2.0, -3.0, 3.0 };
  for (int i = 0; i < 6; ++i)
  {
    claims.Near(bounds[i], expected[i], 1e-12, "bounds of the box");
  }
  claims.Near(filter->GetOccupiedVolume(), 2.0 / 3.0 * vtkMath::Pi(), 0.02, "half of a ball");
  claims.That(errors.None(), "a mesh may stick out");
}

void AnyPolyDataWillDo(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetSampleDimensions(32, 32, 32);

  vtkNew<vtkCubeSource> cube; // quadrilaterals, each face with points of its own
  cube->SetXLength(2.0);
  filter->SetInputConnection(cube->GetOutputPort());
  filter->Update();
  claims.Near(filter->GetOccupiedVolume(), 2.0, 0.02, "volume of a cube of quadrilaterals");

  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(60);
  vtkNew<vtkStripper> strips;
  strips->SetInputConnection(sphere->GetOutputPort());
  filter->SetInputConnection(strips->GetOutputPort());
  filter->Update();
  claims.Near(filter->GetOccupiedVolume(), vtkMath::Pi() / 6.0, 0.005, "volume of a ball of strips");

  // Vertices and lines are no part of a solid; their cell data must not be taken for that of triangles.
  const auto mixed = Ball(0.0, 1.0);
  const vtkIdType some[2] = { 0, 1 };
  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell(1, some);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(2, some);
  mixed->SetVerts(vertices);
  mixed->SetLines(lines);
  test::AddValues<vtkFloatArray>(mixed->GetCellData(), "material_id", mixed->GetNumberOfCells(), 1,
    [](vtkIdType cell, int) { return cell < 2 ? 7.0 : 1.0; });
  filter->SetInputDataObject(mixed);
  filter->AddMaterial(1, 1.25, 0, 0, 0, 0, 0, 0, 0);
  filter->Update();
  claims.Near(At(filter, "ior", 0, 0, 0), 1.25, 1e-6, "n of material 1");
  claims.That(errors.None(), "polygons, strips, vertices and lines are taken");
}

void LaterMeshesWin(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetSampleDimensions(48, 48, 48);
  filter->SetFilterSize(1);
  filter->AddInputDataObject(0, Ball(0.0, 1.0));
  filter->AddInputDataObject(0, Ball(0.3, 0.5));
  filter->AddMaterial(1, 1.33, 1, 2, 3, 0, 0, 0, 0);
  filter->Update();
  claims.Near(At(filter, "ior", 0.3, 0, 0), 1.33, 1e-6, "n of the inner ball");
  claims.Near(At(filter, "sigma_s", 0.3, 0, 0, 2), 3.0, 1e-6, "blue sigma_s of the inner ball");
  claims.Near(At(filter, "ior", -0.5, 0, 0), 1.5, 1e-6, "n of the outer ball");
  claims.Near(filter->GetOccupiedVolume(), 4.0 / 3.0 * vtkMath::Pi(), 0.05, "the inner ball is no more volume");

  // The other way round the large one covers the small one.
  filter->RemoveAllInputConnections(0);
  filter->AddInputDataObject(0, Ball(0.3, 0.5));
  filter->AddInputDataObject(0, Ball(0.0, 1.0));
  filter->Update();
  claims.Near(At(filter, "ior", 0.3, 0, 0), 1.33, 1e-6, "n of the second mesh");
  claims.Near(At(filter, "ior", -0.5, 0, 0), 1.33, 1e-6, "n of the second mesh everywhere");

  // Both in one mesh, with numbers.
  const tyndall::TriangleMesh outer = shapes::Sphere({ 0, 0, 0 }, 1.0, 4);
  const auto both = test::ToPolyData(shapes::Collective(outer, shapes::Sphere({ 0.3, 0, 0 }, 0.5, 4)));
  const auto first = static_cast<vtkIdType>(outer.triangles.size());
  test::AddValues<vtkFloatArray>(both->GetCellData(), "kind", both->GetNumberOfCells(), 1,
    [&](vtkIdType cell, int) { return cell < first ? 4.0 : 1.0; });
  filter->RemoveAllInputConnections(0);
  filter->SetInputDataObject(both);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "kind");
  filter->Update();
  claims.Near(At(filter, "ior", 0.3, 0, 0), 1.5, 1e-6, "n of the higher number");
  claims.That(errors.None(), "several meshes are taken");
}

/// The ball with a number in every cell, of which one is not 1.
vtkSmartPointer<vtkPolyData> NumberedBall(const char* array, double odd)
{
  const auto ball = Ball(0.0, 1.0);
  test::AddValues<vtkDoubleArray>(ball->GetCellData(), array, ball->GetNumberOfCells(), 1,
    [&](vtkIdType cell, int) { return cell == 5 ? odd : 1.0; });
  return ball;
}

void NumbersOfMaterialsAreWhole(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetSampleDimensions(16, 16, 16);
  const auto refused = [&](vtkPolyData* mesh, const std::string& part) {
    filter->SetInputDataObject(mesh);
    filter->Update();
    claims.That(errors.WasOneWith(part), "refused: " + part);
    claims.That(filter->GetOutput()->GetNumberOfCells() == 0, "the output is empty after an error");
  };
  for (double odd : { 1.4, 1e18, -1e18, std::numeric_limits<double>::quiet_NaN() })
  {
    refused(NumberedBall("material_id", odd),
      "The mesh's cell array 'material_id' in cell 5 is " + tyndall::Text("%.15g", odd));
  }
  const auto text = Ball(0.0, 1.0);
  vtkNew<vtkStringArray> names;
  names->SetName("material_id");
  names->SetNumberOfValues(text->GetNumberOfCells());
  text->GetCellData()->AddArray(names);
  refused(text, "The mesh's cell array 'material_id' is text");
  const auto tooShort = Ball(0.0, 1.0);
  test::AddValues<vtkDoubleArray>(tooShort->GetCellData(), "material_id", 3, 1, [](vtkIdType, int) { return 1.0; });
  refused(tooShort, "Array 'material_id' has 3 values");

  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "foo");
  refused(NumberedBall("kind", 1.0), "no cell array 'foo'");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "kind");
  refused(NumberedBall("kind", 1.0), "'kind' of points");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "kind");
  filter->RemoveAllInputConnections(0);
  filter->AddInputDataObject(0, NumberedBall("kind", 1.0));
  filter->AddInputDataObject(0, Ball(0.3, 0.5));
  filter->Update();
  claims.That(errors.None(), "one of several meshes has the array");
}

void MaterialsAreChecked(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  filter->SetFilterSize(1);
  test::Errors errors(filter);
  filter->SetInputDataObject(Ball(0.0, 1.0));
  filter->SetSampleDimensions(16, 16, 16);
  const auto refused = [&](double number, double n, double g, const char* part) {
    filter->RemoveAllMaterials();
    filter->AddMaterial(number, n, 0, 0, 0, 0, 0, 0, g);
    filter->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
  };
  refused(7, -1.0, 0.0, "Material 7 has the refractive index -1");
  refused(7, 1.5, 1.0, "Material 7 has the mean cosine 1");
  refused(0.5, 1.5, 0.0, "The number of a material is 0.5");
  refused(std::numeric_limits<double>::quiet_NaN(), 1.5, 0.0, "The number of a material is nan");
  refused(1e12, 1.5, 0.0, "The number of a material is 1000000000000");
  filter->RemoveAllMaterials();
  for (double number : { 0.0, 1.25, 0.0, 0.0 })
  {
    filter->AddMaterialNumber(number);
  }
  filter->Update();
  claims.That(errors.WasOneWith("The last material has 4 numbers"), "a row that is not whole is refused");
  for (int i = 0; i < 5; ++i)
  {
    filter->AddMaterialNumber(0.0);
  }
  filter->Update();
  claims.That(errors.None() && filter->GetNumberOfMaterials() == 1, "one that is whole is taken");
  claims.Near(At(filter, "ior", 0, 0, 0), 1.25, 1e-6, "n of it");
}

void ConstantIndexIsLeftOut(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  filter->SetInputDataObject(Ball(0.0, 1.0));
  filter->SetSampleDimensions(16, 16, 16);
  filter->SetInsideIndex(1.0);
  filter->Update();
  claims.That(Cells(filter, "occupancy") && !Cells(filter, "ior_gradient"), "the gradient is left out");
  claims.That(
    Cells(filter, "ior") && Cells(filter, "ior")->GetRange()[0] == 1.0 && Cells(filter, "ior")->GetRange()[1] == 1.0,
    "n is told all the same");
  claims.That(LeftOut(filter).find("ior_gradient") != std::string::npos &&
      std::string(filter->GetLeftOut()).find("ior_gradient") != std::string::npos,
    "left_out says so");
  filter->LeaveOutOff();
  filter->Update();
  vtkDataArray* const gradient = Cells(filter, "ior_gradient");
  claims.That(gradient && gradient->GetRange(-1)[1] < 1e-5, "a gradient of 0, where all is to be computed");
  claims.Near(Cells(filter, "ior")->GetRange()[0], 1.0, 1e-6, "the lowest n, smoothed");
  claims.Near(Cells(filter, "ior")->GetRange()[1], 1.0, 1e-6, "the highest n, smoothed");
  claims.That(LeftOut(filter).empty(), "and nothing is left out");
}

/// What is asked for, by an extent or a piece, has the values of the whole, and no more of it is made.
void AskedForPartsAreMadeAlone(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ball(0.0, 1.0));
  filter->SetSampleDimensions(20, 16, 18);
  filter->SetIndexNoise(0.1);
  filter->Update();
  vtkNew<vtkImageData> whole;
  whole->DeepCopy(filter->GetOutput());
  const auto expect = [&](int cells, const std::string& what) {
    vtkImageData* const part = filter->GetOutput();
    claims.That(errors.None() && part->GetNumberOfCells() == cells, what + " is made alone");
    vtkNew<vtkImageData> wanted;
    wanted->ShallowCopy(whole);
    wanted->Crop(part->GetExtent());
    bool same = part->GetCellData()->HasArray("ior_gradient") != 0;
    for (const char* name : { "occupancy", "ior", "ior_gradient", "sigma_a", "sigma_s" })
    {
      vtkDataArray *const found = part->GetCellData()->GetArray(name),
                          *const there = wanted->GetCellData()->GetArray(name);
      same = same && found && there && found->GetNumberOfValues() == there->GetNumberOfValues();
      for (vtkIdType i = 0; same && i < found->GetNumberOfTuples(); ++i)
      {
        for (int c = 0; same && c < found->GetNumberOfComponents(); ++c)
        {
          same = found->GetComponent(i, c) == there->GetComponent(i, c);
        }
      }
    }
    claims.That(same, what + " has the values of the whole");
  };
  const int extent[6] = { 3, 9, 5, 6, 0, 18 };
  filter->Modified();
  filter->UpdateExtent(extent);
  expect(6 * 1 * 18, "an extent");
  claims.That(filter->GetOccupiedVolume() < 1.0, "OccupiedVolume is that of the part");
  filter->Modified();
  filter->UpdatePiece(1, 4, 0);
  expect(20 * 16 * 18 / 4, "a piece");
}

void BadInputIsOneError(test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetSampleDimensions(16, 16, 16);
  const auto refused = [&](vtkPolyData* mesh, const char* part) {
    filter->SetInputDataObject(mesh);
    filter->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
    claims.That(filter->GetOutput()->GetNumberOfCells() == 0, "the output is empty after an error");
  };
  refused(vtkSmartPointer<vtkPolyData>::New(), "no mesh");
  tyndall::TriangleMesh open = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  open.triangles.pop_back();
  refused(test::ToPolyData(open), "The mesh is open: it has 3 boundary edges");

  const auto refusedSettings = [&](const char* part) { refused(Ball(0.0, 1.0), part); };
  filter->SetModelBounds(0, 1, 2, 2, 0, 1);
  refusedSettings("ModelBounds");
  filter->SetModelBounds(0, 0, 0, 0, 0, 0);
  filter->SetSampleDimensions(16, 0, 16);
  refusedSettings("SampleDimensions is (16, 0, 16)");
  filter->SetSampleDimensions(16, 16, 16);
  filter->SetSupersamplingFactor(17);
  refusedSettings("SupersamplingFactor is 17");
  filter->SetSupersamplingFactor(4);
  filter->SetFilterSize(8);
  refusedSettings("filter is 8 voxels");
  filter->SetFilterSize(9);
  filter->SetInsideIndex(-1.0);
  refusedSettings("InsideIndex is -1");
  filter->SetInsideIndex(1.5);
  filter->SetDevice("no such device");
  refusedSettings("no such device");
  filter->SetDevice("");
  const auto far = Ball(0.0, 1.0);
  const vtkIdType unused = far->GetPoints()->InsertNextPoint(0.0, 0.0, 0.0);
  vtkNew<vtkPoints> shifted; // so that the mesh's own numbers are not those of the triangles' points
  shifted->InsertNextPoint(far->GetPoint(unused));
  for (vtkIdType i = 0; i < unused; ++i)
  {
    shifted->InsertNextPoint(far->GetPoint(i));
  }
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType cell = 0; cell < far->GetNumberOfCells(); ++cell)
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    far->GetCellPoints(cell, count, corners);
    const vtkIdType next[3] = { corners[0] + 1, corners[1] + 1, corners[2] + 1 };
    triangles->InsertNextCell(3, next);
  }
  far->SetPoints(shifted);
  far->SetPolys(triangles);
  for (double wrong : { std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN() })
  {
    shifted->SetPoint(9, wrong, 0.0, 0.0);
    shifted->Modified();
    refused(far, "Point 9 of the mesh is at");
  }

  // A warning, with a result.
  filter->SetInputDataObject(test::ToPolyData(shapes::Inverted(shapes::Sphere({ 0, 0, 0 }, 1.0, 3))));
  filter->Update();
  claims.That(errors.WasOneWith("is inverted"), "an inverted mesh is warned of");
  claims.That(filter->GetOccupiedVolume() > 3.5, "an inverted mesh has its volume");

  filter->SetInputDataObject(Ball(0.0, 1.0));
  filter->Update();
  claims.That(errors.None() && filter->GetOutput()->GetNumberOfCells() == 4096, "good input after bad is taken");
}
}

int TestMeshVoxelizer(int, char*[])
{
  return test::WithDevice([](test::Claims& claims) {
    GlassBallInFog(claims);
    MaterialsKeepTheirMeanCosines(claims);
    UntouchedTheFogSuitsTheMesh(claims);
    ModelBoundsAreTheBox(claims);
    AnyPolyDataWillDo(claims);
    LaterMeshesWin(claims);
    NumbersOfMaterialsAreWhole(claims);
    MaterialsAreChecked(claims);
    ConstantIndexIsLeftOut(claims);
    AskedForPartsAreMadeAlone(claims);
    BadInputIsOneError(claims);
  });
}
