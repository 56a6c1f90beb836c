#include "LightPropagation/Problem/PropagationProblem.h"

#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Checks a scene before the first data member of a PropagationProblem is initialised from it. @return `domain`
const Domain& Checked(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  Check(domain, medium, illumination, settings);
  return domain;
}
}

PropagationProblem::PropagationProblem(const Domain& domain, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const DeviceMemory& memory)
  : Unvarying(Checked(domain, medium, illumination, settings).Whole(), illumination, settings)
  , Solving(domain.WithGrid(this->Unvarying.Widened(domain.Whole())))
  , TheSettings(settings)
  , DirectionsAskedFor(settings.directionsPerFace)
  , Solved(domain.IsEmpty() ? Medium() : medium)
{
  this->Narrowing = domain.Whole().VoxelVolume() / this->Whole().VoxelVolume();
  this->TheSettings.directionsPerFace = DirectionsPerFaceFor(settings, this->Unvarying);
  this->TakeUnits(illumination);
  this->TheTraits = TraitsOfAll(domain.Comm(), domain.IsEmpty() ? MediumTraits() : TraitsOf(this->Solved, true));
  this->TakeChannels();
  this->Given = domain.Any(this->SolvedLight.uncollided.IsThere());
  this->Isotropic = !domain.Any(!domain.IsEmpty() && !this->Solved.phase.IsIsotropic());
  this->Truncate(memory);
  // Whether the extinction is equal in all channels: TraitsOf() compares the extinctions for isotropic scattering
  // (similarity relation). If scattering has moments above degree 0, sweeps use other extinctions, which are equal in
  // all channels if the medium is grey.
  this->TheTraits.greyExtinction =
    this->TheTraits.grey || (this->TheTraits.greyExtinction && this->Truncated->Degree() == 0);
}

void PropagationProblem::TakeChannels()
{
  const SceneChannels own(this->Solved, this->TheTraits, this->SolvedLight);
  this->Reduction.emplace(ChannelsOfAll(this->Solving, own));
  this->ChannelCount = this->Reduction->Solved(this->TheSettings.leaveOut);
  if (this->ChannelCount == 1)
  {
    const OneChannelScene scene(this->Solved, this->SolvedLight, *this->Reduction);
    this->Solved = scene.medium;
    this->SolvedLight = scene.light;
  }
}

/// Sets Truncated: the delta-M scattering, of a degree that follows from properties of the domain. Collective.
void PropagationProblem::Truncate(const DeviceMemory& memory)
{
  const Domain& domain = this->Solving;
  AngularDetail detail = AngularDetailOf(this->Solved, this->ChannelCount);
  detail.moments = domain.Max(detail.moments);
  detail.extinction = domain.Sum(detail.extinction);
  std::size_t most = 0;
  for (const VoxelBox& block : domain.Partition().blocks)
  {
    most = std::max(most, block.VoxelCount());
  }
  int degree = 0;
  domain.Collective([&] {
    degree = this->TheTraits.scatters
      ? AngularDegreeFor(detail, this->Whole(), this->TheSettings, this->IsSlab(), most, memory)
      : 0;
  });
  degree = -static_cast<int>(domain.Max(-1.0 * degree)); // lowest degree of all ranks
  this->MuchThinner = IsMuchThinnerAlongOneAxis(detail, this->Whole(), this->ChannelCount, this->TheSettings.periodic);
  domain.Collective([&] {
    std::optional<DirectionKernel> kernel;
    if (degree > 0 && this->MuchThinner)
    {
      kernel.emplace(DirectionsForVoxels(this->TheSettings.directionsPerFace, this->Whole().spacing), degree);
    }
    this->Truncated.emplace(this->Solved, degree, this->ChannelCount, kernel ? &*kernel : nullptr);
  });
  this->Truncated->RaiseDegree(static_cast<int>(domain.Max(1.0 * this->Truncated->Degree())));
}

void PropagationProblem::TakeUnits(const Illumination& illumination)
{
  this->Solved.grid = this->Solving.OwnGrid();
  this->SolvedLight = illumination;
  this->SolvedLight.lights = SeenFrom(this->Whole(), illumination.lights);
  for (Rgb& face : this->SolvedLight.uncollided.escaped)
  {
    face = Times(face, 1.0 / this->Narrowing);
  }
  this->LengthUnit = LengthUnitOf(this->Whole());
  this->Solving.Collective([&] {
    if (this->LengthUnit != 1.0)
    {
      this->InLengths.emplace(this->Solved, this->SolvedLight, this->LengthUnit);
      this->Solved = this->InLengths->medium;
      this->SolvedLight = this->InLengths->illumination;
    }
  });
  this->Solving = this->Solving.WithGrid(InUnit(this->Whole(), this->LengthUnit));
  const AllThatShines here =
    this->Solving.IsEmpty() ? AllThatShines() : ShiningOn(this->Whole(), this->Solved, this->SolvedLight);
  const std::vector<double> all = this->Solving.Max(std::vector<double>{ here.power, here.first });
  this->Solving.Collective([&] { CheckBrightness(this->Whole(), { all[0], all[1] }); });
  this->PowerUnit = PowerUnitFor({ all[0], all[1] });
  if (this->PowerUnit != 1.0)
  {
    this->InUnits.emplace(this->Solved, this->SolvedLight, this->PowerUnit);
    this->Solved = this->InUnits->medium;
    this->SolvedLight = this->InUnits->illumination;
  }
}

void PropagationProblem::Undo(LightField& light) const
{
  this->Reduction->Undo(light, this->ChannelCount);
  if (this->PowerUnit != 1.0)
  {
    ToWatts(light, this->PowerUnit);
  }
  if (this->LengthUnit != 1.0)
  {
    MultiplyPowers(light, this->LengthUnit * this->LengthUnit);
  }
  light.directionsPerFace = this->TheSettings.directionsPerFace;
  if (light.directionsPerFace != this->DirectionsAskedFor)
  {
    light.leftOut.push_back(left_out::DirectionsAlongSlab(light.directionsPerFace));
  }
  MultiplyPowers(light, this->Narrowing);
}
}
