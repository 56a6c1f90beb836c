#include "LightPropagation/ThickVoxels/OctantSources.h"

#include "LightPropagation/Diffusion/SweepModel.h"
#include "LightPropagation/PlaneParallel/LayerResponse.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Nodes = 10;              ///< number of quadrature nodes per hemisphere
constexpr double LeastAlbedo = 1e-3;   ///< smallest albedo, since the response is divided by it
constexpr double LeastAbsorbed = 1e-5; ///< smallest tabulated value of 1 - albedo
/// Maximum of the coefficient beta. In layers without absorption beta is arbitrary, because all power leaves them
/// anyway.
constexpr double MostAlike = 1.0;

/// Response of a layer to incident power 1 at its top: power that leaves through the top, power that leaves through the
/// bottom (`straight`: its uncollided part), and number of collisions per unit of power.
struct Response
{
  double reflected, transmitted, straight, collisions;
};

class Layer
{
public:
  Layer(const LayerModes& modes, const HalfRangeQuadrature& nodes, double depth)
    : Modes(modes)
    , Depth(depth)
    , Operator(modes, depth)
    , Roots(Nodes)
    , Powers(Nodes)
  {
    for (int i = 0; i < Nodes; ++i)
    {
      this->Roots[i] = std::sqrt(nodes.weights[i]);
      this->Powers[i] = 2.0 * Pi * nodes.cosines[i] * this->Roots[i];
      this->Straight += 2.0 * nodes.cosines[i] * nodes.weights[i] * std::exp(-depth / nodes.cosines[i]);
    }
  }

  Response OfDiffuse() const
  {
    const Eigen::VectorXd in = this->Roots / this->Powers.dot(this->Roots);
    const Eigen::VectorXd up = this->Operator.reflect * in, down = this->Operator.transmit * in;
    return { this->Powers.dot(up), this->Powers.dot(down), this->Straight,
      this->Collisions(LayerSource(Nodes), in, up, down) };
  }

  /// Response of the layer to first collisions in it. Their total power is 1; their density is proportional to
  /// exp(-fall z) at optical depth z.
  Response OfFalling(double albedo, double fall) const
  {
    const double lost = -std::expm1(-fall * this->Depth);
    LayerSource source(Nodes);
    source.AddBeam(this->Modes, this->Operator, this->Depth, 1.0 / fall, true,
      albedo * fall / lost / (2.0 * Pi) * this->Roots, Eigen::VectorXd::Zero(Nodes));
    return { this->Powers.dot(source.up), this->Powers.dot(source.down), 0.0,
      1.0 + this->Collisions(source, Eigen::VectorXd::Zero(Nodes), source.up, source.down) };
  }

  double StraightPart() const { return this->Straight; } ///< transmittance of uncollided isotropic light, 2 E_3(depth)

private:
  double Collisions(const LayerSource& source, const Eigen::VectorXd& downAtTop, const Eigen::VectorXd& upAtTop,
    const Eigen::VectorXd& downAtBottom) const
  {
    const LayerMeans means =
      MeansOf(this->Modes, source, this->Depth, downAtTop, upAtTop, downAtBottom, Eigen::VectorXd::Zero(Nodes));
    return 2.0 * Pi * this->Depth * this->Roots.dot(means.sum);
  }

  const LayerModes& Modes;
  double Depth, Straight = 0.0;
  LayerOperator Operator;
  Eigen::VectorXd Roots, Powers;
};

/// Factor that reduces the response of thin voxels, since light incident from neighbouring voxels is not entirely
/// isotropic (fitted to slabs of equal voxels).
double AmongOthers(double depth)
{
  return 1.0 - 0.45 * std::exp(-2.0 * depth);
}

/// Response of a uniform layer to light incident on one side, as tables of the coefficients alpha and beta of
/// numerics.md, Eqs. (46g), (46h). The exact outgoing light of the layer is compared with that of a layer in which the
/// scattering source of each order is uniform over the depth. Layout as in OctantSourcesShared.h,
/// [albedo][depth][value].
struct VoxelResponse
{
  VoxelResponse();

  std::vector<float> diffuse; ///< coefficients for isotropic incident light
  /// Coefficients for first collisions whose density decays exponentially with depth, one table per rate of decay;
  /// relative to the fraction of isotropic light that the layer removes.
  std::vector<float> falling;
};

VoxelResponse::VoxelResponse()
  : diffuse(ResponseValues)
  , falling(static_cast<std::size_t>(ResponseValues) * ResponseProfiles)
{
  const HalfRangeQuadrature nodes(Nodes);
  for (int a = 0; a < ResponseAlbedos; ++a)
  {
    const double root = static_cast<double>(a) / (ResponseAlbedos - 1);
    const double absorbed = std::clamp(root * root, LeastAbsorbed, 1.0 - LeastAlbedo), albedo = 1.0 - absorbed;
    const LayerModes modes({ absorbed, DeltaM(std::vector<double>{ 1.0, 0.0 }) }, nodes, 0);
    for (int d = 0; d < ResponseDepths; ++d)
    {
      const double depth = std::exp2(FirstDepth + 0.5 * d);
      const Layer layer(modes, nodes, depth);
      const double lost = 1.0 - layer.StraightPart(), leaves = lost / (4.0 * depth), part = AmongOthers(depth);
      const Response even = layer.OfDiffuse();
      // scattered power that leaves the layer, all orders
      const double scattered = even.reflected + even.transmitted - even.straight;
      const double kept = std::max(lost - scattered, 1e-6);
      const double alike =
        std::clamp((scattered - 2.0 * leaves * albedo * even.collisions) / (albedo * lost * kept), 0.0, MostAlike);
      float* const values = this->diffuse.data() + ResponseParts * (a * ResponseDepths + d);
      values[0] = static_cast<float>(part * (even.reflected - even.transmitted + even.straight) / (albedo * lost));
      values[1] = static_cast<float>(part * alike);
      values[2] = static_cast<float>(lost);
      for (int p = 0; p < ResponseProfiles; ++p)
      {
        const Response found = layer.OfFalling(albedo, std::exp2(FirstProfile + 0.5 * p));
        const double out = found.reflected + found.transmitted;
        const double beyond = 2.0 * leaves * albedo * found.collisions - albedo * alike * lost * out;
        float* const here = this->falling.data() + p * ResponseValues + ResponseParts * (a * ResponseDepths + d);
        here[0] = static_cast<float>(part * (found.reflected - found.transmitted) / (albedo * lost));
        here[1] = static_cast<float>(part * (out - beyond) / (albedo * lost));
      }
    }
  }
}

/// Optical thickness above which a voxel is thick. Without sources by octant, thinner voxels scatter at most 1% too
/// little light back through the faces where it entered.
constexpr double Thick = 0.2;
/// Optical thickness above which a voxel is thick if the settings leave the choice open. Without sources by octant,
/// thinner voxels scatter up to 2% too little light back; with them, an order takes two to three times as long.
constexpr double ThickUnasked = 0.25;
/// Minimum fraction of thick voxels among the scattering ones, if the settings leave the choice open: if fewer are
/// thick, for example walls in a thin medium, computing sources for all voxels costs too much.
constexpr double Many = 0.25;
/// Optical thickness above which a voxel is opaque: the light that escapes from it is too small, compared with the
/// light scattered in it, for single precision.
constexpr double Opaque = 1e4;

/// Counts of voxels over all channels, from which OctantSources::Matter() decides whether to use sources by octant.
struct ThickVoxels
{
  double scattering = 0.0, thick = 0.0; ///< number of scattering voxels, and of thick ones among these
  double thickest = 0.0;                ///< largest transport optical thickness along a voxel's longest edge
};

/// Counts the thick voxels of all ranks. Collective.
ThickVoxels Count(const PropagationProblem& problem)
{
  const Grid& grid = problem.TheGrid();
  const TruncatedScattering& scattering = problem.Scattering();
  const double longest = *std::max_element(grid.spacing.begin(), grid.spacing.end());
  ThickVoxels voxels;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    const auto scatters = [&](std::size_t i) { return scattering.SigmaS(i, c) > 0.0f; };
    voxels.scattering += SumOverVoxels(grid, [&](std::size_t i) { return scatters(i) ? 1.0 : 0.0; });
    voxels.thick += SumOverVoxels(
      grid, [&](std::size_t i) { return scatters(i) && scattering.SigmaT(i, c) * longest > ThickUnasked ? 1.0 : 0.0; });
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      voxels.thickest = std::max<double>(voxels.thickest, longest * problem.TheMedium().TransportSigmaT(i, c));
    }
  }
  const Domain& domain = problem.TheDomain();
  const std::vector<double> sums = domain.Sum(std::vector<double>{ voxels.scattering, voxels.thick });
  return { sums[0], sums[1], domain.Max(voxels.thickest) };
}
}

bool OctantSources::AreThick(const PropagationProblem& problem)
{
  return problem.TheDomain().Any(AnyVoxelIsThickerThan(Thick, problem.TheMedium()));
}

bool OctantSources::Matter(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  const bool asked = settings.source == PropagationSource::Octants;
  const bool automatic = settings.source == PropagationSource::Automatic && settings.maximumOrders == 0 &&
    settings.acceleration == PropagationAcceleration::Automatic;
  if (!(asked || automatic) || !settings.alongRays || !problem.Traits().scatters || problem.Scattering().Degree() > 0 ||
    settings.firstMoments || settings.maximumOrders == 1 || HasVeryFlatVoxels(problem.Whole()))
  {
    return false;
  }
  const ThickVoxels voxels = Count(problem);
  const bool wanted =
    asked ? voxels.thickest > Thick : voxels.scattering > 0.0 && voxels.thick >= Many * voxels.scattering;
  return wanted && voxels.thickest <= Opaque;
}

OctantSources::OctantSources(const Scene& scene)
  : The(scene)
{
  Device& device = scene.device;
  const VolumeLayout& layout = scene.layout;
  const auto byFaces = [&] {
    Buffer<float> buffer(device, layout.Floats(6), "light at the faces of thick voxels");
    buffer.Fill(0.0f);
    return buffer;
  };
  this->OfSweep = byFaces();
  this->Incoming = byFaces();
  this->Found = Buffer<float>(device, layout.Floats(8), "light of thick voxels by octant");
  this->Found.Fill(0.0f);
  const VoxelResponse response;
  this->Diffuse = Buffer<float>(device, response.diffuse, "the response of thick voxels");
  this->Falling = Buffer<float>(device, response.falling, "the response of thick voxels");
  if (scene.lamps)
  {
    this->OfLamps = byFaces();
    this->MomentsOfLamp = byFaces();
    this->PathOfLamp = Buffer<float>(device, layout.Floats(), "light of lamps");
    this->PathOfLamp.Fill(0.0f);
  }
}

const OctantSources::Crossings& OctantSources::CrossingsOf(const SweptDirections& along)
{
  const auto known = this->Patterns.find(&along);
  if (known != this->Patterns.end())
  {
    return known->second;
  }
  const PropagationSettings& settings = this->The.settings;
  const Grid& grid = this->The.whole;
  const CrossingPattern pattern =
    FindCrossingPattern(grid, along.Set(), along.RaysPerEdge(), along.Starts(), settings.periodic);
  Crossings found = { Buffer<float>(this->The.device, pattern.values, "the pattern of rays"), pattern.first,
    HalfRange(along.Set(), 0) };
  return this->Patterns.emplace(&along, std::move(found)).first->second;
}

void OctantSources::TakeIncoming(const SweptDirections& along)
{
  if (this->IsEmpty())
  {
    return;
  }
  const Crossings& crossings = this->CrossingsOf(along);
  cl::Kernel take = this->The.device.Kernel("take_incoming", kernel_source::OctantSources);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    OctantSourceInfo info = this->InfoOf(c);
    for (int axis = 0; axis < 3; ++axis)
    {
      const PlaneAxes across = AcrossAxis(axis);
      const int low = std::min(across.u, across.v), high = std::max(across.u, across.v);
      info.pattern[2 * axis] = crossings.first[2 * axis] + this->The.block.first[low];
      info.pattern[2 * axis + 1] = crossings.first[2 * axis + 1] + this->The.block.first[high];
    }
    info.perRadiance = static_cast<float>(crossings.perRadiance);
    With(take, info, this->OfSweep, crossings.values, this->Incoming, cl_int(!this->CameIn));
    const std::array<int, 3>& n = this->The.layout.grid.size;
    this->The.device.Queue().enqueueNDRangeKernel(take, cl::NullRange, cl::NDRange(n[1], n[2], 6));
  }
  this->CameIn = true;
}

void OctantSources::TakeLamp(const Buffer<float>& allPath)
{
  if (this->IsEmpty())
  {
    return;
  }
  cl::Kernel add = this->The.device.Kernel("add_lamp", kernel_source::OctantSources);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    With(add, this->InfoOf(c), this->The.medium.SigmaT(), this->The.medium.SigmaS(), this->PathOfLamp,
      this->MomentsOfLamp, this->Falling, this->OfLamps, allPath);
    const std::array<int, 3>& n = this->The.layout.grid.size;
    this->The.device.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(n[0], n[1], n[2]));
  }
  this->LampsShine = true;
}

void OctantSources::Find(const Buffer<float>& source, const BeyondFaces& beyond)
{
  if (this->IsEmpty())
  {
    return;
  }
  cl::Kernel find = this->The.device.Kernel("find_octant_sources", kernel_source::OctantSources);
  const Buffer<float>& lamps = this->LampsShine ? this->OfLamps : this->Found;
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    OctantSourceInfo info = this->InfoOf(c);
    info.beyond = beyond.info;
    for (cl_int& periodic : info.periodic)
    {
      // If `beyond` is given, it also holds the incident radiance of voxels across periodic axes
      periodic = periodic && !beyond.values;
    }
    With(find, info, this->The.medium.SigmaT(), this->The.medium.SigmaS(), source, this->Diffuse, this->Incoming,
      beyond.values ? *beyond.values : this->Incoming, lamps, cl_int(this->LampsShine), this->Found, cl_ulong(c));
    const std::array<int, 3>& n = this->The.layout.grid.size;
    this->The.device.Queue().enqueueNDRangeKernel(find, cl::NullRange, cl::NDRange(n[1], n[2]));
  }
  this->CameIn = false;
  this->LampsShine = false;
}

OctantSourceInfo OctantSources::InfoOf(int channel) const
{
  const Grid& grid = this->The.layout.grid;
  OctantSourceInfo info = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    info.size[axis] = grid.size[axis];
    info.periodic[axis] = this->The.settings.periodic[axis];
    info.spacing[axis] = static_cast<float>(grid.spacing[axis]);
    // An axis with a single, periodic voxel has no sources by octant: light does not vary along it, and one swept
    // direction may represent itself and its mirror image.
    info.leftOut[axis] = this->The.whole.size[axis] == 1 && this->The.settings.periodic[axis];
  }
  info.firstT = this->The.layout.ExtinctionFirst(channel);
  info.first = channel * this->The.layout.Stride();
  info.stride = this->The.layout.Stride();
  return info;
}
}
