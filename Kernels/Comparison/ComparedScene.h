#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"
#include "Refraction/Index/RefractiveMedium.h"
#include "Viewing/Scene/Camera.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Transfer of fields between grids whose voxel sizes differ by integer factors, and the scene of a comparison.
namespace tyndall
{
/// Factors along each axis that make voxels `factor` times as large; 1 along axes with a single voxel.
/// @return no value if `factor` does not divide the size of an axis
std::optional<Factors> CoarseningBy(int factor, const Grid& grid);

Grid Coarsened(const Grid& fine, const Factors& factors);

/// Number of voxels of `fine` per voxel of `coarse` along each axis; no value if the numbers are not integers, or the
/// boxes differ by more than a thousandth of a voxel.
std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse);

/// Means of values over coarse voxels; NaN if a fine value is NaN.
/// @param values  `components` per voxel of `fine`, x fastest
/// @param factors  fine voxels per coarse voxel along each axis
std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors);

/// A closed mesh of one material, surrounded by another material.
struct VoxelizedMaterials
{
  Solid inside;
  Material outside;
};

/// The two materials of a voxelised medium, taken from voxels entirely inside and entirely outside the mesh.
/// @param occupancy  fraction of each voxel inside the mesh
/// @throws InvalidInput if no voxel is entirely inside or outside, voxels of one material differ in a coefficient (as
///   with noise, or several materials), or the mesh is open
VoxelizedMaterials MaterialsOf(const Medium& medium, const Field& ior, const Field& occupancy, TriangleMesh&& mesh);

/// The scene that all solvers of a comparison solve. Does not own its arrays.
struct ComparedScene
{
  Medium medium;
  Illumination illumination;
  Field ior;                            ///< refractive index; null: 1 everywhere
  const std::uint8_t* levels = nullptr; ///< octree level of each voxel, for photons; null: no octree
  std::array<bool, 3> periodic = { false, false, false };
  /// Whether a photon emitter can emit the scene's light. False with boundary radiance or a default sky.
  bool suitsEmitter = true;
  /// The mesh that the medium was voxelised from, with its material and the one outside (MaterialsOf); null: none.
  const VoxelizedMaterials* mesh = nullptr;
  std::optional<Camera> camera; ///< camera of the pictures that are compared
  std::array<int, 2> imageSize = { 320, 240 };
  Field seen; ///< fluence that pictures show, W / length^2, in the scene's voxels; null: not known yet

  bool BendsLight() const; ///< whether the refractive index varies
  bool Emits() const;      ///< whether any voxel emits
  /// Reason why photons cannot simulate this scene; empty if they can.
  /// @param all  whether scattered light is wanted as well as uncollided light
  std::string WhyNotByPhotons(bool all) const;
};

/// A scene whose mesh is voxelised anew, on a grid with voxels of the same or of smaller size.
class VoxelizedScene
{
public:
  /// @param scene  scene with a mesh; must outlive this object
  /// @param refinement  voxels per voxel of the scene along each axis
  VoxelizedScene(Device& device, const ComparedScene& scene, int refinement, const VoxelizationSettings& voxelization,
    int filterSize, const Monitor& monitor);
  VoxelizedScene(const VoxelizedScene&) = delete;
  VoxelizedScene& operator=(const VoxelizedScene&) = delete;

  const ComparedScene& Scene() const { return this->Voxelized; }

private:
  RefractiveMedium Voxels;
  ComparedScene Voxelized;
};
}
