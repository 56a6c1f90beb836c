#pragma once

#include "../Kernels/CubeTurns.h"

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

/// Scenes at the edge of what solvers can do, and what is known of their light.
namespace bench
{
using Vector = std::array<double, 3>;

struct Lamp
{
  enum Kind
  {
    Sun,
    Point,
    Spot, ///< 60 degrees
    Rectangle
  };
  Kind kind = Sun;
  Vector at = {};
  Vector along = { 0.0, 0.0, -1.0 };
  Vector power = { 1.0, 1.0, 1.0 }; ///< W; of a sun W/length^2
  double width = 0.0;               ///< of a rectangle's edges; 0: half a voxel along x
};

/// A medium and what shines on it. Arrays are over the voxels, x fastest, `channels` floats a voxel; empty: 0
/// everywhere.
struct StressScene
{
  std::array<int, 3> cells = { 9, 9, 9 };
  Vector spacing = { 1.0, 1.0, 1.0 };
  int channels = 1;
  std::vector<float> absorption, scattering, emission;
  std::vector<float> index; ///< one a voxel; empty: constant
  double g = 0.0;
  std::vector<Lamp> lamps;
  Vector sky = {};
  std::array<double, 6> faces = {};
  std::array<bool, 3> periodic = {};

  std::size_t VoxelCount() const;
  std::size_t Voxel(int i, int j, int k) const;
  double VoxelVolume() const { return this->spacing[0] * this->spacing[1] * this->spacing[2]; }
  Vector Middle() const; ///< of the middle voxel (of two, the upper one)
  float At(const std::vector<float>& field, std::size_t voxel, int channel) const;
};

/// The scene turned or mirrored.
StressScene Turned(const StressScene& scene, const CubeTurn& turn);

/// The scene with so much of its sky and of its faces' light.
StressScene ShoneUpon(StressScene scene, double part);

/// What a solver has to say to refuse a case that it cannot do.
struct Refusal
{
  std::string method; ///< the solver's name begins with this
  std::string words;  ///< part of the error
};

/// A scene, and what of its light is known without solving it.
struct StressCase
{
  std::string row;  ///< the kind of extreme
  std::string name; ///< which of them
  StressScene scene;
  bool forward = false;                                   ///< of another one with a mean cosine that is not 0
  bool quick = false;                                     ///< also run where there are few seconds
  double furnace = 0.0;                                   ///< radiance everywhere, if not 0
  double bound = std::numeric_limits<double>::infinity(); ///< no radiance is above this
  double middle = 0.0;                                    ///< mean radiance in the middle voxel, if not 0
  double transmitted = -1.0; ///< part of what enters that leaves through +z, if not negative
  double pathInBox = 0.0;    ///< mean length of light's way out of the middle voxel, if not 0
  bool beam = false;         ///< a pure absorber under a sun along -z
  bool shadow = false;       ///< beam, and what is not crossed by it is dark
  std::array<bool, 3> mirrored = { false, false, false }; ///< axes about whose middle the light is symmetric
  std::shared_ptr<StressScene> twin; ///< a scene that is easy, whose light is the same but for `scale`
  double scale = 1.0;                ///< fluence here is that of the twin times this
  int twinChannel = -1;              ///< the twin is grey: this channel alone
  std::shared_ptr<StressScene> rest; ///< light of the twin and of this one add up to that of the scene
  double lampsInside = 1.0;          ///< part of the lamps' power that gets into the box; negative: not known
  bool similarity = false;           ///< the twin is one by the similarity relation, for scattered light
  std::vector<Refusal> refusals;
};

/// All cases, row by row.
std::vector<StressCase> StressCases();
}
