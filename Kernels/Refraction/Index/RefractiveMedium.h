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

/// Checks the properties of a material.
/// @param name  name of the object that consists of the material, for the message
/// @throws InvalidInput if a value is out of range
void Check(const Material& material, const std::string& name);

/// A solid: the region enclosed by a closed mesh.
struct Solid
{
  std::string name; ///< name for messages, e.g. "Mesh 2"
  TriangleMesh mesh;
  Material material;
};

/// Gradient noise that is added to the materials of all solids, as for the cube of Pfeuti 2009, figure 4.9. The
/// material outside the solids is not perturbed.
struct Perturbation
{
  /// Amplitude of the change of n: n becomes n + index * noise, noise in [-1, 1]; n must stay above 0.
  double index = 0.0;
  /// Relative amplitude of sigma_s, in [0, 1]: sigma_s becomes sigma_s (1 + scattering * noise).
  double scattering = 0.0;
  double size = 1.0; ///< size of the noise's features, in units of length, > 0
  std::uint32_t seed = 0;
};

struct RefractiveMediumSettings
{
  Grid grid;
  Material outside; ///< material outside the solids
  Perturbation perturbation;
  VoxelizationSettings voxelization;
  int filterSize = 9;   ///< width of the filter that smooths n, in voxels; see SmoothIndex
  bool leaveOut = true; ///< whether n and its gradient are left empty if n is the same everywhere
};

/// A voxelised scene of solids in a box. In all arrays x varies fastest; leftOut says which arrays are empty, and why.
struct RefractiveMedium
{
  std::vector<float> occupancy;   ///< fraction of the voxel's volume inside any solid, [0, 1]
  std::vector<float> ior;         ///< refractive index n, smoothed; empty if it was left out
  std::vector<float> iorGradient; ///< gradient of n, 1/length, 3 values per voxel; empty if it was left out
  std::vector<float> sigma_a;     ///< absorption coefficient, 1/length, `components` values per voxel
  std::vector<float> sigma_s;     ///< scattering coefficient, 1/length, `components` values per voxel
  int components = 1;             ///< components of sigma_a, sigma_s and gByVoxel: 3 if any material has colour, else 1
  double g = 0.0;                 ///< mean cosine of the phase function in all voxels; not used if gByVoxel is present
  /// Mean cosine of the phase function, `components` values per voxel, 0 in voxels that do not scatter; empty if all
  /// scattering materials have the same g.
  std::vector<float> gByVoxel;
  std::vector<std::string> leftOut;  ///< which arrays are empty and why, for the user
  std::vector<std::string> warnings; ///< irregularities of the meshes, one sentence each, for the user
  std::string device;                ///< name of the device
  double seconds = 0.0;              ///< total duration, s
};

/// The smallest box of cubic voxels that is centred on the solids and leaves a margin on each side. The margin is
/// `margin` times the longest edge of the solids' bounds, plus one voxel more than the filter reaches.
/// @throws InvalidInput if there is no solid or none has an extent, a point is not finite (names it), a size is below
///   1, or the margin is below 0
Grid GridAround(const std::vector<Solid>& solids, const std::array<int, 3>& size, double margin, int filterSize);

/// Voxelises solids (Pfeuti 2009, section 3.1.2). Counts the samples of each voxel that lie inside the solids, averages
/// the materials with their volume fractions as weights, smooths n, and computes its gradient. Where solids overlap,
/// the last one determines the material.
///
/// If scattering materials differ in their mean cosines g, a voxel has the mean g of its materials, weighted by volume
/// fraction and sigma_s (numerics.md, Eq. (3e)).
///
/// A mesh causes a warning if it encloses regions more than once or inside out, if its triangles disagree about the
/// outside, or if triangles have no area. The parity of crossings then decides what is inside. Every sample is
/// examined: a single winding number other than 0 or 1 causes the warning.
/// @throws InvalidInput  if a mesh is empty or open (names the number of boundary edges and the position of the
///   first), a number is out of range, or a voxel's edge is not 1e-18 to 1e18 lengths
/// @throws DeviceError   before any computation, if the machine's memory is not sufficient for 12 to 56 bytes per
///   voxel, or the device's (on a CPU the same memory) for 4 to 8 more; the number of solids does not matter
RefractiveMedium Voxelize(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const Monitor& monitor = {});

/// Facts about the solids in a part of the box that the voxelisation finds. Warnings need the facts of all parts
/// (FindingsOfAll).
struct VoxelFindings
{
  std::vector<WindingNumbers> windings; ///< winding numbers of each solid's mesh at the samples
  bool empty = true;                    ///< whether all voxels are entirely outside the solids
  double volume = 0.0;                  ///< volume inside solids, length^3
};

/// Voxels of the box that one rank computes; may be empty.
struct PartOfBox
{
  VoxelBox made; ///< all voxels that are computed on this rank, ghost cells included
  VoxelBox own;  ///< voxels of `made` that belong to this part and to no other
};

/// A voxelised part of the box, with its contribution to the findings of the box.
struct VoxelizedPart
{
  RefractiveMedium medium;              ///< medium in the computed voxels, without warnings and leftOut
  VoxelFindings findings;               ///< findings in the part's own voxels
  std::vector<MeshTopology> topologies; ///< topology of each solid's mesh
};

/// First of the two steps of Voxelize, for a part of the box, which may have no voxels. The values of each voxel do not
/// depend, bit for bit, on the division into parts. For this, a halo around the part is voxelised too, as wide as half
/// the filter plus two voxels.
/// @throws as Voxelize, for the part
VoxelizedPart VoxelizePart(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const PartOfBox& part, const Monitor& monitor = {});

/// Second step of Voxelize: returns the finished medium of a part of the box.
/// @param all  findings of all parts together. If these are unknown, pass the findings of this part with `empty` false.
///   Then there is no warning if nothing is inside solids, and the index array is left out only if n is the same in all
///   solids and outside
RefractiveMedium Concluded(VoxelizedPart&& part, const VoxelFindings& all, const std::vector<Solid>& solids,
  const RefractiveMediumSettings& settings);

/// Combines the findings of all ranks, each of which has one part of the box. Collective.
VoxelFindings FindingsOfAll(Communicator& communicator, const VoxelFindings& own);
}
