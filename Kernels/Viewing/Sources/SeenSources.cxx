#include "Viewing/Sources/SeenSources.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
struct RectangleSample
{
  glm::dvec3 place; ///< position relative to the grid's lower corner, in units of length
  double share;     ///< fraction of the light's power that the sample stands for
};

/// Appends sample points of a rectangular light: `perEdge` along each edge, at the centres of equal parts. A rectangle
/// is first divided into quarters, recursively, while it is longer than the box and than its distance from the box.
/// Parts near the box thus get more samples.
/// @param middle  centre of the rectangle relative to the grid's lower corner, in units of length
/// @param share   fraction of the light's power
/// @param whole   true for the light, false for a quarter of it
void AddSamples(const Grid& grid, const glm::dvec3& middle, const std::array<glm::dvec3, 2>& edges, int perEdge,
  double share, bool whole, std::vector<RectangleSample>& samples)
{
  const glm::dvec3 end(grid.Length(0), grid.Length(1), grid.Length(2));
  const double distance = glm::distance(middle, glm::clamp(middle, glm::dvec3(0.0), end));
  const double longer = std::max(glm::length(edges[0]), glm::length(edges[1]));
  const double box = std::max({ end.x, end.y, end.z });
  const bool quartered = longer > std::max(distance, whole ? box : 0.5 * box) * (1.0 + 1e-9);
  const int n = quartered ? 2 : whole ? perEdge : std::max(perEdge / 2, 1);
  for (int i = 0; i < n * n; ++i)
  {
    const glm::dvec3 place = middle + ((i % n + 0.5) / n - 0.5) * edges[0] + ((i / n + 0.5) / n - 0.5) * edges[1];
    if (quartered)
    {
      AddSamples(grid, place, { 0.5 * edges[0], 0.5 * edges[1] }, perEdge, 0.25 * share, false, samples);
    }
    else
    {
      samples.push_back({ place, share / (n * n) });
    }
  }
}

/// Replaces lights by the point lights and parallel beams to which shadow rays are traced. Lights of zero power are
/// omitted.
std::vector<SmallLight> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples)
{
  std::vector<SmallLight> small;
  const auto add = [&](const glm::dvec3& place, bool point, const glm::dvec3& axis, double cone, const Rgb& power,
                     double scale, bool cosine) {
    small.push_back(
      { Float4(place, point ? 1.0 : 0.0), Float4(axis, cone), Float4(scale * Vector(power), cosine ? 1.0 : 0.0) });
  };
  for (const Light& light : SeenFrom(grid, lights))
  {
    const glm::dvec3 axis = Vector(DirectionOf(light));
    const glm::dvec3 place = Vector(light.position) - Vector(grid.origin);
    if (IsBlack(light.power))
    {
      continue;
    }
    if (light.type == LightType::Directional)
    {
      add({ 0.0, 0.0, 0.0 }, false, axis, 0.0, light.power, 1.0, false);
    }
    else if (light.type == LightType::Point)
    {
      add(place, true, axis, 0.0, light.power, 1.0 / (4.0 * Pi), false);
    }
    else if (light.type == LightType::Spot)
    {
      add(place, true, axis, std::tan(0.5 * HalfAngle(light)), light.power, AxialIntensity(light), false);
    }
    else
    {
      // The light is Lambertian: its radiant intensity along the axis is power / pi.
      const auto edges = RectangleEdges(light);
      std::vector<RectangleSample> samples;
      AddSamples(grid, place, { Vector(edges[0]), Vector(edges[1]) }, rectangleSamples, 1.0, true, samples);
      for (const RectangleSample& sample : samples)
      {
        add(sample.place, true, axis, 0.0, light.power, sample.share / Pi, true);
      }
    }
  }
  return small;
}

constexpr int MostMoments = 1024;
/// Legendre moments at the end of the series are dropped while their absolute value is below this.
constexpr double Negligible = 1e-5;

/// The highest degree of the angular moments that the solver computed. It is found from straightOn, the fraction of
/// scattering that the solver treated as unscattered, which equals the Legendre moment of the next degree.
/// @param moments    Legendre moments of the phase function
/// @param otherwise  returned if straightOn equals no moment, as for functions that scatter backwards
int DegreeOf(const std::vector<double>& moments, double straightOn, int otherwise)
{
  for (std::size_t l = 1; l < moments.size() && straightOn > 0.0; ++l)
  {
    if (std::abs(moments[l] - straightOn) <= 1e-4 * straightOn)
    {
      return static_cast<int>(l) - 1;
    }
  }
  return otherwise;
}

/// Legendre moments of the light that was scattered at least twice, per unit of unscattered light of the beam and per
/// optical length of scattering (numerics.md, Eq. (112c)).
/// @param moments     Legendre moments of the phase function
/// @param straightOn  fraction of scattering that the solver treats as unscattered
/// @param degree      highest degree of the moments that the solver computed
/// @param depth       optical length of scattering along the beam's path
std::vector<double> MomentsBeyondFirst(const std::vector<double>& moments, double straightOn, int degree, double depth)
{
  std::vector<double> beyond;
  for (std::size_t l = 0; l < moments.size(); ++l)
  {
    const double more = moments[l] - straightOn;
    const double grows = depth > 0.0 ? std::expm1(more * depth) / depth : more;
    beyond.push_back(static_cast<int>(l) <= degree ? -straightOn * straightOn : moments[l] * (grows - straightOn));
  }
  return beyond;
}

double CosineOfColumn(int column)
{
  const double aside = 2.0 * std::min(column, AureoleColumns - column) / AureoleColumns;
  return 2 * column < AureoleColumns ? 1.0 - aside * aside : aside * aside - 1.0;
}
}

std::vector<float> AureoleTable(const PhaseFunction& function, double straightOn, int degree)
{
  std::vector<double> moments = function.Moments(MostMoments);
  const int solved = DegreeOf(moments, straightOn, degree);
  while (moments.size() > 1 && std::abs(moments.back()) < Negligible)
  {
    moments.pop_back();
  }
  std::vector<std::vector<double>> polynomials;
  for (int column = 0; column < AureoleColumns + 2; ++column)
  {
    polynomials.push_back(
      LegendrePolynomials(static_cast<int>(moments.size()) - 1, CosineOfColumn(std::min<int>(column, AureoleColumns))));
  }
  std::vector<float> table;
  for (int row = 0; row < AureoleRows + 2; ++row)
  {
    const double root = std::min<double>(row, AureoleRows) / AureoleRows;
    const std::vector<double> beyond = MomentsBeyondFirst(moments, straightOn, solved, AureoleDepth * root * root);
    for (const std::vector<double>& p : polynomials)
    {
      double sum = 0.0;
      for (std::size_t l = 0; l < beyond.size(); ++l)
      {
        sum += (2.0 * l + 1.0) * beyond[l] * p[l];
      }
      table.push_back(static_cast<float>(sum / (4.0 * Pi)));
    }
  }
  return table;
}

namespace
{
/// Tables of the light that repeated forward scattering adds (AureoleTable), one per channel. They are computed for the
/// smallest straightOn (fraction of scattering treated as unscattered) of the scattering voxels. Voxels with other
/// fractions contribute little.
std::vector<float> TablesOfAureole(const Medium& medium, const ViewTraits& traits)
{
  std::vector<float> tables;
  for (int c = 0; c < traits.moments.aureoleChannels; ++c)
  {
    const std::vector<float> table =
      AureoleTable(medium.phase.OfChannel(c), traits.moments.straightOn[c], traits.moments.degree);
    tables.insert(tables.end(), table.begin(), table.end());
  }
  return tables;
}
}

SeenSources::SeenSources(Device& device, const Medium& medium, const std::vector<Light>& lamps,
  const ViewSettings& settings, const ViewTraits& traits, const SceneOnDevice& scene, const PackedSamples& samples,
  const BlockOfScene* block)
  : TheDevice(device)
  , Settings(settings)
  , Traits(traits)
  , Scene(scene)
  , Samples(samples)
  , Block(block)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  this->Small = traits.shadowRays
    ? SmallLights(lamps, block ? block->block.whole : medium.grid, settings.rectangleSamples)
    : std::vector<SmallLight>();
  this->AureoleTables = Buffer<float>(device, TablesOfAureole(medium, traits), "light scattered forwards");
  this->OfLights = Buffer<float>(device, traits.shadowRays ? 6 * voxels : 0, "light found by shadow rays");
  this->OfMoments = Buffer<float>(device, traits.ShowsMoments() ? 3 * voxels : 0, "light scattered towards the eye");
  this->Lights = Buffer<SmallLight>(device, this->Small, "the lights");
}

ShadowInfo SeenSources::InfoOfVoxels() const
{
  const Grid& grid = this->Traits.grid;
  const double radius = std::cbrt(3.0 * grid.VoxelVolume() / (4.0 * Pi));
  ShadowInfo info = {};
  info.spacing = Float4(Vector(grid.spacing));
  info.size = Int4(grid.size);
  info.bricks = Int4(this->Samples.BrickCount());
  info.block = this->Block ? BlockInfoOf(this->Block->block) : BlockInfo{};
  info.phase = this->Traits.phase.parameters;
  info.components = this->Traits.Components();
  info.step = static_cast<float>(this->Settings.stepSize);
  info.nearestSquare = static_cast<float>(radius * radius / 3.0);
  info.lights = static_cast<int>(this->Small.size());
  info.beside = this->Traits.ShowsMoments();
  return info;
}

ShadowInfo SeenSources::MakeShadowInfo(const Camera& camera) const
{
  const Grid& whole = this->Block ? this->Block->block.whole : this->Traits.grid;
  ShadowInfo info = this->InfoOfVoxels();
  info.eye = Float4(Vector(camera.position) - Vector(whole.origin), camera.parallelProjection ? 1.0 : 0.0);
  info.forward = Float4(Vector(Axes(camera)[2]));
  return info;
}

/// Builds one of the kernels of ShadowRays.cl.
cl::Kernel SeenSources::Kernel(const char* name) const
{
  const ViewTraits& traits = this->Traits;
  return this->TheDevice.Kernel(name, kernel_source::ShadowRays,
    traits.PacketOptions() + traits.PhaseOptions(true) +
      StepOption(LongestSteps(traits.grid, this->Settings.stepSize)) +
      Define("AUREOLE", traits.moments.aureoleChannels));
}

/// Launches a kernel over a box of voxels in batches that can be aborted. One work-item computes a packet of adjacent
/// voxels of a row.
/// @param size     voxels of the box along each axis
/// @param samples  number of samples that the kernel reads for a row of voxels; determines the size of batches
/// @param to       progress that is reported at the end, in [0, 1]
/// @param launch   sets the kernel's arguments for a part of the box
void SeenSources::Launch(cl::Kernel& kernel, const std::array<int, 3>& size, double samples, double to,
  const Monitor& monitor, const std::function<void(const Patch& part)>& launch) const
{
  const int width = this->Traits.packetWidth;
  const std::size_t across = RoundUp<std::size_t>(size[0], 4 * width) / Count(width), rows = Count(size[1]);
  InBatches(this->TheDevice, BatchesOfRows(Count(size[2]), rows, samples, 0.0, to), monitor,
    [&](std::size_t first, std::size_t count) {
      InPatches(first, count, rows, [&](const Patch& part) {
        launch(part);
        this->TheDevice.Queue().enqueueNDRangeKernel(
          kernel, cl::NullRange, cl::NDRange(across, part.columns, part.rows), cl::NDRange(4, 1, 1));
      });
    });
}

void SeenSources::SetArguments(cl::Kernel& see, const ShadowInfo& info, const Buffer<float>& given)
{
  With(see, info, this->Lights, this->Scene.arrays[1].Handle(), this->Scene.meanCosines, this->Scene.phaseRows,
    this->Samples.Sigma(), this->Samples.Bricks(), this->Scene.arrays[0].Handle(), this->Scene.straightOn,
    this->AureoleTables, given, this->OfLights);
}

void SeenSources::SeeLights(const Camera& camera, const Monitor& monitor)
{
  const std::array<int, 3>& size = this->Traits.grid.size;
  ShadowInfo info = this->MakeShadowInfo(camera);
  cl::Kernel see = this->Kernel("see_lights");
  const double samples = LongestSteps(this->Traits.grid, this->Settings.stepSize) * info.lights * size[0];
  this->Launch(see, size, samples, 0.5, monitor, [&](const Patch& part) {
    info.firstSlice = part.row;
    info.firstRow = part.column;
    this->SetArguments(see, info, this->OfMoments);
  });
}

std::vector<float> SeenSources::DepthsTowards(int light, const VoxelBox& asked, const Monitor& monitor)
{
  ShadowInfo info = this->InfoOfVoxels();
  info.asked = Int4(asked.first);
  info.askedSize = Int4(asked.size);
  info.firstLight = light;
  cl::Kernel find = this->Kernel("find_depths");
  const Buffer<float> depths(this->TheDevice, 3 * asked.VoxelCount(), "optical lengths towards a light");
  const double samples = LongestSteps(this->Traits.grid, this->Settings.stepSize) * asked.size[0];
  this->Launch(find, asked.size, samples, 1.0, monitor, [&](const Patch& part) {
    info.firstSlice = part.row;
    info.firstRow = part.column;
    With(find, info, this->Lights, this->Samples.Sigma(), this->Samples.Bricks(), depths);
  });
  return depths.Read();
}

void SeenSources::SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths)
{
  ShadowInfo info = this->MakeShadowInfo(camera);
  info.firstLight = light;
  info.lights = light + 1;
  info.firstSlice = part.first[2] - this->Block->block.first[2];
  info.firstRow = part.first[1] - this->Block->block.first[1];
  info.isGiven = 1;
  cl::Kernel see = this->Kernel("see_lights");
  const Buffer<float> given(this->TheDevice, depths, "optical lengths towards a light");
  this->SetArguments(see, info, given);
  const int width = this->Traits.packetWidth;
  this->TheDevice.Queue().enqueueNDRangeKernel(see, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(part.size[0], 4 * width) / Count(width), Count(part.size[1]), Count(part.size[2])),
    cl::NDRange(4, 1, 1));
  this->TheDevice.Finish();
}

void SeenSources::SeeMoments(const Camera& camera)
{
  const ShadowInfo info = this->MakeShadowInfo(camera);
  cl::Kernel see = this->TheDevice.Kernel("see_moments", kernel_source::SeenMoments,
    Define("DEGREE", this->Traits.moments.degree) + Define("MOMENT_CHANNELS", this->Traits.moments.channels));
  With(see, info, this->Scene.moments, this->OfMoments);
  this->TheDevice.Queue().enqueueNDRangeKernel(see, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(info.size.s[0], 8), info.size.s[1], info.size.s[2]), cl::NDRange(8, 1, 1));
}
}
