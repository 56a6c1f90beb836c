#pragma once

#include <array>

/// A cloud in steps, case 1 of the Intercomparison of 3D Radiation Codes (I3RC): two optical thicknesses side by side,
/// endless by repetition. Lengths in km.
namespace step_cloud
{
constexpr int Columns = 32;
constexpr double ColumnWidth = 0.5 / Columns, Thickness = 0.25; ///< the columns are 0.5 wide in all
constexpr double ThinTau = 2.0, ThickTau = 18.0;                ///< of the first and the second half of the columns
constexpr double G = 0.85;                                      ///< Henyey and Greenstein

/// Fluxes over that of the sun through a level plane.
struct Column
{
  double reflected, transmitted;
  double reflectedError, transmittedError; ///< standard errors; 0 of I3RC's consensus
};

struct Experiment
{
  double sunFromZenith; ///< degrees; the sun's light travels towards +x
  double albedo;
  std::array<Column, Columns> columns;
};

/// Data/Reference/i3rc_step_cloud.csv: I3RC's consensus, or an own Monte Carlo where there is none.
/// @param number  1 to 4
/// @throws std::runtime_error where the table cannot be read, or does not have 32 columns of it
Experiment ExperimentOf(int number);
}
