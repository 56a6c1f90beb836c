#pragma once

#include "Photons/PhotonEmitter.h"

class vtkImageData;
class vtkPolyData;

/// How photons flow between filters.
namespace tyndall
{
/// Photons as polydata: points (double), a vertex each, point data `direction` (3, unit), `power` (3, RGB, W), `weight`
/// (1: share of the light's photons that its place got, 1 where all places are alike) and `light` (1: number of its light, -1 the
/// environment or sky). `direction` is the active vectors, so that glyphs point along it.
void WritePhotons(const EmittedPhotons& emitted, vtkPolyData* output);

/// Photons of polydata: points, and point data `direction` (3) and `power` (1 or 3 components, W).
/// @throws InvalidInput where an array is missing or has another shape
std::vector<Photon> ReadPhotons(vtkPolyData* photons);

/// Polylines with point data `power_left` (part of the photon's power that is left there) and cell data `photon` (its number).
void WritePaths(const std::vector<PhotonPath>& paths, vtkPolyData* output);

/// Cells `octree_level` of an image as whole numbers; empty where it has none.
/// @throws InvalidInput where a level is not a whole number of 0 to 30
std::vector<std::uint8_t> ReadLevels(vtkImageData* image);
}
