#pragma once

#include "Lights/Lights.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <array>
#include <string>
#include <vector>

class vtkDataObject;
class vtkImageData;

/// Reads and writes the phase function of a medium as field data. No other code does.
///
/// | name               | numbers | meaning |
/// |--------------------|---------|---------|
/// | `phase_function`   | a text  | one of the names below; missing: `henyey_greenstein` |
/// | `g`                | 1 or 3  | mean cosine, for all channels or each; with two lobes, of the first. Default 0 |
/// | `phase_second_g`   | 1 or 3  | mean cosine of the second lobe |
/// | `phase_first_part` | 1 or 3  | fraction of the light that the first lobe scatters, 0 to 1 |
/// | `phase_cosine`     | n       | rows of a table: cosine of the scattering angle, -1 to 1, ascending or descending |
/// | `phase_value`      | n       | the phase function at these cosines, in any unit |
///
/// Names: `isotropic`, `henyey_greenstein`, `double_henyey_greenstein`, `schlick`, `rayleigh`, `tabulated`. The
/// functions `isotropic`, `rayleigh` and `tabulated` determine their mean cosine themselves: `g` is optional there and
/// must not contradict it. For `henyey_greenstein` and `schlick` a cell array `g` (1 or 3 components) takes precedence
/// over field data `g`.
namespace tyndall
{
class FloatField;
struct InputsKey;

/// The phase function as field data describe it: text and numbers, which Functions() checks.
struct PhaseDescription
{
  std::string name = "henyey_greenstein";
  Rgb g = {};
  Rgb secondG = {};
  Rgb firstPart = { 1.0, 1.0, 1.0 };
  std::vector<double> cosines, values;
  bool gByVoxel = false; ///< whether the cell array `g` takes precedence; field data `g` is then not written

  /// Phase functions of the red, green and blue channel.
  /// @throws InvalidInput naming the channel, or the row of the table, whose number is out of range
  std::array<PhaseFunction, 3> Functions() const;
  /// The phase function without its parameter g, for a medium whose mean cosine varies by voxel.
  /// @throws InvalidInput unless the phase function has a parameter g that can vary by voxel
  PhaseFunction KindOfVaryingG() const;
};

/// Reads the phase function of a medium from field data.
/// @throws InvalidInput if field data have another type or shape than documented in this header
PhaseDescription ReadPhaseDescription(vtkDataObject* medium);

/// Summary of the field data about the phase function, for messages and comparisons: their names and numbers; for a
/// table, its number of rows and a hash.
std::string PhaseInWords(vtkDataObject* medium);

/// Writes the description as field data and removes field data that this phase function does not need. For functions
/// that determine their mean cosine, `g` is written as that mean cosine.
void WritePhaseDescription(vtkDataObject* medium, const PhaseDescription& description);

/// Reads the cell array `g` of an image; empty if there is none. In voxels that do not scatter, g has no meaning:
/// invalid values read as 0.
FloatField ReadMeanCosines(vtkImageData* medium, const Field& sigma_s);

/// Reads the phase function of a medium from field data and the cell array `g`.
/// @param g        values of the cell array; empty: there is none. Referenced, not owned
/// @param sigma_s  voxels that do not scatter are ignored when deciding whether g varies
/// @throws InvalidInput if a parameter of the phase function is out of range, or naming the first voxel whose g is
///   outside (-1, 1)
PhaseOfMedium ReadPhase(vtkImageData* medium, const Field& g, const Field& sigma_s);

/// Adds everything that ReadPhase reads to a cache key.
void AddPhase(InputsKey& key, vtkImageData* medium);
}
