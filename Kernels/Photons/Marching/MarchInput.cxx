#include "Photons/Marching/MarchInput.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"

#include <limits>
#include <string>
#include <vector>

namespace tyndall
{
FilledBricks CheckMarchedMedium(
  const Domain& domain, const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree)
{
  Check(domain.Whole());
  domain.Partition().Check();
  if (domain.IsEmpty())
  {
    return FilledBricks();
  }
  const std::string rank = std::to_string(domain.Rank());
  const FilledBricks filled = CheckedBricks(medium);
  Require(
    medium.grid.size == domain.Own().size, "The medium of rank " + rank + " does not have the size of its block.");
  CheckIndex(ior, medium.grid);
  CheckLevels(levels, medium.grid, domain.Whole());
  Require((levels != nullptr) == octree,
    "The block of rank " + rank +
      (levels ? " has octree levels and others have none." : " has no octree levels and others have."));
  return filled;
}

void RequireSameMedium(const Domain& domain, const Medium& medium, const Field& ior)
{
  Communicator& communicator = domain.Comm();
  RequireSame(communicator, domain.Partition());
  const bool has = !domain.IsEmpty();
  RequireSame(communicator, "whether there is a refractive index", has, { ior.values ? 1.0 : 0.0 });
  const auto components = [](const Field& field) { return field.values ? field.components : 0; };
  RequireSame(communicator, "the components of sigma_a or sigma_s", has,
    { 1.0 * components(medium.sigma_a), 1.0 * components(medium.sigma_s) });
}

IndexRange IndexRangeOfAll(const Domain& domain, const IndexRange& own)
{
  const double endless = std::numeric_limits<double>::infinity();
  return { static_cast<float>(-domain.Max(domain.IsEmpty() ? -endless : -own.least)),
    static_cast<float>(domain.Max(domain.IsEmpty() ? -endless : own.largest)) };
}
}
