#pragma once

#include "MediumScene.h"

#include "Numerics/Constants.h"
#include "Reference/StepCloudReference.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace step_cloud
{
/// How finely the cloud is cut.
struct Voxels
{
  int perColumn = 4, layers = 32;
};

/// The cloud of an experiment, layers along z, its sun above (+z).
inline Scene SceneOf(const Experiment& experiment, const Voxels& voxels)
{
  const int across = Columns * voxels.perColumn;
  Scene scene({ across, 1, voxels.layers });
  scene.medium.grid.spacing = { ColumnWidth / voxels.perColumn, ColumnWidth, Thickness / voxels.layers };
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const bool thick = static_cast<int>(i) % across >= across / 2;
    const double sigma_t = (thick ? ThickTau : ThinTau) / Thickness;
    scene.sigma_a[i] = static_cast<float>(sigma_t * (1.0 - experiment.albedo));
    scene.sigma_s[i] = static_cast<float>(sigma_t * experiment.albedo);
  }
  scene.medium.phase = tyndall::PhaseFunction::HenyeyGreenstein(G);
  const double angle = experiment.sunFromZenith * tyndall::Pi / 180.0;
  scene.ShineAlong({ std::sin(angle), 0.0, -std::cos(angle) });
  scene.settings.periodic = { true, true, false };
  scene.settings.netFlux = true;
  return scene;
}

/// Net flux upwards through the top or the bottom of the columns, from voxel means: continued from the three layers
/// next to it as a parabola that has these means. At the top the beam is known, and left out of what is continued:
/// under a low sun its shadow edge moves by a column from layer to layer.
/// @param cosine  of the sun from the zenith
inline std::array<double, Columns> FluxThroughFace(
  const tyndall::LightField& light, const tyndall::Grid& grid, bool top, double cosine)
{
  constexpr double OfLayer[] = { 11.0 / 6.0, -7.0 / 6.0, 2.0 / 6.0 };
  const int perColumn = grid.size[0] / Columns;
  std::array<double, Columns> flux = {};
  flux.fill(top ? -cosine : 0.0);
  for (int layer = 0; layer < 3; ++layer)
  {
    const int k = top ? grid.size[2] - 1 - layer : layer;
    for (int i = 0; i < grid.size[0]; ++i)
    {
      const std::size_t voxel = static_cast<std::size_t>(k) * grid.size[0] + i;
      const double beam = top ? cosine * light.fluenceDirect[voxel] : 0.0;
      flux[i / perColumn] += OfLayer[layer] * (light.netFlux[3 * voxel + 2] + beam) / perColumn;
    }
  }
  return flux;
}

/// Reflected and transmitted over what comes in, and of the whole cloud from the power through the box's faces.
struct Found
{
  std::array<double, Columns> reflected, transmitted;
  double reflectedInAll, transmittedInAll;
  double leastSure; ///< largest difference between the means of columns and the whole, of R and T
};

/// Columns are made to add up to the power that goes out of the face, which is counted exactly: what is missing is
/// given to them by optical thickness, for voxels' net flux is the further from the face's the thicker they are.
inline Found FoundIn(const tyndall::LightField& light, const tyndall::Grid& grid, double sunFromZenith)
{
  const double enters = std::cos(sunFromZenith * tyndall::Pi / 180.0);
  Found found = { FluxThroughFace(light, grid, true, enters), FluxThroughFace(light, grid, false, enters), 0.0, 0.0,
    0.0 };
  found.reflectedInAll = light.facePowerOut[5][0] / light.balance.entered[0];
  found.transmittedInAll = light.facePowerOut[4][0] / light.balance.entered[0];
  double meanReflected = 0.0, meanTransmitted = 0.0;
  for (int i = 0; i < Columns; ++i)
  {
    found.reflected[i] = 1.0 + found.reflected[i] / enters;
    found.transmitted[i] = -found.transmitted[i] / enters;
    meanReflected += found.reflected[i] / Columns;
    meanTransmitted += found.transmitted[i] / Columns;
  }
  for (int i = 0; i < Columns; ++i)
  {
    const double part = 2.0 * (i < Columns / 2 ? ThinTau : ThickTau) / (ThinTau + ThickTau);
    found.reflected[i] += part * (found.reflectedInAll - meanReflected);
    found.transmitted[i] += part * (found.transmittedInAll - meanTransmitted);
  }
  found.leastSure =
    std::max(std::abs(found.reflectedInAll - meanReflected), std::abs(found.transmittedInAll - meanTransmitted));
  return found;
}

/// Relative errors of R and T: of the worst column, and of the mean.
struct Errors
{
  double columnReflected = 0.0, columnTransmitted = 0.0; ///< less three standard errors of the reference
  double meanReflected = 0.0, meanTransmitted = 0.0;     ///< signed
};

inline Errors ErrorsOf(const Found& found, const Experiment& experiment)
{
  Errors errors;
  double reflected = 0.0, transmitted = 0.0;
  for (int i = 0; i < Columns; ++i)
  {
    const Column& column = experiment.columns[i];
    const auto error = [](double is, double shouldBe, double standardError) {
      return (std::abs(is - shouldBe) - 3.0 * standardError) / shouldBe;
    };
    errors.columnReflected =
      std::max(errors.columnReflected, error(found.reflected[i], column.reflected, column.reflectedError));
    errors.columnTransmitted =
      std::max(errors.columnTransmitted, error(found.transmitted[i], column.transmitted, column.transmittedError));
    reflected += column.reflected / Columns;
    transmitted += column.transmitted / Columns;
  }
  errors.meanReflected = found.reflectedInAll / reflected - 1.0;
  errors.meanTransmitted = found.transmittedInAll / transmitted - 1.0;
  return errors;
}
}
