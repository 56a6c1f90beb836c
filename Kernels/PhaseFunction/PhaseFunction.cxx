#include "PhaseFunction/PhaseFunction.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr double EndsWithin = 1e-3; ///< largest difference of a table's end cosines from -1 and 1
constexpr double Rounding = 1e-9;   ///< largest accepted excess of a cosine over 1

void CheckMeanCosine(double g)
{
  if (!(std::abs(g) < 1.0))
  {
    throw InvalidInput("The mean cosine g of a phase function is " + Text("%.6g", g) +
      "; it must lie between -1 and 1, and be neither. 0.85 is a cloud's, 0.9 tissue's.");
  }
}

/// 1 + g^2 - 2 g c, with c the cosine; computed without cancellation, also for g near -1.
double SquareOfHenyeyGreenstein(double g, double cosine)
{
  const double size = std::abs(g);
  return (1.0 - size) * (1.0 - size) + 2.0 * size * (1.0 - std::copysign(cosine, g * cosine));
}

double ValueOfHenyeyGreenstein(double g, double cosine)
{
  const double square = SquareOfHenyeyGreenstein(g, cosine);
  return (1.0 - g * g) / (4.0 * Pi * square * std::sqrt(square));
}

/// Inverse cumulative distribution of the Henyey-Greenstein function (Witt 1977).
double CosineOfHenyeyGreenstein(double g, double u)
{
  if (std::abs(g) < 1e-4)
  {
    const double even = 2.0 * u - 1.0;
    return std::clamp(even + 1.5 * g * (1.0 - even * even), -1.0, 1.0);
  }
  const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
  return std::clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
}

/// Cumulative distribution of the Henyey-Greenstein function: fraction of light scattered at cosines below `cosine`.
double BelowOfHenyeyGreenstein(double g, double cosine)
{
  if (std::abs(g) < 1e-4)
  {
    return 0.5 * (1.0 + cosine) - 0.75 * g * (1.0 - cosine * cosine);
  }
  const double root = std::sqrt(SquareOfHenyeyGreenstein(g, cosine));
  return (1.0 - g * g) / (2.0 * g) * (1.0 / root - 1.0 / (1.0 + g));
}

/// Mean cosine of Schlick's function: 1/k + (1 - k^2) / (2 k^2) log((1 - k) / (1 + k)).
double MeanCosineOfSchlick(double k)
{
  if (std::abs(k) < 0.02)
  {
    const double square = k * k;
    return k * (2.0 / 3.0 + square * (2.0 / 15.0 + square * (2.0 / 35.0)));
  }
  return 1.0 / k + (1.0 - k * k) / (2.0 * k * k) * std::log1p(-2.0 * k / (1.0 + k));
}

double KOfSchlick(double g)
{
  double low = 0.0, high = 1.0; // the parameter k is found by bisection, since the mean cosine grows with k
  for (int i = 0; i < 60; ++i)
  {
    const double k = 0.5 * (low + high);
    (MeanCosineOfSchlick(k) < std::abs(g) ? low : high) = k;
  }
  return std::copysign(0.5 * (low + high), g);
}

double BelowOfSchlick(double k, double cosine)
{
  return 0.5 * (1.0 - k) * (1.0 + cosine) / (1.0 - k * cosine);
}

double CosineOfSchlick(double k, double u)
{
  return std::clamp((2.0 * u + k - 1.0) / (2.0 * k * u - k + 1.0), -1.0, 1.0);
}

/// Inverse cumulative distribution of Rayleigh's phase function, 3/8 (1 + c^2) for the cosine c: solves c^3 + 3 c + 4 =
/// 8 u.
double CosineOfRayleigh(double u)
{
  const double half = 4.0 * u - 2.0;
  const double root = std::cbrt(half + std::sqrt(half * half + 1.0));
  return std::clamp(root - 1.0 / root, -1.0, 1.0);
}

[[noreturn]] void FailAtRow(
  std::size_t row, const std::vector<double>& cosines, const std::vector<double>& values, const std::string& what)
{
  throw InvalidInput("Row " + std::to_string(row) + " of the table of a phase function (cosine " +
    Text("%.6g", cosines[row]) + ", value " + Text("%.6g", values[row]) + ") " + what);
}

void CheckCount(std::size_t cosines, std::size_t values)
{
  if (cosines != values)
  {
    throw InvalidInput("The table of a phase function has " + std::to_string(cosines) + " cosines and " +
      std::to_string(values) + " values; it needs one of each a row.");
  }
  if (cosines < 2)
  {
    throw InvalidInput("The table of a phase function has " + std::to_string(cosines) +
      (cosines == 1 ? " row" : " rows") + "; it needs two at least, a cosine and a value each.");
  }
}

/// Checks that a table reaches from cosine -1 to 1. All numbers must be finite.
void CheckEnds(const std::vector<double>& cosines, const std::vector<double>& values)
{
  const char* const what = "is an end of the table; it must reach from cosine -1 to 1.";
  for (const std::size_t row : { std::size_t{ 0 }, cosines.size() - 1 })
  {
    if (1.0 - std::abs(cosines[row]) > EndsWithin)
    {
      FailAtRow(row, cosines, values, what);
    }
  }
  if (cosines.front() * cosines.back() > 0.0)
  {
    FailAtRow(cosines.size() - 1, cosines, values, what);
  }
}

void CheckRows(const std::vector<double>& cosines, const std::vector<double>& values)
{
  CheckCount(cosines.size(), values.size());
  const auto fail = [&](std::size_t row, const char* what) { FailAtRow(row, cosines, values, what); };
  for (std::size_t row = 0; row < cosines.size(); ++row)
  {
    if (!std::isfinite(cosines[row]) || !std::isfinite(values[row]))
    {
      fail(row, "is not a finite number.");
    }
  }
  const bool rising = cosines.back() > cosines.front();
  for (std::size_t row = 0; row < cosines.size(); ++row)
  {
    if (values[row] < 0.0)
    {
      fail(row, "is negative; a phase function is nowhere.");
    }
    if (std::abs(cosines[row]) > 1.0 + Rounding)
    {
      fail(row, "is no cosine: those are from -1 to 1. Angles have to be turned into them.");
    }
    const double before = row > 0 ? std::clamp(cosines[row - 1], -1.0, 1.0) : 0.0;
    const double here = std::clamp(cosines[row], -1.0, 1.0);
    if (row > 0 && (rising ? here <= before : here >= before))
    {
      fail(row, "is out of order: sort the rows by cosine, each one once.");
    }
  }
  CheckEnds(cosines, values);
}

/// Index of the row that begins the interval of `values` (ascending) in which `value` lies. A value beyond the table
/// belongs to the first or the last interval.
std::size_t RowBefore(const std::vector<double>& values, double value)
{
  const auto after = std::upper_bound(values.begin(), values.end(), value);
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - values.begin() - 1, 0, values.size() - 2));
}

double ValueOfTable(const PhaseFunction::Table& table, double cosine)
{
  const std::size_t row = RowBefore(table.cosines, cosine);
  const double low = table.cosines[row];
  const double part = (cosine - low) / (table.cosines[row + 1] - low);
  return table.values[row] + std::clamp(part, 0.0, 1.0) * (table.values[row + 1] - table.values[row]);
}

/// Cumulative distribution of a tabulated phase function: a parabola between two rows of the table.
double BelowOfTable(const PhaseFunction::Table& table, double cosine)
{
  const std::size_t row = RowBefore(table.cosines, cosine);
  const double way = cosine - table.cosines[row];
  return table.below[row] + Pi * way * (table.values[row] + ValueOfTable(table, cosine));
}

double CosineOfTable(const PhaseFunction::Table& table, double u)
{
  const std::size_t row = RowBefore(table.below, u);
  const double width = table.cosines[row + 1] - table.cosines[row];
  const double first = 2.0 * Pi * table.values[row], last = 2.0 * Pi * table.values[row + 1];
  const double rest = u - table.below[row];
  const double root = std::sqrt(std::max(first * first + 2.0 * (last - first) / width * rest, 0.0));
  const double way = first + root > 0.0 ? 2.0 * rest / (first + root) : 0.0;
  return std::clamp(table.cosines[row] + way, table.cosines[row], table.cosines[row + 1]);
}

std::vector<double> MomentsOfTable(const PhaseFunction::Table& table, int degree)
{
  std::vector<double> moments(degree + 1, 0.0);
  const GaussLegendre rule(degree / 2 + 2); // the rule is exact for P_l times a linear function
  for (std::size_t row = 0; row + 1 < table.cosines.size(); ++row)
  {
    const double low = table.cosines[row], width = table.cosines[row + 1] - low;
    for (std::size_t i = 0; i < rule.points.size(); ++i)
    {
      const double part = 0.5 * (rule.points[i] + 1.0);
      const double value = table.values[row] + part * (table.values[row + 1] - table.values[row]);
      const std::vector<double> p = LegendrePolynomials(degree, low + part * width);
      for (int l = 0; l <= degree; ++l)
      {
        moments[l] += 2.0 * Pi * 0.5 * width * rule.weights[i] * value * p[l];
      }
    }
  }
  return moments;
}

/// Legendre moments of a phase function with a peak at cosine 1 (`peak` > 0) or at -1. They are integrated by Gauss's
/// rule over intervals that halve towards the peak.
std::vector<double> MomentsByQuadrature(const PhaseFunction& function, double peak, int degree)
{
  std::vector<double> moments(degree + 1, 0.0);
  const GaussLegendre rule(32 + degree / 2);
  double far = 2.0;
  for (int stretch = 0; stretch < 50; ++stretch, far *= 0.5)
  {
    const double near = stretch == 49 ? 0.0 : 0.5 * far;
    for (std::size_t i = 0; i < rule.points.size(); ++i)
    {
      const double away = near + 0.5 * (rule.points[i] + 1.0) * (far - near);
      const double cosine = std::copysign(1.0, peak) * (1.0 - away);
      const std::vector<double> p = LegendrePolynomials(degree, cosine);
      const double part = 2.0 * Pi * 0.5 * (far - near) * rule.weights[i] * function.Value(cosine);
      for (int l = 0; l <= degree; ++l)
      {
        moments[l] += part * p[l];
      }
    }
  }
  return moments;
}
}

PhaseFunction PhaseFunction::HenyeyGreenstein(double g)
{
  CheckMeanCosine(g);
  PhaseFunction function;
  function.Which = g == 0.0 ? Kind::Isotropic : Kind::HenyeyGreenstein;
  function.The.first = g;
  return function;
}

PhaseFunction PhaseFunction::DoubleHenyeyGreenstein(double g, double secondG, double part)
{
  CheckMeanCosine(g);
  CheckMeanCosine(secondG);
  if (!(part >= 0.0 && part <= 1.0))
  {
    throw InvalidInput("The first part of a double Henyey-Greenstein phase function is " + Text("%.6g", part) +
      "; it must be from 0 to 1.");
  }
  PhaseFunction function;
  function.Which = Kind::DoubleHenyeyGreenstein;
  function.The = { g, secondG, part };
  return function;
}

PhaseFunction PhaseFunction::Schlick(double g)
{
  CheckMeanCosine(g);
  PhaseFunction function;
  // The kind is Schlick also if g is 0, because WithMeanCosine() keeps the kind of function.
  function.Which = Kind::Schlick;
  function.The.first = g == 0.0 ? 0.0 : KOfSchlick(g);
  return function;
}

PhaseFunction PhaseFunction::Rayleigh()
{
  PhaseFunction function;
  function.Which = Kind::Rayleigh;
  return function;
}

PhaseFunction PhaseFunction::Tabulated(std::vector<double> cosines, std::vector<double> values)
{
  CheckRows(cosines, values);
  if (cosines.back() < cosines.front())
  {
    std::reverse(cosines.begin(), cosines.end());
    std::reverse(values.begin(), values.end());
  }
  cosines.front() = -1.0;
  cosines.back() = 1.0;
  Table table = { std::move(cosines), std::move(values), {} };
  const double largest = *std::max_element(table.values.begin(), table.values.end());
  double sum = 0.0;
  for (std::size_t row = 0; row < table.cosines.size(); ++row)
  {
    // Values are divided by the largest one, so that the integral does not overflow.
    table.values[row] /= largest > 0.0 ? largest : 1.0;
    sum +=
      row == 0 ? 0.0 : Pi * (table.values[row] + table.values[row - 1]) * (table.cosines[row] - table.cosines[row - 1]);
    table.below.push_back(sum);
  }
  Require(sum > 0.0,
    "The table of a phase function does not integrate: all of its " + std::to_string(table.values.size()) +
      " values are zero.");
  for (std::size_t row = 0; row < table.cosines.size(); ++row)
  {
    table.values[row] /= sum;
    table.below[row] /= sum;
  }
  PhaseFunction function;
  function.Which = Kind::Tabulated;
  function.Rows = std::make_shared<const Table>(std::move(table));
  return function;
}

double PhaseFunction::Value(double cosine) const
{
  switch (this->Which)
  {
    case Kind::HenyeyGreenstein: return ValueOfHenyeyGreenstein(this->The.first, cosine);
    case Kind::DoubleHenyeyGreenstein:
      return this->The.part * ValueOfHenyeyGreenstein(this->The.first, cosine) +
        (1.0 - this->The.part) * ValueOfHenyeyGreenstein(this->The.second, cosine);
    case Kind::Schlick:
    {
      const double k = std::abs(this->The.first);
      const double away = (1.0 - k) + k * (1.0 - std::copysign(cosine, this->The.first * cosine));
      return (1.0 - k) * (1.0 + k) / (4.0 * Pi * away * away);
    }
    case Kind::Rayleigh: return 3.0 / (16.0 * Pi) * (1.0 + cosine * cosine);
    case Kind::Tabulated: return ValueOfTable(*this->Rows, cosine);
    default: return 1.0 / (4.0 * Pi);
  }
}

double PhaseFunction::MeanCosine() const
{
  switch (this->Which)
  {
    case Kind::HenyeyGreenstein: return this->The.first;
    case Kind::DoubleHenyeyGreenstein:
      return this->The.part * this->The.first + (1.0 - this->The.part) * this->The.second;
    case Kind::Schlick: return MeanCosineOfSchlick(this->The.first);
    case Kind::Tabulated: return MomentsOfTable(*this->Rows, 1)[1];
    default: return 0.0;
  }
}

std::vector<double> PhaseFunction::Moments(int degree) const
{
  std::vector<double> moments(degree + 1, 0.0);
  moments[0] = 1.0;
  switch (this->Which)
  {
    case Kind::HenyeyGreenstein:
    case Kind::DoubleHenyeyGreenstein:
      for (int l = 1; l <= degree; ++l)
      {
        moments[l] =
          this->The.part * std::pow(this->The.first, l) + (1.0 - this->The.part) * std::pow(this->The.second, l);
      }
      return moments;
    case Kind::Schlick: return MomentsByQuadrature(*this, this->The.first, degree);
    case Kind::Rayleigh:
      if (degree >= 2)
      {
        moments[2] = 0.1;
      }
      return moments;
    case Kind::Tabulated: return MomentsOfTable(*this->Rows, degree);
    default: return moments;
  }
}

double PhaseFunction::CosineAt(double u) const
{
  switch (this->Which)
  {
    case Kind::HenyeyGreenstein: return CosineOfHenyeyGreenstein(this->The.first, u);
    case Kind::DoubleHenyeyGreenstein:
    {
      // The cosine is found by bisection, because the cumulative distribution of a sum of two functions has no inverse
      // in closed form.
      double low = -1.0, high = 1.0;
      for (int i = 0; i < 60; ++i)
      {
        const double cosine = 0.5 * (low + high);
        (this->Below(cosine) < u ? low : high) = cosine;
      }
      return 0.5 * (low + high);
    }
    case Kind::Schlick: return CosineOfSchlick(this->The.first, u);
    case Kind::Rayleigh: return CosineOfRayleigh(u);
    case Kind::Tabulated: return CosineOfTable(*this->Rows, u);
    default: return 2.0 * u - 1.0;
  }
}

double PhaseFunction::Below(double cosine) const
{
  switch (this->Which)
  {
    case Kind::HenyeyGreenstein: return BelowOfHenyeyGreenstein(this->The.first, cosine);
    case Kind::DoubleHenyeyGreenstein:
      return this->The.part * BelowOfHenyeyGreenstein(this->The.first, cosine) +
        (1.0 - this->The.part) * BelowOfHenyeyGreenstein(this->The.second, cosine);
    case Kind::Schlick: return BelowOfSchlick(this->The.first, cosine);
    case Kind::Rayleigh: return 0.5 + 0.125 * cosine * (3.0 + cosine * cosine);
    case Kind::Tabulated: return BelowOfTable(*this->Rows, cosine);
    default: return 0.5 * (1.0 + cosine);
  }
}

PhaseFunction PhaseFunction::WithMeanCosine(double g) const
{
  switch (this->Which)
  {
    case Kind::Isotropic:
    case Kind::HenyeyGreenstein: return HenyeyGreenstein(g);
    case Kind::Schlick: return Schlick(g);
    default:
      throw InvalidInput("The mean cosine g varies by voxel, but the medium's phase function is not one of a single "
                         "mean cosine: choose Henyey-Greenstein or Schlick, or take the array g away.");
  }
}

bool PhaseFunction::IsIsotropic() const
{
  return this->Which == Kind::Isotropic ||
    ((this->Which == Kind::Schlick || this->Which == Kind::DoubleHenyeyGreenstein) && this->The.first == 0.0 &&
      this->The.second == 0.0);
}

bool PhaseFunction::operator==(const PhaseFunction& other) const
{
  if (this->IsIsotropic() || other.IsIsotropic())
  {
    return this->IsIsotropic() && other.IsIsotropic();
  }
  const bool sameRows = this->Rows == other.Rows ||
    (this->Rows && other.Rows && this->Rows->cosines == other.Rows->cosines &&
      this->Rows->values == other.Rows->values);
  return this->Which == other.Which && this->The.first == other.The.first && this->The.second == other.The.second &&
    this->The.part == other.The.part && sameRows;
}

DeltaM::DeltaM(const std::vector<double>& all)
  : forward(all.back())
  , moments(all.begin(), all.end() - 1)
{
  if (this->moments.size() > 1)
  {
    // The fraction treated as unscattered is limited on both sides. It is not negative, since only light near the
    // forward direction counts as unscattered. Its upper limit keeps the moments of the remainder in [-1, 1].
    this->forward = std::max(this->forward, 0.0);
    for (double moment : this->moments)
    {
      this->forward = std::min(this->forward, 0.5 * (1.0 + moment));
    }
  }
  for (double& moment : this->moments)
  {
    moment = (moment - this->forward) / (1.0 - this->forward);
  }
}

std::vector<DeltaM> Truncations(const PhaseFunction& function, int degree)
{
  const std::vector<double> moments = function.Moments(degree + 1);
  std::vector<DeltaM> truncations;
  for (int l = 0; l <= degree; ++l)
  {
    truncations.emplace_back(std::vector<double>(moments.begin(), moments.begin() + l + 2));
  }
  return truncations;
}

double LeastDamping(const std::function<double(double s)>& least)
{
  constexpr double MostDamping = 16.0; // at which all moments above degree 0 vanish
  double low = 0.0, high = MostDamping;
  for (int i = 0; i < 20; ++i)
  {
    const double s = 0.5 * (low + high);
    (least(s) >= LeastPart ? high : low) = s;
  }
  return high;
}
}
