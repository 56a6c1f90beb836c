#include "LightPropagation/Problem/GridAxes.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Width of a voxel along unvarying axes, in units of its edge along the other axes: larger widths gain little, and
/// flat voxels slow down the diffusion solve.
constexpr double Width = 10.0;
constexpr int EdgeInSlabs = 12;
/// Even number of directions along a cube face's edge with which the quadrature nevertheless has directions normal to
/// an axis; their light would wrap around forever.
constexpr int EdgeWithCosineZero = 10;
}

AxisPermutation::AxisPermutation(
  const Grid& grid, const Illumination& illumination, const PropagationSettings& settings)
{
  if (!UnvaryingAxes(grid, illumination, settings).IsSlab() || !illumination.environment.Empty() ||
    illumination.uncollided.IsThere())
  {
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Along = grid.size[axis] > 1 || !settings.periodic[axis] ? axis : this->Along;
  }
}

template <class Value>
std::array<Value, 3> AxisPermutation::Turned(const std::array<Value, 3>& given) const
{
  return { given[this->Along], given[(this->Along + 1) % 3], given[(this->Along + 2) % 3] };
}

template <class Value>
std::array<Value, 3> AxisPermutation::TurnedBack(const std::array<Value, 3>& turned) const
{
  return { turned[(3 - this->Along) % 3], turned[(4 - this->Along) % 3], turned[(5 - this->Along) % 3] };
}

Medium AxisPermutation::Of(const Medium& medium) const
{
  Medium turned = medium;
  turned.grid.size = this->Turned(medium.grid.size);
  turned.grid.spacing = this->Turned(medium.grid.spacing);
  turned.grid.origin = this->Turned(medium.grid.origin);
  return turned;
}

Illumination AxisPermutation::Of(const Illumination& illumination) const
{
  Illumination turned = illumination;
  for (Light& light : turned.lights)
  {
    light.position = this->Turned(light.position);
    light.direction = this->Turned(light.direction);
  }
  for (int face = 0; face < 6; ++face)
  {
    turned.faces[this->FaceWhenTurned(face)] = illumination.faces[face];
    turned.faceAlbedo[this->FaceWhenTurned(face)] = illumination.faceAlbedo[face];
  }
  return turned;
}

PropagationSettings AxisPermutation::Of(const PropagationSettings& settings) const
{
  PropagationSettings turned = settings;
  turned.periodic = this->Turned(settings.periodic);
  return turned;
}

/// Moves the values of face cells back to the original faces; the order of cells within a face is unchanged.
void AxisPermutation::TurnBackCells(std::vector<float>& values, const Grid& grid) const
{
  const std::size_t each = values.size() / BoxFaceCellCount(grid);
  Grid turnedGrid = grid;
  turnedGrid.size = this->Turned(grid.size);
  const std::vector<float> turned = values;
  for (int face = 0; face < 6; ++face)
  {
    const std::size_t count = grid.VoxelCount() / grid.size[face / 2];
    const auto from = static_cast<std::ptrdiff_t>(each * LayoutOfFace(turnedGrid, this->FaceWhenTurned(face)).first);
    const auto to = static_cast<std::ptrdiff_t>(each * LayoutOfFace(grid, face).first);
    std::copy_n(turned.begin() + from, each * count, values.begin() + to);
  }
}

/// Converts scattered moments from harmonics of permuted directions to harmonics of original directions, degree by
/// degree. The coefficients of the conversion are integrals over all directions of products of the two harmonics,
/// computed by an exact quadrature.
void AxisPermutation::TurnBackMoments(LightField& light, const Grid& grid) const
{
  const std::size_t channels = static_cast<std::size_t>(light.channels);
  const std::size_t harmonics = light.scatteredMoments.size() / (grid.VoxelCount() * channels);
  const int degree = static_cast<int>(std::lround(std::sqrt(static_cast<double>(harmonics)))) - 1;
  std::vector<double> matrix(harmonics * harmonics, 0.0);
  const GaussLegendre rule(degree + 1);
  const int around = 2 * degree + 1;
  for (std::size_t i = 0; i < rule.points.size(); ++i)
  {
    for (int k = 0; k < around; ++k)
    {
      const double sine = std::sqrt(1.0 - rule.points[i] * rule.points[i]), azimuth = 2.0 * Pi * k / around;
      const std::array<double, 3> omega = { sine * std::cos(azimuth), sine * std::sin(azimuth), rule.points[i] };
      const std::vector<double> here = SphericalHarmonics(degree, omega);
      const std::vector<double> there = SphericalHarmonics(degree, this->Turned(omega));
      for (std::size_t at = 0; at < matrix.size(); ++at)
      {
        matrix[at] += rule.weights[i] * 2.0 * Pi / around * here[at / harmonics] * there[at % harmonics];
      }
    }
  }
  std::vector<double> turned(harmonics);
  for (std::size_t first = 0; first < light.scatteredMoments.size(); ++first)
  {
    if (first % (harmonics * channels) >= channels)
    {
      continue; // only at the index of the first moment of a voxel and channel are all its moments converted
    }
    for (std::size_t j = 0; j < harmonics; ++j)
    {
      turned[j] = light.scatteredMoments[first + j * channels];
    }
    for (std::size_t j = 0; j < harmonics; ++j)
    {
      double sum = 0.0;
      for (std::size_t k = 0; k < harmonics; ++k)
      {
        sum += matrix[j * harmonics + k] * turned[k];
      }
      light.scatteredMoments[first + j * channels] = static_cast<float>(sum);
    }
  }
}

void AxisPermutation::Undo(LightField& light, const Grid& grid) const
{
  for (std::size_t i = 0; i < light.netFlux.size(); i += 3)
  {
    const std::array<float, 3> flux =
      this->TurnedBack<float>({ light.netFlux[i], light.netFlux[i + 1], light.netFlux[i + 2] });
    std::copy(flux.begin(), flux.end(), light.netFlux.begin() + static_cast<std::ptrdiff_t>(i));
  }
  for (std::size_t i = 0; i < light.firstMoments.size(); i += 6)
  {
    std::array<float, 6> moments;
    std::copy_n(light.firstMoments.begin() + static_cast<std::ptrdiff_t>(i), 6, moments.begin());
    for (int face = 0; face < 6; ++face)
    {
      light.firstMoments[i + static_cast<std::size_t>(face)] = moments[this->FaceWhenTurned(face)];
    }
  }
  for (std::array<double, 3>& direction : light.storedDirections)
  {
    direction = this->TurnedBack(direction);
  }
  for (Light& lamp : light.lampsApart)
  {
    lamp.direction = this->TurnedBack(lamp.direction);
  }
  this->TurnBackCells(light.surfaceRadiance, grid);
  this->TurnBackCells(light.facePower, grid);
  const std::array<Rgb, 6> power = light.facePowerOut, albedo = light.faceAlbedo;
  for (int face = 0; face < 6; ++face)
  {
    light.facePowerOut[face] = power[this->FaceWhenTurned(face)];
    light.faceAlbedo[face] = albedo[this->FaceWhenTurned(face)];
  }
  if (!light.scatteredMoments.empty())
  {
    this->TurnBackMoments(light, grid);
  }
}

UnvaryingAxes::UnvaryingAxes(const Grid& grid, const Illumination& illumination, const PropagationSettings& settings)
{
  if (settings.source == PropagationSource::Constant || AnyHasPosition(SeenFrom(grid, illumination.lights)))
  {
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Single[axis] = grid.size[axis] == 1 && settings.periodic[axis];
  }
}

Grid UnvaryingAxes::Widened(const Grid& grid) const
{
  double width = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    width = std::max(width, this->Single[axis] ? 0.0 : Width * grid.spacing[axis]);
  }
  Grid wide = grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    wide.spacing[axis] = this->Single[axis] && width > 0.0 ? width : grid.spacing[axis];
  }
  return wide;
}

int DirectionsPerFaceFor(const PropagationSettings& settings, const UnvaryingAxes& unvarying)
{
  const int told = settings.directionsPerFace;
  const int edge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(std::max(told, 0)))));
  if (!settings.adaptDirections || edge * edge != told)
  {
    return told;
  }
  const int periodicAxes = settings.periodic[0] + settings.periodic[1] + settings.periodic[2];
  const bool goRound = periodicAxes == 1 || periodicAxes == 2;
  const int even = goRound || unvarying.IsSlab() ? edge + edge % 2 : edge;
  const bool stays = goRound && even == EdgeWithCosineZero;
  const int enough = unvarying.IsSlab() || stays ? std::max(even, EdgeInSlabs) : even;
  return enough * enough;
}
}
