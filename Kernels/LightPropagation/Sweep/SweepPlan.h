#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/SweepShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Device.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Plan of a sweep along one axis: memory layout of the bundles, the units of work that run concurrently, and the
/// planes that each unit crosses in each launch. Computed once, on the host.
struct SweepPlan
{
  /// @param box  the part of the grid that is swept; must be the whole grid if any axis is periodic
  /// @param netFlux  the sweep also computes the net flux
  /// @param partialCurrents  the sweep also computes the power that enters each voxel through each of its faces
  /// @param angular  angular functions in the bundles' directions, must outlive the plan; null: no angular moments,
  /// fluence only
  /// @param moments  memory layout of the angular moments
  /// @param faceIn  incident radiance is given for each cell of the box's faces
  /// @param octantSource  the source of a voxel differs between octants of directions
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
  bool forward = false; ///< whether any rays march forward
  bool backward = false;

  int vector = 8;   ///< floats of a work-item's vector
  int row = 0;      ///< floats of a padded row
  int rowsKept = 0; ///< rows of a plane held in scratch, if rows are packed just before they are crossed; 0: all rows
  PlaneInfo plane = {};
  std::vector<BundleInfo> bundleRows;
  /// Floats for one way (forward or backward): of the maps; of the rows outside; of the radiances at the faces
  std::size_t mapsEachWay = 0;
  std::size_t outsideEachWay = 0;
  std::size_t radianceEachWay = 0;
  std::vector<float> coefficients; ///< see BundleInfo::coefficients; forward first
  std::size_t coefficientsEachWay = 0;
  FunctionOrder order;         ///< order of the angular functions for this axis
  bool momentsInPlace = false; ///< rows of a plane are rows of the moments' array, so no packing is needed
  int momentRow = 0;           ///< floats of a packed row: all channels and all functions from the second on

  std::vector<UnitInfo> units;
  std::vector<cl_int2> schedule; ///< [launch][unit], planes from, to
  int launches = 0;
  double secondsPerLaunch = 0.0; ///< upper estimate, for a slow core
  int laps = 1; ///< laps round a short periodic axis in which rays start, so that the ray pattern fits; else 1
  std::vector<cl_int2> roundSchedule; ///< launches that wrap around a periodic axis, one unit at a time

  int Planes() const { return this->box.size[this->axes.axis]; }
  int PatternPlanes() const { return this->Planes() * this->laps; } ///< planes in which the rays of a sweep start
  /// Planes of the grid that rays cross before they reach the box. @param way  0 forward, 1 backward
  int PlanesBefore(int way) const;
  /// Planes of the ray pattern, from its start, that rays cross up to the end of the box; the larger of both ways.
  int CrossingPlanes() const;
  std::size_t ScratchFloats() const; ///< scratch of one unit

  /// How rays cross each plane, [plane][bundle]. @param firstPlane  first plane of the ray pattern
  std::vector<CrossingInfo> Crossings(int firstPlane, int planes) const;
  /// Path of emitted and scattered light within its voxel of origin, [unit][plane].
  /// @param lapPlanes  planes that the rays had crossed when this lap began
  std::vector<OwnLightInfo> OwnLight(int lapPlanes = 0) const;
  /// Position of each angular function in a group of moments (MomentPlacesShared.h), in this axis's order. 0 for the
  /// first function, which is stored elsewhere, and if there are no angular moments.
  std::vector<cl_int> FunctionPlaces() const;
  void DescribeMoments(SweepInfo& info) const;
  /// Lowers the limit for thin voxels (PlaneInfo::thin) so that it also holds on the longer segments of rays that
  /// continue beyond the planes of their pattern. Call before OwnLight().
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
