#pragma once

#include "BlocksOfRanks.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Lights/Lights.h"
#include "Viewing/MediumRayCaster.h"

#include "vtkTimeStamp.h"

#include <memory>
#include <string>
#include <vector>

class vtkImageData;
class vtkMediumRayCaster;

namespace tyndall
{
/// Indices, for SetInputArrayToProcess, of the arrays that a ray caster reads beside those of MediumArray.
enum ViewedArrays
{
  ViewedFluence = 3,
  ViewedFluenceDirect = 4,
  ViewedIndex = 5,
  ViewedMeanDirection = 6,
  ViewedArrayCount = 7
};

/// Default names of the arrays, by index.
constexpr const char* ViewedNames[ViewedArrayCount] = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct",
  "ior", "mean_direction" };

/// Values on the boundary faces of the whole image, cell by cell (BoxFaces.h); empty if not known.
struct FaceValues
{
  std::vector<float> values;
  int components = 0;

  Field Seen() const { return { this->values.empty() ? nullptr : this->values.data(), this->components }; }
};

/// A medium and its light as input of the ray caster, with the arrays that own the values.
struct ViewedInputs
{
  MediumInput medium;
  FloatField fluence, direct, ior, meanDirection;
  MomentsInput moments;
  FaceValues surface, power, albedo; ///< light at the faces

  SolvedLight Light() const;
};

/// @param whole  the grid of which the image is a part; field data on light at faces covers all of it
/// @throws InvalidInput as ReadChosenCells and Check
ViewedInputs ReadViewed(vtkMediumRayCaster* filter, vtkImageData* image, const Grid& whole);

/// Hash of which of the arrays read an image has, and of the field data used: these must be the same in all ranks'
/// pieces.
double ArraysInANumber(vtkMediumRayCaster* filter, vtkImageData* image);

/// Medium, light and illumination on the device, ready for rendering.
struct CasterScene
{
  InputsKey key;
  vtkTimeStamp made;
  Grid grid;
  bool lightsAlone = false;        ///< there is no fluence, so shadow rays are needed
  std::vector<std::string> doubts; ///< warnings not issued yet
  std::vector<VoxelBox> held;      ///< by rank, the voxels that the rank's ray caster holds
  std::unique_ptr<MediumRayCaster> caster;
};

/// What a scene is made from.
struct SceneSource
{
  vtkMediumRayCaster* filter;
  vtkImageData* image; ///< this rank's piece, or the complete image
  ViewSettings settings;
  const BlocksOfRanks& blocks;
  const GridBlock* alone = nullptr; ///< the image is this block of a larger grid, rendered alone; null: it is not

  const Domain& Over() const { return this->blocks.Over(); }
  /// The block that the image is; null: it is the complete grid.
  const GridBlock* Block() const
  {
    return this->alone ? this->alone : this->Over().IsSerial() ? nullptr : &this->blocks.Own();
  }
};

/// Prepares the scene: of the complete image, of a block that is rendered alone, or of each rank's block with a halo,
/// which is fetched from the neighbours if the input has none. Collective.
/// @return null if this rank has no block
/// @throws on all ranks, if on one
std::unique_ptr<CasterScene> MakeScene(
  const SceneSource& source, const InputsKey& key, const Illumination& illumination);
}
