#include "DiscreteOrdinates/OrdinatesScene.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/Published/PublishedOrders.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Distribution/SharedMedium.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
std::unique_ptr<FaceLight> FaceLightOf(Device& device, const OrdinatesScene& scene, const OrdinateGroups& groups)
{
  if (std::all_of(scene.faceAlbedo.begin(), scene.faceAlbedo.end(), IsBlack))
  {
    return nullptr;
  }
  const Grid& grid = scene.domain.Whole();
  std::array<double, 6> powerIn = {};
  for (int g = 0; g < groups.Count(); ++g)
  {
    for (int lane = 0; lane < OrdinateLanes; ++lane)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        powerIn[EntryFace(axis, groups.All()[g].up[axis])] +=
          groups.Weight(g, lane) * std::abs(groups.Of(g, lane).omega[axis]) * grid.VoxelVolume() / grid.spacing[axis];
      }
    }
  }
  std::vector<double> ofCells;
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) { ofCells.push_back(powerIn[cell.face]); });
  return std::make_unique<FaceLight>(device, grid, 1, std::move(ofCells), scene.faceAlbedo);
}

std::optional<LightOfCells> CellsOf(const FaceLight* faces)
{
  return faces ? std::optional<LightOfCells>({ faces->Out(), faces->In() }) : std::nullopt;
}

SweepTally SumOf(const Domain& domain, const SweepTally& own)
{
  SweepTally sum = own;
  std::vector<Rgb*> powers = { &sum.onTheWay };
  for (std::size_t face = 0; face < 6; ++face)
  {
    powers.push_back(&sum.in[face]);
    powers.push_back(&sum.out[face]);
  }
  SumOverRanks(domain, powers);
  return sum;
}

void OrdinatesRecord::Add(double goesOn, const EnergyLedger& ledger)
{
  const EnergyBalance& balance = ledger.Balance();
  this->Sum += goesOn;
  this->Left = goesOn > 0.0 ? this->Rest.After(goesOn, this->Sum) : 0.0;
  this->Rows.push_back({ static_cast<int>(this->Rows.size()), ClockSeconds() - this->Start, this->Left,
    this->Sum > 0.0 ? goesOn / this->Sum : 0.0, balance.absorbed[0], balance.escaped[0], balance.leftOver[0] });
}

namespace
{
/// Directions per cube face of the quadrature with which peaks of the environment are found, if the solve itself uses
/// directions on a spiral.
constexpr int FacesPeaksAreSoughtFor = 25;

void TakePowers(LightField& light, const EnergyLedger& ledger, int channel)
{
  const EnergyBalance& balance = ledger.Balance();
  light.balance.entered[channel] = balance.entered[0];
  light.balance.emitted[channel] = balance.emitted[0];
  light.balance.absorbed[channel] = balance.absorbed[0];
  light.balance.escaped[channel] = balance.escaped[0];
  light.balance.leftOver[channel] = balance.leftOver[0];
  for (int face = 0; face < 6; ++face)
  {
    light.facePowerOut[face][channel] = ledger.FacePowerOut()[face][0];
  }
}

/// Adds the rows of the convergence table of one channel to those of all channels. If a channel has fewer rows than
/// others, its last one is repeated.
void AddRows(std::vector<ConvergenceRow>& sum, const std::vector<ConvergenceRow>& rows, bool first)
{
  const ConvergenceRow last = sum.empty() ? ConvergenceRow() : sum.back();
  const std::size_t count = std::max(sum.size(), rows.size());
  while (sum.size() < count)
  {
    sum.push_back(last);
    sum.back().iteration = static_cast<int>(sum.size()) - 1;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    const ConvergenceRow& row = rows[std::min(i, rows.size() - 1)];
    sum[i].seconds += row.seconds;
    sum[i].residual = first ? row.residual : std::max(sum[i].residual, row.residual);
    sum[i].change = first ? row.change : std::max(sum[i].change, row.change);
    sum[i].absorbed += row.absorbed;
    sum[i].escaped += row.escaped;
    sum[i].leftOver += row.leftOver;
  }
}
}

FarLight FarLightOf(const Illumination& shining, int perFace, const OrdinatesSettings& settings)
{
  const bool spiral = settings.spiralDirections > 0;
  const DirectionSet cube = spiral ? EquiangularDirections(FacesPeaksAreSoughtFor)
    : IsPublished(settings)        ? PublishedDirections(perFace)
                                   : EquiangularDirections(perFace);
  const SplitEnvironment environment = Split(shining.environment, cube);
  FarLight far = { cube.directions, {}, environment.peaks };
  if (!spiral)
  {
    far.radiance = BoundaryRadiance(cube, environment.smooth, shining.sky);
    return far;
  }
  far.directions = IsPublished(settings) ? SpiralDirections(settings.spiralDirections)
                                         : WeightedSpiralDirections(settings.spiralDirections);
  for (const Direction& direction : far.directions)
  {
    const std::array<double, 3>& omega = direction.omega;
    const Rgb seen =
      environment.smooth.Empty() ? Rgb{} : Lookup(environment.smooth, { -omega[0], -omega[1], -omega[2] });
    far.radiance.push_back(seen + shining.sky);
  }
  return far;
}

PhaseFunction FunctionOf(const Domain& domain, const Medium& medium, int channel)
{
  std::vector<double> sums = { 0.0, 0.0 }; // sums over voxels of sigma_s, and of sigma_s times mean cosine
  for (std::size_t i = 0; medium.phase.Varies() && i < medium.grid.VoxelCount(); ++i)
  {
    sums[0] += medium.sigma_s.At(i, channel);
    sums[1] += static_cast<double>(medium.sigma_s.At(i, channel)) * medium.phase.MeanCosine(i, channel);
  }
  sums = domain.Sum(sums);
  const PhaseFunction function = medium.phase.OfChannel(channel);
  return medium.phase.Varies() ? function.WithMeanCosine(sums[0] > 0.0 ? sums[1] / sums[0] : 0.0) : function;
}

std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel)
{
  std::array<Rgb, 6> albedo = {};
  for (int face = 0; face < 6; ++face)
  {
    albedo[face].fill(shining.faceAlbedo[face][channel]);
  }
  return albedo;
}

UncollidedImage UncollidedOf(const Illumination& shining, int channel)
{
  UncollidedImage image = shining.uncollided;
  image.fluence.standsForAll = image.fluence.HasColour() ? channel : image.fluence.standsForAll;
  for (Rgb& face : image.escaped)
  {
    face.fill(face[channel]);
  }
  return image;
}

SeparablePhaseFunction SeparableOf(const PhaseFunction& function, const std::vector<Direction>& directions,
  const OrdinatesSettings& settings, bool nowhereNegative)
{
  const bool matrix = settings.scattering == OrdinatesScattering::Matrix;
  SeparableSettings separable;
  separable.factorisation = settings.scattering == OrdinatesScattering::SphericalHarmonics
    ? PhaseFactorisation::SphericalHarmonics
    : PhaseFactorisation::SingularValues;
  separable.terms = matrix ? static_cast<int>(directions.size()) : settings.terms;
  separable.repaired = !IsPublished(settings);
  separable.sampling = IsPublished(settings) ? PhaseSampling::PointValues : PhaseSampling::CellMeans;
  separable.truncatesPeak = !IsPublished(settings) && !matrix;
  separable.nowhereNegative = nowhereNegative && !IsPublished(settings);
  return { function, directions, separable };
}

std::vector<std::string> DoubtsOf(const OrdinatesSettings& settings, double thickestStep, bool cosineVaries)
{
  std::vector<std::string> doubts;
  if (IsPublished(settings) && thickestStep > 1.0)
  {
    doubts.push_back("Explicit steps as published are not stable where sigma_t times the step, the shortest edge of a "
                     "voxel, is above 1: here it is up to " +
      Text("%.3g", thickestStep) +
      ". Radiance becomes negative, and above 2 it grows without end. Choose the conservative scheme, or finer "
      "voxels.");
  }
  if (cosineVaries)
  {
    doubts.emplace_back("The mean cosine g varies by voxel; discrete ordinates are solved with its mean, weighted by "
                        "sigma_s. Light Propagation Maps tell voxels apart.");
  }
  return doubts;
}

void CheckMemory(
  Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings, int facesDegree)
{
  const int functions = (facesDegree + 1) * (facesDegree + 1);
  const std::size_t moments = functions > 0 ? VolumeLayout{ grid, 1, true }.MomentFloats(functions) : 0;
  const std::size_t bytes = sizeof(float) * moments +
    (IsPublished(settings) ? BytesOfPublishedOrders(grid, angles, settings)
                           : BytesOfSweptOrders(grid, angles, settings));
  CheckMemory(device, angles.phase.DirectionCount(), bytes,
    sizeof(float) * AngularScattering::Floats(angles.groups, grid.VoxelCount()));
}

void CheckMemory(Device& device, int directions, std::size_t bytes, std::size_t radiance)
{
  const std::size_t free = device.MemoryLimit() - device.BytesInUse();
  if (bytes <= free && radiance <= device.AllocationLimit())
  {
    return;
  }
  const auto mebibytes = [](std::size_t count) { return Text("%.0f", std::ceil(count / 1048576.0)) + " MiB"; };
  throw DeviceError("Discrete ordinates with " + std::to_string(directions) + " directions need " + mebibytes(bytes) +
    " for this grid, " + mebibytes(radiance) + " of them in one piece, the radiance along all directions; " +
    device.Name() + " has " + mebibytes(free) + " left, " + mebibytes(device.AllocationLimit()) +
    " in one piece. Choose fewer directions, a coarser grid, or Light Propagation Maps.");
}

IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel)
{
  bool any = false;
  for (const Rgb& face : shining.faces)
  {
    any = any || face[channel] > 0.0;
  }
  for (const Rgb& radiance : far.radiance)
  {
    any = any || radiance[channel] > 0.0;
  }
  if (!any)
  {
    return {};
  }
  return [&far, &shining, channel](
           int direction, int face) { return far.radiance[direction][channel] + shining.faces[face][channel]; };
}

std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel)
{
  std::vector<Light> lamps;
  for (const std::vector<Light>* of : { &shining.lights, &far.peaks })
  {
    for (Light lamp : *of)
    {
      lamp.power = { lamp.power[channel], lamp.power[channel], lamp.power[channel] };
      if (lamp.power[0] > 0.0)
      {
        lamps.push_back(lamp);
      }
    }
  }
  return lamps;
}

void TakeChannel(LightField& light, const OrdinatesResult& found, int channel)
{
  const std::size_t voxels = found.fluence.size();
  light.fluence.resize(voxels * light.channels);
  light.fluenceDirect.resize(voxels * light.channels);
  light.netFlux.resize(found.flux.size() * light.channels);
  for (std::size_t i = 0; i < voxels; ++i)
  {
    light.fluence[i * light.channels + channel] = found.fluence[i];
    light.fluenceDirect[i * light.channels + channel] = found.direct[i];
    for (std::size_t a = 0; a < 3 && !found.flux.empty(); ++a)
    {
      light.netFlux[(i * light.channels + channel) * 3 + a] = found.flux[a * voxels + i];
    }
  }
  light.facePower.resize(std::max(light.facePower.size(), found.facePower.size() * light.channels), 0.0f);
  for (std::size_t cell = 0; cell < found.facePower.size(); ++cell)
  {
    light.facePower[cell * light.channels + channel] = found.facePower[cell];
  }
  TakePowers(light, found.ledger, channel);
  AddRows(light.convergence, found.convergence, channel == 0);
}

void DescribeLight(LightField& light, const Device& device, const FarLight& far, const BoundaryLight* faces)
{
  light.scatteredRadiance.resize(light.fluence.size());
  std::transform(light.fluence.begin(), light.fluence.end(), light.scatteredRadiance.begin(),
    [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.halfRangeFlux.fill(HalfRangeFlux(faces ? faces->Along().Set() : DirectionSet{ 0, false, far.directions }));
  light.uncollidedDirections = faces ? faces->Along().Set().PerFace() : 0;
  light.device = device.Name();
}

void Judge(const OrdinatesSettings& settings, const Domain& domain, const Medium& medium, LightField& light)
{
  if (!IsPublished(settings))
  {
    JudgeBalance(light, domain, medium);
  }
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  const bool isAsked = settings.maximumOrders > 0 || (settings.seriesAfter > 0 && !IsPublished(settings));
  light.converged = isAsked || residual <= settings.tolerance;
  if (!light.converged)
  {
    light.doubts.push_back("The light has not converged: after " + std::to_string(light.convergence.size()) +
      " orders its estimated relative error is " + Text("%.3g", residual) + ", Tolerance is " +
      Text("%.3g", settings.tolerance) + ". Light Propagation Maps accelerate such media.");
  }
}
}
