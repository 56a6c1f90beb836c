#pragma once

#include "Photons/Importance/PhotonImportance.h"

class vtkImageData;

/// Importance maps as VTK data, for exchange between filters.
namespace tyndall
{
/// Writes the map as an image of size x size x lights cells over the unit square, one layer per light: cells
/// `importance` (the active scalars; mean 1 per light), field data `light` (number of the light of each layer) and
/// `even` (1: photons should be spread evenly).
void WriteImportanceMap(const Importance& importance, vtkImageData* output);

/// Writes the pilot light from which the map was computed, as an image of the coarse cells: `fluence` (active),
/// `photon_count`, `origin_mean`, `origin_deviation` (2 components each, in cells of the map), `gradient`, `chosen`.
void WritePilotLight(Importance&& importance, vtkImageData* output);

/// Reads the map from an image with cells `importance` (1 component) and field data `light` (missing: layers are lights
/// 0, 1, ...).
/// @return the map; empty, so photons are spread evenly, if there is no image, it has no cells, or its field data
///   `even` is 1
/// @throws InvalidInput if layers are not square, or `light` is not a whole number for each layer, lists a light twice
///   or one that does not exist; and what Check of a map throws
ImportanceMap ReadImportanceMap(vtkImageData* image, const Illumination& illumination);
}
