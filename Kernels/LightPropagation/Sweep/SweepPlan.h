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
/// On CPUs, a row of voxels has memory for at least this number of voxels, so that one program sweeps all shorter rows.
constexpr int ShortestRow = 64;

/// Properties of a sweep along one axis on which its SweepPlan depends.
struct SweepDescription
{
  Grid grid;
  VoxelBox box = {}; ///< region of the grid that is swept; the whole grid if it is empty or if any axis is periodic
  std::array<bool, 3> periodic = {};
  int channels = 1;
  bool netFlux = false;
  /// Whether the power that enters each voxel through each of its faces is summed
  bool partialCurrents = false;
  /// Values of the angular functions in the bundles' directions; must outlive the plan. Null: no angular moments,
  /// fluence only
  const AngularValues* angular = nullptr;
  MomentPlaces moments = {}; ///< memory layout of the angular moments
  bool faceIn = false;       ///< whether incident radiance is given per cell of the box's faces
  bool octantSource = false; ///< whether the source of a voxel differs between octants of directions
};

/// Description of the sweep of `volume`; periodic[a] tells whether axis a is periodic.
SweepDescription Describe(const SweepVolume& volume, const std::array<bool, 3>& periodic);

/// Plan of a sweep along one axis: memory layout of the bundles, the units of work (groups of bundles that one
/// work-item carries in one sense) that run concurrently, and the planes that each unit of work crosses in each launch.
/// Computed once, on the host.
struct SweepPlan : SweepDescription
{
  SweepPlan(const Device& device, const SweepDescription& sweep, const AxisBundles& rays);

  PlaneAxes axes;
  /// Bundles of 1, 2, 4 or 8 members (directions), the numbers for which the kernels are compiled
  std::vector<Bundle> bundles;
  bool forward = false; ///< whether any rays march from the lower to the upper end of the axis
  bool backward = false;

  int vector = 8; ///< number of floats in a vector of the kernels (SIMD width)
  int row = 0;    ///< number of floats in a row of voxels or rays, with its padding
  /// Number of rows of a plane that scratch memory holds if rows are packed (copied to scratch) just before bundles
  /// cross them; 0: all rows
  int rowsKept = 0;
  PlaneInfo plane = {};
  std::vector<BundleInfo> bundleRows;
  EachWay eachWay = {}; ///< number of floats of each array for one sense of marching
  /// Values of the angular functions (BundleInfo::coefficients), first those for rays that march forward
  std::vector<float> coefficients;
  FunctionOrder order; ///< order in which this marching axis stores the angular functions: by parity along u and v
  /// Whether the array of moments holds each row of a plane contiguously, so that rows need not be packed (copied to
  /// scratch)
  bool momentsInPlace = false;
  /// Number of floats in a row of moments that is packed (copied to scratch): all channels, all functions from the
  /// second on
  int momentRow = 0;

  std::vector<UnitInfo> units;
  /// Range of planes (first, end) that each unit of work crosses in each launch, [launch][unit of work]
  std::vector<cl_int2> schedule;
  int launches = 0;
  double secondsPerLaunch = 0.0; ///< upper estimate of the time of a launch on a slow core, s
  /// Number of laps around the axis in which rays start. Above 1 only on a periodic axis that is too short for the
  /// rays' pattern of moves
  int laps = 1;
  /// Range of planes (first, end) that each unit of work crosses in each launch when rays wrap around a periodic axis,
  /// [launch][unit of work]; only one unit of work runs in each launch
  std::vector<cl_int2> roundSchedule;

  int Planes() const { return this->box.size[this->axes.axis]; }
  /// Number of planes of the ray pattern, after which the sideways moves of rays repeat: the planes of all `laps`
  int PatternPlanes() const { return this->Planes() * this->laps; }
  /// Number of planes of the grid that rays cross before they reach the swept box.
  /// @param way  sense of marching: 0 forward, 1 backward
  int PlanesBefore(int way) const;
  /// Number of planes from where rays start to the end of the swept box, in all laps in which rays start; the larger
  /// number of the two senses of marching.
  int CrossingPlanes() const;
  /// Number of floats of scratch memory per unit of work (the rays that one work-item carries)
  std::size_t ScratchFloats() const;

  /// Sideways moves and segment lengths of rays in each plane, [plane][bundle].
  /// @param firstPlane  first plane, counted from the plane where rays start
  std::vector<CrossingInfo> Crossings(int firstPlane, int planes) const;
  /// Path integral that a unit source in a voxel causes within that voxel, [unit of work][plane].
  /// @param lapPlanes  number of planes that the rays have crossed at the start of this lap around a periodic axis
  std::vector<OwnLightInfo> OwnLight(int lapPlanes = 0) const;
  /// For each angular function, in this axis's order: offset of its values within a group of moments. A group has the
  /// moments of MomentGroup voxels along x (MomentPlacesShared.h). The offset is 0 for the first function, which is
  /// stored elsewhere, and if there are no angular moments.
  std::vector<cl_int> FunctionPlaces() const;
  /// Arguments of the kernel `sweep` that the plan determines.
  SweepInfo Info() const;
  /// Lowers PlaneInfo::thin, the extinction below which a voxel counts as thin. This is necessary for rays that
  /// continue around a periodic axis, because their segments in voxels may be longer than in the first lap. Call before
  /// OwnLight().
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
