#pragma once

#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Photons/Marching/PhotonMarcher.h"

#include "vtkTimeStamp.h"

#include <cstdint>
#include <memory>
#include <vector>

/// Reading of the medium that photons march through, and its cache on the device, for filters.
namespace tyndall
{
/// A medium with its refractive index and octree, and the arrays that own their values.
struct RefractiveInput
{
  MediumInput input;
  FloatField ior;                   ///< refractive index, one value per voxel; empty: 1 everywhere
  std::vector<std::uint8_t> levels; ///< octree level of each voxel; empty if there is no octree

  const std::uint8_t* Levels() const { return this->levels.empty() ? nullptr : this->levels.data(); }
};

/// Reads the medium of an image (see ReadMedium), its refractive index from cell array `ior` (1 component, optional) or
/// the array that SetInputArrayToProcess(RefractiveIndex, ...) selects, and the optional cell array `octree_level` of
/// `octree` or, if that is null, of the medium.
/// @throws InvalidInput if the medium is invalid (ReadMedium), the voxels of `octree` differ from the medium's, or
///   `octree` has no levels
RefractiveInput ReadRefractiveMedium(vtkAlgorithm* filter, vtkImageData* medium, vtkImageData* octree = nullptr);
/// Reads the medium, refractive index and octree of this rank's block of a domain. Collective.
/// @param medium, octree  images of the block; null if it has no voxels
/// @throws InvalidInput as the serial overload, the same error on all ranks
RefractiveInput ReadRefractiveMedium(
  vtkAlgorithm* filter, const Domain& domain, vtkImageData* medium, vtkImageData* octree = nullptr);

/// Cache of a filter's PhotonMarcher, which holds the prepared medium on the device. The marcher is prepared again only
/// if the medium, the octree, the settings or the device have changed; it does not depend on lights and photons.
class KeptMarcher
{
public:
  struct Found
  {
    InputsKey key; ///< cache key of `marcher`: medium, octree, settings, device; keeps the device alive
    std::unique_ptr<PhotonMarcher> marcher;
    bool kept = false; ///< whether `marcher` is the cached one, prepared by an earlier update
  };

  /// Returns the marcher for these settings: the cached one if it is valid and the domain is serial, else a new one.
  /// Empties the cache until Keep, so that no invalid marcher remains after an error. Collective.
  /// @param medium, octree  images of this rank's block; null if it has no voxels
  /// @throws InvalidInput as ReadRefractiveMedium and PhotonMarcher
  /// @throws DeviceError
  Found Find(vtkAlgorithm* filter, const std::shared_ptr<Device>& device, const Domain& domain, vtkImageData* medium,
    vtkImageData* octree, const MarchSettings& settings);
  void Keep(Found&& found); ///< caches the marcher; to be called only if the domain is serial

  /// Frees the marcher if a filter upstream of these ports has run. To be called also in RequestUpdateExtent, so that
  /// the device memory is free before upstream filters run.
  void ForgetIfRan(vtkAlgorithm* filter, std::initializer_list<int> ports);
  void Forget() { this->Marcher.reset(); }

private:
  InputsKey Key; ///< cache key of Marcher: medium, octree, settings, device; keeps the device alive
  std::unique_ptr<PhotonMarcher> Marcher;
  vtkTimeStamp Made;
};
}
