#pragma once

#include "Photons/Importance/PhotonImportance.h"

class vtkImageData;

/// How importance maps flow between filters.
namespace tyndall
{
/// The map as an image of size x size x lights cells that fill the unit square, a layer per light: cells `importance`
/// (the active scalars; mean 1 per light), field data `light` (number of the light of each layer) and `even` (1:
/// photons are best spread evenly).
void WriteImportanceMap(const Importance& importance, vtkImageData* output);

/// What the map was made of, as an image of the coarse cells: `fluence` (active), `photon_count`, `origin_mean`,
/// `origin_deviation` (2 each, in cells of the map), `gradient`, `chosen`.
void WritePilotLight(Importance&& importance, vtkImageData* output);

/// The map of an image with cells `importance` (1 component) and field data `light` (missing: layers are lights from 0
/// on). Empty: spread photons evenly, because there is no image, it has no cells, or its field data `even` says so.
/// @throws InvalidInput where layers are not square, `light` is not a whole number for each layer, or has a light twice
///   or one that does not exist; and as Check of a map
ImportanceMap ReadImportanceMap(vtkImageData* image, const Illumination& illumination);
}
