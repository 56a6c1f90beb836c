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

LightEnds LightEndsIn(const Medium& medium, const Illumination& illumination)
{
  LightEnds ends;
  const auto any = [&](const Field& field, int channel) {
    bool found = false;
    for (std::size_t i = 0; i < medium.grid.VoxelCount() && field.values && !found; ++i)
    {
      found = field.At(i, channel) > 0.0f;
    }
    return found;
  };
  for (int c = 0; c < 3; ++c)
  {
    bool meets = illumination.uncollided.IsThere();
    for (const Light& light : illumination.lights)
    {
      meets = meets || (light.type != LightType::Directional && light.power[c] > 0.0);
    }
    ends.absorbs[c] = any(medium.sigma_a, c);
    ends.begins[c] = !ends.absorbs[c] && (any(medium.emission, c) || (meets && any(medium.sigma_s, c)));
  }
  return ends;
}

void RequireSink(const LightEnds& ends, const Illumination& illumination, const PropagationSettings& settings)
{
  const std::array<bool, 3>& periodic = settings.periodic;
  const bool anyFace = !periodic[0] || !periodic[1] || !periodic[2];
  for (int c = 0; c < 3; ++c)
  {
    bool closed = true;
    for (int face = 0; face < 6; ++face)
    {
      closed = closed && (periodic[face / 2] || illumination.faceAlbedo[face][c] >= 1.0);
    }
    if (closed && anyFace && !ends.absorbs[c])
    {
      throw InvalidInput("Every face gives back all light (FaceAlbedo 1) and the medium absorbs none: light would grow "
                         "without end. Give a face an albedo below 1, or the medium some sigma_a.");
    }
    if (!anyFace && !ends.absorbs[c] && ends.begins[c] && settings.maximumOrders == 0)
    {
      throw InvalidInput("All three axes are periodic and the medium absorbs no light: what begins in it would grow "
                         "without end. Leave an axis open, give the medium some sigma_a, or set MaximumOrders.");
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
  RequireSink(LightEndsIn(medium, illumination), illumination, settings);
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
  this->PowerUnit = PowerUnitFor(ShiningOn(this->Solved.grid, this->Solved, this->SolvedLight));
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
