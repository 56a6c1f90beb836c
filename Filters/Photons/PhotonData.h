#pragma once

#include "Common/ImageInput.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Importance/PhotonImportance.h"

#include <array>
#include <optional>

class vtkImageData;
class vtkPolyData;

/// Photons, and maps of where to start them, as VTK data, for exchange between filters.
namespace tyndall
{
class Communicator;

/// Writes photons as polydata: points (double), with one vertex each, point data `direction` (3, unit), `power` (3,
/// RGB, W), `weight` (1: its power over the power it would have if its light's photons were spread evenly), `light` (1:
/// number of its light, -1 the environment or sky) and `batch` (1: number of the independent set that it belongs to).
/// `direction` is the active vectors, so that glyphs point along it. Field data `photon_box`: bounds of the box that
/// the photons were made for, in the box's own axes.
/// @param axes  axes of the box and of the emitted photons, which are written in the scene's coordinates
void WritePhotons(const EmittedPhotons& emitted, const Grid& box, const OwnAxes& axes, vtkPolyData* output);

/// A warning, with both boxes and advice, if photons were made for another box than the medium's; else empty. Photons
/// without `photon_box` are accepted.
std::string DoubtOfBox(vtkPolyData* photons, const Grid& medium);

/// Reads photons from polydata: points, and point data `direction` (3), `power` (1 or 3 components, W), `weight`
/// (missing: 1) and `batch` (missing: 0). Hidden and duplicate points are skipped.
/// @param axes  axes to whose coordinates the photons are transformed
/// @throws InvalidInput if an array is missing or has another shape, or a batch is not a whole number from 0 to 63
std::vector<Photon> ReadPhotons(vtkPolyData* photons, const OwnAxes& axes);

/// Reads this rank's share of photons that are distributed over ranks. If all ranks have the same photons, each takes a
/// part. Collective.
/// @throws InvalidInput as ReadPhotons, on all ranks if on one
std::vector<Photon> ShareOfPhotons(Communicator& communicator, vtkPolyData* given, const OwnAxes& axes);

/// Writes paths as polylines with point data `power_left` (fraction of the photon's power that is left at the point)
/// and cell data `photon` (its number).
/// @param axes  axes of the paths, which are written in the scene's coordinates
void WritePaths(const std::vector<PhotonPath>& paths, const OwnAxes& axes, vtkPolyData* output);

/// Reads cells `octree_level` of an image as whole numbers; empty if there is no such array.
/// @throws InvalidInput if a level is not a whole number from 0 to 30
std::vector<std::uint8_t> ReadLevels(vtkImageData* image);

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
