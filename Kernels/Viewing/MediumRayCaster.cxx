#include "MediumRayCaster.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
/// Field by field the same as MediumRayCaster.cl's.
struct MediumRayCaster::View
{
  cl_float4 Eye, Forward, Right, Up, InverseSpacing, Background, Marching;
  cl_int4 Picture, Size, Bricks, Environment;
};

namespace
{
constexpr int Brick = 8; ///< as in Sampling.cl
constexpr double Pi = 3.14159265358979323846;

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

glm::dvec3 Vector(const std::array<double, 3>& v)
{
  return { v[0], v[1], v[2] };
}

cl_float4 Float4(const glm::dvec3& v, double w)
{
  return { { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w) } };
}

cl_int4 Int4(int x, int y, int z)
{
  return { { x, y, z, 0 } };
}

std::size_t RoundUp(std::size_t count, std::size_t multiple)
{
  return (count + multiple - 1) / multiple * multiple;
}

/// Columns and rows of pixels in a packet, as in MediumRayCaster.cl.
std::array<int, 2> PacketPixels(int width)
{
  return width == 16 ? std::array<int, 2>{ 4, 4 }
    : width == 8     ? std::array<int, 2>{ 4, 2 }
    : width == 4     ? std::array<int, 2>{ 2, 2 }
                     : std::array<int, 2>{ 1, 1 };
}

void CheckLightField(const Field& field, const char* name, std::size_t voxels)
{
  if (!field.values)
  {
    return;
  }
  if (field.components != 1 && field.components != 3)
  {
    throw InvalidInput(std::string(name) + " has " + std::to_string(field.components) +
      " components a voxel; give it 1 (grey) or 3 (red, green, blue).");
  }
  for (std::size_t i = 0; i < voxels * field.components; ++i)
  {
    if (!std::isfinite(field.values[i]))
    {
      throw InvalidInput(std::string(name) + " is not finite in voxel number " + std::to_string(i / field.components) +
        " (the first such voxel).");
    }
  }
}

void CheckSettings(const ViewSettings& settings)
{
  if (settings.imageSize[0] < 1 || settings.imageSize[1] < 1)
  {
    throw InvalidInput("The image is " + std::to_string(settings.imageSize[0]) + " by " +
      std::to_string(settings.imageSize[1]) + " pixels; it needs at least one each way.");
  }
  if (!(settings.stepSize > 0.0) || !std::isfinite(settings.stepSize))
  {
    throw InvalidInput(
      "The step size is " + std::to_string(settings.stepSize) + " voxels; it must be a positive number.");
  }
  const std::array<int, 5> widths = { 0, 1, 4, 8, 16 };
  if (std::find(widths.begin(), widths.end(), settings.packetWidth) == widths.end())
  {
    throw InvalidInput(
      "Packets of " + std::to_string(settings.packetWidth) + " rays do not exist; use 0, 1, 4, 8 or 16.");
  }
  if (!(settings.minimumTransmittance >= 0.0 && settings.minimumTransmittance < 1.0))
  {
    throw InvalidInput("The transmittance at which rays stop is " + std::to_string(settings.minimumTransmittance) +
      "; it must be at least 0 and below 1.");
  }
  if (settings.shadowRays && settings.rectangleSamples < 1)
  {
    throw InvalidInput("A rectangular light needs at least one sample per edge.");
  }
}

void CheckWhatIsNeeded(const ViewSettings& settings, const SolvedLight& light)
{
  const bool separates = settings.shadowRays != settings.singleScatteringOnly; // direct light from the rest
  if (separates && light.fluence.values && !light.fluenceDirect.values)
  {
    throw InvalidInput(
      "fluence_direct is missing: without it, light that scattered once cannot be told from the rest of "
      "fluence. Let the solver write it, or use neither or both of shadow rays and single scattering only.");
  }
}

bool IsZero(const Rgb& colour)
{
  return colour[0] == 0.0 && colour[1] == 0.0 && colour[2] == 0.0;
}

/// A bound of sigma_t over voxels and channels, 1/length.
double LargestExtinction(const Medium& medium)
{
  double sum = 0.0;
  for (const Field& field : { medium.sigma_a, medium.sigma_s })
  {
    const std::size_t count = field.values ? medium.grid.VoxelCount() * field.components : 0;
    sum += count > 0 ? *std::max_element(field.values, field.values + count) : 0.0f;
  }
  return sum;
}

/// Points and parallel beams that stand for the lights, as ScatteredLight.cl's small_light: three float4 each, world
/// coordinates from the box's lower corner.
std::vector<cl_float4> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples)
{
  std::vector<cl_float4> small;
  const auto add = [&](const glm::dvec3& place, bool point, const glm::dvec3& axis, double cone, const Rgb& power,
                     double scale, bool cosine) {
    small.push_back(Float4(place, point ? 1.0 : 0.0));
    small.push_back(Float4(axis, cone));
    small.push_back(Float4(scale * Vector(power), cosine ? 1.0 : 0.0));
  };
  for (const Light& light : lights)
  {
    const double length = glm::length(Vector(light.direction));
    const glm::dvec3 axis = length > 0.0 ? Vector(light.direction) / length : glm::dvec3(0.0, 0.0, -1.0);
    const glm::dvec3 place = Vector(light.position) - Vector(grid.origin);
    if (IsZero(light.power))
    {
      continue;
    }
    if (light.type == LightType::Directional)
    {
      add({ 0.0, 0.0, 0.0 }, false, axis, -2.0, light.power, 1.0, false);
    }
    else if (light.type == LightType::Point)
    {
      add(place, true, axis, -2.0, light.power, 1.0 / (4.0 * Pi), false);
    }
    else if (light.type == LightType::Spot)
    {
      const double cone = std::cos(light.angle * Pi / 360.0);
      add(place, true, axis, cone, light.power, 1.0 / (2.0 * Pi * (1.0 - cone)), false);
    }
    else
    {
      // Lambertian: radiant intensity along the axis is power / pi.
      const auto edges = RectangleEdges(light);
      const int n = rectangleSamples;
      for (int sample = 0; sample < n * n; ++sample)
      {
        const glm::dvec3 offset =
          ((sample % n + 0.5) / n - 0.5) * Vector(edges[0]) + ((sample / n + 0.5) / n - 0.5) * Vector(edges[1]);
        add(place + offset, true, axis, -2.0, light.power, 1.0 / (Pi * n * n), true);
      }
    }
  }
  return small;
}

/// Pixels of the environment with a column more on both sides, so that it closes.
std::vector<cl_float4> ClosedEnvironment(const Environment& environment)
{
  const int width = environment.width;
  std::vector<cl_float4> pixels(static_cast<std::size_t>(width + 2) * environment.height);
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < width + 2; ++i)
    {
      const std::size_t from = 3 * (static_cast<std::size_t>(j) * width + (i + width - 1) % width);
      pixels[static_cast<std::size_t>(j) * (width + 2) + i] = { { environment.radiance[from],
        environment.radiance[from + 1], environment.radiance[from + 2], 0.0f } };
    }
  }
  return pixels;
}

/// Turns 1 (empty) and -1 (filled) into plus or minus the number of king's moves to the nearest brick of the other sign, at
/// most 127; two sweeps find it exactly.
void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count)
{
  std::vector<int> moves(bricks.size(), 127);
  const auto relax = [&](int i, int j, int k, int side) {
    const std::size_t here = (static_cast<std::size_t>(k) * count[1] + j) * count[0] + i;
    for (int neighbour = 0; neighbour < 13; ++neighbour)
    {
      const int x = i + side * (neighbour % 3 - 1);
      const int y = j + side * (neighbour / 3 % 3 - 1);
      const int z = k + side * (neighbour / 9 - 1);
      if (x >= 0 && y >= 0 && z >= 0 && x < count[0] && y < count[1] && z < count[2])
      {
        const std::size_t there = (static_cast<std::size_t>(z) * count[1] + y) * count[0] + x;
        const bool other = bricks[there] != bricks[here];
        moves[here] = std::min(moves[here], other ? 1 : moves[there] + 1);
      }
    }
  };
  const int last = count[0] * count[1] * count[2] - 1;
  for (int n = 0; n <= last; ++n)
  {
    relax(n % count[0], n / count[0] % count[1], n / (count[0] * count[1]), 1);
  }
  for (int n = last; n >= 0; --n)
  {
    relax(n % count[0], n / count[0] % count[1], n / (count[0] * count[1]), -1);
  }
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    bricks[brick] = static_cast<cl_char>(bricks[brick] * moves[brick]);
  }
}

std::size_t PaddedCount(const Grid& grid)
{
  return static_cast<std::size_t>(grid.size[0] + 2) * (grid.size[1] + 2) * (grid.size[2] + 2);
}

/// Work-groups have fixed shapes throughout: PoCL compiles a kernel anew for every shape.
///
/// Queues rows of work (slices, rows of packets) in batches of roughly 50 ms, as long as the last one suggests.
template <class QueueRows>
void InBatches(Device& device, int rows, const Monitor& monitor, double from, double to, const QueueRows& queueRows)
{
  int batch = std::max(1, rows / 8);
  for (int first = 0; first < rows;)
  {
    const int count = std::min(batch, rows - first);
    const Clock::time_point start = Clock::now();
    queueRows(first, count);
    device.Finish();
    first += count;
    Report(monitor, from + (to - from) * first / rows);
    const double fitting = 0.05 * count / std::max(SecondsSince(start), 1e-6);
    batch = static_cast<int>(std::min(std::max(fitting, 1.0), 4.0 * count));
  }
}
}

MediumRayCaster::MediumRayCaster(Device& device, const Medium& medium, const SolvedLight& light,
  const Illumination& illumination, const ViewSettings& settings, const Field& /*ior*/)
  : TheDevice(device)
  , TheGrid(medium.grid)
  , Settings(settings)
  , G(medium.g)
{
  Check(medium);
  Check(illumination);
  CheckLightField(light.fluence, "fluence", medium.grid.VoxelCount());
  CheckLightField(light.fluenceDirect, "fluence_direct", medium.grid.VoxelCount());
  CheckSettings(settings);
  CheckWhatIsNeeded(settings, light);

  // Traits of the scene.
  this->Coloured = medium.sigma_a.components == 3 || medium.sigma_s.components == 3;
  const std::vector<cl_float4> lights = settings.shadowRays
    ? SmallLights(illumination.lights, medium.grid, settings.rectangleSamples)
    : std::vector<cl_float4>();
  this->LightCount = static_cast<int>(lights.size() / 3);
  this->SourcesDependOnCamera = this->LightCount > 0 && medium.g != 0.0;
  this->LargestExtinction = tyndall::LargestExtinction(medium);
  this->UnderSky = !illumination.environment.Empty() || !IsZero(illumination.sky);
  this->Background = this->UnderSky ? illumination.sky : settings.backgroundColor;

  this->Upload(medium, light);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->BrickCount[axis] = (medium.grid.size[axis] + Brick - 1) / Brick;
  }
  this->Samples = Buffer<cl_float4>(device, PaddedCount(medium.grid), "the ray caster's samples");
  this->Extinctions =
    Buffer<cl_float4>(device, this->Coloured ? PaddedCount(medium.grid) : 0, "the ray caster's coloured extinction");
  this->Bricks =
    Buffer<cl_char>(device, static_cast<std::size_t>(this->BrickCount[0]) * this->BrickCount[1] * this->BrickCount[2],
      "the ray caster's bricks");
  this->Direct =
    Buffer<float>(device, this->LightCount > 0 ? 6 * medium.grid.VoxelCount() : 0, "light found by shadow rays");
  this->Lights = Buffer<cl_float4>(device, lights, "the lights");
  if (!illumination.environment.Empty() && settings.showBackground)
  {
    this->EnvironmentSize = { illumination.environment.width, illumination.environment.height };
  }
  this->EnvironmentPixels = Buffer<cl_float4>(device,
    this->EnvironmentSize[0] > 0 ? ClosedEnvironment(illumination.environment) : std::vector<cl_float4>(),
    "the environment");

  // What is not needed.
  const auto omit = [this](bool needed, const char* what) {
    if (!needed)
    {
      this->Omitted.push_back(what);
    }
  };
  omit(this->Coloured, "transmittance per channel: extinction is grey");
  omit(this->Components[2] > 0, "emission: the medium does not shine");
  omit(this->LightCount > 0, "shadow rays: not asked for, or no light");
  omit(this->EnvironmentSize[0] > 0, "environment: none, or not shown");
}

bool MediumRayCaster::Adopt(const ViewSettings& settings)
{
  CheckSettings(settings);
  const ViewSettings& now = this->Settings;
  if (settings.singleScatteringOnly != now.singleScatteringOnly || settings.shadowRays != now.shadowRays ||
    settings.rectangleSamples != now.rectangleSamples || settings.showBackground != now.showBackground ||
    settings.packetWidth != now.packetWidth)
  {
    return false;
  }
  this->SourcesReady &= this->LightCount == 0 || settings.stepSize == now.stepSize; // shadow rays step as well
  this->Background = this->UnderSky ? this->Background : settings.backgroundColor;
  this->Settings = settings;
  return true;
}

/// On a CPU as wide as its registers; a GPU makes its own packets.
int MediumRayCaster::PacketWidth() const
{
  const int width = this->TheDevice.FloatVectorWidth();
  return this->Settings.packetWidth > 0     ? this->Settings.packetWidth
    : !this->TheDevice.IsCpu() || width < 4 ? 1
    : width < 8                             ? 4
    : width < 16                            ? 8
                                            : 16;
}

void MediumRayCaster::Upload(const Medium& medium, const SolvedLight& light)
{
  const std::array<Field, 5> fields = { medium.sigma_a, medium.sigma_s, medium.emission, light.fluence,
    light.fluenceDirect };
  // What the mode does not look at stays away.
  const bool shadows = this->Settings.shadowRays;
  const bool single = this->Settings.singleScatteringOnly;
  const std::array<bool, 5> used = { true, true, true, !single, shadows != single };
  const std::array<const char*, 5> names = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct" };
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    this->Components[i] = used[i] && fields[i].values ? fields[i].components : 0;
    const std::size_t count = medium.grid.VoxelCount() * this->Components[i];
    this->Arrays[i] = Buffer<float>(this->TheDevice, fields[i].values, count, names[i]);
  }
}

std::string MediumRayCaster::PackingOptions() const
{
  const std::array<const char*, 5> names = { "ABSORPTION", "SCATTERING", "EMISSION", "FLUENCE", "UNSCATTERED" };
  std::string options =
    "-DREAL_WIDTH=" + std::to_string(this->PacketWidth()) + " -DCOLOURED=" + std::to_string(this->Coloured ? 1 : 0);
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    options += std::string(" -D") + names[i] + "=" + std::to_string(this->Components[i]);
  }
  return options;
}

void MediumRayCaster::Pack(bool withShadowRays)
{
  const std::initializer_list<std::string_view> sources = { kernel_source::Numerics, kernel_source::Sampling,
    kernel_source::ScatteredLight };
  const std::string options = this->PackingOptions() + " -DSHADOW_RAYS=" + (withShadowRays ? "1" : "0");
  const cl_int4 size = Int4(this->TheGrid.size[0], this->TheGrid.size[1], this->TheGrid.size[2]);
  const cl_int4 bricks = Int4(this->BrickCount[0], this->BrickCount[1], this->BrickCount[2]);
  const cl_int single = this->Settings.singleScatteringOnly ? 1 : 0;

  cl::Kernel pack = this->TheDevice.Kernel("pack_samples", sources, options);
  With(pack, size, single, this->Arrays[0], this->Arrays[1], this->Arrays[2], this->Arrays[3], this->Arrays[4],
    this->Direct, this->Samples, this->Extinctions);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    pack, cl::NullRange, cl::NDRange(RoundUp(size.s[0] + 2, 64), size.s[1] + 2, size.s[2] + 2), cl::NDRange(64, 1, 1));

  cl::Kernel find = this->TheDevice.Kernel("find_empty_bricks", sources, options);
  With(find, size, bricks, this->Samples, this->Extinctions, this->Bricks);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    find, cl::NullRange, cl::NDRange(RoundUp(bricks.s[0], 4), bricks.s[1], bricks.s[2]), cl::NDRange(4, 1, 1));
  std::vector<cl_char> distances = this->Bricks.Read();
  FindDistances(distances, this->BrickCount);
  this->Bricks.Write(distances.data());
}

void MediumRayCaster::SeeLights(const Camera& camera, const Monitor& monitor)
{
  const cl_int4 size = Int4(this->TheGrid.size[0], this->TheGrid.size[1], this->TheGrid.size[2]);
  const cl_int4 bricks = Int4(this->BrickCount[0], this->BrickCount[1], this->BrickCount[2]);
  const glm::dvec3 eye = Vector(camera.position) - Vector(this->TheGrid.origin);
  const double radius = std::cbrt(3.0 * this->TheGrid.VoxelVolume() / (4.0 * Pi));
  cl::Kernel see = this->TheDevice.Kernel("see_lights",
    { kernel_source::Numerics, kernel_source::Sampling, kernel_source::ScatteredLight },
    this->PackingOptions() + " -DSHADOW_RAYS=1");
  const std::size_t across = RoundUp(this->TheGrid.size[0], 4 * this->PacketWidth()) / this->PacketWidth();
  InBatches(this->TheDevice, this->TheGrid.size[2], monitor, 0.0, 0.5, [&](int first, int count) {
    With(see, size, bricks, Float4(Vector(this->TheGrid.spacing), 0.0),
      Float4(eye, camera.parallelProjection ? 1.0 : 0.0), Float4(Vector(Axes(camera)[2]), 0.0),
      static_cast<float>(this->G), static_cast<float>(this->Settings.stepSize),
      static_cast<float>(radius * radius / 3.0), this->LightCount, this->Lights, this->Arrays[1], this->Samples,
      this->Extinctions, this->Bricks, first, this->Direct);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      see, cl::NullRange, cl::NDRange(across, this->TheGrid.size[1], count), cl::NDRange(4, 1, 1));
  });
}

MediumRayCaster::View MediumRayCaster::MakeView(const Camera& camera) const
{
  const auto axes = Axes(camera);
  const Grid& grid = this->TheGrid;
  const glm::dvec3 inverseSpacing = 1.0 / Vector(grid.spacing);
  const glm::dvec3 eye = Vector(camera.position) - Vector(grid.origin);
  const glm::dvec3 forward = Vector(axes[2]);
  const double halfHeight = camera.parallelProjection ? camera.parallelScale : std::tan(camera.viewAngle * Pi / 360.0);
  const double halfWidth = halfHeight * this->Settings.imageSize[0] / this->Settings.imageSize[1];
  double farDepth = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 at(
      corner & 1 ? grid.Length(0) : 0.0, corner & 2 ? grid.Length(1) : 0.0, corner & 4 ? grid.Length(2) : 0.0);
    farDepth = std::max(farDepth, glm::dot(at - eye, forward));
  }
  View view;
  view.Eye = Float4(eye * inverseSpacing, camera.parallelProjection ? 1.0 : 0.0);
  view.Forward = Float4(forward, 0.0);
  view.Right = Float4(halfWidth * Vector(axes[0]), 0.0);
  view.Up = Float4(halfHeight * Vector(axes[1]), 0.0);
  view.InverseSpacing = Float4(inverseSpacing, 0.0);
  view.Background = Float4(Vector(this->Background), this->Settings.showBackground ? 1.0 : 0.0);
  view.Marching = Float4({ this->Settings.stepSize, this->Settings.minimumTransmittance, farDepth }, 0.0);
  view.Picture = Int4(this->Settings.imageSize[0], this->Settings.imageSize[1], 0);
  view.Size = Int4(grid.size[0], grid.size[1], grid.size[2]);
  view.Bricks = Int4(this->BrickCount[0], this->BrickCount[1], this->BrickCount[2]);
  view.Environment = Int4(this->EnvironmentSize[0], this->EnvironmentSize[1], 0);
  return view;
}

void MediumRayCaster::PrepareSources(const Camera& camera, const Monitor& monitor)
{
  if (this->LightCount > 0)
  {
    this->Pack(false); // shadow rays need the extinction and its bricks
    this->SeeLights(camera, monitor);
  }
  this->Pack(this->LightCount > 0);
  this->SourcesReady = true;
  if (this->LightCount == 0)
  {
    this->Arrays = {};
  }
}

std::string MediumRayCaster::CastingOptions() const
{
  // Longest optical length of a step; the kernel has a shorter way to cross it up to 2.
  const double longest = this->LargestExtinction * this->Settings.stepSize *
    *std::max_element(this->TheGrid.spacing.begin(), this->TheGrid.spacing.end());
  const auto define = [](const char* name, bool value) { return std::string(" -D") + name + (value ? "=1" : "=0"); };
  return "-DREAL_WIDTH=" + std::to_string(this->PacketWidth()) + define("COLOURED", this->Coloured) +
    define("SKIP_BRICKS", this->Settings.skipEmptyBricks) + define("ENVIRONMENT", this->EnvironmentSize[0] > 0) +
    define("THIN_STEPS", longest <= 2.0);
}

void MediumRayCaster::CastRays(View& view, double from, const Monitor& monitor)
{
  const std::array<int, 2> packet = PacketPixels(this->PacketWidth());
  cl::Kernel cast = this->TheDevice.Kernel("cast_rays",
    { kernel_source::Numerics, kernel_source::Sampling, kernel_source::MediumRayCaster }, this->CastingOptions());
  // Batches of whole work-groups: else the last rows of one would be cast again by the next.
  const int group = 8;
  const std::size_t across = RoundUp(view.Picture.s[0], group * packet[0]) / packet[0];
  const int rows = static_cast<int>(RoundUp(view.Picture.s[1], group * packet[1]) / (group * packet[1]));
  InBatches(this->TheDevice, rows, monitor, from, 1.0, [&](int first, int count) {
    view.Picture.s[2] = first * group;
    With(cast, view, this->Samples, this->Extinctions, this->Bricks, this->EnvironmentPixels, this->Radiance,
      this->Alpha, this->Depth);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      cast, cl::NullRange, cl::NDRange(across, static_cast<std::size_t>(count) * group), cl::NDRange(group, group));
  });
}

Picture MediumRayCaster::Render(const Camera& camera, const Monitor& monitor)
{
  View view = this->MakeView(camera);
  Report(monitor, 0.0);
  const bool prepares = !this->SourcesReady || this->SourcesDependOnCamera;
  if (prepares)
  {
    this->PrepareSources(camera, monitor);
  }

  Picture picture;
  picture.width = this->Settings.imageSize[0];
  picture.height = this->Settings.imageSize[1];
  picture.farDepth = view.Marching.s[2];
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * picture.height;
  if (this->Alpha.Size() != pixels)
  {
    Buffer<float> radiance(this->TheDevice, 3 * pixels, "the picture");
    Buffer<float> alpha(this->TheDevice, pixels, "the picture's alpha");
    Buffer<float> depth(this->TheDevice, pixels, "the picture's depth");
    this->Radiance.Swap(radiance); // all or none, where one does not fit
    this->Alpha.Swap(alpha);
    this->Depth.Swap(depth);
  }
  this->CastRays(view, prepares && this->LightCount > 0 ? 0.5 : 0.0, monitor);
  picture.radiance = this->Radiance.Read();
  picture.alpha = this->Alpha.Read();
  picture.depth = this->Depth.Read();
  return picture;
}
}
