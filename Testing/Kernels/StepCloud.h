#pragma once

#include "MediumScene.h"

#include "Medium/BoxFaces.h"
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
  scene.settings.facePower = true;
  return scene;
}

/// Power that leaves through the cells of the top (face 5) or the bottom (4) of each column, over its area.
inline std::array<double, Columns> LeavingColumns(const tyndall::LightField& light, const tyndall::Grid& grid, int face)
{
  const tyndall::BoxFaceLayout layout = tyndall::LayoutOfFace(grid, face);
  const int perColumn = grid.size[0] / Columns;
  std::array<double, Columns> power = {};
  for (int i = 0; i < grid.size[0]; ++i)
  {
    power[i / perColumn] += light.facePower[layout.first + i] / perColumn;
  }
  return power;
}

/// Reflected and transmitted over what comes in, and of the whole cloud from the power through the box's faces.
struct Found
{
  std::array<double, Columns> reflected, transmitted;
  double reflectedInAll, transmittedInAll;
};

inline Found FoundIn(const tyndall::LightField& light, const tyndall::Grid& grid, double sunFromZenith)
{
  const double enters = std::cos(sunFromZenith * tyndall::Pi / 180.0);
  Found found = { LeavingColumns(light, grid, 5), LeavingColumns(light, grid, 4),
    light.facePowerOut[5][0] / light.balance.entered[0], light.facePowerOut[4][0] / light.balance.entered[0] };
  for (int i = 0; i < Columns; ++i)
  {
    found.reflected[i] /= enters;
    found.transmitted[i] /= enters;
  }
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
