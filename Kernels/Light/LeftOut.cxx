#include "Light/LeftOut.h"

#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tyndall
{
namespace left_out
{
const char* const Grey = "colour: medium and light are grey, one channel does";
const char* const GreyMedium = "colour: the medium is grey, one component of sigma_a and sigma_s does";
const char* const OneColour = "colour: the medium is grey and all light has one colour, one channel stands for three";
const char* const OneColourOfLight = "colour: light has one colour everywhere, its channels are smoothed at once";
const char* const GreyExtinction = "sigma_t a channel: red, green and blue share one, and its transmittance";
const char* const NoScattering = "scattering: sigma_s is zero";
const char* const NoAbsorption = "absorption: sigma_a is zero";
const char* const NoEmission = "emission: the medium does not shine";
const char* const OneOrder = "scattering orders after the first: nothing is scattered";
const char* const Acceleration = "acceleration: few scattering orders do";
const char* const SpiralAcceleration =
  "acceleration: not along directions of a spiral, by the whole matrix or singular values of a phase function, or of "
  "light that another solver began";
const char* const MomentsForPictures = "angular moments for pictures: not asked for";
const char* const NetFlux = "net_flux: not asked for";
const char* const Isotropic = "anisotropy: light is scattered evenly";
const char* const ConstantIndex = "refraction: the refractive index is constant, rays are straight";
const char* const EmptyBricks = "empty bricks: rays leap over 8x8x8 voxels that are empty";
const char* const OwnUncollided = "uncollided flux of lamps, environment, sky and faces: UncollidedLight has it";
const char* const NoLights = "uncollided flux of lamps: there are no lights";
const char* const NoEmissionPeaks = "uncollided flux of bright emission: no small bright part outshines all else, or "
                                    "an axis is periodic, or EmissionError is 0";
const char* const BlackFaces = "reflecting faces: no face of the box has an albedo";
const char* const DefaultSky = "lights of the scene: there are none, so the default sky shines (DefaultSky)";
const char* const DarkOutside = "boundary radiance: no environment, sky or face shines";
const char* const EvenOutside = "uncollided flux of the boundaries: what comes from outside is the same from "
                                "everywhere and goes with scattered light";
const char* const ThinVoxels = "light at the faces of thick voxels: there are none";
const char* const NotByOctant =
  "Source By octant: not with accelerated orders, angular moments, small bright emission, "
  "light of another solver or voxels of more than 10000 mean free paths";
const char* const NotSideBySide =
  "marching beside diffusion: the device does one after the other, and takes no longer than by turns";

std::string EmptyVoxels(double part)
{
  return "scattering in empty voxels: " + std::to_string(std::lround(100.0 * part)) + "% of the voxels do not scatter";
}

std::string EmptyMoments(double part)
{
  return "angular moments in empty voxels: " + std::to_string(std::lround(100.0 * part)) +
    "% of the voxels have no medium, and only their fluence is swept";
}

std::string EmptySlabs(const VoxelBox& filled, const Grid& grid)
{
  const double part = 1.0 - static_cast<double>(filled.VoxelCount()) / static_cast<double>(grid.VoxelCount());
  return "empty slabs: " + std::to_string(std::lround(100.0 * part)) +
    "% of the voxels lie outside the box that the medium fills";
}

std::string DarkDirections(double lit)
{
  return "dark directions: no light comes from outside along " + std::to_string(std::lround(100.0 * (1.0 - lit))) +
    "% of the rays";
}

std::string DarkChannels(int dark, int channels)
{
  return "dark channels: nothing is scattered or shines in " + std::to_string(dark) + " of " + std::to_string(channels);
}

std::string MirrorImages(int classes, int directions)
{
  return "mirror images: nothing changes along periodic axes of one voxel, " + std::to_string(classes) + " of " +
    std::to_string(directions) + " directions stand for all";
}

std::string SourcesBesideVolume(int beside, int sources)
{
  return "light sources beside the volume: the light of " + std::to_string(beside) + " of " + std::to_string(sources) +
    " does not reach it";
}

std::string PhotonsBesideVolume(double part)
{
  return "photons beside the volume: " + Text("%.2g", 100.0 * part) + "% of the samples would miss it";
}

std::string TermsOfZero(int terms, int asked)
{
  return "terms " + std::to_string(terms + 1) + " to " + std::to_string(asked) + ": their eigenvalues are 0";
}

std::string TwoAxes(int polarNodes)
{
  return "two axes: nothing varies along them, the layers are solved in the cosine alone, with " +
    std::to_string(polarNodes) + " cosines up and as many down";
}

std::string DirectionsAlongSlab(int perFace)
{
  return "directions too few for a slab, or parallel to a periodic axis: solved with " + std::to_string(perFace) +
    " a face";
}
}

void AddMissing(std::vector<std::string>& texts, const std::vector<std::string>& more)
{
  std::copy_if(more.begin(), more.end(), std::back_inserter(texts),
    [&](const std::string& text) { return std::find(texts.begin(), texts.end(), text) == texts.end(); });
}
}
