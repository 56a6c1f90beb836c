#pragma once

#include "Scene/VolumeCoefficients.h"

#include <vector>

class vtkAlgorithm;
class vtkImageData;

namespace tyndall
{
/// Adds the cell arrays of a medium made of transfer functions: sigma_a, sigma_s and, if the colour is emitted,
/// emission. Coefficients are means over the voxel (VoxelMeans). Hidden voxels are empty.
/// @param filter  its array number 0 (SetInputArrayToProcess) has the scalars
/// @param input  cells that are voxels around points (AreMadeAroundPoints) have a medium between the points alone
/// @return the extinction of each voxel in the first channel, 1/length
/// @throws InvalidInput if the array or its number of components does not suit (CoefficientsOf)
std::vector<float> AddMediumOfVolume(
  vtkAlgorithm* filter, VolumeAppearance appearance, vtkImageData* input, vtkImageData* output);
}
