#pragma once

#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Photons/Marching/PhotonMarcher.h"

#include "vtkTimeStamp.h"

#include <cstdint>
#include <memory>
#include <vector>

/// The medium of photons, as filters read it and keep it prepared.
namespace tyndall
{
/// A medium through which photons march, and the arrays that it sees.
struct RefractiveInput
{
  MediumInput input;
  FloatField ior;                   ///< not there: 1 everywhere
  std::vector<std::uint8_t> levels; ///< of the octree; empty: there is none

  const std::uint8_t* Levels() const { return this->levels.empty() ? nullptr : this->levels.data(); }
};

/// The medium of an image (see ReadMedium) with its cells `ior` (1 component, optional) or those chosen as number
/// RefractiveIndex, and cells `octree_level` of `octree` or, where that is null, of the medium, if it has them.
/// @throws InvalidInput as ReadMedium, and where the octree is of other voxels or has no levels
RefractiveInput ReadRefractiveMedium(vtkAlgorithm* filter, vtkImageData* medium, vtkImageData* octree = nullptr);

/// A PhotonMarcher of a filter's medium, which is prepared once, and again only when something that it was made of has
/// changed: what ReadRefractiveMedium reads, the settings or the device. It does not depend on light and photons.
class KeptMarcher
{
public:
  struct Found
  {
    InputsKey key; ///< holds the device
    std::unique_ptr<PhotonMarcher> marcher;
    bool kept = false; ///< whether nothing had to be prepared
  };

  /// The marcher of the settings, given away until Keep: after an error there is none to keep.
  /// @throws InvalidInput as ReadRefractiveMedium and PhotonMarcher; DeviceError
  Found Find(vtkAlgorithm* filter, const std::shared_ptr<Device>& device, vtkImageData* medium, vtkImageData* octree,
    const MarchSettings& settings);
  void Keep(Found&& found);

  /// To be asked in RequestUpdateExtent, too: memory is given back before the filters before run, which may need it.
  void ForgetIfRan(vtkAlgorithm* filter, std::initializer_list<int> ports);
  void Forget() { this->Marcher.reset(); }

private:
  InputsKey Key; ///< holds the device
  std::unique_ptr<PhotonMarcher> Marcher;
  vtkTimeStamp Made;
};
}
