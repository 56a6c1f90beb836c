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
/// Arrays that a ray caster reads beside those of MediumArray, by the numbers of SetInputArrayToProcess.
enum ViewedArrays
{
  ViewedFluence = 3,
  ViewedFluenceDirect = 4,
  ViewedIndex = 5,
  ViewedMeanDirection = 6,
  ViewedArrayCount = 7
};

/// Their names where none was chosen.
constexpr const char* ViewedNames[ViewedArrayCount] = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct",
  "ior", "mean_direction" };

/// Values of the faces of the whole image, cell by cell (BoxFaces.h); none where they are not known.
struct FaceValues
{
  std::vector<float> values;
  int components = 0;

  Field Seen() const { return { this->values.empty() ? nullptr : this->values.data(), this->components }; }
};

/// A medium and its light as a picture shows them: what its arrays say, and the memory they are in.
struct ViewedInputs
{
  MediumInput medium;
  FloatField fluence, direct, ior, meanDirection;
  MomentsInput moments;
  FaceValues surface, power, albedo; ///< light at the faces

  SolvedLight Light() const;
};

/// @param whole  the grid of which the image is a part; light at faces is known of all of that
/// @throws InvalidInput  as ReadChosenCells and Check
ViewedInputs ReadViewed(vtkMediumRayCaster* filter, vtkImageData* image, const Grid& whole);

/// A number for which arrays an image has that pictures read, and for what of its field data is used: what the pieces
/// of ranks have to have alike.
double ArraysInANumber(vtkMediumRayCaster* filter, vtkImageData* image);

/// What light at the faces of the whole belongs to those of a block's arrays.
void KeepFacesOf(const GridBlock& block, const std::array<int, 3>& size, ViewedInputs& inputs);

/// The inputs of the voxels of a box, of all ranks, each of which knows those of its block. All ranks call it.
/// @param wanted  by rank, in voxels of the whole; of no voxels where a rank has no block
/// @param given   what the arrays of `inputs` are of; with the block in it
/// @param image   whose field data say how the medium scatters
/// @param inputs  of a rank without a block: nothing
ViewedInputs SpreadTo(const std::vector<VoxelBox>& wanted, const VoxelBox& given, Communicator& communicator,
  const BlockPartition& partition, vtkImageData* image, const ViewedInputs& inputs);

/// One array of the same, as numbers.
std::vector<float> SpreadTo(const std::vector<VoxelBox>& wanted, const VoxelBox& given, Communicator& communicator,
  const BlockPartition& partition, const Field& field);
}
