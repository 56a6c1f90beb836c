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
/// Optical properties of a homogeneous material.
struct Material
{
  double n = 1.0;   ///< refractive index, > 0
  Rgb sigma_a = {}; ///< absorption coefficient, 1/length, >= 0
  Rgb sigma_s = {}; ///< scattering coefficient, 1/length, >= 0
  double g = 0.0;   ///< mean cosine of the phase function, in (-1, 1)
};

/// @param name  name of the object made of it, for the message
/// @throws InvalidInput if a value is out of range
void Check(const Material& material, const std::string& name);

/// A solid: the region enclosed by a closed mesh.
struct Solid
{
  std::string name; ///< for messages, e.g. "Mesh 2"
  TriangleMesh mesh;
  Material material;
};

/// Gradient noise added to the materials of all solids, as on the cube of Pfeuti 2009, figure 4.9. The outside is not
/// perturbed.
struct Perturbation
{
  double index = 0.0;      ///< n becomes n + index * noise, noise in [-1, 1]; must leave n > 0
  double scattering = 0.0; ///< sigma_s becomes sigma_s (1 + scattering * noise), in [0, 1]
  double size = 1.0;       ///< size of the noise's features, length, > 0
  std::uint32_t seed = 0;
};

struct RefractiveMediumSettings
{
  Grid grid;
  Material outside;
  Perturbation perturbation;
  VoxelizationSettings voxelization;
  int filterSize = 9; ///< filter that smooths n, voxels per edge; see SmoothIndex
};

/// A voxelised scene of solids in a box. Arrays have x fastest; leftOut lists the arrays that are empty.
struct RefractiveMedium
{
  std::vector<float> occupancy;   ///< fraction of the voxel inside any solid, [0, 1]
  std::vector<float> ior;         ///< n, smoothed; empty if n is the same everywhere
  std::vector<float> iorGradient; ///< gradient of n, 1/length, 3 per voxel; empty if ior is
  std::vector<float> sigma_a;     ///< 1/length, `components` per voxel
  std::vector<float> sigma_s;
  int components = 1; ///< 3 if any material has colour
  double g = 0.0;     ///< mean cosine of the phase function in all voxels; not used if gByVoxel is present
  /// Mean cosine, `components` per voxel, 0 in voxels that do not scatter; empty if all scattering materials have one
  /// g.
  std::vector<float> gByVoxel;
  std::vector<std::string> leftOut;
  std::vector<std::string> warnings; ///< irregularities of the meshes, for the user
  std::string device;
  double seconds = 0.0; ///< total duration
};

/// The smallest box of cubic voxels centred on the solids that leaves on each side `margin` times the longest edge of
/// their bounds, and one voxel more than the filter reaches.
/// @throws InvalidInput if there is no solid or none has an extent, a point is not finite (names it), a size is below
///   1, or the margin is below 0
Grid GridAround(const std::vector<Solid>& solids, const std::array<int, 3>& size, double margin, int filterSize);

/// Voxelises solids (Pfeuti 2009, section 3.1.2): counts the samples inside, gives each voxel the mean of its materials
/// weighted by their volume fractions, smooths n, and computes its gradient. Where solids overlap, the last one counts.
///
/// If scattering materials differ in their mean cosines g, a voxel's g is their mean weighted by volume fraction and
/// sigma_s (numerics.md, Eq. (3e)).
///
/// A mesh is voxelised by parity, with a warning, if it encloses regions more than once or inside out, its edges
/// disagree about what is outside, or it has triangles without area. Every sample is examined: a single sample that
/// shows such a fault gives the warning.
/// @throws InvalidInput  if a mesh is empty or open (names the count of boundary edges and the place of the first), a
///   number is out of range, or a voxel's edge is not 1e-18 to 1e18 lengths
/// @throws DeviceError   at once, if 12 to 56 bytes per voxel do not fit the machine's memory, or 4 to 8 more the
///   device's (on a CPU the same memory); the number of solids does not matter
RefractiveMedium Voxelize(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const Monitor& monitor = {});

/// Results that are final only when all voxels of the box are known; those of a part of the box, or of all of it.
struct VoxelFindings
{
  std::vector<WindingNumbers> windings; ///< one per solid
  bool empty = true;                    ///< whether no voxel is inside a solid
  double volume = 0.0;                  ///< volume inside solids, length^3
};

/// The voxels of the box that are computed; without voxels, nothing is computed.
struct PartOfBox
{
  VoxelBox made;
  VoxelBox own; ///< the voxels in `made` that belong to this part alone
};

/// A part of the box, and its contribution to what is reported for the whole box.
struct VoxelizedPart
{
  RefractiveMedium medium; ///< in the voxels made; without warnings and leftOut
  VoxelFindings findings;  ///< for the part's own voxels
  std::vector<MeshTopology> topologies;
};

/// First of the two steps of Voxelize, for a part of the box, which may be without voxels: each voxel gets the same
/// values, bit for bit, as in the whole box. A halo of the voxels on which the part depends (half the filter and two)
/// is voxelised with it.
/// @throws as Voxelize, for the part
VoxelizedPart VoxelizePart(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const PartOfBox& part, const Monitor& monitor = {});

/// Second step: the finished medium of a part of the box.
/// @param all  findings of all parts. If unknown, pass those of this part with `empty` false: then no warning says that
///   nothing is inside solids, and every part gets an index array unless no solid differs in n from the outside
RefractiveMedium Concluded(VoxelizedPart&& part, const VoxelFindings& all, const std::vector<Solid>& solids,
  const RefractiveMediumSettings& settings);

/// Combines the findings of all ranks, each of which has its own part. Collective.
VoxelFindings FindingsOfAll(Communicator& communicator, const VoxelFindings& own);
}
