#pragma once

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Phase function: the angular distribution of scattered light. It depends only on the cosine of the angle between the
/// directions before and after scattering (1 forward, -1 backward), and is therefore reciprocal. All solvers, the
/// photons and the ray caster use this class; numerics.md, section 2.1.
///
/// A value type. Copies are cheap, since they share the table.
class PhaseFunction
{
public:
  enum class Kind
  {
    Isotropic,
    HenyeyGreenstein,
    DoubleHenyeyGreenstein,
    Schlick,
    Rayleigh,
    Tabulated
  };

  PhaseFunction() = default; ///< creates an isotropic phase function
  /// Phase function of Henyey and Greenstein (1941).
  /// @param g  mean cosine in (-1, 1), else InvalidInput is thrown; 0: isotropic
  static PhaseFunction HenyeyGreenstein(double g);
  /// Sum of two Henyey-Greenstein functions (Kattawar 1975), e.g. a forward and a backward lobe.
  /// @param part  weight of the first function, in [0, 1]; the second function has weight 1 - part
  static PhaseFunction DoubleHenyeyGreenstein(double g, double secondG, double part);
  /// Schlick's phase function (1 - k^2) / (4 pi (1 - k cosine)^2) (Blasi et al. 1993), with k chosen so that the mean
  /// cosine is exactly g.
  static PhaseFunction Schlick(double g);
  /// Rayleigh's phase function 3 / (16 pi) (1 + cosine^2).
  static PhaseFunction Rayleigh();
  /// Phase function that is linear between the rows of a table, for example from a Mie code; normalised to an integral
  /// of 1.
  /// @param cosines  from -1 to 1 (to 1e-3), ascending or descending
  /// @param values   in any unit, not negative
  /// @throws InvalidInput if a row is not a number, negative or out of order (names the first such row), there are
  ///   fewer than two rows, or the integral is zero
  static PhaseFunction Tabulated(std::vector<double> cosines, std::vector<double> values);

  Kind TheKind() const { return this->Which; }
  bool IsIsotropic() const; ///< whether scattering is isotropic, whatever the kind of function

  /// Value at a cosine, 1/sr; the integral over all directions is 1.
  /// @param cosine  in [-1, 1]
  double Value(double cosine) const;
  double MeanCosine() const; ///< mean cosine g, in (-1, 1)
  /// Legendre moments 2 pi integral p(c) P_l(c) dc for l = 0 to `degree`: 1, the mean cosine, ...
  std::vector<double> Moments(int degree) const;
  /// Inverse of the cumulative distribution: the cosine below which the fraction u of the light is scattered, 0 <= u <=
  /// 1.
  double CosineAt(double u) const;

  /// Cumulative distribution, inverse of CosineAt: the fraction of the light that is scattered at cosines below
  /// `cosine`, which is in [-1, 1].
  double Below(double cosine) const;

  /// Phase function of the same kind with mean cosine g. Only for Henyey-Greenstein and Schlick functions, which have
  /// one parameter, and for isotropic functions, which yield Henyey-Greenstein.
  /// @throws InvalidInput for other kinds, or if g is outside (-1, 1)
  PhaseFunction WithMeanCosine(double g) const;

  /// Parameters of the function, for kernels. Henyey-Greenstein: g, second g, and weight of the first function.
  /// Schlick: k.
  struct Parameters
  {
    double first = 0.0, second = 0.0, part = 1.0;
  };
  const Parameters& Shape() const { return this->The; }
  /// Rows of a tabulated function.
  struct Table
  {
    /// `cosines`: ascending. `values`: phase function at these cosines, 1/sr. `below`: cumulative distribution at these
    /// cosines.
    std::vector<double> cosines, values, below;
  };

  /// Whether two phase functions have equal values. Isotropic functions are equal, whatever their kinds.
  bool operator==(const PhaseFunction& other) const;
  bool operator!=(const PhaseFunction& other) const { return !(*this == other); }

private:
  Kind Which = Kind::Isotropic;
  Parameters The;
  std::shared_ptr<const Table> Rows;
};

/// Delta-M truncation of a phase function (Wiscombe 1977; numerics.md, Eqs. (8a), (8b)). The forward peak is treated as
/// unscattered light, and the remainder is expanded in Legendre moments up to a degree. The scattering coefficient is
/// then sigma_s (1 - forward). For degree 0 scattering is isotropic with sigma_s (1 - g), the similarity relation.
struct DeltaM
{
  double forward = 0.0;        ///< fraction of scattered light treated as unscattered; negative for degree 0 and g < 0
  std::vector<double> moments; ///< Legendre moments 0 to degree of the remainder; the first is 1

  DeltaM() = default;
  /// Truncates a phase function at a degree.
  /// @param moments  Legendre moments 0 to degree + 1 of the phase function
  explicit DeltaM(const std::vector<double>& moments);
};

/// Truncations of a phase function at the degrees 0 to `degree`, one element per degree.
std::vector<DeltaM> Truncations(const PhaseFunction& function, int degree);

/// A phase function that is tabulated for pairs of directions counts as nowhere negative if its smallest value,
/// relative to its mean, is at least this. The margin above 0 allows for rounding.
constexpr double LeastPart = 1e-3;
/// Smallest damping s of numerics.md, Eq. (8d), for which a phase function is nowhere below LeastPart. Found by 20
/// bisections.
/// @param least  smallest value of the phase function with damping s, relative to its mean
double LeastDamping(const std::function<double(double s)>& least);
}
