#pragma once

#include "Lights/Lights.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <array>
#include <string>
#include <vector>

class vtkDataObject;
class vtkImageData;

/// The one place where filters read and write how a medium scatters. Field data:
///
/// | name               | numbers | meaning |
/// |--------------------|---------|---------|
/// | `phase_function`   | a text  | one of the names below; missing: `henyey_greenstein` |
/// | `g`                | 1 or 3  | mean cosine, of all or each channel; of two lobes that of the first. Missing: 0 |
/// | `phase_second_g`   | 1 or 3  | mean cosine of the second lobe |
/// | `phase_first_part` | 1 or 3  | part of the light that the first lobe scatters, 0 to 1 |
/// | `phase_cosine`     | n       | rows of a table: cosines of the scattering angle, -1 to 1, rising or falling |
/// | `phase_value`      | n       | the phase function there, in any unit |
///
/// Names: `isotropic`, `henyey_greenstein`, `double_henyey_greenstein`, `schlick`, `rayleigh`, `tabulated`. Of
/// `isotropic`, `rayleigh` and `tabulated`, whose mean cosine is known without it, `g` may be there or not, but must
/// not contradict. Cells `g` (1 or 3 components) of `henyey_greenstein` and `schlick` count before field data `g`.
namespace tyndall
{
class FloatField;
struct InputsKey;

/// What field data say. A text and numbers that are not checked before Functions().
struct PhaseDescription
{
  std::string name = "henyey_greenstein";
  Rgb g = {};
  Rgb secondG = {};
  Rgb firstPart = { 1.0, 1.0, 1.0 };
  std::vector<double> cosines, values;
  bool gByVoxel = false; ///< cells `g` count: field data `g` is not written

  /// Of each channel.
  /// @throws InvalidInput naming the channel whose number, or the row of the table, that is out of range
  std::array<PhaseFunction, 3> Functions() const;
  /// Of a medium whose mean cosine varies by voxel: the kind alone.
  /// @throws InvalidInput where the function has no mean cosine to choose
  PhaseFunction KindOfVaryingG() const;
};

/// @throws InvalidInput where field data have another type or shape than the table above says
PhaseDescription ReadPhaseDescription(vtkDataObject* medium);

/// What field data say, for messages, and to compare: names and numbers, of tables how many there are and a number that
/// others hardly have.
std::string PhaseInWords(vtkDataObject* medium);

/// Writes it as field data, and takes away those that it does not need. `g` of functions that need none is their mean
/// cosine.
void WritePhaseDescription(vtkDataObject* medium, const PhaseDescription& description);

/// Cells `g` of an image; not there where it has none. Where nothing scatters their values have no meaning: those that
/// would be refused are 0.
FloatField ReadMeanCosines(vtkImageData* medium, const Field& sigma_s);

/// How a medium with such field data and cells `g` scatters.
/// @param g         without values: there are no such cells. Seen, not owned
/// @param sigma_s   cells that do not scatter do not count for whether g varies
/// @throws InvalidInput as Functions(), and naming the first voxel whose g is outside (-1, 1)
PhaseOfMedium ReadPhase(vtkImageData* medium, const Field& g, const Field& sigma_s);

/// Adds all that ReadPhase reads to the key of something that is kept.
void AddPhase(InputsKey& key, vtkImageData* medium);
}
