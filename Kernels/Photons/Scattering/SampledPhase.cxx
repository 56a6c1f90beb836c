#include "Photons/Scattering/SampledPhase.h"

#include "Device/Defines.h"

#include <vector>

namespace tyndall
{
namespace
{
constexpr int TableParts = 65536;

enum Ways
{
  Evenly = 0,
  ByHenyeyGreenstein = 1,
  BySchlick = 2,
  ByTable = 3
};

int WayOf(const Medium& medium)
{
  const PhaseFunction& function = medium.phase.OfChannel(0);
  if (!medium.phase.Varies() && function.IsIsotropic())
  {
    return Evenly;
  }
  switch (function.TheKind())
  {
    case PhaseFunction::Kind::Isotropic: return medium.phase.Varies() ? ByHenyeyGreenstein : Evenly;
    case PhaseFunction::Kind::HenyeyGreenstein: return ByHenyeyGreenstein;
    case PhaseFunction::Kind::Schlick: return BySchlick;
    default: return ByTable;
  }
}

std::vector<float> ParametersOf(const Medium& medium)
{
  if (!medium.phase.Varies())
  {
    return { static_cast<float>(medium.phase.OfChannel(0).Shape().first) };
  }
  std::vector<float> values;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    values.push_back(static_cast<float>(medium.phase.At(i, 0).Shape().first));
  }
  return values;
}

std::vector<float> TableOf(const PhaseFunction& function)
{
  std::vector<float> cosines;
  for (int i = 0; i <= TableParts; ++i)
  {
    cosines.push_back(static_cast<float>(function.CosineAt(static_cast<double>(i) / TableParts)));
  }
  return cosines;
}
}

SampledPhase::SampledPhase(Device& device, const Medium& medium)
  : Way(WayOf(medium))
  , Varies(medium.phase.Varies())
  , Parts(Way == ByTable ? TableParts : 0)
{
  std::vector<float> numbers;
  if (this->Way == ByTable)
  {
    numbers = TableOf(medium.phase.OfChannel(0));
  }
  else if (this->Way != Evenly)
  {
    numbers = ParametersOf(medium);
  }
  this->Numbers = Buffer<float>(device, numbers, "how light is scattered");
}

std::string SampledPhase::Options() const
{
  return Define("PHASE", this->Way) + Define("VARIES", this->Varies) + Define("COSINES", this->Parts);
}
}
