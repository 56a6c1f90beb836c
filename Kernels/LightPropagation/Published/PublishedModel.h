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
/// Model shared by Algorithms 1 and 2 of Gruson et al. 2012: directions, boundary radiance, and the moments into which
/// a ray's deposits are summed. Interpretation of the paper's equations, and losses of the scheme: numerics.md, section
/// 3, Eqs. (9) to (14).
///
/// A ray of direction i, weight w_i (sr), carries radiance L, W / (length^2 sr). Deposits are stored divided by
/// sigma_s, so that fluence, the sum of deposits over all directions, is 4 pi I / sigma_s in the paper's notation, and
/// exists in vacuum too. If a box is periodic along some axes, rays of light that enters through a face parallel to the
/// marching axis start at the same positions within their voxels as all rays of the map, not at the face. Such a box
/// should therefore be several voxels wide.
class PublishedModel
{
public:
  /// @param channels  3: three channels even if medium and light are grey; 1: as many as the scene needs
  /// @throws InvalidInput  from Check() of medium, illumination and settings (PropagationProblem.h) and from
  ///   CheckPublished; if the number of directions is not a square
  PublishedModel(
    const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels = 1);

  /// Number of channels: 3 if medium or light is coloured or three were requested, else 1.
  int Channels() const { return this->ChannelCount; }
  const DirectionSet& Directions() const { return this->Set; }

  /// Incident radiance, W / (length^2 sr), along `direction` through the upstream face normal to
  /// `axis`, before the first scattering.
  const Rgb& Boundary(int direction, int axis) const { return this->BoundaryRadiances[direction][axis]; }

  /// Directions for which the scattered radiance I is stored: a single (0, 0, 0) for the mean over all directions, or
  /// settings.storedDirections directions.
  const std::vector<std::array<double, 3>>& StoredDirections() const { return this->Stored; }
  /// Directions for which the source U is stored: the six face normals if StoredDirections() has a single entry, else
  /// StoredDirections().
  const std::vector<std::array<double, 3>>& SourceDirections() const { return this->Sources; }
  /// Index of the entry of SourceDirections() nearest to `direction`: d(i) of Eq. (3).
  int SourceOf(int direction) const { return this->NearestSource[direction]; }

  /// Number of moments. A moment is the sum over directions of a coefficient times the mean radiance of a voxel in that
  /// direction. Moment 0 is the fluence. Further moments are the scattered radiance of each source direction and the
  /// net flux, unless they are multiples of moment 0.
  int MomentCount() const { return static_cast<int>(this->Coefficients.size()); }
  /// Coefficient of a direction's mean radiance in a moment.
  double Coefficient(int moment, int direction) const { return this->Coefficients[moment][direction]; }

  /// A quantity expressed as a factor times one of the moments.
  struct Part
  {
    int moment = 0;
    double factor = 1.0;
  };
  /// All moments of light of fluence 1 and mean direction `mean`, for light that another solver computed. A fraction
  /// |mean| of this light is assigned to the nearest direction of the quadrature; the remainder is isotropic. The net
  /// flux is exact.
  std::vector<double> MomentsAlong(const std::array<double, 3>& mean) const;
  /// Scattering source U along one of the directions for which it is stored, divided by sigma_s.
  Part Source(int sourceDirection) const;
  /// Scattered radiance I of a stored direction, divided by sigma_s.
  Part ScatteredRadiance(int storedDirection) const;
  /// Index of the moment that is the net flux along `axis`.
  int NetFlux(int axis) const { return this->FirstFlux + axis; }

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

/// Reason why the published scheme cannot solve a scene; empty if it can. Reasons: the phase function varies between
/// voxels or channels, or faces reflect.
std::string WhyNotPublished(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput if WhyNotPublished() is not empty; the error's text is that reason
void CheckPublished(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput if a face reflects: neither published algorithm has reflecting faces
void CheckPublishedFaces(const Illumination& illumination);

/// Lights that the published scheme does not support, as texts for LightField::leftOut; empty if there are none.
std::vector<std::string> LeftOutAsPublished(const Illumination& illumination);

/// Adds the uncollided light of another solver to the moments of an order.
/// @param add  called to add a value to one moment of one voxel and channel
void AddGiven(const PublishedModel& model, const UncollidedImage& image, std::size_t voxels,
  const std::function<void(std::size_t moment, std::size_t voxel, int channel, double value)>& add);

/// Writes fluence, scattered radiance and, if requested, net flux to `field`, from the moments of all orders. Also sets
/// its members leftOut and converged. field.convergence must be set before.
/// @param moment  returns the values of the moment with a given index, [voxel][channel]
void WritePublishedLight(const PublishedModel& model, const Medium& medium, const MediumTraits& traits,
  const Illumination& illumination, const PropagationSettings& settings,
  const std::function<std::vector<float>(int)>& moment, LightField& field);

class GridWalk;

/// Geometry of the rays of one direction, whose map marches plane by plane along the normal of the direction's cube
/// face.
struct MapGeometry
{
  MapGeometry(
    const Grid& grid, const PropagationSettings& settings, const Direction& direction, int index, int perFace);

  int axis, axisU, axisV; ///< marching axis; transverse axes, u the faster one in the map's memory
  int planes, sizeU, sizeV;
  bool forward;          ///< whether rays march towards increasing index along `axis`
  double slopeU, slopeV; ///< transverse shift per plane, in voxels
  double length;         ///< path length of a ray in one plane of voxels
  double beamPower;      ///< power of a ray at radiance 1: weight times perpendicular area, length^2 sr
  /// density_i of Eq. (13), 1/length: a ray's radiance times its path length in a voxel, times this factor, is its
  /// contribution to the mean radiance of the voxel
  double density;

  /// Index along `axis` of the plane of voxels that rays enter after crossing `crossed` planes.
  int PlaneAt(int crossed) const { return this->forward ? crossed : this->planes - 1 - crossed; }
  /// Face across `entryAxis` through which this direction enters: index 2 * entryAxis, or 2 * entryAxis + 1 for the
  /// upper side.
  int EntryFace(int entryAxis) const { return 2 * entryAxis + (this->Upward[entryAxis] ? 0 : 1); }
  int ExitFace(int exitAxis) const { return this->EntryFace(exitAxis) ^ 1; }
  /// Transverse position within its voxel, 0 to 1, at which a ray begins order `order` if it began order 0 at `start`.
  /// Differs from `start` if the ray has wrapped around a periodic axis.
  double StartOfOrder(double start, double slope, int order) const;
  /// Path of the rays of one sub-map in a scattering order. Rays start at resolution^2 positions within their voxels;
  /// the rays that start at the same position form a sub-map. Sub-maps are numbered row by row.
  GridWalk Walk(int resolution, int subMap, int order) const;

private:
  std::array<bool, 3> Upward;
  bool Continues; ///< whether rays wrap around the marching axis after the last plane
};

/// Traverses the voxels along one ray (Amanatides and Woo 1987), in double precision. Two voxel boundaries whose
/// distance along the ray is less than 1e-9 of its path through a plane are crossed at once, so that rounding affects
/// all rays of a direction equally. A boundary at the very end of the path is crossed in the next order.
class GridWalk
{
public:
  /// @param startU, startV  position within the first voxel, [0, 1]
  GridWalk(double startU, double startV, double slopeU, double slopeV, int planes);

  int moveU = 0; ///< move into the next voxel along u before the segment, voxels: -1, 0 or 1
  int moveV = 0;
  /// Plane of voxels that the segment crosses, counted from where the ray starts; -1 before the first call of Next()
  int plane = -1;
  double fraction = 0.0; ///< length of the segment, relative to the length of the ray within the plane

  bool Next(); ///< moves to the next segment; false beyond the last plane

private:
  int Planes;
  double Depth = 0.0, NextU, NextV, StepU, StepV;
  int SignU, SignV;
};
}
