#pragma once

#include "Common/LightTransportData.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SolvedLight.h"

#include <array>
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

/// Crops the values on the faces of the whole grid to the faces of a block's arrays.
/// @param size  voxels of the block's arrays
void KeepFacesOf(const GridBlock& block, const std::array<int, 3>& size, ViewedInputs& inputs);

/// Gathers the inputs of the voxels in this rank's wanted box from the ranks' blocks. Collective.
/// @param wanted  boxes by rank, in voxels of the whole; empty if a rank has no block
/// @param given   box of the arrays of `inputs`, which contains this rank's block
/// @param image   its field data describe the phase function
/// @param inputs  empty on a rank without a block
ViewedInputs SpreadTo(const std::vector<VoxelBox>& wanted, const VoxelBox& given, Communicator& communicator,
  const BlockPartition& partition, vtkImageData* image, const ViewedInputs& inputs);

/// As above, for one array.
std::vector<float> SpreadTo(const std::vector<VoxelBox>& wanted, const VoxelBox& given, Communicator& communicator,
  const BlockPartition& partition, const Field& field);
}
