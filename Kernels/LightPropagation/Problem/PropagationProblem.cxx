#include "LightPropagation/Problem/PropagationProblem.h"

#include "Light/LeftOut.h"

namespace tyndall
{
namespace
{
/// So that the first member of a problem is made of what has been looked at.
const Grid& Checked(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  Check(medium);
  Check(illumination);
  Check(settings);
  return medium.grid;
}
}

PropagationProblem::PropagationProblem(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const DeviceMemory& memory)
  : Unvarying(Checked(medium, illumination, settings), illumination, settings)
  , TheSettings(settings)
  , DirectionsAskedFor(settings.directionsPerFace)
{
  Medium wide = medium;
  wide.grid = this->Unvarying.Widened(medium.grid);
  this->Narrowing = medium.grid.VoxelVolume() / wide.grid.VoxelVolume();
  this->TheSettings.directionsPerFace = DirectionsPerFaceFor(settings, this->Unvarying);
  this->TakeUnits(wide, illumination);
  this->TheTraits = TraitsOf(this->Solved, true);
  this->Reduction.emplace(this->Solved, this->TheTraits, this->SolvedLight);
  this->ChannelCount = this->Reduction->Solved(settings.leaveOut);
  if (this->ChannelCount == 1)
  {
    const OneChannelScene scene(this->Solved, this->SolvedLight, *this->Reduction);
    this->Solved = scene.medium;
    this->SolvedLight = scene.light;
  }
  const int degree = AngularDegreeFor(this->Solved, this->TheSettings, this->IsSlab(), memory);
  this->Truncated.emplace(this->Solved, this->TheTraits.scatters ? degree : 0, this->ChannelCount);
  // The traits know of extinction by the similarity relation alone.
  this->TheTraits.greyExtinction =
    this->TheTraits.grey || (this->TheTraits.greyExtinction && this->Truncated->Degree() == 0);
}

void PropagationProblem::TakeUnits(const Medium& wide, const Illumination& illumination)
{
  this->Solved = wide;
  this->SolvedLight = illumination;
  this->LengthUnit = LengthUnitOf(wide.grid);
  if (this->LengthUnit != 1.0)
  {
    this->InLengths.emplace(this->Solved, this->SolvedLight, this->LengthUnit);
    this->Solved = this->InLengths->medium;
    this->SolvedLight = this->InLengths->illumination;
  }
  this->PowerUnit = PowerUnitOf(this->Solved, this->SolvedLight);
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
