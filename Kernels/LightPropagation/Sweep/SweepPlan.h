#pragma once

#include "LightPropagation/Angular/AngularValues.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/SweepShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Device.h"

#include <array>
#include <vector>

namespace tyndall
{
/// How a sweep goes: its bundles' place in memory, the units of work that march at the same time, and which planes each
/// crosses in which launch. Worked out once on the host.
struct SweepPlan
{
  /// @param box  the part of the grid that is swept; all of it, or no axis is periodic
  /// @param netFlux  the net flux is wanted too
  /// @param partialCurrents  and the power that enters voxels by face
  /// @param angular  of the bundles' directions, must stay; null: light has no angular moments
  /// @param moments  where they are
  /// @param faceIn  light comes in by cells of the box's faces
  /// @param octantSource  voxels shine otherwise into each octant
  SweepPlan(const Device& device, const Grid& grid, const VoxelBox& box, int axis, const std::vector<Bundle>& bundles,
    int channels, const std::array<bool, 3>& periodic, bool netFlux, bool partialCurrents, const AngularValues* angular,
    const MomentPlaces& moments, bool faceIn, bool octantSource);

  Grid grid;
  VoxelBox box;
  PlaneAxes axes;
  std::vector<Bundle> bundles; ///< of 1, 2, 4 or 8 members: what the kernels are compiled for
  int channels;
  std::array<bool, 3> periodic;
  bool netFlux;
  bool partialCurrents;
  const AngularValues* angular;
  bool faceIn;
  bool octantSource;
  MomentPlaces moments;
  bool forward = false; ///< some rays march that way
  bool backward = false;

  int vector = 8;   ///< floats of a work-item's vector
  int row = 0;      ///< floats of a padded row
  int rowsKept = 0; ///< of planes in scratch, where each is packed just before it is crossed; 0: all
  PlaneInfo plane = {};
  std::vector<BundleInfo> bundleRows;
  std::size_t mapsEachWay = 0; ///< floats of the maps, the rows outside and the radiances at the faces, one way
  std::size_t outsideEachWay = 0;
  std::size_t radianceEachWay = 0;
  std::vector<float> coefficients; ///< as BundleInfo has them, forward first
  std::size_t coefficientsEachWay = 0;
  FunctionOrder order;         ///< of the angular functions, along this axis
  bool momentsInPlace = false; ///< rows of planes are rows of the moments' array: nothing needs to be packed
  int momentRow = 0;           ///< floats of a packed row, of all functions from the second on and channels

  std::vector<UnitInfo> units;
  std::vector<cl_int2> schedule; ///< [launch][unit]: planes from, to
  int launches = 0;
  double secondsPerLaunch = 0.0; ///< at most, on a slow core
  int laps = 1; ///< times that a sweep's rays start anew on a short periodic axis, so that their pattern has room
  std::vector<cl_int2> roundSchedule; ///< for going round a periodic axis, one unit at a time

  int Planes() const { return this->box.size[this->axes.axis]; }
  int PatternPlanes() const { return this->Planes() * this->laps; } ///< that the rays of a sweep start in
  /// Planes of the grid that rays of a way (0 forward) have crossed before they come to the box.
  int PlanesBefore(int way) const;
  int CrossingPlanes() const; ///< that rays cross to the box's end, either way: of the pattern, from its beginning
  std::size_t ScratchFloats() const; ///< of one unit

  /// [plane][bundle], planes counted on from `firstPlane`.
  std::vector<CrossingInfo> Crossings(int firstPlane, int planes) const;
  /// [unit][plane] how the medium's own light gets out of the voxel where it starts.
  /// @param lapPlanes  that rays had crossed when they began this lap
  std::vector<OwnLightInfo> OwnLight(int lapPlanes = 0) const;
  /// Where each angular function is in a group of moments (MomentPlacesShared.h), in the order of this axis; of the
  /// first, which is not in one, and where light has no moments, 0.
  std::vector<cl_int> FunctionPlaces() const;
  void DescribeMoments(SweepInfo& info) const;
  /// Rays go on from the end of the grid in planes of the pattern beyond those of its own; before OwnLight().
  void LetRaysGoOn();

private:
  void LayLaps();
  void LayPlane(const Device& device);
  int PlanesChained(const Device& device) const;
  void LayMoments();
  void LayBundles();
  BundleInfo Describe(const Bundle& bundle) const;
  void LayFrames();
  int ParitiesOf(const Bundle& bundle) const;
  void LayCoefficients(std::size_t bundle, int way);
  void LayUnits(int computeUnits);
  std::vector<int> SlabBorders(int groups);
  void LaySchedule();
  void LayRounds();
  int RaysPerUnit() const;
  double LongestSegment() const;
  OwnLightInfo OwnLightOf(const UnitInfo& unit, int plane) const;
};
}
