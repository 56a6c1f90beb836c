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
/// What Algorithms 1 and 2 of Gruson et al. 2012 have in common: directions, boundary conditions, and how a ray's
/// deposits become the stored quantities. How their equations are read where the paper leaves a choice, and what the
/// scheme loses: numerics.md, section 3, Eqs. (9) to (14).
///
/// A ray of direction i, weight w_i (sr), carries radiance L, W / (length^2 sr). Deposits are kept divided by sigma_s,
/// so that fluence, the sum of deposits over all directions, is 4 pi I / sigma_s of the paper and exists in vacuum as
/// well. Light that enters a periodic box sideways starts on the map's lattice, so such a box should be several voxels
/// wide.
class PublishedModel
{
public:
  /// @param channels  3: as if something had colour; 1: as the scene needs
  /// @throws InvalidInput what Check() of medium, illumination and settings throws (PropagationProblem.h), and
  /// CheckPublished; directions that are not a square number
  PublishedModel(
    const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels = 1);

  int Channels() const { return this->ChannelCount; } ///< 3 where medium or light is coloured, else 1
  const DirectionSet& Directions() const { return this->Set; }

  /// Radiance that enters along `direction` through the face across `axis` in order 0.
  const Rgb& Boundary(int direction, int axis) const { return this->BoundaryRadiances[direction][axis]; }

  /// Directions of I: one (0, 0, 0) for its mean over all directions, or settings.storedDirections.
  const std::vector<std::array<double, 3>>& StoredDirections() const { return this->Stored; }
  /// Directions of U: the six faces where I has one, else those of I.
  const std::vector<std::array<double, 3>>& SourceDirections() const { return this->Sources; }
  /// d(i) of Eq. (3), an index into SourceDirections.
  int SourceOf(int direction) const { return this->NearestSource[direction]; }

  /// A moment is a sum over directions of a coefficient times a voxel's mean radiance in that direction. Moment 0 is
  /// the fluence; the scattered radiance per source direction and the net flux follow where they are not multiples of
  /// it.
  int MomentCount() const { return static_cast<int>(this->Coefficients.size()); }
  double Coefficient(int moment, int direction) const { return this->Coefficients[moment][direction]; }

  /// A quantity as a multiple of a moment.
  struct Part
  {
    int moment = 0;
    double factor = 1.0;
  };
  /// All moments of light of fluence 1 that another solver found, as if the part of it that goes along its mean
  /// direction (whose length that is) came along the nearest direction of the set, the rest along all. Its net flux is
  /// its own.
  std::vector<double> MomentsAlong(const std::array<double, 3>& mean) const;
  Part Source(int sourceDirection) const;
  Part ScatteredRadiance(int storedDirection) const;
  int NetFlux(int axis) const { return this->FirstFlux + axis; } ///< which moment

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

/// Why a scene cannot be solved as published: the phase function varies by voxel or channel, or faces reflect. Empty:
/// it can.
std::string WhyNotPublished(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput with that
void CheckPublished(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput where a face reflects: no paper has such faces
void CheckPublishedFaces(const Illumination& illumination);

/// Lights that the published scheme cannot carry, for LightField::leftOut; empty if none.
std::vector<std::string> LeftOutAsPublished(const Illumination& illumination);

/// Adds to the moments of an order light that another solver found.
/// @param add  adds a value to a moment of a voxel and channel
void AddGiven(const PublishedModel& model, const UncollidedImage& image, std::size_t voxels,
  const std::function<void(std::size_t moment, std::size_t voxel, int channel, double value)>& add);

/// Fluence, scattered radiance and, on request, net flux from the moments of all orders; what was left out, and whether
/// the light has converged. `field` has its convergence.
/// @param moment  by number: by voxel with channels interleaved
void WritePublishedLight(const PublishedModel& model, const Medium& medium, const MediumTraits& traits,
  const Illumination& illumination, const PropagationSettings& settings,
  const std::function<std::vector<float>(int)>& moment, LightField& field);

class GridWalk;

/// The rays of a direction as its map goes through the grid plane by plane along the axis of its face.
struct MapGeometry
{
  MapGeometry(
    const Grid& grid, const PropagationSettings& settings, const Direction& direction, int index, int perFace);

  int axis, axisU, axisV; ///< marching axis; those across it, u the faster one in the map's memory
  int planes, sizeU, sizeV;
  bool forward;          ///< towards +axis
  double slopeU, slopeV; ///< voxels moved per plane
  double length;         ///< of a ray in one plane
  double beamPower;      ///< W that a ray carries at radiance 1: weight, area across the ray
  double density;        ///< mean radiance in a voxel that a ray deposits per radiance times length, 1/length

  int PlaneAt(int crossed) const { return this->forward ? crossed : this->planes - 1 - crossed; } ///< after so many
  int EntryFace(int entryAxis) const; ///< 2 axis (+ 1 on the upper side): through which light of this direction enters
  int ExitFace(int exitAxis) const { return this->EntryFace(exitAxis) ^ 1; }
  /// Where in its voxel, [0, 1], a ray begins an order that it began at `start` in order 0. Other than `start` where it
  /// went on through a periodic axis.
  double StartOfOrder(double start, double slope, int order) const;
  /// The way of a ray of one of the resolution^2 sub-maps, row by row, in an order.
  GridWalk Walk(int resolution, int subMap, int order) const;

private:
  std::array<bool, 3> Upward;
  bool Continues; ///< behind the last plane
};

/// Follows one ray from voxel to voxel (Amanatides and Woo 1987), in double. Crossings closer than 1e-9 of a plane
/// happen together, so that all rays of a direction agree on ties. What happens together with the end is left to the
/// next order.
class GridWalk
{
public:
  /// @param startU, startV  where the ray starts in its voxel, [0, 1]
  GridWalk(double startU, double startV, double slopeU, double slopeV, int planes);

  int moveU = 0; ///< voxels to move before the segment: -1, 0, 1
  int moveV = 0;
  int plane = -1;        ///< the segment's plane, counted from where the ray starts
  double fraction = 0.0; ///< the segment's length over a plane's

  bool Next(); ///< to the next segment; false behind the last plane

private:
  int Planes;
  double Depth = 0.0, NextU, NextV, StepU, StepV;
  int SignU, SignV;
};
}
