#include "DiscreteOrdinates/OrdinatesTransport.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/PipelinedSweep.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Light/ChannelReduction.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Conservative/OrderSweeps.h"
#include "LightPropagation/Conservative/SolveMemory.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Diffusion/SweepModel.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Light that wraps around periodic axes is swept again until its power has fallen to this fraction of the power that
/// wraps in the first sweep, but at most MostLaps times.
constexpr double WrappedLeft = 1e-6;
constexpr int MostLaps = 500;
/// Number of scattering orders up to which anisotropic scattering is not accelerated in slabs, or if the tolerance is
/// below RoundedMoments. Acceleration represents scattering by angular moments, which is less accurate than scattering
/// from each direction into all directions, and whose rounding errors keep the residual above 1e-7 or so.
constexpr double FewOrders = 100.0;
constexpr double RoundedMoments = 1e-6;

/// Directions of a quadrature that are swept. If a symmetry makes several directions carry the same light
/// (SweptDirections), one of them is swept, with the solid angle of all.
struct SweptOrdinates
{
  explicit SweptOrdinates(const SweptDirections& of)
  {
    for (std::size_t d = 0; d < of.Set().directions.size(); ++d)
    {
      const std::vector<int> all = of.AllOf(static_cast<int>(d));
      if (all.front() == static_cast<int>(d))
      {
        this->index.push_back(static_cast<int>(d));
        this->directions.push_back(of.Set().directions[d]);
        this->directions.back().weight *= static_cast<double>(all.size());
      }
    }
  }

  std::vector<int> index; ///< in the quadrature
  std::vector<Direction> directions;
};

/// Sweeps the scattered light of TransportParts by discrete ordinates.
class OrdinatesTransport : public SweepOperator
{
public:
  OrdinatesTransport(TransportParts& parts, const SweepRequest& request)
    : Parts(parts)
    , Request(request)
    , ByDiamonds(parts.How == IterationScheme::Dsa)
    , Laps(request.mostPlanes < MostPlanesAround ? 1 : MostLaps)
    , Ordinates(parts.Usual)
    , Groups(this->Ordinates.directions)
    , Voxels(parts.Layout.grid.VoxelCount())
    , Sums(parts.TheDevice, 4 * this->Groups.Count() * OrdinateStride(this->Voxels), "sums over directions")
    , Nothing(parts.TheDevice, parts.Layout.Floats(), "no source")
  {
    this->Sums.Fill(0.0f);
    this->Nothing.Fill(0.0f);
    std::vector<cl_int> up;
    for (const OrdinateGroup& group : this->Groups.All())
    {
      up.insert(up.end(), group.up.begin(), group.up.end());
    }
    this->Up = Buffer<cl_int>(parts.TheDevice, up, "the directions");
    if (request.angular)
    {
      this->LoadFunctions(*request.angular);
    }
    for (int c = 0; c < parts.Layout.channels; ++c)
    {
      this->MakeChannel(c);
    }
  }

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override
  {
    for (const std::unique_ptr<Channel>& channel : this->Channels)
    {
      channel->sweep->Forget();
    }
  }

private:
  /// Sweep of one channel, and its light by cell of the box's faces.
  struct Channel
  {
    std::optional<LightOfCells> cells;
    std::unique_ptr<OrdinateSweep> sweep;
  };
  void MakeChannel(int channel);
  void LoadFunctions(const AngularValues& angular);
  FacePowers SweepOnce(
    int channel, const Buffer<float>* source, const IncomingRadiance& incoming, bool onlyWraps, const Monitor& monitor);
  FacePowers SweepChannel(
    int channel, const Buffer<float>* source, const IncomingRadiance& incoming, const Monitor& monitor);
  /// Whether voxels or faces may emit light along any direction of a sweep, in addition to its boundary source.
  bool ShinesEverywhere(const Buffer<float>* source) const
  {
    return source || this->Request.faceIn || this->Parts.Problem.Settings().IsPeriodic();
  }
  void Spread(int channel, const Buffer<float>* source);
  /// Array of the deposit for the light through the faces of voxels, and its number of values per voxel: 6 (partial
  /// currents), 3 (net flux, unless the angular moments contain it) or 0 (no array).
  std::pair<const Buffer<float>*, int> Through() const
  {
    const Deposit& deposit = this->Request.deposit;
    using Found = std::pair<const Buffer<float>*, int>;
    return deposit.partialCurrents                       ? Found(deposit.partialCurrents, 6)
      : deposit.flux && this->Request.angular == nullptr ? Found(deposit.flux, 3)
                                                         : Found(&this->Nothing, 0);
  }
  void Gather(int channel) const;
  cl::Kernel Kernel(const char* name) const
  {
    return this->Parts.TheDevice.Kernel(name, kernel_source::UpwindSweep, Define("REAL_WIDTH", OrdinateLanes));
  }
  MomentPlaces Places() const { return this->Parts.Layout.Places(this->Parts.Functions()); }

  TransportParts& Parts;
  const SweepRequest Request;
  const bool ByDiamonds; ///< weighted diamond differences
  const int Laps;        ///< largest number of laps around periodic axes in a sweep
  const SweptOrdinates Ordinates;
  const OrdinateGroups Groups;
  const std::size_t Voxels;
  Buffer<float> Sums;     ///< SweptSums::values
  Buffer<float> Nothing;  ///< isotropic source of 0
  Buffer<float> Radiance; ///< of all directions; empty if scattering is isotropic
  /// Values: angular functions and distributions of the beams along each direction. Weights: angular functions times
  /// the direction's solid angle. Both have the layout of UpwindSweep.cl.
  Buffer<float> Values, Weights;
  Buffer<cl_int> Up;
  std::vector<std::unique_ptr<Channel>> Channels;
};

void OrdinatesTransport::MakeChannel(int c)
{
  TransportParts& parts = this->Parts;
  const Domain& domain = parts.TheDomain();
  this->Channels.push_back(std::make_unique<Channel>());
  Channel& channel = *this->Channels.back();
  if (this->Request.deposit.faceOut)
  {
    channel.cells.emplace(LightOfCells{ parts.Faces->Out(), parts.Faces->In(), c * parts.Faces->Cells() });
  }
  const SweptFaces faces =
    SweptFaces::Of(domain.Whole(), parts.Problem.Settings().periodic, channel.cells ? &*channel.cells : nullptr);
  const Grid& grid = parts.Layout.grid;
  if (domain.IsSerial())
  {
    channel.sweep = std::make_unique<UpwindSweep>(parts.TheDevice, grid, this->Groups, faces);
    return;
  }
  channel.sweep = std::make_unique<PipelinedSweep>(parts.TheDevice, domain, grid, this->Groups, faces);
}

void OrdinatesTransport::LoadFunctions(const AngularValues& angular)
{
  const int count = angular.Functions();
  const auto valueOf = [&](int g, int k, int lane) -> double {
    const int d = this->Ordinates.index[this->Groups.All()[g].direction[lane]];
    return k < count ? angular.functions[d][k] : angular.beams[d][k - count];
  };
  const std::vector<float> values = this->Groups.Table(count + angular.Beams(), valueOf);
  const std::vector<float> weights = this->Groups.Table(
    count, [&](int g, int k, int lane) { return this->Groups.Weight(g, lane) * valueOf(g, k, lane); });
  Device& device = this->Parts.TheDevice;
  this->Values = Buffer<float>(device, values, "the angular functions");
  this->Weights = Buffer<float>(device, weights, "the angular functions");
  this->Radiance =
    Buffer<float>(device, this->Groups.Lanes() * OrdinateStride(this->Voxels), "radiance of all directions");
}

/// Writes the source of a channel along all directions to Radiance, if scattering is not isotropic.
/// @param source  null: no source
void OrdinatesTransport::Spread(int c, const Buffer<float>* source)
{
  if (!source)
  {
    this->Radiance.Fill(0.0f);
  }
  else if (this->Request.angular && this->Voxels > 0)
  {
    cl::Kernel spread = this->Kernel("spread_moments");
    With(spread, this->Places(), cl_int(c), cl_int(this->Request.angular->Beams()),
      cl_ulong(this->Parts.Layout.Stride()), *source, this->Values, this->Radiance,
      cl_ulong(OrdinateStride(this->Voxels)), cl_int(0));
    Launch(this->Parts.TheDevice, spread, cl::NDRange(this->Voxels, this->Groups.Count()));
  }
}

/// Adds the light of the last sweep of a channel to the deposit.
void OrdinatesTransport::Gather(int c) const
{
  if (this->Voxels == 0)
  {
    return;
  }
  const TransportParts& parts = this->Parts;
  const Deposit& deposit = this->Request.deposit;
  const cl_ulong stride = OrdinateStride(this->Voxels), ofChannel = parts.Layout.Stride();
  const auto volume = static_cast<float>(parts.Layout.grid.VoxelVolume());
  const cl_int groups = this->Groups.Count();
  const std::array<double, 3>& h = parts.Layout.grid.spacing;
  const cl_float4 edges = { { float(h[0]), float(h[1]), float(h[2]), 0.0f } };
  const auto [through, partsOfThrough] = this->Through();
  cl::Kernel sums = this->Kernel("gather_sums");
  With(sums, this->Sums, this->Up, groups, stride, volume, *deposit.path, *through, cl_int(partsOfThrough), edges,
    ofChannel, cl_ulong(c * ofChannel));
  Launch(parts.TheDevice, sums, cl::NDRange(this->Voxels));
  if (this->Request.angular)
  {
    cl::Kernel moments = this->Kernel("gather_moments");
    With(moments, this->Places(), cl_int(c), groups, volume, this->Radiance, this->Weights, *deposit.path, stride);
    Launch(parts.TheDevice, moments, cl::NDRange(this->Voxels));
  }
}

/// Sweeps a channel once. Collective.
/// @param source  as for Apply()
/// @param onlyWraps  as in OrdinateArrays
FacePowers OrdinatesTransport::SweepOnce(
  int c, const Buffer<float>* source, const IncomingRadiance& incoming, bool onlyWraps, const Monitor& monitor)
{
  const TransportParts& parts = this->Parts;
  const bool everywhere = this->ShinesEverywhere(source);
  parts.TheDomain().Collective([&] {
    this->Spread(c, source);
    if (!everywhere)
    {
      this->Sums.Fill(0.0f); // directions without light are not swept
    }
  });
  const SweptSums sums = { this->Sums,
    this->Request.angular ? nullptr
      : source            ? source
                          : &this->Nothing,
    parts.Layout.ExtinctionFirst(c), c * parts.Layout.Stride(), this->ByDiamonds, this->Through().second == 3 };
  const OrdinateArrays arrays = { this->Radiance, parts.OnDevice.SigmaT(), this->Nothing, &sums, onlyWraps };
  const VoxelBox& box = this->Request.box;
  OrdinateSweep& sweep = *this->Channels[c]->sweep;
  return box.VoxelCount() == 0 ? sweep.Apply(arrays, incoming, everywhere, monitor)
                               : static_cast<UpwindSweep&>(sweep).ApplyWithin(box, arrays, monitor);
}

/// Sweeps a channel, in laps around periodic axes until at most the fraction WrappedLeft of the light that wraps in the
/// first lap is in transit, and adds its light to the deposit. By mean chords, a lap carries on the light that wrapped
/// in the last one, and the light of all laps is added. Diamond differences are not linear where radiance would be
/// negative, as beside a periodic face without incident light: each lap therefore sweeps all light again, together with
/// what wrapped in the last lap, and only the light of the final lap counts. Collective.
/// @param source  as for Apply()
FacePowers OrdinatesTransport::SweepChannel(
  int c, const Buffer<float>* source, const IncomingRadiance& incoming, const Monitor& monitor)
{
  const Domain& domain = this->Parts.TheDomain();
  const Monitor ofLaps = monitor ? Monitor([&](double) { return monitor(1.0); }) : Monitor();
  const bool repeats = this->ByDiamonds && this->Parts.Problem.Settings().IsPeriodic();
  const Buffer<float>* const cells = repeats ? this->Request.deposit.faceOut : nullptr;
  Buffer<float> before;
  FacePowers sum;
  double left = 0.0, wraps = 0.0; // power that the next lap would add
  for (int lap = 0; lap == 0 || (lap < this->Laps && left > WrappedLeft * wraps); ++lap)
  {
    const bool first = lap == 0, all = first || this->ByDiamonds;
    domain.Collective([&] {
      if (cells && first)
      {
        before = Buffer<float>(this->Parts.TheDevice, cells->Read(), "light by cells");
      }
      else if (cells)
      {
        cells->CopyFrom(before, 0, before.Size());
      }
    });
    const FacePowers powers =
      this->SweepOnce(c, all ? source : nullptr, all ? incoming : IncomingRadiance(), !all, first ? monitor : ofLaps);
    left = this->ByDiamonds ? std::abs(powers.onTheWay - sum.onTheWay) : powers.onTheWay;
    wraps = first ? left : wraps;
    for (int face = 0; face < 6; ++face)
    {
      sum.in[face] = powers.in[face] + (this->ByDiamonds ? 0.0 : sum.in[face]);
      sum.out[face] = powers.out[face] + (this->ByDiamonds ? 0.0 : sum.out[face]);
    }
    sum.onTheWay = powers.onTheWay;
    if (!this->ByDiamonds)
    {
      domain.Collective([&] { this->Gather(c); });
    }
  }
  if (this->ByDiamonds)
  {
    domain.Collective([&] { this->Gather(c); });
    sum.onTheWay = left;
  }
  return sum;
}

SweepTally OrdinatesTransport::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  const int channels = this->Parts.Layout.channels;
  for (int c = 0; c < channels; ++c)
  {
    const IncomingRadiance incoming = [&](int d, int face) { return boundary(this->Ordinates.index[d], face)[c]; };
    const FacePowers powers = this->SweepChannel(c, source, boundary ? incoming : IncomingRadiance(),
      OfPart(monitor, static_cast<double>(c) / channels, (c + 1.0) / channels));
    for (int face = 0; face < 6; ++face)
    {
      tally.in[face][c] = powers.in[face];
      tally.out[face][c] = powers.out[face];
    }
    tally.onTheWay[c] = powers.onTheWay;
  }
  return tally;
}

/// Model of how sweeps of discrete ordinates carry light between voxels, for the diffusion solver. At uniform radiance,
/// all voxel faces normal to an axis are crossed by the same power. Weighted diamond differences are exact for light
/// that varies along one axis only (numerics.md, Eq. (D15)).
SweepModel ModelOfOrdinates(const TransportParts& parts)
{
  const Grid& grid = parts.Problem.Whole();
  SweepModel model;
  model.halfRange = HalfRange(parts.Usual.Set(), 0) / (4.0 * Pi);
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes across = AcrossAxis(axis);
    for (const int along : { across.u, across.v })
    {
      model.pattern.first[2 * axis + (along == across.u ? 0 : 1)] = static_cast<int>(model.pattern.values.size());
      model.pattern.values.insert(model.pattern.values.end(), grid.size[along], along == across.u ? 1.0f : 0.0f);
    }
    std::map<float, double> weights; // by cosine: directions of equal cosine form one node
    for (const Direction& direction : parts.Usual.Set().directions)
    {
      const double cosine = direction.omega[axis];
      weights[static_cast<float>(cosine)] += std::max(direction.weight * cosine / (4.0 * Pi), 0.0);
    }
    for (const auto& [cosine, weight] : weights)
    {
      if (cosine > 0.0f)
      {
        model.flatSource[axis].push_back(
          { cosine, static_cast<float>(grid.spacing[axis] / cosine), static_cast<float>(weight) });
      }
    }
  }
  return model;
}

/// Checks that a solve fits the device. @throws DeviceError
void CheckMemoryOf(Device& device, const PropagationProblem& problem, IterationScheme how)
{
  const int directions = 6 * problem.Settings().directionsPerFace;
  const std::size_t voxels = OrdinateStride(problem.TheGrid().VoxelCount());
  const bool omitsSlabs = how == IterationScheme::SourceIteration &&
    PaysToOmitEmptySlabs(problem.Traits().filled, problem.TheGrid(), problem.Settings());
  const std::size_t sums = sizeof(float) * voxels * directions / 2; // four floats for eight directions
  const std::size_t radiance = problem.Scattering().Degree() > 0 ? 2 * sums : 0;
  CheckMemory(device, directions, BytesOfSolve(device, problem, how) + (omitsSlabs ? 2 : 1) * sums + radiance,
    std::max(sums, radiance));
}

/// Replaces the transport of scattered light by sweeps of discrete ordinates.
void TransportByOrdinates(TransportParts& parts)
{
  parts.Scattered.make = [&parts](const SweepRequest& request) -> std::unique_ptr<SweepOperator> {
    std::unique_ptr<SweepOperator> sweep;
    parts.TheDomain().Collective([&] { sweep = std::make_unique<OrdinatesTransport>(parts, request); });
    return sweep;
  };
  parts.Scattered.model = [&parts] { return ModelOfOrdinates(parts); };
  if (parts.Faces)
  {
    const Grid& grid = parts.Problem.Whole();
    std::vector<double> powerIn;
    ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
      const int axis = cell.face / 2;
      powerIn.push_back(HalfRange(parts.Usual.Set(), axis) * grid.VoxelVolume() / grid.spacing[axis]);
    });
    parts.Faces->SetPowerIn(std::move(powerIn));
  }
}

}

bool IteratesAsMaps(const OrdinatesSettings& settings, bool isIsotropic)
{
  return !IsPublished(settings) && settings.seriesAfter == 0 && settings.spiralDirections == 0 &&
    (isIsotropic || settings.scattering == OrdinatesScattering::SphericalHarmonics);
}

namespace
{
/// A problem and how SolveBySweptOrdinates() solves it.
struct SweptProblem
{
  /// Collective.
  /// @param even  as for SolveBySweptOrdinates()
  SweptProblem(
    Device& device, const SceneBlock& scene, const OrdinatesSettings& settings, const PropagationProblem& even)
  {
    if (!IteratesAsMaps(settings, even.IsIsotropic()) || !ResolvesTerms(even.Settings(), settings.terms))
    {
      return;
    }
    if (!even.IsIsotropic())
    {
      PropagationSettings as = AsPropagation(settings);
      as.angularDegree = std::min(static_cast<int>(std::sqrt(settings.terms + 0.5)) - 1, HighestAngularDegree);
      this->inMoments.emplace(scene.domain, scene.medium, scene.illumination, as, MemoryOf(device));
    }
    const PropagationProblem& own = this->inMoments ? *this->inMoments : even;
    this->how = even.HasGivenLight() ? IterationScheme::SourceIteration : ChooseIterationScheme(own);
    const bool isExact = own.IsSlab() || settings.tolerance < RoundedMoments;
    const bool byDirections = this->inMoments && (!this->IsAccelerated() || (isExact && OrdersNeeded(own) < FewOrders));
    this->problem = byDirections ? nullptr : &own;
  }
  SweptProblem(const SweptProblem&) = delete;
  SweptProblem& operator=(const SweptProblem&) = delete;

  bool IsAccelerated() const { return this->how != IterationScheme::SourceIteration; }

  std::optional<PropagationProblem> inMoments;
  const PropagationProblem* problem = nullptr; ///< null: it is not solved by SolveBySweptOrdinates()
  IterationScheme how = IterationScheme::SourceIteration;
};

/// Whether a channel alone is solved otherwise than all channels together: by another iteration scheme, or in moments
/// of another degree. Both change the light of optically thick voxels, and the light of a channel must not depend on
/// the other channels. Collective.
bool ChannelsDiffer(
  Device& device, const SceneBlock& scene, const OrdinatesSettings& settings, const SweptProblem& all, int channels)
{
  const auto differ = [&](int c) {
    const OneChannelScene one(scene.medium, scene.illumination, c);
    const PropagationProblem even(scene.domain, one.medium, one.light, AsPropagation(settings));
    const SweptProblem swept(device, { scene.domain, one.medium, one.light }, settings, even);
    return swept.how != all.how || !swept.problem != !all.problem ||
      (all.problem && swept.problem->Scattering().Degree() != all.problem->Scattering().Degree());
  };
  return channels > 1 && IteratesAsMaps(settings, true) && (differ(0) || differ(1) || differ(2));
}
}

bool AreAccelerated(Device& device, const SceneBlock& scene, const OrdinatesSettings& settings)
{
  const PropagationProblem even(scene.domain, scene.medium, scene.illumination, AsPropagation(settings));
  const SweptProblem swept(device, scene, settings, even);
  return swept.problem && swept.IsAccelerated();
}

std::optional<LightField> SolveBySweptOrdinates(Device& device, const SceneBlock& scene,
  const OrdinatesSettings& settings, const PropagationProblem& even, const Monitor& monitor)
{
  const SweptProblem swept(device, scene, settings, even);
  if (ChannelsDiffer(device, scene, settings, swept, even.Channels()))
  {
    return SolveEachColour(scene, monitor, [&](const SceneBlock& one, const Monitor& ofOne) {
      return SolveDiscreteOrdinates(device, one.domain, one.medium, one.illumination, settings, ofOne, one.kept);
    });
  }
  if (!swept.problem)
  {
    return {};
  }
  scene.domain.Collective([&] { CheckMemoryOf(device, *swept.problem, swept.how); });
  return SolveBySweeps(
    device, *swept.problem, scene.illumination, swept.how, monitor, scene.kept, TransportByOrdinates);
}
}
