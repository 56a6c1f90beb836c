#pragma once

#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include "Device/Monitor.h"

#include <array>
#include <optional>
#include <vector>

namespace tyndall
{
/// The rays of the sequential algorithm as published (SequentialPropagation.h), one after the other, through a grid or
/// through whole planes of it.
///
/// Exponentials are the library's, in double; radiance is float. Memory: about as many floats a voxel and channel as
/// there are directions of U, and doubles as there are moments.
class SequentialRays
{
public:
  /// @param whole  the grid; must stay, as do model and settings
  /// @param slab   planes of it that are here, through which maps along their axis alone go; none: all of them
  /// @param medium  of these planes
  SequentialRays(const Grid& whole, const std::optional<PublishedSlab>& slab, const Medium& medium,
    const PublishedModel& model, const PropagationSettings& settings);

  void DarkenMoments(); ///< an order is about to begin

  /// All rays of one direction's map through the planes that are here.
  /// @param order  from 0: in it light comes in from outside
  /// @param given  radiance of the rays ahead of these planes, [map row][map column][channel] of where they began: as
  ///   they left the planes before in this order, or the box through a periodic axis in the last; empty: none
  /// @param faces  of the whole box, told what leaves
  /// @param tally  added to
  /// @param monitor  given fractions of the map
  /// @return radiance behind these planes, likewise; behind the last of a periodic axis by where rays go on in the next
  ///   order. Empty where rays leave the box there
  std::vector<float> Send(int direction, int order, const std::vector<float>& given, PublishedFaces& faces,
    SweepTally& tally, const Monitor& monitor);

  MapGeometry MapOf(int direction) const;       ///< through the whole grid
  std::size_t FloatsOfMap(int direction) const; ///< of what is given and returned

  /// Of the order, of the voxels that are here, channels interleaved.
  std::vector<double>& Moment(int moment) { return this->Moments[moment]; }
  const std::vector<double>& Moment(int moment) const { return this->Moments[moment]; }
  /// U of a direction, likewise, at first the medium's emission; empty where no map here reads it.
  std::vector<float>& Source(int sourceDirection) { return this->Sources[sourceDirection]; }

private:
  struct Ray
  {
    int direction;
    int u, v;
    float radiance[3];
  };

  /// What one map is sent with.
  struct Sending
  {
    const MapGeometry& map;
    int order;
    PublishedFaces& faces;
    SweepTally& tally;
    const float* source;
  };

  bool IsHere(const MapGeometry& map, int plane) const;
  static int PlaneAt(const MapGeometry& map, int onTheWay);
  void Start(Ray& ray, const float* given, const Sending& sending) const;
  void Follow(Ray& ray, double startU, double startV, const Sending& sending);
  void Move(Ray& ray, int w, int moveU, int moveV, const Sending& sending) const;
  void Enter(Ray& ray, const Rgb& boundary, const Sending& sending) const;
  void Leave(const Ray& ray, int axis, int w, double power, const Sending& sending) const;
  void ComeBack(Ray& ray, int axis, int w, double share, const Sending& sending) const;
  std::size_t CellOf(int face, const Ray& ray, int w, const Sending& sending) const;
  void CrossVoxel(Ray& ray, const float* source, std::size_t first, double length, double density);

  const Grid& Whole;
  std::optional<PublishedSlab> Slab;
  std::array<int, 3> Size; ///< of what is here
  const PublishedModel& Model;
  const PropagationSettings& Settings;
  int Channels;
  std::vector<float> Extinction, Scattering;
  std::vector<std::vector<float>> Sources;
  /// Of this order. Where voxels are flat a ray comes by thousands of times: as floats their sums were off by 6e-4.
  std::vector<std::vector<double>> Moments;
  std::vector<float> Coefficients; ///< of the moments, for the direction that is under way
};
}
