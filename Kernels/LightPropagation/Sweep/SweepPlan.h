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
/// What a sweep along one axis carries and computes, as far as its plan depends on it.
struct SweepDescription
{
  Grid grid;
  VoxelBox box = {}; ///< the part of the grid that is swept; empty, and if any axis is periodic: the whole grid
  std::array<bool, 3> periodic = {};
  int channels = 1;
  bool netFlux = false;
  bool partialCurrents = false; ///< power that enters each voxel through each of its faces
  /// Angular functions in the bundles' directions, must outlive the plan; null: no angular moments, fluence only
  const AngularValues* angular = nullptr;
  MomentPlaces moments = {}; ///< memory layout of the angular moments
  bool faceIn = false;       ///< incident radiance is given for each cell of the box's faces
  bool octantSource = false; ///< the source of a voxel differs between octants of directions
};

/// The sweep of a volume in which these axes are periodic.
SweepDescription Describe(const SweepVolume& volume, const std::array<bool, 3>& periodic);

/// Plan of a sweep along one axis: memory layout of the bundles, the units of work that run concurrently, and the
/// planes that each unit crosses in each launch. Computed once, on the host.
struct SweepPlan : SweepDescription
{
  SweepPlan(const Device& device, const SweepDescription& sweep, const AxisBundles& rays);

  PlaneAxes axes;
  std::vector<Bundle> bundles; ///< of 1, 2, 4 or 8 members: what the kernels are compiled for
  bool forward = false;        ///< whether any rays march forward
  bool backward = false;

  int vector = 8;   ///< floats of a work-item's vector
  int row = 0;      ///< floats of a padded row
  int rowsKept = 0; ///< rows of a plane held in scratch, if rows are packed just before they are crossed; 0: all rows
  PlaneInfo plane = {};
  std::vector<BundleInfo> bundleRows;
  EachWay eachWay = {};            ///< floats for one way, forward or backward
  std::vector<float> coefficients; ///< see BundleInfo::coefficients; forward first
  FunctionOrder order;             ///< order of the angular functions for this axis
  bool momentsInPlace = false;     ///< rows of a plane are rows of the moments' array, so no packing is needed
  int momentRow = 0;               ///< floats of a packed row: all channels and all functions from the second on

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
  /// What a launch of the kernel `sweep` takes from the plan.
  SweepInfo Info() const;
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
