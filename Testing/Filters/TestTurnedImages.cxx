// An image that its direction matrix turns, mirrored or not, is solved in its own axes: where lights, photons,
// environment and camera are turned along, it has the light of the same image that is not turned, bit for bit but for
// the rounding of the turn. Outputs are in the scene: images have the matrix, vectors and photons are turned with it.

#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkMatrix3x3.h"
#include "vtkMediumRayCaster.h"
#include "vtkObjectFactory.h"
#include "vtkParticipatingMedium.h"
#include "vtkPassInputTypeAlgorithm.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRefractionOctree.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
using Vec = std::array<double, 3>;

/// A turn of the scene about the origin, and a shift.
struct Turn
{
  const char* name;
  std::array<double, 9> matrix;
  Vec shift;

  Vec Way(const Vec& v) const
  {
    const auto& m = this->matrix;
    return { m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
      m[6] * v[0] + m[7] * v[1] + m[8] * v[2] };
  }
  Vec Place(const Vec& p) const
  {
    const Vec way = this->Way(p);
    return { way[0] + this->shift[0], way[1] + this->shift[1], way[2] + this->shift[2] };
  }
};

/// About x, then z, in degrees.
Turn TurnOf(const char* name, double aboutX, double aboutZ, bool mirrored, const Vec& shift)
{
  const double degree = std::acos(-1.0) / 180.0;
  const double cx = std::cos(aboutX * degree), sx = std::sin(aboutX * degree);
  const double cz = std::cos(aboutZ * degree), sz = std::sin(aboutZ * degree), x = mirrored ? -1.0 : 1.0;
  return { name, { x * cz, -sz * cx, sz * sx, x * sz, cz * cx, -cz * sx, 0.0, sx, cx }, shift };
}

const Turn Still = TurnOf("not turned", 0.0, 0.0, false, { 0.0, 0.0, 0.0 });
const Turn Rotated = TurnOf("rotated", 34.0, 71.0, false, { 5.0, -3.0, 2.0 });
const Turn Mirrored = TurnOf("mirrored", -52.0, 23.0, true, { -1.0, 4.0, 0.5 });
const Turn AboutUp = TurnOf("turned about z", 0.0, 37.0, false, { 0.0, 0.0, 0.0 });

constexpr Vec Oblong = { 0.5, 0.4, 0.6 }, Cube = { 0.5, 0.5, 0.5 };

vtkSmartPointer<vtkImageData> Fog(const Turn& turn, const Vec& spacing = Oblong)
{
  const auto image = test::MakeImage({ { 6, 5, 4 }, spacing, { 1.0, 2.0, 3.0 }, { 2, -1, 0 } });
  const auto add = [&](const char* name, double mean) {
    test::AddValues<vtkFloatArray>(image->GetCellData(), name, image->GetNumberOfCells(), 1,
      [=](vtkIdType i, int) { return mean * (1.0 + 0.8 * std::sin(1.7 * static_cast<double>(i * i) + mean)); });
  };
  add("sigma_a", 0.2);
  add("sigma_s", 0.9);
  image->SetOrigin(turn.Place({ 1.0, 2.0, 3.0 }).data());
  image->SetDirectionMatrix(turn.matrix.data());
  return image;
}

struct Lamp
{
  double type;
  Vec place, direction, power;
  double width, height, angle;
};

vtkSmartPointer<vtkPolyData> Lights(const std::vector<Lamp>& lamps, const Turn& turn)
{
  auto lights = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Lamp& lamp : lamps)
  {
    points->InsertNextPoint(turn.Place(lamp.place).data());
  }
  lights->SetPoints(points);
  const auto add = [&](const char* name, int components, const test::Values& value) {
    test::AddValues<vtkDoubleArray>(
      lights->GetPointData(), name, static_cast<vtkIdType>(lamps.size()), components, value);
  };
  add("light_type", 1, [&](vtkIdType i, int) { return lamps[i].type; });
  add("direction", 3, [&](vtkIdType i, int c) { return turn.Way(lamps[i].direction)[c]; });
  add("power", 3, [&](vtkIdType i, int c) { return lamps[i].power[c]; });
  add("size", 2, [&](vtkIdType i, int c) { return c == 0 ? lamps[i].width : lamps[i].height; });
  add("angle", 1, [&](vtkIdType i, int) { return lamps[i].angle; });
  return lights;
}

/// A sun, a lamp inside, and a spot outside.
vtkSmartPointer<vtkPolyData> AllLights(const Turn& turn)
{
  return Lights({ { 0.0, { 0.0, 0.0, 0.0 }, { -0.3, 0.5, -0.8 }, { 1.0, 1.0, 1.0 }, 0.0, 0.0, 0.0 },
                  { 1.0, { 3.13, 2.71, 4.07 }, { 0.0, 0.0, 1.0 }, { 2.0, 2.0, 2.0 }, 0.0, 0.0, 0.0 },
                  { 2.0, { 0.2, 2.1, 6.3 }, { 0.7, 0.2, -0.7 }, { 9.0, 9.0, 9.0 }, 0.0, 0.0, 40.0 } },
    turn);
}

vtkSmartPointer<vtkImageData> Copy(vtkAlgorithm* filter, int port = 0)
{
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->DeepCopy(filter->GetOutputDataObject(port));
  return copy;
}

/// That an array has the values of another, turned by threes where it is of vectors: to this part of the largest.
void IsSame(test::Claims& claims, vtkDataArray* found, vtkDataArray* wanted, const Turn& turn, bool vectors,
  const std::string& what, double precision = 1e-6)
{
  if (!claims.That(
        found && wanted && found->GetNumberOfValues() == wanted->GetNumberOfValues() && wanted->GetNumberOfValues() > 0,
        what + " is there"))
  {
    return;
  }
  double largest = 0.0, apart = 0.0;
  for (vtkIdType i = 0; i < wanted->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < wanted->GetNumberOfComponents(); ++c)
    {
      double value = wanted->GetComponent(i, c);
      if (vectors)
      {
        const int first = c / 3 * 3;
        value = turn.Way({ wanted->GetComponent(i, first), wanted->GetComponent(i, first + 1),
          wanted->GetComponent(i, first + 2) })[c % 3];
      }
      largest = std::max(largest, std::abs(value));
      apart = std::max(apart, std::abs(value - found->GetComponent(i, c)));
    }
  }
  claims.That(largest > 0.0 && apart <= precision * largest,
    what + " is that of the image that is not turned; apart by " + std::to_string(apart / largest));
}

/// That an image lies where one that was not turned lies, turned.
void LiesThere(
  test::Claims& claims, vtkImageData* image, vtkImageData* still, const Turn& turn, const std::string& what)
{
  double corners[2][3] = {};
  Vec wanted[2];
  for (int end = 0; end < 2; ++end)
  {
    const vtkIdType last = end * (still->GetNumberOfPoints() - 1);
    still->GetPoint(last, wanted[end].data());
    image->GetPoint(last, corners[end]);
    wanted[end] = turn.Place(wanted[end]);
    for (int axis = 0; axis < 3; ++axis)
    {
      claims.Near(corners[end][axis], wanted[end][axis], 1e-9, what + ", place of a corner");
    }
  }
  claims.That(std::equal(turn.matrix.begin(), turn.matrix.end(), image->GetDirectionMatrix()->GetData()),
    what + " has the direction matrix");
  claims.That(
    std::equal(image->GetExtent(), image->GetExtent() + 6, still->GetExtent()), what + " has the extent of the image");
}

template <class Solver>
vtkSmartPointer<vtkImageData> Solve(test::Claims& claims, vtkImageData* fog, vtkPolyData* lights, const char* name)
{
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(fog);
  solver->SetLightsData(lights);
  solver->SetSkyColor(0.1, 0.1, 0.1);
  solver->SetFaceRadiance(0.2, 0.0, 0.0, 0.0, 0.0, 0.3);
  solver->SetNetFlux(true);
  solver->Update();
  claims.That(errors.None(), std::string("no error of ") + solver->GetClassName() + ", " + name);
  return Copy(solver);
}

template <class Solver>
void SolvesInOwnAxes(test::Claims& claims, const char* name, const Vec& spacing = Oblong)
{
  const auto still = Solve<Solver>(claims, Fog(Still, spacing), AllLights(Still), name);
  for (const Turn& turn : { Rotated, Mirrored })
  {
    const std::string what = std::string(name) + " of the image that is " + turn.name;
    const auto turned = Solve<Solver>(claims, Fog(turn, spacing), AllLights(turn), turn.name);
    const auto same = [&](const char* array, bool vectors) {
      IsSame(claims, turned->GetCellData()->GetArray(array), still->GetCellData()->GetArray(array), turn, vectors,
        what + ", " + array);
    };
    same("fluence", false);
    same("net_flux", true);
    IsSame(claims, turned->GetFieldData()->GetArray("face_power_out"),
      still->GetFieldData()->GetArray("face_power_out"), turn, false, what + ", power by the image's own faces");
    LiesThere(claims, turned, still, turn, what);
  }
}

/// The environment follows: exactly where it can stand so, and a bright pixel is as a sun from there.
vtkSmartPointer<vtkImageData> Environment(int width, const test::Values& value)
{
  const auto image = test::MakeImage({ { width - 1, width / 2 - 1, 0 } });
  test::AddValues<vtkFloatArray>(image->GetPointData(), "radiance", image->GetNumberOfPoints(), 3, value);
  return image;
}

vtkSmartPointer<vtkImageData> LitByEnvironment(
  test::Claims& claims, const Turn& turn, vtkImageData* environment, double azimuth)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(Fog(turn));
  maps->SetEnvironmentData(environment);
  maps->SetEnvironmentAzimuth(azimuth);
  maps->Update();
  claims.That(errors.None(), "no error of maps with an environment");
  return Copy(maps);
}

void EnvironmentStaysInTheScene(test::Claims& claims)
{
  const auto sky = Environment(16, [](vtkIdType i, int) { return 1.0 + 0.9 * std::sin(3.1 * static_cast<double>(i)); });
  const auto still = LitByEnvironment(claims, Still, sky, 0.0);
  const auto turned = LitByEnvironment(claims, AboutUp, sky, 37.0);
  IsSame(claims, turned->GetCellData()->GetArray("fluence"), still->GetCellData()->GetArray("fluence"), AboutUp, false,
    "fluence of an environment");

  constexpr int width = 128, column = 20, row = 45;
  const double pi = std::acos(-1.0), polar = pi * (1.0 - (row + 0.5) / (width / 2)),
               azimuth = 2.0 * pi * (column + 0.5) / width;
  const double pixel = 2.0 * pi / width * 2.0 * std::sin(0.5 * pi / (width / 2)) * std::sin(polar); // sr
  const auto one = Environment(width, [](vtkIdType i, int) { return i == row * width + column ? 100.0 : 0.0; });
  const Vec way = { -std::sin(polar) * std::cos(azimuth), -std::sin(polar) * std::sin(azimuth), -std::cos(polar) };
  for (const Turn& turn : { Rotated, Mirrored })
  {
    vtkNew<vtkLightPropagationMaps> sun;
    sun->SetInputDataObject(Fog(turn));
    const double power = 100.0 * pixel;
    sun->SetLightsData(
      Lights({ { 0.0, { 0.0, 0.0, 0.0 }, way, { power, power, power }, 0.0, 0.0, 0.0 } }, Still)); // in the scene
    sun->Update();
    const auto lit = LitByEnvironment(claims, turn, one, 0.0);
    IsSame(claims, lit->GetCellData()->GetArray("fluence"), sun->GetOutput()->GetCellData()->GetArray("fluence"), turn,
      false, std::string("fluence of a bright pixel, ") + turn.name, 0.05);
  }
}

/// The first edge of a rectangle is horizontal in the scene: a strip shines as the squares that make it up.
void RectanglesLieInTheScene(test::Claims& claims)
{
  const Vec direction = { 0.48, 0.6, -0.64 };
  const double across = std::hypot(direction[0], direction[1]);
  const Vec along = { -direction[1] / across, direction[0] / across, 0.0 };
  const auto light = [&](int parts) {
    constexpr double length = 4.0, width = 0.1;
    std::vector<Lamp> lamps;
    for (int i = 0; i < parts; ++i)
    {
      const double off = ((i + 0.5) / parts - 0.5) * length;
      Vec place = Rotated.Place({ 2.0, 2.0, 4.5 });
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] += off * along[axis] - 2.5 * direction[axis];
      }
      lamps.push_back(
        { 3.0, place, direction, { 10.0 / parts, 10.0 / parts, 10.0 / parts }, length / parts, width, 0.0 });
    }
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputDataObject(Fog(Rotated));
    maps->SetLightsData(Lights(lamps, Still));
    maps->Update();
    return Copy(maps);
  };
  const auto strip = light(1), squares = light(40);
  IsSame(claims, strip->GetCellData()->GetArray("fluence"), squares->GetCellData()->GetArray("fluence"), Still, false,
    "fluence of a strip", 0.03);
}

/// Emitter, octree, marcher, reconstruction, and maps after them.
struct PhotonChain
{
  explicit PhotonChain(test::Claims& claims, const Turn& turn)
  {
    const auto fog = Fog(turn);
    test::AddValues<vtkFloatArray>(fog->GetCellData(), "ior", fog->GetNumberOfCells(), 1,
      [](vtkIdType i, int) { return 1.0 + 0.02 * std::sin(0.3 * static_cast<double>(i)); });
    const auto lights = AllLights(turn);
    test::Errors errors[] = { test::Errors(this->Importance), test::Errors(this->Emitter), test::Errors(this->Marcher),
      test::Errors(this->Reconstruction), test::Errors(this->Maps) };
    this->Importance->SetInputDataObject(fog);
    this->Importance->SetLightsData(lights);
    this->Importance->SetPilotCount(4096);
    this->Emitter->SetInputDataObject(fog);
    this->Emitter->SetLightsData(lights);
    this->Emitter->SetImportanceMapConnection(this->Importance->GetOutputPort());
    this->Emitter->SetPhotonCount(3000);
    this->Octree->SetInputDataObject(fog);
    this->Marcher->SetInputDataObject(fog);
    this->Marcher->SetPhotonsConnection(this->Emitter->GetOutputPort());
    this->Marcher->SetOctreeConnection(this->Octree->GetOutputPort());
    this->Marcher->SetPathCount(5);
    this->Reconstruction->SetInputConnection(this->Marcher->GetOutputPort());
    const auto straight = Fog(turn); // maps know of no index
    this->Maps->SetInputDataObject(straight);
    this->Maps->SetUncollidedLightConnection(this->Reconstruction->GetOutputPort());
    test::Errors ofOctree(this->Octree);
    this->Maps->Update();
    const bool isTurned = std::string(turn.name) != Still.name;
    claims.That(isTurned ? ofOctree.WasOneWith("The tree grid") : ofOctree.None(), "a warning of the tree grid");
    for (const test::Errors& each : errors)
    {
      claims.That(each.None(), std::string("no error of photons, ") + turn.name);
    }
  }

  vtkNew<vtkPhotonImportance> Importance;
  vtkNew<vtkPhotonEmitter> Emitter;
  vtkNew<vtkRefractionOctree> Octree;
  vtkNew<vtkPhotonMarcher> Marcher;
  vtkNew<vtkPhotonReconstruction> Reconstruction;
  vtkNew<vtkLightPropagationMaps> Maps;
};

void PhotonsFlyInTheScene(test::Claims& claims)
{
  const PhotonChain still(claims, Still);
  for (const Turn& turn : { Rotated, Mirrored })
  {
    const PhotonChain turned(claims, turn);
    const std::string what = std::string(" of photons, ") + turn.name;
    vtkPolyData *const photons = turned.Emitter->GetOutput(), *const before = still.Emitter->GetOutput();
    claims.That(photons->GetNumberOfPoints() == before->GetNumberOfPoints(), "as many photons");
    double apart = 0.0;
    for (vtkIdType i = 0; i < std::min(photons->GetNumberOfPoints(), before->GetNumberOfPoints()); ++i)
    {
      const Vec wanted = turn.Place({ before->GetPoint(i)[0], before->GetPoint(i)[1], before->GetPoint(i)[2] });
      for (int axis = 0; axis < 3; ++axis)
      {
        apart = std::max(apart, std::abs(wanted[axis] - photons->GetPoint(i)[axis]));
      }
    }
    claims.Near(apart, 0.0, 1e-6, "distance of places" + what);
    IsSame(claims, photons->GetPointData()->GetArray("direction"), before->GetPointData()->GetArray("direction"), turn,
      true, "direction" + what, 1e-5);
    vtkImageData *const light = turned.Marcher->GetOutput(), *const of = still.Marcher->GetOutput();
    IsSame(claims, light->GetCellData()->GetArray("fluence"), of->GetCellData()->GetArray("fluence"), turn, false,
      "fluence" + what, 1e-5);
    IsSame(claims, light->GetCellData()->GetArray("mean_direction"), of->GetCellData()->GetArray("mean_direction"),
      turn, true, "mean_direction" + what, 1e-5);
    auto* const paths = vtkPolyData::SafeDownCast(turned.Marcher->GetOutputDataObject(1));
    auto* const pathsBefore = vtkPolyData::SafeDownCast(still.Marcher->GetOutputDataObject(1));
    const Vec end =
      turn.Place({ pathsBefore->GetPoint(1)[0], pathsBefore->GetPoint(1)[1], pathsBefore->GetPoint(1)[2] });
    claims.Near(paths->GetPoint(1)[0], end[0], 1e-4, "a corner of a path");
    LiesThere(claims, light, of, turn, "light" + what);
    LiesThere(claims, vtkImageData::SafeDownCast(turned.Octree->GetOutputDataObject(0)),
      vtkImageData::SafeDownCast(still.Octree->GetOutputDataObject(0)), turn, "an octree");
    LiesThere(claims, vtkImageData::SafeDownCast(turned.Importance->GetOutputDataObject(1)),
      vtkImageData::SafeDownCast(still.Importance->GetOutputDataObject(1)), turn, "pilot light");
    IsSame(claims, turned.Reconstruction->GetOutput()->GetCellData()->GetArray("mean_direction"),
      still.Reconstruction->GetOutput()->GetCellData()->GetArray("mean_direction"), turn, true,
      "reconstructed mean_direction" + what, 1e-4);
    IsSame(claims, turned.Maps->GetOutput()->GetCellData()->GetArray("fluence"),
      still.Maps->GetOutput()->GetCellData()->GetArray("fluence"), turn, false, "light of maps" + what, 1e-5);
  }
}

/// A picture from a camera that is turned along, of a mirrored scene with left and right exchanged.
void PicturesFollow(test::Claims& claims)
{
  constexpr int width = 24, height = 18;
  const auto picture = [&](const Turn& turn) {
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputDataObject(Fog(turn));
    maps->SetLightsData(AllLights(turn));
    vtkNew<vtkMediumRayCaster> caster;
    test::Errors errors(caster);
    caster->SetInputConnection(maps->GetOutputPort());
    caster->SetLightsData(AllLights(turn));
    caster->SetShadowRays(true);
    caster->SetImageSize(width, height);
    caster->SetCameraPosition(turn.Place({ 9.0, -6.0, 7.0 }).data());
    caster->SetCameraFocalPoint(turn.Place({ 3.5, 2.5, 4.0 }).data());
    caster->SetCameraViewUp(turn.Way({ 0.1, 0.2, 1.0 }).data());
    caster->Update();
    claims.That(errors.None(), std::string("no error of pictures, ") + turn.name);
    const auto made = Copy(caster);
    claims.That(made->GetDirectionMatrix()->IsIdentity(), "a picture is not turned itself");
    return made;
  };
  const auto still = picture(Still);
  for (const Turn& turn : { Rotated, Mirrored })
  {
    const auto turned = picture(turn);
    vtkDataArray *const found = turned->GetPointData()->GetArray("radiance"),
                        *const wanted = still->GetPointData()->GetArray("radiance");
    const auto exchanged = vtkSmartPointer<vtkDataArray>::Take(found->NewInstance());
    exchanged->DeepCopy(found);
    for (vtkIdType i = 0; i < found->GetNumberOfTuples() && turn.name == Mirrored.name; ++i)
    {
      exchanged->SetTuple(i, i / width * width + width - 1 - i % width, found);
    }
    IsSame(claims, exchanged, wanted, turn, false, std::string("radiance, ") + turn.name, 2e-5);
  }
}

/// What filters keep from one update to the next is of one matrix.
void AnotherMatrixIsSeen(test::Claims& claims)
{
  const auto sun = Lights({ { 0.0, { 0.0, 0.0, 0.0 }, { 0.3, 0.2, -0.9 }, { 1.0, 1.0, 1.0 }, 0.0, 0.0, 0.0 } }, Still);
  const auto fog = Fog(Rotated);
  vtkNew<vtkLightPropagationMaps> maps, anew;
  vtkNew<vtkMediumRayCaster> caster;
  maps->SetInputDataObject(fog);
  maps->SetLightsData(sun);
  maps->Update();
  vtkNew<vtkImageData> other;
  other->ShallowCopy(fog);
  other->SetDirectionMatrix(Mirrored.matrix.data());
  maps->SetInputDataObject(other);
  maps->Update();
  anew->SetInputDataObject(other);
  anew->SetLightsData(sun);
  anew->Update();
  IsSame(claims, maps->GetOutput()->GetCellData()->GetArray("fluence"),
    anew->GetOutput()->GetCellData()->GetArray("fluence"), Still, false, "light after another matrix", 0.0);
}

/// Points, negative spacings, media and maps step by step.
void OtherImagesAreTurned(test::Claims& claims)
{
  const auto lit = [&](vtkImageData* fog, const Turn& turn) {
    return Solve<vtkLightPropagationMaps>(claims, fog, AllLights(turn), "another image");
  };
  const auto still = lit(Fog(Still), Still);
  vtkDataArray* const wanted = still->GetCellData()->GetArray("fluence");

  const auto down = Fog(Rotated); // an axis by a spacing below 0, and the matrix the other way
  std::array<double, 9> matrix = Rotated.matrix;
  for (int row = 0; row < 3; ++row)
  {
    matrix[3 * row + 1] *= -1.0;
  }
  down->SetSpacing(0.5, -0.4, 0.6);
  down->SetDirectionMatrix(matrix.data());
  const auto ofDown = lit(down, Rotated);
  IsSame(claims, ofDown->GetCellData()->GetArray("fluence"), wanted, Rotated, false, "a spacing below 0");
  LiesThere(claims, ofDown, still, Rotated, "light of a spacing below 0");

  const auto points = test::MakeImage({ { 5, 4, 3 }, { 0.5, 0.4, 0.6 }, {}, { 2, -1, 0 } }); // in the voxels' middles
  points->SetDirectionMatrix(Rotated.matrix.data());
  points->SetOrigin(Rotated.Place({ 1.25, 2.2, 3.3 }).data());
  points->GetPointData()->ShallowCopy(Fog(Still)->GetCellData());
  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputDataObject(points);
  medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "sigma_a");
  medium->Update();
  LiesThere(claims, medium->GetOutput(), still, Rotated, "a medium around points");
  const auto ofPoints = lit(points, Rotated);
  IsSame(claims, ofPoints->GetCellData()->GetArray("fluence"), wanted, Rotated, false, "voxels around points");
  LiesThere(claims, ofPoints, still, Rotated, "light around points");

  vtkNew<vtkLPMPropagate> propagate;
  vtkNew<vtkLPMCollect> collect;
  vtkSmartPointer<vtkImageData> steps[2];
  for (const bool isTurned : { false, true })
  {
    const Turn& turn = isTurned ? Rotated : Still;
    propagate->SetInputDataObject(Fog(turn));
    propagate->SetLightsData(AllLights(turn));
    collect->SetInputConnection(propagate->GetOutputPort());
    test::Errors errors(collect);
    collect->Update();
    claims.That(errors.None(), "no error of LPMCollect");
    steps[isTurned] = Copy(collect);
  }
  IsSame(claims, steps[1]->GetCellData()->GetArray("fluence"), steps[0]->GetCellData()->GetArray("fluence"), Rotated,
    false, "light of one step");
  LiesThere(claims, steps[1], steps[0], Rotated, "light of one step");
}

/// As most filters of VTK do, this hands on the matrix in the image alone, not in what it tells of the image.
class Through : public vtkPassInputTypeAlgorithm
{
public:
  static Through* New();
  vtkTypeMacro(Through, vtkPassInputTypeAlgorithm);

protected:
  int RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override
  {
    vtkDataObject::GetData(outputs, 0)->ShallowCopy(vtkDataObject::GetData(inputs[0], 0));
    return 1;
  }
};
vtkStandardNewMacro(Through);

/// Pieces over ranks and writers are asked for by what is told beforehand.
void ExtentsAreToldBehindOtherFilters(test::Claims& claims)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const Turn turns[] = { { "axes exchanged", { 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0 }, {} },
    { "two axes down", { -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0 }, {} } };
  for (const Turn& turn : turns)
  {
    vtkNew<Through> through, again;
    through->SetInputDataObject(Fog(turn));
    again->SetInputConnection(through->GetOutputPort());
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputConnection(again->GetOutputPort());
    maps->SetSkyColor(1.0, 1.0, 1.0);
    test::Errors errors(maps);
    maps->UpdateInformation();
    std::array<int, 6> told, made;
    maps->GetOutputInformation(0)->Get(Pipeline::WHOLE_EXTENT(), told.data());
    maps->Update();
    maps->GetOutput()->GetExtent(made.data());
    claims.That(errors.None() && told == made && maps->GetOutput()->GetNumberOfCells() == 120,
      std::string("the extent is told as it will be, ") + turn.name);
    maps->UpdatePiece(1, 2, 0);
    claims.That(errors.None() && maps->GetOutput()->GetNumberOfCells() == 60, std::string("half of it, ") + turn.name);
  }
}

void OthersAreRefused(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  const auto sheared = Fog(Still);
  const double shear[9] = { 1.0, 0.2, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 };
  sheared->SetDirectionMatrix(shear);
  test::Errors errors(maps);
  maps->SetInputDataObject(sheared);
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->Update();
  claims.That(errors.WasOneWith("Resample To Image"), "a sheared image is refused");

  const auto other = Fog(Still);
  test::AddCells(other, "fluence_direct", 1.0);
  maps->SetInputDataObject(Fog(Rotated));
  maps->SetUncollidedLightData(other);
  maps->Update();
  claims.That(errors.WasOneWith("turned otherwise"), "light of an image that is turned otherwise is refused");
}
}

int TestTurnedImages(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    SolvesInOwnAxes<vtkLightPropagationMaps>(claims, "maps");
    SolvesInOwnAxes<vtkDiscreteOrdinates>(claims, "ordinates");
    SolvesInOwnAxes<vtkLatticeBoltzmannLighting>(claims, "lattice", Cube);
    EnvironmentStaysInTheScene(claims);
    RectanglesLieInTheScene(claims);
    PhotonsFlyInTheScene(claims);
    PicturesFollow(claims);
    AnotherMatrixIsSeen(claims);
    OtherImagesAreTurned(claims);
    ExtentsAreToldBehindOtherFilters(claims);
    OthersAreRefused(claims);
  });
}
