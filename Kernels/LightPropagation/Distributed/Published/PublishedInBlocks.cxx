#include "LightPropagation/Distributed/Published/PublishedInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Distributed/Published/SlabRaysInTurn.h"
#include "LightPropagation/Distributed/Published/SlabRaysOnDevice.h"
#include "LightPropagation/Distributed/Published/SweepInSlabs.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Published/PublishedLight.h"
#include "LightPropagation/Published/PublishedWarmStart.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "Lights/UncollidedImage.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// What all ranks have together.
struct SceneOfAll
{
  MediumTraits traits;
  int channels = 1;
  bool isotropic = true;
  Rgb emitted = {};   ///< W
  bool given = false; ///< uncollided light is
};

SceneOfAll SceneOf(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination)
{
  SceneOfAll scene;
  const MediumTraits own = has ? TraitsOf(medium) : MediumTraits();
  scene.traits = TraitsOfAll(communicator, own);
  const int channels = has ? SceneChannels(medium, own, illumination).given : 1;
  scene.channels = static_cast<int>(communicator.Largest({ 1.0 * channels })[0]);
  scene.isotropic = !OnAnyRank(communicator, has && !medium.phase.IsIsotropic());
  scene.given = OnAnyRank(communicator, has && illumination.uncollided.IsThere());
  const Rgb emitted = has ? EmittedBy(medium, scene.channels) : Rgb{};
  const std::vector<double> sum = communicator.Sum({ emitted[0], emitted[1], emitted[2] });
  std::copy(sum.begin(), sum.end(), scene.emitted.begin());
  return scene;
}

/// Rays of an algorithm, still without planes; faces must stay.
using MakeRays = std::function<std::unique_ptr<SlabRays>(const PublishedModel& model, const PublishedFaces& faces)>;

/// Orders one by one, of all ranks; of the voxels those of this rank's block.
class PublishedOfBlock
{
public:
  /// All ranks make one together. What is given must stay.
  PublishedOfBlock(Communicator& communicator, const BlockPartition& partition, bool has, const Medium& medium,
    const Illumination& illumination, const PropagationSettings& settings, const PublishedModel& model,
    const SceneOfAll& scene, const MakeRays& make, const KeptLight* kept)
    : Comm(communicator)
    , Has(has)
    , CountsGiven(IsFirstThatHas(communicator, partition))
    , TheMedium(medium)
    , Given(illumination.uncollided)
    , Model(model)
    , NetFlux(settings.netFlux)
    , Ledger(partition.whole.VoxelVolume(), scene.emitted, this->Model, settings)
    , Faces(partition.whole, this->Model, settings)
    , Rays(make(this->Model, this->Faces))
    , Sweep(communicator, partition, medium, this->Model, settings, *this->Rays)
    , Warm({ medium, this->Model, settings, partition.whole, 1, &communicator, partition.blocks[communicator.Rank()] },
        kept)
    , Emits(scene.traits.emits || !settings.leaveOut)
    , IsGiven(scene.given)
    , Values(has ? medium.grid.VoxelCount() * model.Channels() : 0)
  {
  }

  void RunOrder(const Monitor& monitor)
  {
    const int order = this->Ledger.Orders();
    const Monitor ofOrder = OfPart(monitor, [this](double done) { return this->Ledger.Progress(done); });
    this->Ledger.Count(this->Sweep.Run(order, this->Emits, this->Faces, ofOrder));
    this->Collect(order);
    this->BeginOrGoOnWarm(order);
    this->Scatter();
    if (order == 0 && this->IsGiven)
    {
      this->Ledger.Count(this->PowersGiven());
    }
    this->Close();
    this->Emits = true; // from now on U is not zero
  }

  bool Done() const { return this->Ledger.Done(); }
  int Orders() const { return this->Ledger.Orders(); }

  LightField Result() const
  {
    LightField field;
    TakeMoments(
      this->Model, this->NetFlux, [this](int k) { return this->OneOf(this->Totals, k); }, field);
    field.fluenceDirect = this->FluenceDirect;
    this->Ledger.WriteTo(field);
    this->Faces.WriteTo(field);
    if (this->Warm.Keeps())
    {
      field.leftOut.push_back(this->Warm.Words());
    }
    return field;
  }

  KeptLight Left() const { return this->Warm.Leave(this->Totals, this->Faces, this->Ledger.Rate()); }
  bool BeganWarm() const { return this->Warm.Begins(); }

private:
  std::vector<float> OneOf(const std::vector<float>& moments, int k) const
  {
    const auto first = moments.begin() + static_cast<std::ptrdiff_t>(k * this->Values);
    return { first, first + static_cast<std::ptrdiff_t>(this->Values) };
  }

  /// What all sweeps left in this block.
  void Collect(int order)
  {
    HeldFailure failure;
    failure.Attempt([&] {
      this->Totals.resize(this->Values * this->Model.MomentCount(), 0.0f); // in the first order
      this->Moments.resize(this->Totals.size());
    });
    for (int k = 0; k < this->Model.MomentCount() && this->Has; ++k)
    {
      const std::vector<float> moment = this->Sweep.Moment(k, failure);
      failure.Attempt([&] {
        std::copy(moment.begin(), moment.end(), this->Moments.begin() + static_cast<std::ptrdiff_t>(k * this->Values));
      });
    }
    failure.Attempt([&] {
      if (order == 0 && this->Has)
      {
        this->LookAtDirect();
      }
    });
    this->Comm.Collective([&] { failure.Throw(); });
  }

  void LookAtDirect()
  {
    if (this->Given.IsThere())
    {
      AddGiven(this->Model, this->Given, this->TheMedium.grid.VoxelCount(),
        [this](std::size_t k, std::size_t voxel, int c, double value) {
          this->Moments[k * this->Values + voxel * this->Model.Channels() + c] += static_cast<float>(value);
        });
    }
    this->FluenceDirect = this->OneOf(this->Moments, 0);
  }

  /// As ParallelPropagation does.
  void BeginOrGoOnWarm(int order)
  {
    if (order == 0 && this->Warm.Keeps())
    {
      this->Warm.AddTo(this->Moments, this->Faces, this->FluenceDirect);
      if (this->Warm.Begins())
      {
        this->Ledger.BeginWarm(this->Warm.Rate());
      }
    }
    else if (order == 1 && this->Warm.Begins())
    {
      this->Warm.TakeFrom(this->Moments);
    }
  }

  /// Eq. (4): U of the next order, and I of all so far.
  void Scatter()
  {
    std::transform(
      this->Totals.begin(), this->Totals.end(), this->Moments.begin(), this->Totals.begin(), std::plus<>());
    HeldFailure failure;
    if (this->Has)
    {
      this->Sweep.WriteSources([this](int d) { return this->SourceOf(d); }, failure);
    }
    this->Comm.Collective([&] { failure.Throw(); });
  }

  std::vector<float> SourceOf(int sourceDirection) const
  {
    const PublishedModel::Part part = this->Model.Source(sourceDirection);
    const float factor = static_cast<float>(part.factor);
    std::vector<float> source = this->OneOf(this->Moments, part.moment);
    const std::size_t channels = static_cast<std::size_t>(this->Model.Channels());
    for (std::size_t i = 0; i < source.size(); ++i)
    {
      source[i] *= factor * this->TheMedium.sigma_s.At(i / channels, static_cast<int>(i % channels));
    }
    return source;
  }

  /// What came in is what all ranks' voxels take and what left, which each is told.
  SweepTally PowersGiven() const
  {
    SweepTally tally;
    for (int c = 0; c < this->Model.Channels() && this->Has; ++c)
    {
      tally.in[0][c] = PowerLost(this->Given, this->TheMedium, c);
      for (int face = 0; face < 6 && this->CountsGiven; ++face)
      {
        tally.in[0][c] += this->Given.escaped[face][c];
        tally.out[face][c] = this->Given.escaped[face][c];
      }
    }
    return SumOverRanks(this->Comm, tally);
  }

  void Close()
  {
    if (this->Faces.Count())
    {
      this->Faces.PowersLeft() = this->Comm.Sum(this->Faces.PowersLeft());
    }
    this->Faces.CloseOrder(this->Ledger);
    const OrderSums own =
      this->Has ? SumsOf(this->TheMedium, this->Model.Channels(), this->Moments.data()) : OrderSums();
    std::vector<double> values;
    for (const Rgb* rgb : { &own.fluence, &own.magnitude, &own.absorbed, &own.scattered })
    {
      values.insert(values.end(), rgb->begin(), rgb->end());
    }
    values = this->Comm.Sum(values);
    OrderSums all;
    auto from = values.begin();
    for (Rgb* rgb : { &all.fluence, &all.magnitude, &all.absorbed, &all.scattered })
    {
      std::copy_n(from, 3, rgb->begin());
      from += 3;
    }
    this->Ledger.CloseOrder(all);
  }

  Communicator& Comm;
  const bool Has, CountsGiven;
  const Medium& TheMedium;
  const UncollidedImage& Given;
  const PublishedModel& Model;
  const bool NetFlux;
  OrderLedger Ledger;
  PublishedFaces Faces;
  const std::unique_ptr<SlabRays> Rays;
  SweepInSlabs Sweep;
  PublishedWarmStart Warm;
  bool Emits; ///< U is not zero
  const bool IsGiven;
  const std::size_t Values;           ///< of a moment: voxels times channels
  std::vector<float> Totals, Moments; ///< of all orders, of the last; [moment][voxel][channel]
  std::vector<float> FluenceDirect;
};

void CheckPublishedBlocks(Communicator& communicator, const BlockPartition& partition, bool has, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings)
{
  communicator.Collective([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    if (has)
    {
      CheckBlock(medium, illumination, settings);
      CheckPublishedPhase(medium);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
  });
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, settings);
  RequireSame(communicator, "StoredDirections", true, { 1.0 * settings.storedDirections });
  RequireSink(LightEndsOnAny(communicator, has, medium, illumination), illumination, settings);
}

std::vector<std::string> LeftOutOfBlocks(
  const SceneOfAll& scene, const Illumination& illumination, const PropagationSettings& settings, int orders)
{
  std::vector<std::string> words =
    LeftOutAsPublished(scene.isotropic, scene.traits, scene.given, illumination, settings, orders);
  if (settings.leaveOut && scene.channels == 1)
  {
    words.insert(words.begin(), left_out::Grey);
  }
  return words;
}

/// By an algorithm, which is the same on all ranks.
LightField SolveBy(const MakeRays& make, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor,
  KeptLight* kept)
{
  RequireSame(communicator, "WarmStart", true, { kept ? 1.0 : 0.0 });
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  CheckPublishedBlocks(communicator, partition, has, medium, illumination, settings);
  Medium own = has ? medium : Medium();
  own.grid = partition.OwnGrid(communicator.Rank());
  const SceneOfAll scene = SceneOf(communicator, has, own, illumination);
  std::optional<PublishedModel> model;
  communicator.Collective(
    [&] { model.emplace(has ? medium.phase : PhaseOfMedium(), illumination, settings, scene.channels); });
  PublishedOfBlock propagation(communicator, partition, has, own, illumination, settings, *model, scene, make, kept);
  do
  {
    propagation.RunOrder(monitor);
  } while (!propagation.Done());
  LightField light;
  communicator.Collective([&] { light = propagation.Result(); });
  const std::vector<std::string> leftOut = LeftOutOfBlocks(scene, illumination, settings, propagation.Orders());
  light.leftOut.insert(light.leftOut.begin(), leftOut.begin(), leftOut.end());
  light.halfRangeFlux = HalfRangeFlux(model->Directions());
  JudgeConvergence(settings, light, false);
  WarnAboutInputLight(illumination, light);
  communicator.Collective([&] {
    if (kept)
    {
      Keep(propagation.Left(), propagation.BeganWarm(), light, *kept);
    }
  });
  return light;
}

void RequireSameAlgorithm(Communicator& communicator, bool inTurn)
{
  RequireSame(communicator, "Algorithm", true, { inTurn ? 1.0 : 0.0 });
}
}

LightField SolvePublishedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor,
  KeptLight* kept)
{
  RequireSameAlgorithm(communicator, false);
  const MakeRays make = [&](const PublishedModel& model, const PublishedFaces& faces) {
    return std::make_unique<SlabRaysOnDevice>(device, partition.whole, model, settings, faces);
  };
  LightField light = SolveBy(make, communicator, partition, medium, illumination, settings, monitor, kept);
  light.device = device.Name();
  return light;
}

LightField SolveSequentialInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  RequireSameAlgorithm(communicator, true);
  const MakeRays make = [&](const PublishedModel& model, const PublishedFaces&) {
    return std::make_unique<SlabRaysInTurn>(partition.whole, model, settings);
  };
  LightField light = SolveBy(make, communicator, partition, medium, illumination, settings, monitor, nullptr);
  light.device = SequentialDevice;
  return light;
}
}
