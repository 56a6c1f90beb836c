#include "StressScenes.h"

#include "Reference/SlabReference.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace bench
{
std::size_t StressScene::VoxelCount() const
{
  return static_cast<std::size_t>(this->cells[0]) * this->cells[1] * this->cells[2];
}

std::size_t StressScene::Voxel(int i, int j, int k) const
{
  return (static_cast<std::size_t>(k) * this->cells[1] + j) * this->cells[0] + i;
}

Vector StressScene::Middle() const
{
  Vector middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    middle[axis] = (this->cells[axis] / 2 + 0.5) * this->spacing[axis];
  }
  return middle;
}

float StressScene::At(const std::vector<float>& field, std::size_t voxel, int channel) const
{
  return field.empty() ? 0.0f : field[voxel * this->channels + channel];
}

StressScene Turned(const StressScene& scene, const CubeTurn& turn)
{
  StressScene turned = scene;
  turned.cells = turn.Moved(scene.cells);
  turned.spacing = turn.Moved(scene.spacing);
  turned.periodic = turn.Moved(scene.periodic);
  turned.absorption = turn.Field(scene.absorption, scene.cells, scene.channels);
  turned.scattering = turn.Field(scene.scattering, scene.cells, scene.channels);
  turned.emission = turn.Field(scene.emission, scene.cells, scene.channels);
  turned.index = turn.Field(scene.index, scene.cells);
  for (Lamp& lamp : turned.lamps)
  {
    lamp.along = turn.Direction(lamp.along);
    lamp.at = turn.Position(lamp.at,
      { scene.cells[0] * scene.spacing[0], scene.cells[1] * scene.spacing[1], scene.cells[2] * scene.spacing[2] });
    lamp.width = lamp.width > 0.0 ? lamp.width : 0.5 * scene.spacing[0];
  }
  for (int face = 0; face < 6; ++face)
  {
    turned.faces[turn.Face(face)] = scene.faces[face];
  }
  return turned;
}

StressScene ShoneUpon(StressScene scene, double part)
{
  for (double& radiance : scene.sky)
  {
    radiance *= part;
  }
  for (double& radiance : scene.faces)
  {
    radiance *= part;
  }
  return scene;
}

namespace
{
const double NearlyWhite = 1.0 - 1e-7;

std::string Number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%g", value);
  return text;
}

std::size_t MiddleVoxel(const StressScene& scene)
{
  return scene.Voxel(scene.cells[0] / 2, scene.cells[1] / 2, scene.cells[2] / 2);
}

/// The same medium everywhere.
StressScene Uniform(
  double sigma_a, double sigma_s, std::array<int, 3> cells = { 9, 9, 9 }, Vector spacing = { 1, 1, 1 })
{
  StressScene scene;
  scene.cells = cells;
  scene.spacing = spacing;
  scene.absorption.assign(scene.VoxelCount(), static_cast<float>(sigma_a));
  scene.scattering.assign(scene.VoxelCount(), static_cast<float>(sigma_s));
  return scene;
}

/// (1 - albedo) keeps what float would lose near 1.
StressScene OfAlbedo(double sigma_t, double albedo)
{
  return Uniform((1.0 - albedo) * sigma_t, albedo * sigma_t);
}

/// Two media by turns.
StressScene Checkerboard(double thin, double thick, double albedo)
{
  StressScene scene;
  scene.absorption.resize(scene.VoxelCount());
  scene.scattering.resize(scene.VoxelCount());
  for (int k = 0; k < scene.cells[2]; ++k)
  {
    for (int j = 0; j < scene.cells[1]; ++j)
    {
      for (int i = 0; i < scene.cells[0]; ++i)
      {
        const double sigma = (i + j + k) % 2 == 0 ? thin : thick;
        scene.absorption[scene.Voxel(i, j, k)] = static_cast<float>((1.0 - albedo) * sigma);
        scene.scattering[scene.Voxel(i, j, k)] = static_cast<float>(albedo * sigma);
      }
    }
  }
  return scene;
}

StressCase Named(const std::string& row, const std::string& name, StressScene scene)
{
  StressCase made;
  made.row = row;
  made.name = name;
  made.scene = std::move(scene);
  return made;
}

/// In equilibrium with a sky: radiance is the sky's everywhere.
StressCase Furnace(const std::string& row, const std::string& name, StressScene scene)
{
  scene.emission = scene.absorption;
  scene.sky = { 1.0, 1.0, 1.0 };
  StressCase made = Named(row, name + ", furnace", std::move(scene));
  made.furnace = made.bound = 1.0;
  made.mirrored = { true, true, true };
  return made;
}

/// Lit by a sun along -z.
StressCase Beam(const std::string& row, const std::string& name, StressScene scene)
{
  scene.lamps = { Lamp() };
  StressCase made = Named(row, name + ", beam", std::move(scene));
  made.beam =
    std::all_of(made.scene.scattering.begin(), made.scene.scattering.end(), [](float sigma) { return sigma == 0.0f; });
  made.mirrored = { true, true, false };
  return made;
}

/// A cube with one face that shines. Where nothing is absorbed the six faces together are a furnace, so each gives its
/// middle a sixth.
StressCase OneFace(const std::string& row, const std::string& name, StressScene scene)
{
  scene.faces[4] = 1.0;
  StressCase made = Named(row, name + ", one face", std::move(scene));
  made.bound = 1.0;
  const std::vector<float>& absorption = made.scene.absorption;
  if (std::all_of(absorption.begin(), absorption.end(), [](float sigma) { return sigma == 0.0f; }))
  {
    made.middle = 1.0 / 6.0;
  }
  made.mirrored = { true, true, false };
  return made;
}

/// All that fits a medium with these coefficients.
void AddMedium(
  std::vector<StressCase>& cases, const std::string& row, const std::string& name, const StressScene& scene, bool quick)
{
  cases.push_back(Furnace(row, name, scene));
  cases.back().quick = quick;
  cases.push_back(OneFace(row, name, scene));
  cases.back().quick = quick;
  cases.push_back(Beam(row, name, scene));
}

void AddThicknesses(std::vector<StressCase>& cases)
{
  for (const double albedo : { 0.0, 0.5, NearlyWhite, 1.0 })
  {
    for (int decade = -12; decade <= 12; decade += 3)
    {
      const std::string name =
        "1e" + std::to_string(decade) + ", albedo " + (albedo == NearlyWhite ? "1 - 1e-7" : Number(albedo));
      AddMedium(cases, "sigma_t h", name, OfAlbedo(std::pow(10.0, decade), albedo),
        decade == 6 && (albedo == 0.5 || albedo == 1.0));
    }
  }
}

void AddMeanCosines(std::vector<StressCase>& cases)
{
  for (const double g : { -0.99, -0.95, -0.5, 0.5, 0.95, 0.99 })
  {
    StressScene scene = OfAlbedo(1.0, 0.9);
    scene.g = g;
    StressCase made = Beam("|g| to 0.99", "g " + Number(g), scene);
    made.twin = std::make_shared<StressScene>(made.scene);
    made.twin->g = 0.0;
    for (float& sigma : made.twin->scattering)
    {
      sigma = static_cast<float>(sigma * (1.0 - g));
    }
    made.similarity = true;
    made.quick = g == 0.99;
    cases.push_back(made);
    cases.push_back(Furnace("|g| to 0.99", "g " + Number(g), scene));
  }
}

/// n = `inside` in a ball or in voxels by turns, 1 about them, without any smooth border. Two layers about it are the
/// spline's.
StressScene Glass(double inside, bool checkered)
{
  StressScene scene;
  scene.cells = { 11, 11, 11 };
  scene.absorption.assign(scene.VoxelCount(), 0.05f);
  scene.scattering = scene.absorption;
  scene.index.assign(scene.VoxelCount(), 1.0f);
  for (int k = 2; k < 9; ++k)
  {
    for (int j = 2; j < 9; ++j)
    {
      for (int i = 2; i < 9; ++i)
      {
        const bool glass = checkered ? (i + j + k) % 2 == 0 : std::hypot(i - 5, j - 5, k - 5) < 3.1;
        scene.index[scene.Voxel(i, j, k)] = glass ? static_cast<float>(inside) : 1.0f;
      }
    }
  }
  return scene;
}

void AddIndices(std::vector<StressCase>& cases)
{
  for (const bool checkered : { false, true })
  {
    for (const double n : { 1.0 + 1e-6, 1.5, 4.0 })
    {
      const std::string name = std::string(checkered ? "checkerboard of 1 and " : "ball of ") + Number(n);
      cases.push_back(Beam("n 1 to 4", name, Glass(n, checkered)));
      cases.back().quick = n == 4.0;
      cases.push_back(Furnace("n 1 to 4", name, Glass(n, checkered)));
      cases.back().furnace = 0.0; // for solvers that do not bend light; the viewer's furnace is its own
      cases.back().bound = 17.0;  // n^2
    }
  }
}

void AddCoefficients(std::vector<StressCase>& cases)
{
  const std::string row = "coefficients";
  AddMedium(cases, row, "0", Uniform(0.0, 0.0), true);
  AddMedium(cases, row, "denormal", Uniform(1e-40, 1e-40), false);
  AddMedium(cases, row, "absorption 1e30", Uniform(1e30, 0.0), false);
  AddMedium(cases, row, "scattering 1e30", Uniform(0.0, 1e30), true);
  cases[cases.size() - 3].refusals = { { "maps, given light", "Something is beyond what floats carry" } };
  AddMedium(cases, row, "both 1e30", Uniform(1e30, 1e30), false);
  AddMedium(cases, row, "both 1e36", Uniform(1e36, 1e36), false);
  AddMedium(cases, row, "both 3e38, more than a float together", Uniform(3e38, 3e38), true);
  for (std::size_t i = cases.size() - 3; i < cases.size(); ++i)
  {
    cases[i].refusals = { { "", "sigma_a and sigma_s add up to 6e+38 in voxel (0, 0, 0)" } };
  }
  AddMedium(cases, row, "1e-30 of white", Uniform(1e-30, 1.0), false);
}

void AddContrasts(std::vector<StressCase>& cases)
{
  for (const double albedo : { 0.0, 0.5, NearlyWhite, 1.0 })
  {
    const std::string name = ", albedo " + (albedo == NearlyWhite ? "1 - 1e-7" : Number(albedo));
    AddMedium(cases, "checkerboard 1e8", "1e-4 and 1e4" + name, Checkerboard(1e-4, 1e4, albedo), albedo == 1.0);
    AddMedium(cases, "checkerboard 1e12", "1e-6 and 1e6" + name, Checkerboard(1e-6, 1e6, albedo), albedo == 0.5);
  }
  AddMedium(cases, "checkerboard 1e8", "0 and 1e8, albedo 1", Checkerboard(0.0, 1e8, 1.0), false);
}

/// Mean length of the way from the middle of a cube of edge 1 to its surface, over all directions.
double MeanWayOutOfACube()
{
  const int n = 400;
  double sum = 0.0;
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const double u = (2.0 * i + 1.0) / n - 1.0, v = (2.0 * j + 1.0) / n - 1.0;
      sum += 1.0 / (1.0 + u * u + v * v);
    }
  }
  return 0.5 * 6.0 * sum * (2.0 / n) * (2.0 / n) / (4.0 * std::acos(-1.0));
}

void AddSingleVoxels(std::vector<StressCase>& cases)
{
  for (const double sigma : { 0.0, 1e-6, 1.0, 1e6 })
  {
    StressScene scene = Uniform(0.0, 0.0);
    scene.absorption[MiddleVoxel(scene)] = static_cast<float>(sigma);
    scene.emission.assign(scene.VoxelCount(), 0.0f);
    scene.emission[MiddleVoxel(scene)] = static_cast<float>(std::max(sigma, 1.0));
    StressCase made = Named("hot voxel in vacuum", "sigma_a h " + Number(sigma), scene);
    made.mirrored = { true, true, true };
    made.quick = sigma == 1.0;
    made.bound = sigma >= 1.0 ? 1.0 : made.bound;
    made.pathInBox = sigma == 0.0 ? 9.0 * MeanWayOutOfACube() : 0.0;
    cases.push_back(made);
  }
  for (const double sigma : { 1e3, 1e12, 1e30 })
  {
    StressScene scene = Uniform(0.0, 0.0);
    scene.absorption[MiddleVoxel(scene)] = static_cast<float>(sigma);
    cases.push_back(Beam("opaque voxel in light", "absorbing, sigma_t h " + Number(sigma), scene));
    cases.back().quick = sigma == 1e12;
    cases.push_back(Furnace("opaque voxel in light", "absorbing, sigma_t h " + Number(sigma), scene));
    std::swap(scene.absorption, scene.scattering);
    cases.push_back(Beam("opaque voxel in light", "white, sigma_t h " + Number(sigma), scene));
    if (sigma == 1e30)
    {
      cases.back().refusals = { { "maps", "Its thickest voxel, (4, 4, 4), has optical thickness 1e+30" } };
    }
    cases.push_back(Furnace("opaque voxel in light", "white, sigma_t h " + Number(sigma), scene));
  }
}

void AddLampsInside(std::vector<StressCase>& cases)
{
  const char* const names[] = { "sun", "point", "spot", "rectangle" };
  for (const Lamp::Kind kind : { Lamp::Point, Lamp::Spot, Lamp::Rectangle })
  {
    for (const double sigma : { 1e3, 1e12 })
    {
      for (const bool white : { false, true })
      {
        StressScene scene = Uniform(0.0, 0.0);
        (white ? scene.scattering : scene.absorption)[MiddleVoxel(scene)] = static_cast<float>(sigma);
        Lamp lamp;
        lamp.kind = kind;
        lamp.at = scene.Middle();
        scene.lamps = { lamp };
        StressCase made = Named("light in an opaque voxel",
          std::string(names[kind]) + (white ? ", white " : ", black ") + Number(sigma), scene);
        made.mirrored = { kind == Lamp::Point, kind == Lamp::Point, false };
        made.quick = kind == Lamp::Point && sigma == 1e12;
        if (white && sigma == 1e12)
        {
          made.refusals = { { "maps", "Its thickest voxel, (4, 4, 4), has optical thickness 1e+12" } };
        }
        cases.push_back(made);
      }
    }
  }
}

void Scale(StressScene& scene, double by)
{
  scene = ShoneUpon(scene, by);
  for (Lamp& lamp : scene.lamps)
  {
    for (double& power : lamp.power)
    {
      power *= by;
    }
  }
  for (float& emission : scene.emission)
  {
    emission = static_cast<float>(emission * by);
  }
}

void AddPowers(std::vector<StressCase>& cases)
{
  const StressScene medium = OfAlbedo(0.3, 0.8);
  StressScene sun = medium, sky = medium, lamp = medium, glow = medium, face = medium;
  sun.lamps = { Lamp() };
  sky.sky = { 1.0, 1.0, 1.0 };
  lamp.lamps = { Lamp() };
  lamp.lamps[0].kind = Lamp::Point;
  lamp.lamps[0].at = { 3.3, 4.4, 5.2 };
  glow.emission = glow.absorption;
  face.faces[4] = 1.0;
  const std::pair<const char*, const StressScene*> lit[] = { { "sun", &sun }, { "sky", &sky }, { "lamp", &lamp },
    { "emission", &glow }, { "face", &face } };
  for (const double power : { 1e-36, 1e-30, 1e30, 1e36 })
  {
    for (const auto& [name, scene] : lit)
    {
      StressCase made = Named("power", std::string(name) + " of " + Number(power), *scene);
      made.twin = std::make_shared<StressScene>(made.scene);
      made.scale = power;
      Scale(made.scene, power);
      made.quick = power == 1e30 && scene == &sun;
      if (power == 1e-36) // thousands of photons share it
      {
        const std::string words = "would carry less power than";
        made.refusals = { { "photons", words }, { "rebuilt", words }, { "octree", words } };
      }
      cases.push_back(made);
    }
  }
}

void AddSpacings(std::vector<StressCase>& cases)
{
  for (const double edge : { 1e-9, 1e9 })
  {
    StressScene scene = OfAlbedo(0.3, 0.9);
    scene.lamps = { Lamp() };
    scene.lamps.push_back({ Lamp::Point, { 3.3, 4.4, 5.2 }, {}, { 1.0, 1.0, 1.0 } });
    StressCase made = Named("spacing", "all " + Number(edge), scene);
    made.twin = std::make_shared<StressScene>(scene);
    made.scene.spacing.fill(edge);
    for (double& x : made.scene.lamps[1].at)
    {
      x *= edge;
    }
    for (double& power : made.scene.lamps[1].power)
    {
      power *= edge * edge;
    }
    for (std::vector<float>* field : { &made.scene.absorption, &made.scene.scattering })
    {
      std::transform(
        field->begin(), field->end(), field->begin(), [=](float sigma) { return static_cast<float>(sigma / edge); });
    }
    made.quick = true;
    cases.push_back(made);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double ratio : { 1e-3, 1e3 })
    {
      for (const double albedo : { 0.0, 0.9, 1.0 })
      {
        StressScene scene = OfAlbedo(1.0, albedo);
        scene.spacing[axis] = ratio;
        AddMedium(cases, "spacing", std::string(1, "xyz"[axis]) + " " + Number(ratio) + ", albedo " + Number(albedo),
          scene, false);
        cases.back().quick = axis == 2 && albedo == 1.0;
        StressCase& face = cases[cases.size() - 2];
        face.middle = 0.0;                         // that is of a cube
        if (axis == 2 ? ratio > 1.0 : ratio < 1.0) // the face that shines is a thin side of the box
        {
          face.refusals = { { "maps", "of the light that shines through the box's faces: too few" } };
        }
      }
    }
  }
}

void AddShapes(std::vector<StressCase>& cases)
{
  const std::array<int, 3> shapes[] = { { 1, 1, 1 }, { 1, 1, 1000 }, { 1000, 1, 1 }, { 1, 1000, 1 }, { 9, 9, 1 },
    { 1, 9, 9 }, { 9, 1, 9 } };
  for (const std::array<int, 3>& shape : shapes)
  {
    const std::string name = std::to_string(shape[0]) + "x" + std::to_string(shape[1]) + "x" + std::to_string(shape[2]);
    for (const double albedo : { 0.0, 0.9, 1.0 })
    {
      AddMedium(cases, "shape", name + ", albedo " + Number(albedo), Uniform(0.1 * (1.0 - albedo), 0.1 * albedo, shape),
        albedo == 0.9);
      cases[cases.size() - 2].middle = 0.0; // that is of a cube that many rays enter
    }
  }
  // A slab, of 1 x 1 x 1000 voxels with periodic sides: T of diffuse light by the diffusion limit.
  for (const double tau : { 100.0, 1e4, 1e6 })
  {
    StressScene slab = Uniform(0.0, tau / 1000.0, { 1, 1, 1000 });
    slab.periodic = { true, true, false };
    slab.faces[4] = 1.0;
    StressCase made = Named("shape", "slab of 1x1x1000, albedo 1, tau " + Number(tau), slab);
    made.transmitted = ThickSlabTransmittance(tau);
    made.bound = 1.0;
    cases.push_back(made);
  }
}

/// Lamps on the box's upper face, its edge and its corner, and where voxels meet.
void AddLampsOnEdges(std::vector<StressCase>& cases)
{
  const char* const names[] = { "sun", "point", "spot", "rectangle" };
  const struct
  {
    const char* name;
    Vector at;
    double ofPoint, ofSpot; ///< parts of their power that get into the box
  } places[] = { { "face", { 4.5, 4.5, 9.0 }, 0.5, 1.0 }, { "edge", { 0.0, 4.5, 9.0 }, 0.25, 0.5 },
    { "corner", { 0.0, 0.0, 9.0 }, 0.125, 0.25 }, { "voxels' corner", { 3.0, 4.0, 6.0 }, 1.0, 1.0 } };
  for (const double sigma : { 0.0, 0.3, 1e3 })
  {
    for (const auto& place : places)
    {
      for (const Lamp::Kind kind : { Lamp::Point, Lamp::Spot, Lamp::Rectangle })
      {
        StressScene scene = OfAlbedo(sigma, 0.8);
        scene.lamps = { { kind, place.at } };
        StressCase made =
          Named("lamp on an edge", std::string(names[kind]) + ", " + place.name + ", sigma " + Number(sigma), scene);
        made.lampsInside = kind == Lamp::Point ? place.ofPoint : place.ofSpot;
        if (kind == Lamp::Rectangle && place.ofSpot < 1.0)
        {
          made.lampsInside = -1.0; // what is beside the box shines in through its sides
        }
        made.quick = kind == Lamp::Point && sigma == 0.3;
        cases.push_back(made);
      }
    }
  }
}

/// A lamp so far away that it is a sun.
void AddFarLamps(std::vector<StressCase>& cases)
{
  for (const double distance : { 1e6, 1e17, 1e160 })
  {
    StressScene scene = OfAlbedo(0.3, 0.8);
    scene.lamps = { Lamp() };
    StressCase made = Named("far lamp", "at " + Number(distance), scene);
    made.twin = std::make_shared<StressScene>(scene);
    Lamp& lamp = made.scene.lamps[0];
    lamp.kind = Lamp::Point;
    lamp.at = { 4.5, 4.5, distance };
    lamp.power.fill(std::min(4.0 * std::acos(-1.0) * distance * distance, 1e38));
    made.scale = lamp.power[0] / (4.0 * std::acos(-1.0)) / distance / distance;
    made.lampsInside = 81.0 * made.scale / lamp.power[0];
    if (distance > 1e100)
    {
      made.refusals = { { "", "which is less than a float holds" }, { "", "would carry less power than" } };
    }
    cases.push_back(made);
  }
}

/// One voxel emits among others of up to a thousand mean free paths, in a box of unlike edges.
void AddScatterersAround(std::vector<StressCase>& cases)
{
  for (const double albedo : { 0.5, 0.998, 1.0 })
  {
    for (const unsigned seed : { 1u, 2u, 3u })
    {
      StressScene scene = Uniform(0.0, 0.0, { 9, 8, 7 });
      std::mt19937 random(seed);
      for (std::size_t i = 0; i < scene.VoxelCount(); ++i)
      {
        const double sigma = std::pow(10.0, 6.0 * static_cast<double>(random()) / 4294967296.0 - 3.0);
        scene.absorption[i] = static_cast<float>((1.0 - albedo) * sigma);
        scene.scattering[i] = static_cast<float>(albedo * sigma);
      }
      scene.emission.assign(scene.VoxelCount(), 0.0f);
      scene.emission[MiddleVoxel(scene)] = 1.0f;
      cases.push_back(
        Named("hot voxel in scatterers", "albedo " + Number(albedo) + ", medium " + std::to_string(seed), scene));
    }
  }
}

/// All faces and periodic axes; what all lights make is the sum of what they make one by one.
void AddBoundaries(std::vector<StressCase>& cases)
{
  const std::pair<const char*, std::array<bool, 3>> axes[] = { { "no axis", { false, false, false } },
    { "x", { true, false, false } }, { "z", { false, false, true } }, { "x and y", { true, true, false } },
    { "y and z", { false, true, true } }, { "all axes", { true, true, true } } };
  for (const auto& [name, periodic] : axes)
  {
    for (const double sigma : { 0.0, 0.3, 1e3 })
    {
      const bool closed = periodic[0] && periodic[1] && periodic[2];
      StressScene scene = OfAlbedo(sigma, 0.5);
      scene.periodic = periodic;
      const std::string called = std::string("periodic: ") + name + ", sigma " + Number(sigma);
      if (!(closed && sigma == 0.0))
      {
        cases.push_back(Furnace("boundaries", called, scene));
      }
      if (!periodic[2])
      {
        cases.push_back(Beam("boundaries", called, scene));
      }
      scene.emission = scene.absorption;
      for (int face = 0; face < 6; ++face)
      {
        scene.faces[face] = periodic[face / 2] ? 0.0 : face + 1.0;
      }
      StressCase lit = Named("boundaries", called + ", all lights", scene);
      lit.scene.lamps = { { Lamp::Point, { 3.3, 4.4, 5.2 } } };
      lit.scene.sky = { 0.5, 0.5, 0.5 };
      if (periodic[0] + periodic[1] + periodic[2] !=
        2) // else a part of the light is that of layers, by other directions
      {
        lit.twin = std::make_shared<StressScene>(lit.scene);
        lit.twin->faces = {};
        lit.twin->emission.clear();
        lit.rest = std::make_shared<StressScene>(scene);
      }
      lit.quick = sigma == 0.3;
      if (sigma > 0.0 || !(periodic[0] || periodic[1] || periodic[2]))
      {
        cases.push_back(lit);
      }
    }
  }
}

/// Colours that differ by six orders in extinction and in light.
void AddColours(std::vector<StressCase>& cases)
{
  const Vector sigma = { 1.0, 1e-3, 1e3 }, power = { 1e-6, 1.0, 1e-3 };
  StressScene scene;
  scene.channels = 3;
  scene.lamps = { Lamp() };
  scene.lamps[0].power = power;
  scene.sky = power;
  for (std::size_t i = 0; i < scene.VoxelCount(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      scene.absorption.push_back(static_cast<float>(0.1 * sigma[c]));
      scene.scattering.push_back(static_cast<float>(0.9 * sigma[c]));
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    StressCase made = Named("colours 1e6 apart", std::string("channel ") + "rgb"[c], scene);
    StressScene alone = Uniform(0.1 * sigma[c], 0.9 * sigma[c]);
    alone.lamps = { Lamp() };
    alone.lamps[0].power.fill(power[c]);
    alone.sky.fill(power[c]);
    made.twin = std::make_shared<StressScene>(alone);
    made.twinChannel = c;
    made.mirrored = { true, true, false };
    made.quick = c == 0;
    cases.push_back(made);
  }
}

/// The scenes that scatter once more, with mean cosines of their own. What is known of a light by symmetry or balance
/// alone stays; what is known of isotropic scattering goes.
std::vector<StressCase> Forward(const std::vector<StressCase>& cases)
{
  std::vector<StressCase> forward;
  for (const double g : { -0.95, -0.9, 0.5, 0.9, 0.99, 0.999 })
  {
    for (const StressCase& one : cases)
    {
      const std::vector<float>& sigma = one.scene.scattering;
      const bool scatters = std::any_of(sigma.begin(), sigma.end(), [](float value) { return value > 0.0f; });
      if (!scatters || one.scene.g != 0.0 || !one.scene.index.empty())
      {
        continue;
      }
      StressCase made = one;
      made.forward = true;
      made.quick = one.quick && g == 0.99;
      made.row += ", g " + Number(g);
      made.scene.g = g;
      made.transmitted = -1.0;
      for (Refusal& refusal : made.refusals)
      {
        refusal.words = refusal.words.substr(0, refusal.words.find(" 6e+38")); // the sum is by the similarity relation
      }
      if (made.twin)
      {
        made.twin = std::make_shared<StressScene>(*one.twin);
        made.twin->g = g;
      }
      if (made.rest)
      {
        made.rest = std::make_shared<StressScene>(*one.rest);
        made.rest->g = g;
      }
      forward.push_back(made);
    }
  }
  return forward;
}
}

std::vector<StressCase> StressCases()
{
  std::vector<StressCase> cases;
  AddThicknesses(cases);
  AddMeanCosines(cases);
  AddIndices(cases);
  AddCoefficients(cases);
  AddContrasts(cases);
  AddSingleVoxels(cases);
  AddLampsInside(cases);
  AddPowers(cases);
  AddSpacings(cases);
  AddShapes(cases);
  AddLampsOnEdges(cases);
  AddFarLamps(cases);
  AddScatterersAround(cases);
  AddBoundaries(cases);
  AddColours(cases);
  const std::vector<StressCase> forward = Forward(cases);
  cases.insert(cases.end(), forward.begin(), forward.end());
  return cases;
}
}
