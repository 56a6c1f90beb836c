#pragma once

#include "BlocksOfRanks.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Lights/Lights.h"
#include "Viewing/PictureError.h"

#include "vtkTimeStamp.h"

#include <memory>
#include <string>
#include <vector>

class vtkImageData;
class vtkMediumRayCaster;

namespace tyndall
{
/// Indices, for SetInputArrayToProcess, of the arrays that vtkMediumRayCaster reads in addition to those of
/// MediumArray.
enum ViewedArrays
{
  ViewedFluence = 3,
  ViewedFluenceDirect = 4,
  ViewedIndex = 5,
  ViewedMeanDirection = 6,
  ViewedArrayCount = 7
};

/// Default names of the arrays of MediumArray and ViewedArrays, by index.
constexpr const char* ViewedNames[ViewedArrayCount] = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct",
  "ior", "mean_direction" };

/// Values on the boundary faces of the whole grid: one tuple per face of a boundary voxel (ordered by face of the box,
/// -x to +z, and within it with the lower axis fastest), or one tuple per face of the box; empty if unknown.
struct FaceValues
{
  std::vector<float> values;
  int components = 0;

  Field Seen() const { return { this->values.empty() ? nullptr : this->values.data(), this->components }; }
};

/// Input of the ray caster: a medium and its light, with the arrays that own the values.
struct ViewedInputs
{
  MediumInput medium;
  FloatField fluence, direct, ior, meanDirection;
  FloatField fluenceError; ///< read only with EstimateError
  MomentsInput moments;
  double errorLength = 0.0; ///< length over which errors of `fluence` have the same sign; 0: not known
  /// Outgoing radiance and its error, power, albedo and incident radiance at the box's faces.
  FaceValues surface, surfaceError, power, albedo, entering;

  SolvedLight Light() const;
};

/// Reads the medium and the light that the ray caster renders from an image.
/// @param whole  grid of the domain, of which the image is a block; field data on light at faces are for the whole grid
/// @throws InvalidInput if an array has the wrong shape, or the medium is invalid
ViewedInputs ReadViewed(vtkMediumRayCaster* filter, vtkImageData* image, const Grid& whole);

/// Hash of the presence and components of the arrays that the filter reads, and of the field data that it uses: both
/// must be the same in the pieces of all ranks.
double ArraysInANumber(vtkMediumRayCaster* filter, vtkImageData* image);

/// Medium, light and illumination on the device, prepared for rendering.
struct CasterScene
{
  InputsKey key;
  vtkTimeStamp made;
  Grid grid;
  bool lightsAlone = false;        ///< whether there are lights but no fluence, so that shadow rays are used
  std::vector<std::string> doubts; ///< warnings that have not been issued yet
  std::vector<VoxelBox> held;      ///< voxels that the ray caster of each rank holds, by rank
  std::unique_ptr<MediumRayCaster> caster;
  std::unique_ptr<PictureErrorCasters> error; ///< null without EstimateError

  bool Adopt(const ViewSettings& settings)
  {
    return this->caster->Adopt(settings) && (!this->error || this->error->Adopt(settings));
  }
};

/// Input of MakeScene: the image to render, the view settings, and the blocks of all ranks.
struct SceneSource
{
  vtkMediumRayCaster* filter;
  vtkImageData* image; ///< this rank's piece, or the complete image
  ViewSettings settings;
  const BlocksOfRanks& blocks;
  /// Position of `image` in the larger grid of which it is a block, if it is rendered without the other blocks; else
  /// null.
  const GridBlock* alone = nullptr;

  const Domain& Over() const { return this->blocks.Over(); }
  /// Position of `image` in the larger grid of which it is a block; null if it is the complete grid.
  const GridBlock* Block() const
  {
    return this->alone ? this->alone : this->Over().IsSerial() ? nullptr : &this->blocks.Own();
  }
};

/// Prepares a scene on the device: of the complete image, of a block that is rendered alone, or of the block of each
/// rank with a halo, which is gathered from other ranks if the input has none. Collective.
/// @param key  cache key of the scene
/// @return null if this rank has no block
/// @throws InvalidInput as ReadViewed, and as the constructor of MediumRayCaster; on all ranks if on any
std::unique_ptr<CasterScene> MakeScene(
  const SceneSource& source, const InputsKey& key, const Illumination& illumination);
}
