#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Communicator.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Voxelization/TriangleMesh.h"
#include "Refraction/Voxelization/Voxelization.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// What a place is made of.
struct Material
{
  double n = 1.0;   ///< refractive index, > 0
  Rgb sigma_a = {}; ///< absorption coefficient, 1/length, >= 0
  Rgb sigma_s = {}; ///< scattering coefficient, 1/length, >= 0
  double g = 0.0;   ///< mean cosine of the phase function, in (-1, 1)
};

/// @param name  of what is made of it, for the message
/// @throws InvalidInput where a value is out of its range
void Check(const Material& material, const std::string& name);

/// A solid: what a closed mesh encloses.
struct Solid
{
  std::string name; ///< for messages, e.g. "Mesh 2"
  TriangleMesh mesh;
  Material material;
};

/// Gradient noise on the materials of all solids, as on the cube of Pfeuti 2009, figure 4.9. Outside nothing is
/// perturbed.
struct Perturbation
{
  double index = 0.0;      ///< n becomes n + index * noise, noise in [-1, 1]; must leave n > 0
  double scattering = 0.0; ///< sigma_s becomes sigma_s (1 + scattering * noise), in [0, 1]
  double size = 1.0;       ///< of the noise's features, length, > 0
  std::uint32_t seed = 0;
};

struct RefractiveMediumSettings
{
  Grid grid;
  Material outside;
  Perturbation perturbation;
  VoxelizationSettings voxelization;
  int filterSize = 9; ///< of the smoothing of n, see SmoothIndex
};

/// Solids in a box, as a medium of voxels. Arrays have x fastest; leftOut says which are empty.
struct RefractiveMedium
{
  std::vector<float> occupancy;   ///< part of the voxel inside any solid, [0, 1]
  std::vector<float> ior;         ///< n, smoothed; empty where n is the same everywhere
  std::vector<float> iorGradient; ///< its gradient, 1/length, 3 per voxel; empty where ior is
  std::vector<float> sigma_a;     ///< 1/length, `components` per voxel
  std::vector<float> sigma_s;
  int components = 1; ///< 3 where any material has colour
  double g = 0.0;     ///< mean cosine of the phase function of all voxels; not used where gByVoxel is there
  /// `components` per voxel, of voxels that do not scatter 0; empty where materials that scatter have one g.
  std::vector<float> gByVoxel;
  std::vector<std::string> leftOut;
  std::vector<std::string> warnings; ///< of what is odd about a mesh, for the user
  std::string device;
  double seconds = 0.0; ///< that all of it took
};

/// The smallest box of cubic voxels about solids, these in its middle, that leaves on each side `margin` times the
/// longest edge of their bounds, and one voxel more than the filter reaches.
/// @throws InvalidInput where there is no solid or none with an extent, a point is not finite (names it), a size is
///   below 1, or a margin below 0
Grid GridAround(const std::vector<Solid>& solids, const std::array<int, 3>& size, double margin, int filterSize);

/// Voxelises solids (Pfeuti 2009, section 3.1.2): samples inside are counted, each voxel gets the mean of its materials
/// weighted by their parts of it, n is smoothed, and its gradient taken. Where solids overlap, the last one counts.
///
/// Where materials that scatter have different mean cosines g, a voxel's is their mean weighted by part and sigma_s
/// (numerics.md, Eq. (3e)).
///
/// A mesh that encloses regions more than once or inside out, whose edges disagree about what is outside, or that has
/// triangles without area, is voxelised by parity and gives a warning. Every sample is examined: a single one where it
/// shows is enough.
/// @throws InvalidInput  where a mesh is empty or open (names the count of boundary edges and the place of the first),
///   a number is out of its range, or a voxel's edge beyond 1e-18 to 1e18 lengths
/// @throws DeviceError   at once, if 12 to 56 bytes per voxel do not fit the machine's memory or 4 to 8 more the
///   device's (on a CPU the same memory); they do not grow with the number of solids
RefractiveMedium Voxelize(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const Monitor& monitor = {});

/// What is known of voxels only when all of the box are: of those of a part, or of all.
struct VoxelFindings
{
  std::vector<WindingNumbers> windings; ///< one for each solid
  bool empty = true;                    ///< nothing is inside a solid
  double volume = 0.0;                  ///< inside solids, length^3
};

/// What of the box is made; without voxels: nothing.
struct PartOfBox
{
  VoxelBox made;
  VoxelBox own; ///< in it, what no other part has as its own
};

/// A part of the box, and what is to be said of all of it.
struct VoxelizedPart
{
  RefractiveMedium medium; ///< of the voxels made; without warnings and leftOut
  VoxelFindings findings;  ///< of the part's own
  std::vector<MeshTopology> topologies;
};

/// Voxelize in two steps, of a part of the box, of which no voxels may be made: each voxel gets what it gets of the
/// whole, bit for bit. So many voxels round the part as it depends on (half the filter and two) are voxelised with it.
/// @throws as Voxelize, of the part
VoxelizedPart VoxelizePart(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const PartOfBox& part, const Monitor& monitor = {});

/// The medium of a part of the box.
/// @param all  what was found of all parts. Where that is not known, of this one, and `empty` false: then it is never
///   said that nothing is inside solids, and the index is there in every part unless no solid has another one
RefractiveMedium Concluded(VoxelizedPart&& part, const VoxelFindings& all, const std::vector<Solid>& solids,
  const RefractiveMediumSettings& settings);

/// Of ranks that have parts of their own. All call it.
VoxelFindings FindingsOfAll(Communicator& communicator, const VoxelFindings& own);
}
