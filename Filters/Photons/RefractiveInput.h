#pragma once

#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Photons/Marching/PhotonMarcher.h"

#include "vtkTimeStamp.h"

#include <cstdint>
#include <memory>
#include <vector>

/// The medium that photons march through, as filters read it and cache it on the device.
namespace tyndall
{
/// A medium with its refractive index and octree, and the arrays that own their values.
struct RefractiveInput
{
  MediumInput input;
  FloatField ior;                   ///< refractive index; if there is none, 1 everywhere
  std::vector<std::uint8_t> levels; ///< octree level of each voxel; empty if there is no octree

  const std::uint8_t* Levels() const { return this->levels.empty() ? nullptr : this->levels.data(); }
};

/// Reads the medium of an image (see ReadMedium) with its cells `ior` (1 component, optional) or those chosen as number
/// RefractiveIndex, and cells `octree_level`, if there are any, of `octree` or, if that is null, of the medium.
/// @throws InvalidInput as ReadMedium, and if the octree's voxels differ from the medium's or it has no levels
RefractiveInput ReadRefractiveMedium(vtkAlgorithm* filter, vtkImageData* medium, vtkImageData* octree = nullptr);
/// The same for a rank's block of a domain. Collective.
/// @param medium, octree  images of the block; null if it has no voxels
/// @throws InvalidInput, the same on all ranks
RefractiveInput ReadRefractiveMedium(
  vtkAlgorithm* filter, const Domain& domain, vtkImageData* medium, vtkImageData* octree = nullptr);

/// Cache of the PhotonMarcher of a filter's medium. It is prepared again only if something that it depends on has
/// changed: what ReadRefractiveMedium reads, the settings or the device. It does not depend on lights and photons.
class KeptMarcher
{
public:
  struct Found
  {
    InputsKey key; ///< holds the device
    std::unique_ptr<PhotonMarcher> marcher;
    bool kept = false; ///< whether the cached marcher was still valid
  };

  /// Returns the marcher for these settings: cached if the domain is serial, or newly prepared. The cache is empty
  /// until Keep, so that nothing invalid remains after an error. Collective.
  /// @param medium, octree  images of this rank's block; null if it has no voxels
  /// @throws InvalidInput as ReadRefractiveMedium and PhotonMarcher
  /// @throws DeviceError
  Found Find(vtkAlgorithm* filter, const std::shared_ptr<Device>& device, const Domain& domain, vtkImageData* medium,
    vtkImageData* octree, const MarchSettings& settings);
  void Keep(Found&& found); ///< of a serial domain

  /// Frees the marcher if a filter upstream of these ports has run. To be called in RequestUpdateExtent, too, so that
  /// device memory is free before upstream filters run, which may need it.
  void ForgetIfRan(vtkAlgorithm* filter, std::initializer_list<int> ports);
  void Forget() { this->Marcher.reset(); }

private:
  InputsKey Key; ///< holds the device
  std::unique_ptr<PhotonMarcher> Marcher;
  vtkTimeStamp Made;
};
}
