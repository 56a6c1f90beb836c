#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Lights/UncollidedImage.h"

#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
/// Common part of Algorithms 1 and 2 of Gruson et al. 2012: directions, boundary conditions, and how the deposits of a
/// ray become the stored quantities. For how the equations are read where the paper leaves a choice, and for the losses
/// of the scheme, see numerics.md, section 3, Eqs. (9) to (14).
///
/// A ray of direction i, weight w_i (sr), carries radiance L, W / (length^2 sr). Deposits are stored divided by
/// sigma_s, so that fluence, the sum of deposits over all directions, is 4 pi I / sigma_s in the paper's notation, and
/// exists in vacuum too. Light that enters a periodic box through a side face starts on the lattice of the map, so such
/// a box should be several voxels wide.
class PublishedModel
{
public:
  /// @param channels  3: solve three channels even if all is grey; 1: as many as the scene needs
  /// @throws InvalidInput  from Check() of medium, illumination and settings (PropagationProblem.h) and from
  ///   CheckPublished; if the number of directions is not a square
  PublishedModel(
    const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels = 1);

  int Channels() const { return this->ChannelCount; } ///< 3 if medium or light is coloured, else 1
  const DirectionSet& Directions() const { return this->Set; }

  /// Boundary radiance in order 0 along `direction` through the face perpendicular to `axis`.
  const Rgb& Boundary(int direction, int axis) const { return this->BoundaryRadiances[direction][axis]; }

  /// Directions of I: a single (0, 0, 0) for the mean over all directions, or settings.storedDirections directions.
  const std::vector<std::array<double, 3>>& StoredDirections() const { return this->Stored; }
  /// Directions of U: the six face normals if I has a single one, else the directions of I.
  const std::vector<std::array<double, 3>>& SourceDirections() const { return this->Sources; }
  /// d(i) of Eq. (3), an index into SourceDirections.
  int SourceOf(int direction) const { return this->NearestSource[direction]; }

  /// Number of moments. A moment is the sum over directions of a coefficient times the mean radiance of a voxel in that
  /// direction. Moment 0 is the fluence. Scattered radiance by source direction and net flux have moments of their own
  /// if they are not multiples of moment 0.
  int MomentCount() const { return static_cast<int>(this->Coefficients.size()); }
  double Coefficient(int moment, int direction) const { return this->Coefficients[moment][direction]; }

  /// A quantity as a multiple of a moment.
  struct Part
  {
    int moment = 0;
    double factor = 1.0;
  };
  /// All moments of light of fluence 1 from another solver. The length of `mean` is the fraction of the light that is
  /// treated as coming along the nearest direction of the set; the rest is spread over all directions. The net flux is
  /// exact.
  std::vector<double> MomentsAlong(const std::array<double, 3>& mean) const;
  Part Source(int sourceDirection) const;
  Part ScatteredRadiance(int storedDirection) const;
  int NetFlux(int axis) const { return this->FirstFlux + axis; } ///< index of the moment

private:
  int ChannelCount = 1;
  bool Isotropic = true;
  int FirstFlux = 0;
  DirectionSet Set;
  std::vector<std::array<Rgb, 3>> BoundaryRadiances;
  std::vector<std::array<double, 3>> Stored;
  std::vector<std::array<double, 3>> Sources;
  std::vector<int> NearestSource;
  std::vector<std::vector<double>> Coefficients;
};

/// Why the published scheme cannot solve a scene: its phase function varies between voxels or channels, or faces
/// reflect. Empty if it can.
std::string WhyNotPublished(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput with the message of WhyNotPublished, if any
void CheckPublished(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput if a face reflects: neither paper has reflecting faces
void CheckPublishedFaces(const Illumination& illumination);

/// Lights that the published scheme does not support, for LightField::leftOut; empty if none.
std::vector<std::string> LeftOutAsPublished(const Illumination& illumination);

/// Adds light from another solver to the moments of an order.
/// @param add  adds a value to a moment of a voxel and channel
void AddGiven(const PublishedModel& model, const UncollidedImage& image, std::size_t voxels,
  const std::function<void(std::size_t moment, std::size_t voxel, int channel, double value)>& add);

/// Writes fluence, scattered radiance and, if requested, net flux from the moments of all orders; also leftOut and
/// converged. field.convergence must be set.
/// @param moment  returns a moment by number, by voxel with channels interleaved
void WritePublishedLight(const PublishedModel& model, const Medium& medium, const MediumTraits& traits,
  const Illumination& illumination, const PropagationSettings& settings,
  const std::function<std::vector<float>(int)>& moment, LightField& field);

class GridWalk;

/// Geometry of the rays of one direction, whose map marches plane by plane along the axis of its cube face.
struct MapGeometry
{
  MapGeometry(
    const Grid& grid, const PropagationSettings& settings, const Direction& direction, int index, int perFace);

  int axis, axisU, axisV; ///< marching axis; transverse axes, u the faster one in the map's memory
  int planes, sizeU, sizeV;
  bool forward;          ///< towards +axis
  double slopeU, slopeV; ///< transverse shift per plane, in voxels
  double length;         ///< of a ray in one plane
  double beamPower;      ///< W that a ray carries at radiance 1: weight times perpendicular area
  double density;        ///< mean radiance that a ray deposits in a voxel, per radiance and length, 1/length

  int PlaneAt(int crossed) const
  {
    return this->forward ? crossed : this->planes - 1 - crossed;
  }                                   ///< the plane after `crossed` planes
  int EntryFace(int entryAxis) const; ///< 2 axis (+ 1 on the upper side): the face where this direction enters
  int ExitFace(int exitAxis) const { return this->EntryFace(exitAxis) ^ 1; }
  /// Transverse position within its voxel, [0, 1], at which a ray begins an order, if it began order 0 at `start`.
  /// Differs from `start` if the ray has wrapped around a periodic axis.
  double StartOfOrder(double start, double slope, int order) const;
  /// Path of a ray of one of the resolution^2 sub-maps, numbered row by row, in an order.
  GridWalk Walk(int resolution, int subMap, int order) const;

private:
  std::array<bool, 3> Upward;
  bool Continues; ///< behind the last plane
};

/// Traverses the voxels along one ray (Amanatides and Woo 1987), in double. Voxel boundaries closer than 1e-9 of a
/// plane are crossed together, so that all rays of a direction treat ties equally. Crossings that coincide with the end
/// of the path are left to the next order.
class GridWalk
{
public:
  /// @param startU, startV  position within the first voxel, [0, 1]
  GridWalk(double startU, double startV, double slopeU, double slopeV, int planes);

  int moveU = 0; ///< voxels to move before the segment: -1, 0, 1
  int moveV = 0;
  int plane = -1;        ///< plane of the segment, counted from the start of the ray
  double fraction = 0.0; ///< length of the segment over that of a whole plane

  bool Next(); ///< moves to the next segment; false beyond the last plane

private:
  int Planes;
  double Depth = 0.0, NextU, NextV, StepU, StepV;
  int SignU, SignV;
};
}
