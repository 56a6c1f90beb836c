#pragma once

#include "Common/CellArrays.h"
#include "Common/LightTransportWriting.h"
#include "Device/Errors.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkImageData;
class vtkPolyData;

/// Reads the data that filters exchange: arrays with their names, shapes and units. LightTransportWriting.h writes
/// them.
///
/// These functions throw InvalidInput with a message for users. A filter does all its work within Guarded, which turns
/// the exception into a VTK error:
///
///     int vtkX::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
///     {
///       return Guarded(this, outputs, [&] {
///         vtkImageData* image = vtkImageData::GetData(inputs[0]);
///         const MediumInput input = ReadMedium(this, image);
///         LightField light = Solve(input.medium, ..., MonitorOf(this));
///         vtkImageData* output = vtkImageData::GetData(outputs);
///         output->ShallowCopy(image);
///         WriteLight(std::move(light), output);
///       });
///     }
namespace tyndall
{
class Domain;

/// The three values of a property, such as a colour or a position.
inline std::array<double, 3> Triple(const double* values)
{
  return { values[0], values[1], values[2] };
}

/// Relative density of fog inside a level set as a function of the signed distance from its surface, negative inside: 1
/// in the interior, falling linearly to 0 at the surface within the last voxel, 0 outside. Equals OpenVDB's
/// sdfToFogVolume with a cutoff of one voxel.
template <typename Value>
Value FogInside(Value distance, double voxel)
{
  return std::min(std::max(static_cast<Value>(-distance / voxel), Value(0)), Value(1));
}

/// Indices for SetInputArrayToProcess of the medium's arrays, in filters whose port 0 takes a medium.
enum MediumArray
{
  SigmaA = 0,
  SigmaS = 1,
  Emission = 2,
};
/// Index for SetInputArrayToProcess of the refractive index, in filters that use it.
constexpr int RefractiveIndex = 3;

Quantities QuantitiesOfMedium(); ///< indices of MediumArray, and RefractiveIndex, each with the default array's name

/// Texts for field data `ignored` (IgnoredFact): IgnoredIndex for a filter that ignores refraction, IgnoredEmission for
/// one that ignores the medium's emission because its photons start from lights only. Empty if nothing is ignored.
std::vector<std::string> IgnoredIndex(bool isUnusual);
std::vector<std::string> IgnoredEmission(bool isUnusual);
/// Joins texts of IgnoredIndex and IgnoredEmission to one warning; empty if there are none.
std::string WarningOf(const std::vector<std::string>& ignored);

/// A medium together with the arrays that it refers to.
struct MediumInput
{
  Medium medium;
  FloatField sigma_a, sigma_s, emission, g;

  bool Emits() const; ///< whether emission is above 0 in any voxel
};

/// Reads the medium of an image and checks it. Cell arrays `sigma_a` and `sigma_s` (1 or 3 components, 1/length) and
/// `emission` (optional, 1 or 3 components), or the arrays selected instead by SetInputArrayToProcess (MediumArray).
/// Phase function: cell array `g` (optional, 1 or 3 components) if the mean cosine varies by voxel, otherwise field
/// data `g` (1 or 3 numbers; default 0); field data `phase_function` and the parameters in PhaseFunctionData.h (default
/// Henyey-Greenstein).
MediumInput ReadMedium(vtkAlgorithm* filter, vtkImageData* image);
/// Reads and checks the medium of this rank's block: the arrays and field data that ReadMedium(filter, image) reads.
/// Collective.
/// @param own  the block's image; null if it has no voxels
/// @throws InvalidInput, the same on all ranks, if ReadMedium throws on any
MediumInput ReadMedium(vtkAlgorithm* filter, const Domain& domain, vtkImageData* own);

/// Angular moments of scattered light, as WriteLight writes them; empty if the solver computed none or some of the
/// arrays are missing.
struct MomentsInput
{
  FloatField moments, straightOn;
  std::vector<Light> lampsApart;
};

/// Uncollided light computed by another filter, together with the arrays that it refers to.
struct UncollidedInput
{
  UncollidedImage image;
  FloatField fluence, meanDirection;
};

/// All light sources outside of the medium, together with the arrays that they refer to.
struct IlluminationInput
{
  Illumination illumination;
  UncollidedInput uncollided;
  bool isDefaultSky = false; ///< whether no light is given, so that a default sky is used; see vtkPropagationAlgorithm
};

/// Reads the uncollided light of PhotonMarcher or PhotonReconstruction: cell array `fluence_direct` (1 or 3
/// components), optional cell array `mean_direction` (3 components; default isotropic), optional field data
/// `face_power_out` (default 0).
/// @throws InvalidInput if the image's voxels are not those of the medium, or an array is missing or has the wrong
///   shape
UncollidedInput ReadUncollided(vtkImageData* image, const Grid& medium);

/// Reads the angular moments of scattered light from an image; empty if one of the arrays is missing.
/// @throws InvalidInput if an array has the wrong shape
MomentsInput ReadMoments(vtkImageData* image);

/// Reads lights as LightRig writes them, and checks them: point data `light_type` and `power` (1 or 3 components);
/// `direction`, `size` and `angle` if the types need them. Hidden and duplicate points are skipped. Returns no lights
/// without polydata or points.
std::vector<Light> ReadLights(vtkPolyData* lights);

/// Transforms lights, or illumination with its environment, from the scene axes to the medium axes (OwnAxes).
std::vector<Light> InOwnAxes(std::vector<Light> lights, const OwnAxes& axes);
Illumination InOwnAxes(Illumination illumination, const OwnAxes& axes);

/// Reads the environment from a latitude-longitude image of width x height x 1 points, and checks it: point data
/// `radiance`, 1 (grey) or 3 components; hidden points are black. Returns an empty environment without an image.
Environment ReadEnvironment(vtkImageData* image);

/// Whether there is no light source: no lamp, no environment, and black sky and faces.
bool NothingShines(const Illumination& illumination);

/// Adds incident isotropic radiance `sky` (red, green, blue) and boundary sources at the faces -x, +x, -y, +y, -z, +z,
/// W/(length^2 sr). The values are checked.
void AddDiffuse(Illumination& illumination, const double* sky, const double* faceRadiance);

/// Adds reflecting boundaries: one albedo for each face, multiplied by red, green and blue factors for each face. The
/// values are checked.
void AddFaceAlbedo(Illumination& illumination, const double* albedo, const double* colour);
}
