#include "Reference/SlabReference.h"

#include "Reference/ReferenceTable.h"

#include <cmath>
#include <limits>

namespace
{
/// Of both faces: what diffusion adds to a slab's optical thickness.
double ExtrapolationLengths()
{
  return 2.0 * ReferenceRowWhere("hopf", { { "tau", std::numeric_limits<double>::infinity() } })["q"];
}
}

SlabReference SlabOf(double tau, double albedo)
{
  const ReferenceRow row = ReferenceRowWhere("slab", { { "tau", tau }, { "omega", albedo }, { "g", 0.0 } });
  return { tau, albedo, row["R_diffuse"], row["T_diffuse"], row["R_mu1"], row["T_mu1"], row["T_mu05"] };
}

double ThickSlabTransmittance(double tau)
{
  return 4.0 / (3.0 * (tau + ExtrapolationLengths()));
}

double ThickSlabBeamTransmittance(double tau, double mu)
{
  return ChandrasekharH(1.0, mu) / std::sqrt(3.0) / (tau + ExtrapolationLengths());
}

double ChandrasekharH(double albedo, double mu)
{
  return ReferenceRowWhere("chandrasekhar_H", { { "omega", albedo }, { "mu", mu } })["H"];
}
