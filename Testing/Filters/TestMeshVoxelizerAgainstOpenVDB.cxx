#include "../Kernels/PlyFile.h"
#include "MediumScene.h"
#include "MeshData.h"

#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkMeshVoxelizer.h"

// Visible, as in Filters/IO/VDB/VDBBytes.h, which says why.
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#pragma GCC visibility pop

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

// CGAL's meshes, voxelised by this project and by OpenVDB's meshToVolume. `./run test` fetches them; without them the
// test is skipped.
namespace
{
using tyndall::TriangleMesh;

std::string FileOf(const std::string& name)
{
  return std::string(TYNDALL_FETCHED_DATA) + "/" + name + ".ply";
}

/// Signed distance from the mesh, in the image's own lengths, of the centres of its voxels.
openvdb::FloatGrid::Ptr DistanceFrom(const TriangleMesh& mesh, vtkImageData* image)
{
  const double edge = image->GetSpacing()[0];
  std::vector<openvdb::Vec3s> points;
  for (const auto& p : mesh.points)
  {
    openvdb::Vec3s index;
    for (int axis = 0; axis < 3; ++axis)
    {
      index[axis] = static_cast<float>((p[axis] - image->GetOrigin()[axis]) / edge - 0.5);
    }
    points.push_back(index);
  }
  std::vector<openvdb::Vec3I> triangles;
  for (const auto& t : mesh.triangles)
  {
    triangles.emplace_back(static_cast<unsigned>(t[0]), static_cast<unsigned>(t[1]), static_cast<unsigned>(t[2]));
  }
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(points, triangles);
  return openvdb::tools::meshToVolume<openvdb::FloatGrid>(
    adapter, *openvdb::math::Transform::createLinearTransform(edge));
}

void AgreesOn(const std::string& name, int size, test::Claims& claims)
{
  const TriangleMesh mesh = ReadPly(FileOf(name));
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(test::ToPolyData(mesh));
  filter->SetSampleDimensions(size, size, size);
  filter->Update();
  const std::string what = name + " at " + std::to_string(size) + ": ";
  if (!claims.That(errors.None(), what + "no errors"))
  {
    return;
  }

  vtkImageData* image = filter->GetOutput();
  auto* occupancy = vtkArrayDownCast<vtkFloatArray>(image->GetCellData()->GetArray("occupancy"));
  const openvdb::FloatGrid::Ptr distance = DistanceFrom(mesh, image);
  auto look = distance->getConstAccessor();
  const double diagonal = std::sqrt(3.0) * image->GetSpacing()[0];
  vtkIdType far = 0, inside = 0, wrong = 0;
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    const int index = static_cast<int>(i);
    const float d = look.getValue({ index % size, index / size % size, index / size / size });
    if (std::abs(d) > diagonal)
    {
      ++far;
      inside += d < 0.0f;
      wrong += occupancy->GetValue(i) != (d < 0.0f ? 1.0f : 0.0f);
    }
  }
  std::cout << what << far << " of " << image->GetNumberOfCells()
            << " voxels are farther than a diagonal from the mesh, " << inside << " of them inside\n";
  claims.That(wrong == 0, what + std::to_string(wrong) + " voxels disagree with OpenVDB");
  claims.That(far > image->GetNumberOfCells() / 2 && inside > image->GetNumberOfCells() / 200,
    what + "there is something to compare");
}

void IsRefused(const std::string& name, const std::string& why, test::Claims& claims)
{
  vtkNew<vtkMeshVoxelizer> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(test::ToPolyData(ReadPly(FileOf(name))));
  filter->Update();
  claims.That(errors.WasOneWith(why), name + " is refused: " + why);
  claims.That(filter->GetOutput()->GetNumberOfCells() == 0, name + " has no output");
}
}

int TestMeshVoxelizerAgainstOpenVDB(int, char*[])
{
  if (!std::ifstream(FileOf("armadillo")))
  {
    std::cerr << FileOf("armadillo") << " is not there; ./run test fetches it.\n";
    return 125;
  }
  openvdb::initialize();
  return test::WithDevice([](test::Claims& claims) {
    for (int size : { 64, 128, 256 })
    {
      AgreesOn("armadillo", size, claims);
      AgreesOn("elephant", size, claims);
    }
    IsRefused("elephant-with-holes", "1353 boundary edges", claims);
    IsRefused("mech-holes-shark", "304 boundary edges", claims);
    IsRefused("lion-head", "36 boundary edges", claims);
  });
}
