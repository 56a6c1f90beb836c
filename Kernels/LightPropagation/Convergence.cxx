#include "LightPropagation/Convergence.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
/// Safety factor on the sum of later orders that RestOfOrders::After() estimates after a warm start, since the error of
/// an initial guess decreases unevenly.
constexpr double WarmMargin = 1.5;
/// Safety factor on the error that RestOfChanges::After() estimates, since changes decrease unevenly.
constexpr double MarginOfChanges = 1.5;
/// Fraction of the incoming power above which power that was still in transport when the solver stopped adds a warning,
/// unless the tolerance is larger.
constexpr double MuchLeftOver = 0.01;
/// Relative decrease per order below which light that wraps around periodic axes counts as endless.
constexpr double SlowestFall = 1e-4;
/// Light that wraps around periodic axes counts as endless only if all other power is at most this fraction of it.
constexpr double NextToAll = 1e-3;

constexpr double ImbalanceAtMost = 1e-2; ///< imbalance, as fraction of the power, above which the solve fails
constexpr double ImbalanceUnsaid = 1e-4; ///< imbalance, as fraction of the power, up to which there is no warning
/// An imbalance is relative to the incoming power of its channel or, if that is smaller, to this fraction of the
/// incoming power of the brightest channel.
constexpr double FaintChannel = 1e-3;
constexpr double OpaqueVoxel = 100.0; ///< approximate optical thickness beyond which floats lose light in a voxel

struct ThickestVoxel
{
  /// optical thickness along its longest edge, with the transport extinction sigma_a + sigma_s (1 - g), largest of all
  /// channels
  double thickness = 0.0;
  std::string name; ///< text that describes its position in the grid; empty: not known
};

/// Voxel of a medium with the largest transport extinction.
/// @param named  grid in whose indices the voxel is described
/// @param first  position in that grid of the medium's first voxel
ThickestVoxel ThickestOf(const Medium& medium, const Grid& named, const std::array<int, 3>& first = {})
{
  const Grid& grid = medium.grid;
  const int channels = medium.Channels();
  std::size_t thickest = 0;
  float largest = 0.0f;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      const float sigma_t = medium.TransportSigmaT(i, c);
      thickest = sigma_t > largest ? i : thickest;
      largest = std::max(largest, sigma_t);
    }
  }
  if (grid.VoxelCount() == 0)
  {
    return {};
  }
  const std::array<int, 3> at = grid.VoxelAt(thickest);
  return { largest * *std::max_element(grid.spacing.begin(), grid.spacing.end()),
    VoxelName(named, named.IndexOf({ first[0] + at[0], first[1] + at[1], first[2] + at[2] })) };
}

/// Voxel of the domain with the largest transport optical thickness. Collective.
ThickestVoxel ThickestOf(const Domain& domain, const Medium& medium)
{
  const ThickestVoxel own = domain.IsEmpty() ? ThickestVoxel() : ThickestOf(medium, domain.Whole(), domain.Own().first);
  const double thickest = domain.Max(own.thickness);
  const bool has = own.thickness == thickest;
  return { thickest, WordsOfAny(domain.Comm(), has ? own.name : std::string()) };
}

/// Result of an energy balance check: no error, an error worth a warning, or failure.
enum class Balancing
{
  Well,
  Poorly,
  Not
};

/// Largest value, over channels, of powerOf(channel, incoming power) divided by the incoming power (entered plus
/// emitted) of the channel or, if larger, by a thousandth of the brightest channel's incoming power. In a solve with
/// one channel the powers of the other two are 0.
/// @param powerOf  function of channel and incoming power in W, returns W
template <class PowerOf>
double LargestPart(const EnergyBalance& balance, const PowerOf& powerOf)
{
  Rgb in = {};
  for (std::size_t c = 0; c < in.size(); ++c)
  {
    in[c] = balance.entered[c] + balance.emitted[c];
  }
  const double least = FaintChannel * *std::max_element(in.begin(), in.end());
  double worst = 0.0;
  for (std::size_t c = 0; c < in.size(); ++c)
  {
    const double power = powerOf(c, in[c]), scale = std::max(in[c], least);
    const double part = scale > 0.0 ? power / scale : power;
    worst = part <= worst || std::isnan(worst) ? worst : part;
  }
  return worst;
}

/// Energy imbalance: fraction of the incoming power that is lost or created.
double ImbalanceOf(const EnergyBalance& balance)
{
  return LargestPart(balance, [&](std::size_t c, double in) {
    return std::abs(in - balance.absorbed[c] - balance.escaped[c] - balance.leftOver[c]);
  });
}

/// Physically impossible power, as a fraction of the incoming power: absorbed or escaped power below 0, or more power
/// still in transport than has come in. The balance may hold nevertheless.
double ImpossiblePart(const EnergyBalance& balance)
{
  return LargestPart(balance, [&](std::size_t c, double in) {
    return std::max({ -balance.absorbed[c], -balance.escaped[c], balance.leftOver[c] - in });
  });
}

Balancing BalancingOf(const EnergyBalance& balance)
{
  const double error = ImbalanceOf(balance);
  if (ImpossiblePart(balance) > ImbalanceAtMost)
  {
    return Balancing::Not;
  }
  return error <= ImbalanceUnsaid ? Balancing::Well : error <= ImbalanceAtMost ? Balancing::Poorly : Balancing::Not;
}

/// Text on possible causes of an energy imbalance, and remedies.
/// @param enters  whether power enters from outside the medium
std::string WordsOfImbalance(const ThickestVoxel& thickest, bool enters)
{
  const std::string thickness = Text("%.3g", thickest.thickness);
  if (thickest.thickness > OpaqueVoxel)
  {
    return "more than floats can carry through this medium. Its thickest voxel" +
      (thickest.name.empty() ? std::string() : ", " + thickest.name + ",") + " has optical thickness " + thickness +
      "; beyond some hundred it is opaque, so give it less.";
  }
  const std::string others = "resample very flat voxels; another solver shows which light is right.";
  return "more than rounding. " +
    (thickest.thickness > 0.0 ? "Voxels of at most " + thickness + " mean free paths are not the cause: look"
                              : "Look") +
    (enters
        ? " at the lights. Move lamps, if any, that are very far away, on a face of the box or at a corner of a voxel, "
          "make very narrow cones wider, and " +
          others
        : " at the emission, for nothing else shines, and " + others);
}

/// Throws InvalidInput for a balance with impossible powers: the iteration has failed.
[[noreturn]] void RefuseImpossible(const EnergyBalance& balance)
{
  const double in = Sum(balance.entered) + Sum(balance.emitted);
  const auto text = [](double power) { return Text("%.3g", power) + " W"; };
  throw InvalidInput("The light has no meaning: of " + text(in) + ", " + text(Sum(balance.absorbed)) +
    " are absorbed, " + text(Sum(balance.escaped)) + " leave and " + text(Sum(balance.leftOver)) +
    " are left over, where none may be below 0 or above all, in no channel. The iteration went astray: set "
    "Acceleration to none where the solver has it, or choose another solver.");
}

void Judge(LightField& light, Balancing balancing, const ThickestVoxel& thickest)
{
  const double error = ImbalanceOf(light.balance);
  if (balancing == Balancing::Not && error <= ImbalanceAtMost)
  {
    RefuseImpossible(light.balance);
  }
  const std::string why = WordsOfImbalance(thickest, !(Sum(light.balance.entered) <= 0.0)),
                    part = Text("%.2g", error) + " of the power is lost or made, ";
  if (balancing == Balancing::Poorly)
  {
    light.doubts.push_back("The energy balance is off: " + part + why);
    return;
  }
  throw InvalidInput((std::isnan(error) ? "The light is not a number, " : "The light does not balance: " + part) + why);
}

/// Fraction of the incoming power that was still in transport when the solver stopped.
double LeftOver(const EnergyBalance& balance)
{
  const double all = Sum(balance.entered) + Sum(balance.emitted);
  return all > 0.0 ? Sum(balance.leftOver) / all : 0.0;
}
}

bool MeetsTolerance(const PropagationSettings& settings, double residual)
{
  return settings.maximumOrders == 0 && residual <= settings.tolerance;
}

void RestOfOrders::BeginWarm(double rate)
{
  this->Warm = true;
  this->Least = rate;
  this->Compares = false;
}

double RestOfOrders::After(double now, double all)
{
  const double ratio = this->Compares ? now / this->Last : this->Least > 0.0 ? this->Least : 1.0;
  const double growth = this->Orders > 1 ? std::max(0.0, ratio - this->LastRatio) : 0.0;
  const double limit = std::min(std::max(ratio + growth, this->Least), 1.0 - 1e-9);
  const double rest = (this->Warm ? WarmMargin : 1.0) * (now / all * limit / (1.0 - limit));
  this->LastRatio = ratio;
  this->Last = now;
  this->Compares = true;
  ++this->Orders;
  return this->Orders == 1 ? std::min(rest, 1.0) : rest;
}

double RestOfChanges::After(double change, double guessedRatio)
{
  const double measured = this->Changes > 0 && this->Last > 0.0 ? change / this->Last : 1.0;
  const double ratio = guessedRatio > 0.0 ? guessedRatio : measured;
  const double fall = std::clamp(this->Changes > 1 ? std::max(ratio, this->LastRatio) : ratio, 0.5, 0.95);
  const bool first = this->Changes == 0;
  ++this->Changes;
  this->LastRatio = ratio;
  this->Last = change;
  return first && change != 0.0 ? 1.0 : MarginOfChanges * change * fall / (1.0 - fall);
}

double GoesOnToItsEnd(int maximumOrders, double before, double onTheWay, double others)
{
  const bool endless =
    maximumOrders == 0 && before > 0.0 && onTheWay >= (1.0 - SlowestFall) * before && NextToAll * onTheWay >= others;
  return endless ? others : others + onTheWay;
}

double GoesOnAsForeseen(double before, double onTheWay, double others)
{
  return onTheWay < (1.0 - SlowestFall) * before ? others : GoesOnToItsEnd(0, before, onTheWay, others);
}

double ProgressOf(const PropagationSettings& settings, double residual, double iterations)
{
  if (settings.maximumOrders > 0)
  {
    return iterations / settings.maximumOrders;
  }
  const double creeping = 1.0 - 1.0 / (1.0 + 0.05 * iterations);
  const double tolerance = std::clamp(settings.tolerance, 1e-12, 0.9);
  const double way = std::log(std::clamp(residual, tolerance, 1.0)) / std::log(tolerance);
  return std::min(std::max(creeping, way), 0.99);
}

void WarnAboutInputLight(const Domain& domain, const Illumination& illumination, LightField& light)
{
  if (domain.Any(illumination.uncollided.IsThere()) && Reflects(illumination))
  {
    light.doubts.emplace_back("FaceAlbedo gives back scattered light only: through which cells of the faces the light "
                              "of UncollidedLight leaves is not known.");
  }
}

void JudgeBalance(LightField& light, const Domain& domain, const Medium& medium)
{
  const double worst = domain.Max(static_cast<double>(BalancingOf(light.balance)));
  if (worst > 0.0)
  {
    Judge(light, static_cast<Balancing>(static_cast<int>(worst)), ThickestOf(domain, medium));
  }
}

void JudgeConvergence(const PropagationSettings& settings, LightField& light, bool accelerates)
{
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  light.converged = settings.maximumOrders > 0 || MeetsTolerance(settings, residual);
  if (!light.converged)
  {
    const bool mayBeSlower = accelerates && settings.acceleration != PropagationAcceleration::None;
    light.doubts.push_back("The light has not converged: after " + std::to_string(light.convergence.size()) +
      " sweeps its estimated relative error is " + Text("%.3g", residual) + ", Tolerance is " +
      Text("%.3g", settings.tolerance) + ". Set a larger Tolerance, " +
      (mayBeSlower ? "or Acceleration to none, " : "") + "or resample to voxels of more equal edges.");
  }
  const double left = LeftOver(light.balance);
  if (settings.maximumOrders == 0 && left > std::max(MuchLeftOver, settings.tolerance))
  {
    light.doubts.push_back("Of the light's power " + Text("%.3g", 100.0 * left) +
      "% is left over: its rays still go round periodic axes. A light inside a thin periodic box has images without "
      "end: make the box wider, or its axes not periodic.");
  }
}
}
