// Structures shared by C++ and the kernels of PublishedPhotons.cl.
#pragma once

#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
/// Parameters of marching through a rank's block of the domain. Positions are in voxels of the domain.
typedef struct
{
  IndexGrid whole; ///< number of voxels of the domain along each axis
  /// Number of voxels of the block along each axis; coefficients, octree levels and light are stored in these voxels.
  IndexGrid own;
  /// Number of voxels, along each axis, of the region in which n is known: the block and two voxels around it.
  IndexGrid known;
  int first[3];      ///< first voxel of the block in the domain
  int knownFirst[3]; ///< first voxel of the region `known` in the domain
  float spacing[3];  ///< edges of a voxel, in units of length
  int stepLimit;     ///< maximum number of steps of a photon
} PublishedMarchInfo;

/// Values of PublishedPhoton::face that are not faces of the volume.
enum
{
  PublishedGivenUp = 6,  ///< the photon was terminated after stepLimit steps
  PublishedElsewhere = 7 ///< the photon continues in another block
};

/// State of a photon at one end of a step.
typedef struct
{
  float position[3]; ///< position in voxels of the domain
  float velocity[3]; ///< n times direction; the unit direction alone before the first step
  float power[3];    ///< power by channel, in the unit of TypicalPower (PublishedPhotons.cxx)
} PublishedPlace;

/// A photon between steps, or between blocks, with the complete state on which its further path depends.
typedef struct
{
  int voxel[3]; ///< voxel of the domain in which the photon continues, if it is in another block
  /// Face of the volume (0 to 5: -x to +z) through which the photon left; or PublishedGivenUp, PublishedElsewhere.
  int face;
  int steps;    ///< number of steps begun; 0: the photon has not started
  int done;     ///< number of voxels on the line of the last step in which the photon has already deposited its light
  int deposits; ///< number of deposits of the photon in voxels
  int givenUp;  ///< number of deposits that were lost because all compare-and-swap attempts failed
  PublishedPlace from, to; ///< states of the photon at the beginning and at the end of its last step
  float deposited[3];      ///< power of all deposits of the photon, by channel, in the unit of PublishedPlace::power
} PublishedPhoton;
SHARED_END
