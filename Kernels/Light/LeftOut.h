#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Texts of LightField::leftOut. Each names a part of the computation that the scene did not need; the comments say for
/// which scenes it is used. All solvers use the same texts.
namespace left_out
{
extern const char* const Grey;             ///< text if neither medium nor lights are coloured
extern const char* const GreyMedium;       ///< text if all coefficients of a medium are grey
extern const char* const OneColour;        ///< text if the medium is grey and all lights have the same colour
extern const char* const OneColourOfLight; ///< text if light has the same colour everywhere
extern const char* const GreyExtinction;   ///< text if all channels have the same sigma_t, hence one transmittance
extern const char* const NoScattering;
extern const char* const NoAbsorption;
extern const char* const NoEmission;
extern const char* const
  OneOrder; ///< text if there is only one scattering order: no light is scattered, though the medium could scatter
extern const char* const Acceleration; ///< text if source iteration is faster than an accelerated solve
/// Text if the discrete ordinates chosen cannot be accelerated.
extern const char* const SpiralAcceleration;
extern const char* const NetFlux;
extern const char* const MomentsForPictures; ///< text if angular moments of scattered light were not requested
extern const char* const Isotropic;
extern const char* const ConstantIndex;
extern const char* const EmptyBricks;
extern const char* const NoLights;
extern const char* const OwnUncollided;   ///< text if uncollided light is given by another solver
extern const char* const NoEmissionPeaks; ///< text if there is no localised emission that needs separate rays
extern const char* const BlackFaces;      ///< text if no face of the box reflects
extern const char* const DefaultSky;      ///< text if no light was given, so that the filter used its default sky
extern const char* const DarkOutside;     ///< text if neither environment nor sky nor faces emit light
extern const char* const EvenOutside; ///< text if boundary light is isotropic, so that it needs no separate quadrature
extern const char* const
  ThinVoxels; ///< text if all voxels are optically thin: the position of scattering within a voxel does not matter
/// Text if "By octant" was requested for the setting Source but cannot be used in this scene.
extern const char* const NotByOctant;
extern const char* const NotSideBySide; ///< text if the device does not run two queues concurrently
/// Text stating which part of the voxels does not scatter, so that no source is computed for them.
std::string EmptyVoxels(double part);
/// Text stating which part of the voxels has no medium, so that no angular moments of their light are computed.
std::string EmptyMoments(double part);
std::string EmptySlabs(const VoxelBox& filled, const Grid& grid);
/// Text stating that many directions carry no incident light.
/// @param lit  fraction of the rays that carry incident light
std::string DarkDirections(double lit);
/// Text stating that channels without sources are dark, and were not solved.
std::string DarkChannels(int dark, int channels);
std::string MirrorImages(int classes, int directions);
/// Text stating that photons of some light sources would all miss the volume.
std::string SourcesBesideVolume(int beside, int sources);
/// Text stating which part of the samples emits no photon, because it would miss the volume.
std::string PhotonsBesideVolume(double part);
/// Text stating that a phase function has fewer terms than were asked for, because the eigenvalues of the other terms
/// are 0.
std::string TermsOfZero(int terms, int asked);
/// Text stating that the scene varies along one axis only and was therefore solved as plane-parallel layers.
/// @param polarNodes  number of polar cosines of that solve
std::string TwoAxes(int polarNodes);
/// Text stating that plane-parallel layers were solved with `perFace` directions per cube face instead of the set
/// number.
std::string DirectionsAlongSlab(int perFace);
}

/// Appends the texts of `more` that `texts` does not contain yet.
void AddMissing(std::vector<std::string>& texts, const std::vector<std::string>& more);
}
