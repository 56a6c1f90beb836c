#include "LightPropagation/Published/SequentialPropagation.h"

#include "Light/ChannelReduction.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedLight.h"
#include "LightPropagation/Published/SequentialRays.h"
#include "LightPropagation/Uncollided/GivenLight.h"

#include <algorithm>
#include <optional>

namespace tyndall
{
namespace
{
class SequentialPropagation
{
public:
  SequentialPropagation(
    const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels)
    : TheMedium(medium)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Ledger(medium, this->Model, settings)
    , Faces(medium.grid, this->Model, settings)
    , Channels(this->Model.Channels())
    , Given(illumination.uncollided)
    , Values(medium.grid.VoxelCount() * this->Channels)
    , Rays(medium.grid, std::nullopt, medium, this->Model, this->Settings)
    , Moments(this->Model.MomentCount(), std::vector<float>(this->Values))
    , Carried(this->Model.Directions().directions.size())
  {
  }

  LightField Solve(const Monitor& monitor)
  {
    LightField field;
    do
    {
      this->Propagate(monitor);
      if (this->Ledger.Orders() == 0 && this->Given.IsThere())
      {
        this->AddGiven();
      }
      this->Ledger.Count(this->Tally);
      const std::vector<double>& ofOrder = this->Rays.Moment(0);
      const std::vector<float> fluence(ofOrder.begin(), ofOrder.end());
      this->Faces.CloseOrder(this->Ledger);
      this->Ledger.CloseOrder(SumsOf(this->TheMedium, this->Channels, fluence.data()));
      this->UpdateSources();
      if (this->Ledger.Orders() == 1)
      {
        field.fluenceDirect = fluence;
      }
    } while (!this->Ledger.Done());
    this->WriteTo(field);
    return field;
  }

private:
  /// All rays of all maps, once.
  void Propagate(const Monitor& monitor)
  {
    this->Rays.DarkenMoments();
    this->Tally = {};
    const std::size_t directions = this->Carried.size();
    for (std::size_t i = 0; i < directions; ++i)
    {
      const Monitor ofMap = OfPart(monitor, [this, i, directions](double done) {
        return this->Ledger.Progress((static_cast<double>(i) + done) / static_cast<double>(directions));
      });
      this->Carried[i] =
        this->Rays.Send(static_cast<int>(i), this->Ledger.Orders(), this->Carried[i], this->Faces, this->Tally, ofMap);
    }
  }

  /// Light that another solver found, to the moments of the first order.
  void AddGiven()
  {
    tyndall::AddGiven(this->Model, this->Given, this->TheMedium.grid.VoxelCount(),
      [this](std::size_t k, std::size_t voxel, int c, double value) {
        this->Rays.Moment(static_cast<int>(k))[voxel * this->Channels + c] += value;
      });
    tyndall::Add(this->Tally, TallyOf(this->Given, this->TheMedium, 0, this->Channels));
  }

  /// The rest of Eq. (4): U of the next order from what this one left in the voxels.
  void UpdateSources()
  {
    for (std::size_t k = 0; k < this->Moments.size(); ++k)
    {
      const std::vector<double>& moment = this->Rays.Moment(static_cast<int>(k));
      std::transform(this->Moments[k].begin(), this->Moments[k].end(), moment.begin(), this->Moments[k].begin(),
        [](float sum, double more) { return sum + static_cast<float>(more); });
    }
    const int sources = static_cast<int>(this->Model.SourceDirections().size());
    for (int d = 0; d < sources; ++d)
    {
      const PublishedModel::Part part = this->Model.Source(d);
      const std::vector<double>& moment = this->Rays.Moment(part.moment);
      std::vector<float>& source = this->Rays.Source(d);
      for (std::size_t i = 0; i < source.size(); ++i)
      {
        const float scattered = this->TheMedium.sigma_s.At(i / this->Channels, static_cast<int>(i % this->Channels));
        source[i] = static_cast<float>(part.factor * scattered * moment[i]);
      }
    }
  }

  void WriteTo(LightField& field) const
  {
    TakeMoments(
      this->Model, this->Settings.netFlux, [this](int k) { return this->Moments[k]; }, field);
    this->Ledger.WriteTo(field);
    this->Faces.WriteTo(field);
    field.halfRangeFlux = HalfRangeFlux(this->Model.Directions());
    field.device = SequentialDevice;
  }

  const Medium& TheMedium;
  PropagationSettings Settings;
  PublishedModel Model;
  OrderLedger Ledger;
  SweepTally Tally; ///< of the order that runs
  PublishedFaces Faces;
  int Channels;
  UncollidedImage Given;
  std::size_t Values; ///< voxels times channels
  SequentialRays Rays;
  std::vector<std::vector<float>> Moments; ///< of all orders
  std::vector<std::vector<float>> Carried; ///< by direction: radiance on its way through a periodic axis
};
}

LightField SolveSequential(
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  Check(medium);
  CheckPublishedPhase(medium); // before channels become one
  Check(illumination);
  const MediumTraits traits = TraitsOf(medium);
  const SceneChannels channels(medium, traits, illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      LightField field = SequentialPropagation(ofChannels, light, settings, count).Solve(monitor);
      field.leftOut = LeftOutAsPublished(medium.phase.IsIsotropic(), traits, illumination.uncollided.IsThere(),
        illumination, settings, static_cast<int>(field.convergence.size()));
      JudgeConvergence(settings, field, false);
      WarnAboutInputLight(illumination, field);
      return field;
    });
}
}
