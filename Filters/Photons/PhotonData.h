#pragma once

#include "Common/ImageInput.h"
#include "Photons/Emission/PhotonEmitter.h"

#include <array>
#include <optional>

class vtkImageData;
class vtkPolyData;

/// How photons flow between filters.
namespace tyndall
{
class Communicator;

/// Photons as polydata: points (double), a vertex each, point data `direction` (3, unit), `power` (3, RGB, W), `weight`
/// (1: its power over what it had if its light's photons were spread evenly), `light` (1: number of its light, -1 the
/// environment or sky) and `batch` (1: of which of the independent sets it is). `direction` is the active vectors, so
/// that glyphs point along it. Field data `photon_box`: bounds of the box that they were made for, in its own axes.
/// @param axes  of the box, and of the photons as they are emitted: they are written in the scene
void WritePhotons(const EmittedPhotons& emitted, const Grid& box, const OwnAxes& axes, vtkPolyData* output);

/// Where photons were made for another box than that of a medium: both boxes and what to do, as a warning; else empty.
/// Photons that do not say their box are taken as they are.
std::string DoubtOfBox(vtkPolyData* photons, const Grid& medium);

/// Photons of polydata: points, and point data `direction` (3), `power` (1 or 3 components, W), `weight` (missing: 1)
/// and `batch` (missing: 0). Hidden and duplicate points are left out.
/// @param axes  into which they are turned
/// @throws InvalidInput where an array is missing or has another shape, or a batch is not a whole number of 0 to 63
std::vector<Photon> ReadPhotons(vtkPolyData* photons, const OwnAxes& axes);

/// Photons of which each rank has some. Where all have all of them, each takes a part. All ranks call it.
/// @throws InvalidInput as ReadPhotons, on all ranks
std::vector<Photon> ShareOfPhotons(Communicator& communicator, vtkPolyData* given, const OwnAxes& axes);

/// Polylines with point data `power_left` (part of the photon's power that is left there) and cell data `photon` (its
/// number).
/// @param axes  those of the paths, which are written in the scene
void WritePaths(const std::vector<PhotonPath>& paths, const OwnAxes& axes, vtkPolyData* output);

/// Cells `octree_level` of an image as whole numbers; empty where it has none.
/// @throws InvalidInput where a level is not a whole number of 0 to 30
std::vector<std::uint8_t> ReadLevels(vtkImageData* image);
}
