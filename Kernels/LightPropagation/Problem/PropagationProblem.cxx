#include "LightPropagation/Problem/PropagationProblem.h"

#include "Device/Errors.h"
#include "Light/LeftOut.h"

namespace tyndall
{
namespace
{
/// So that the first member of a problem is made of what has been looked at.
const Grid& Checked(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  Check(medium, illumination, settings);
  return medium.grid;
}
}

std::array<bool, 3> ChannelsThatAbsorb(const Medium& medium)
{
  std::array<bool, 3> absorbs = {};
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < medium.grid.VoxelCount() && !absorbs[c]; ++i)
    {
      absorbs[c] = medium.sigma_a.At(i, medium.sigma_a.components == 3 ? c : 0) > 0.0f;
    }
  }
  return absorbs;
}

void CheckLightHasAnEnd(
  const std::array<bool, 3>& absorbs, const Illumination& illumination, const std::array<bool, 3>& periodic)
{
  bool anyFace = false;
  for (int c = 0; c < 3; ++c)
  {
    bool closed = true;
    for (int face = 0; face < 6; ++face)
    {
      closed = closed && (periodic[face / 2] || illumination.faceAlbedo[face][c] >= 1.0);
      anyFace = anyFace || !periodic[face / 2];
    }
    if (closed && anyFace && !absorbs[c])
    {
      throw InvalidInput("Every face gives back all light (FaceAlbedo 1) and the medium absorbs none: light would grow "
                         "without end. Give a face an albedo below 1, or the medium some sigma_a.");
    }
  }
}

void CheckBlock(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  Check(medium);
  Check(illumination);
  Check(illumination.uncollided, medium);
  Check(settings);
  CheckFaceAlbedo(illumination, settings.periodic);
}

void Check(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  CheckBlock(medium, illumination, settings);
  CheckLightHasAnEnd(ChannelsThatAbsorb(medium), illumination, settings.periodic);
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
  this->Truncate(memory);
  // The traits know of extinction by the similarity relation alone.
  this->TheTraits.greyExtinction =
    this->TheTraits.grey || (this->TheTraits.greyExtinction && this->Truncated->Degree() == 0);
}

void PropagationProblem::Truncate(const DeviceMemory& memory)
{
  const Grid& grid = this->TheGrid();
  const AngularDetail detail = AngularDetailOf(this->Solved, this->ChannelCount);
  const int degree = this->TheTraits.scatters
    ? AngularDegreeFor(detail, grid, this->TheSettings, this->IsSlab(), grid.VoxelCount(), memory)
    : 0;
  std::optional<DirectionKernel> kernel;
  if (degree > 0 && IsMuchThinnerAlongOneAxis(detail, grid, this->ChannelCount, this->TheSettings.periodic))
  {
    kernel.emplace(DirectionsForVoxels(this->TheSettings.directionsPerFace, grid.spacing), degree);
  }
  this->Truncated.emplace(this->Solved, degree, this->ChannelCount, kernel ? &*kernel : nullptr);
}

void PropagationProblem::TakeUnits(const Medium& wide, const Illumination& illumination)
{
  this->Solved = wide;
  this->SolvedLight = illumination;
  this->SolvedLight.lights = SeenFrom(wide.grid, illumination.lights);
  for (Rgb& face : this->SolvedLight.uncollided.escaped)
  {
    face = Times(face, 1.0 / this->Narrowing);
  }
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
