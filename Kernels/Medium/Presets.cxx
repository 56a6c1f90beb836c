#include "Medium/Presets.h"

namespace tyndall
{
namespace
{
const char* const AsMeasured = "the medium as it was measured";
const char* const Jensen = "Jensen, Marschner, Levoy, Hanrahan: A practical model for subsurface light transport, "
                           "SIGGRAPH 2001, figure 5 (reduced scattering)";

/// Converts coefficients given per kilometre or metre to 1/mm.
constexpr Rgb PerMillimetre(const Rgb& coefficients, double lengthInMillimetres)
{
  return { coefficients[0] / lengthInMillimetres, coefficients[1] / lengthInMillimetres,
    coefficients[2] / lengthInMillimetres };
}

/// Mean cosine 0, for media without a measured value, or whose sigma_s is the reduced coefficient sigma_s (1 - g).
constexpr Rgb Isotropic = { 0.0, 0.0, 0.0 };

constexpr Rgb OfAllColours(double g)
{
  return { g, g, g };
}

/// Cloud, by Slingo's parametrisation for the band 0.25 to 0.69 um at effective radius r = 10 um:
///   extinction = a + b / r = 0.02817 + 1.305 / 10 m^2/g
///   1 - albedo = c + d r = -5.62e-8 + 1.63e-7 * 10
///   g          = e + f r = 0.829 + 0.002482 * 10
MediumPreset Cloud()
{
  const double extinction = 0.02817 + 1.305 / 10.0; // 1/m
  const double absorbed = -5.62e-8 + 1.63e-7 * 10.0;
  const double s = extinction * (1.0 - absorbed);
  const double a = extinction * absorbed;
  return { "Cloud", "1 g of liquid water per cubic metre, in droplets of 10 um effective radius",
    PerMillimetre({ s, s, s }, 1e3), PerMillimetre({ a, a, a }, 1e3), OfAllColours(0.829 + 0.002482 * 10.0),
    "Slingo: A GCM parameterization for the shortwave radiative properties of water clouds, J. Atmos. Sci. 46 (1989), "
    "visible band" };
}

MediumPreset Fog()
{
  return { "Fog", "1 droplet per cubic centimetre", PerMillimetre({ 0.5636, 0.5620, 0.5587 }, 1e6),
    PerMillimetre({ 1.646e-6, 1.675e-7, 2.331e-7 }, 1e6), OfAllColours(0.866),
    "Hess, Koepke, Schult: Optical properties of aerosols and clouds (OPAC), Bull. Am. Meteorol. Soc. 79 (1998), "
    "data file of fog" };
}

/// Smoke. Absorption is 7.5 m^2/g at 550 nm, proportional to 1 / wavelength. Scattering is the extinction, 8.7 m^2/g at
/// 633 nm, minus the absorption at 633 nm. It is equal in all channels, and isotropic because no mean cosine was
/// measured.
MediumPreset Smoke()
{
  const double scattering = 8.7 - 7.5 * 550.0 / 633.0;
  return {
    "Smoke", "1 g of soot per cubic metre", PerMillimetre({ scattering, scattering, scattering }, 1e3),
    PerMillimetre({ 7.5 * 550.0 / 650.0, 7.5, 7.5 * 550.0 / 450.0 }, 1e3), Isotropic,
    "Absorption: Bond, Bergstrom: Light absorption by carbonaceous particles, Aerosol Sci. Technol. 40 (2006). "
    "Extinction: Mulholland, Croarkin: Specific extinction coefficient of flame generated smoke, Fire Mater. 24 (2000)"
  };
}

MediumPreset Espresso()
{
  return { "Espresso", AsMeasured, { 7.78262, 8.13050, 8.53875 }, { 4.79838, 6.57512, 8.84925 },
    { 0.907, 0.896, 0.880 },
    "Narasimhan, Gupta, Donner, Ramamoorthi, Nayar, Jensen: Acquiring scattering properties of participating media by "
    "dilution, SIGGRAPH 2006" };
}
}

const std::vector<MediumPreset>& MediumPresets()
{
  static const std::vector<MediumPreset> presets = {
    Cloud(),
    Fog(),
    Smoke(),
    { "Skim milk", AsMeasured, { 0.70, 1.22, 1.90 }, { 0.0014, 0.0025, 0.0142 }, Isotropic, Jensen },
    { "Whole milk", AsMeasured, { 2.55, 3.21, 3.77 }, { 0.0011, 0.0024, 0.014 }, Isotropic, Jensen },
    { "Cream", AsMeasured, { 7.38, 5.47, 3.15 }, { 0.0002, 0.0028, 0.0163 }, Isotropic, Jensen },
    Espresso(),
    { "Ketchup", AsMeasured, { 0.18, 0.07, 0.03 }, { 0.061, 0.97, 1.45 }, Isotropic, Jensen },
    { "Marble", AsMeasured, { 2.19, 2.62, 3.00 }, { 0.0021, 0.0041, 0.0071 }, Isotropic, Jensen },
    { "Skin 1", AsMeasured, { 0.74, 0.88, 1.01 }, { 0.032, 0.17, 0.48 }, Isotropic, Jensen },
    { "Skin 2", AsMeasured, { 1.09, 1.59, 1.79 }, { 0.013, 0.070, 0.145 }, Isotropic, Jensen },
  };
  return presets;
}
}
