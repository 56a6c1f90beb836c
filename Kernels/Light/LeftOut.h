#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <string>

namespace tyndall
{
/// What a scene did not need, in the words of `left_out`, the same in every solver.
namespace left_out
{
extern const char* const Grey;           ///< neither medium nor light has colour
extern const char* const OneColour;      ///< the medium is grey, and light has one colour
extern const char* const GreyExtinction; ///< one transmittance for three channels
extern const char* const NoScattering;
extern const char* const NoAbsorption;
extern const char* const NoEmission;
extern const char* const OneOrder; ///< nothing is scattered though the medium could
extern const char* const NetFlux;
extern const char* const MomentsForPictures; ///< what is scattered, by direction
extern const char* const Isotropic;
extern const char* const ConstantIndex;
extern const char* const EmptyBricks;
extern const char* const NoLights;
extern const char* const OwnUncollided;   ///< uncollided light was found by another solver
extern const char* const NoEmissionPeaks; ///< what the medium emits needs no rays of its own
extern const char* const BlackFaces;      ///< no face of the box gives back light
extern const char* const DefaultSky;      ///< nothing was given that shines: light of the filter's own
extern const char* const DarkOutside;     ///< neither environment nor sky nor faces shine
extern const char* const EvenOutside;     ///< they shine evenly: directions of its own are not needed
extern const char* const ThinVoxels;      ///< it does not matter where in voxels light is scattered
extern const char* const NotByOctant;     ///< Source By octant was asked for, but does not go with the scene
extern const char* const NotSideBySide;   ///< what was queued side by side was done one after the other
std::string EmptySlabs(const VoxelBox& filled, const Grid& grid);
std::string DarkDirections(double lit); ///< part of the rays
std::string MirrorImages(int classes, int directions);
std::string TwoAxes(int polarNodes);          ///< nothing varies along them
std::string DirectionsAlongSlab(int perFace); ///< solved with instead
}
}
