#pragma once

#include "Common/ImageInput.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Importance/PhotonImportance.h"

class vtkImageData;
class vtkPolyData;

/// Conversion of photons, their paths and importance maps to and from VTK data, for exchange between filters.
namespace tyndall
{
class Communicator;

/// Writes photons as polydata: points (double) with one vertex each, and point data: `direction` (unit vector), `power`
/// (red, green, blue, W), `weight` (ratio of the photon's power to its power if the photons of its light were evenly
/// distributed), `light` (number of the photon's light, -1 for the environment or sky) and `batch` (number of the
/// photon's independent set). `direction` is the active vectors, so that glyphs point along it. Field data
/// `photon_box`: bounds of the box that the photons were made for, in the axes of the box.
/// @param box  box that the photons were emitted for
/// @param axes  axes of the box and of the emitted photons; photons are written in the scene's coordinates
void WritePhotons(const EmittedPhotons& emitted, const Grid& box, const OwnAxes& axes, vtkPolyData* output);

/// Text of the warning that the photons were emitted for another box (field data `photon_box`) than the medium's; empty
/// if the boxes are equal or `photon_box` is missing.
std::string DoubtOfBox(vtkPolyData* photons, const Grid& medium);

/// Reads photons from polydata: points, and point data `direction` (3), `power` (1 or 3 components, W), `weight`
/// (missing: 1) and `batch` (missing: 0). Hidden and duplicate points are skipped.
/// @param axes  axes to whose coordinates the photons are transformed
/// @throws InvalidInput if an array is missing or has another shape, or a batch is not a whole number from 0 to 63
std::vector<Photon> ReadPhotons(vtkPolyData* photons, const OwnAxes& axes);

/// Reads this rank's share of the photons: its complete input if inputs differ between ranks; a contiguous range of its
/// input if all ranks have the same. Collective.
/// @param axes  axes to whose coordinates the photons are transformed
/// @throws InvalidInput as ReadPhotons, on all ranks if on any
std::vector<Photon> ShareOfPhotons(Communicator& communicator, vtkPolyData* given, const OwnAxes& axes);

/// Writes photon paths as polylines with point data `power_left` (fraction of the photon's initial power at the point)
/// and cell data `photon` (number of the photon).
/// @param axes  axes of `paths`; the polylines are written in the scene's coordinates
void WritePaths(const std::vector<PhotonPath>& paths, const OwnAxes& axes, vtkPolyData* output);

/// Reads the cell array `octree_level` of an image, one whole number per voxel.
/// @return the levels; empty if the image has no such array
/// @throws InvalidInput if a level is not a whole number from 0 to 30
std::vector<std::uint8_t> ReadLevels(vtkImageData* image);

/// Writes an importance map as an image of size x size x lights cells over the unit square, one layer per light: cells
/// `importance` (the active scalars; mean 1 per light), field data `light` (number of the light of each layer) and
/// `even` (1: photons should be spread evenly).
void WriteImportanceMap(const Importance& importance, vtkImageData* output);

/// Writes the pilot light from which an importance map was computed, as an image of the coarse cells: `fluence`
/// (W/length^2, the active scalars), `photon_count`, `origin_mean`, `origin_deviation` (2 components each, in cells of
/// the map), `gradient` (W/length^2), `chosen` (0 or 1).
void WritePilotLight(Importance&& importance, vtkImageData* output);

/// Reads an importance map from an image with cell array `importance` (1 component) and field data `light` (missing:
/// layers are lights 0, 1, ...).
/// @return the map; empty (evenly distributed photons) if `image` is null, has no cells, or its field data `even` is 1
/// @throws InvalidInput if layers are not square, if `light` is not one whole number per layer, lists a light twice or
///   a light that does not exist, or if a value of `importance` is not above 0 or not finite
ImportanceMap ReadImportanceMap(vtkImageData* image, const Illumination& illumination);
}
