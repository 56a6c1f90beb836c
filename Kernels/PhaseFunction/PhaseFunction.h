#pragma once

#include <memory>
#include <vector>

namespace tyndall
{
/// Phase function: the angular distribution of scattered light, by the cosine between its directions before and after
/// scattering (1 forward, -1 backward). Symmetric in both directions (reciprocity). All solvers, the photons and the
/// ray caster use this description; numerics.md, section 2.1.
///
/// A value type: copies are cheap, since they share the table.
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

  PhaseFunction() = default; ///< isotropic
  /// Henyey and Greenstein 1941.
  /// @param g  mean cosine in (-1, 1), else InvalidInput is thrown; 0: isotropic
  static PhaseFunction HenyeyGreenstein(double g);
  /// Sum of two Henyey-Greenstein functions (Kattawar 1975), e.g. a forward and a backward lobe.
  /// @param part  weight of the first function, in [0, 1]; the second has the rest
  static PhaseFunction DoubleHenyeyGreenstein(double g, double secondG, double part);
  /// (1 - k^2) / (4 pi (1 - k cosine)^2), Blasi et al. 1993, with k chosen so that the mean cosine is exactly g.
  static PhaseFunction Schlick(double g);
  /// 3 / (16 pi) (1 + cosine^2)
  static PhaseFunction Rayleigh();
  /// Piecewise linear between the rows of a table, e.g. from a Mie code; normalised to an integral of 1.
  /// @param cosines  from -1 to 1 (to 1e-3), ascending or descending
  /// @param values   in any unit, not negative
  /// @throws InvalidInput if a row is not a number, negative or out of order (names the first), there are fewer than
  ///   two rows, or the integral is zero
  static PhaseFunction Tabulated(std::vector<double> cosines, std::vector<double> values);

  Kind TheKind() const { return this->Which; }
  bool IsIsotropic() const; ///< whether it scatters isotropically, whatever its kind

  /// Value in 1/sr; its integral over all directions is 1.
  /// @param cosine  in [-1, 1]
  double Value(double cosine) const;
  double MeanCosine() const; ///< in (-1, 1)
  /// Legendre moments 2 pi integral p(c) P_l(c) dc for l = 0 to `degree`: 1, the mean cosine, ...
  std::vector<double> Moments(int degree) const;
  /// The cosine below which a fraction u of the light is scattered, 0 <= u <= 1: the inverse cumulative distribution.
  double CosineAt(double u) const;

  /// Fraction of the light scattered below a cosine in [-1, 1]: the cumulative distribution, which CosineAt inverts.
  double Below(double cosine) const;

  /// The same kind of function with another mean cosine, for the two kinds that have one parameter; for an isotropic
  /// function, Henyey-Greenstein.
  /// @throws InvalidInput for other kinds, or if g is outside (-1, 1)
  PhaseFunction WithMeanCosine(double g) const;

  /// Parameters for kernels: Henyey-Greenstein's g, second g and weight of the first; for Schlick, k.
  struct Parameters
  {
    double first = 0.0, second = 0.0, part = 1.0;
  };
  const Parameters& Shape() const { return this->The; }
  struct Table
  {
    std::vector<double> cosines, values, below; ///< ascending; values, 1/sr; cumulative distribution at each cosine
  };
  const Table* TheTable() const { return this->Rows.get(); } ///< null unless Tabulated

  /// Whether both are the same function; isotropic ones are equal, whatever their kind.
  bool operator==(const PhaseFunction& other) const;
  bool operator!=(const PhaseFunction& other) const { return !(*this == other); }

private:
  Kind Which = Kind::Isotropic;
  Parameters The;
  std::shared_ptr<const Table> Rows;
};

/// Delta-M truncation of a phase function (Wiscombe 1977; numerics.md, Eqs. (8a), (8b)): the forward peak is treated as
/// unscattered light, the rest is expanded up to a degree. Scattering is then sigma_s (1 - forward), with the moments
/// given here; for degree 0 it is isotropic with sigma_s (1 - g), the similarity relation.
struct DeltaM
{
  double forward = 0.0;        ///< fraction of scattered light treated as unscattered; negative for degree 0 and g < 0
  std::vector<double> moments; ///< Legendre moments 0 to degree of the rest; the first is 1

  DeltaM() = default;
  /// @param moments  Legendre moments 0 to degree + 1 of the phase function
  explicit DeltaM(const std::vector<double>& moments);
};

/// Truncations of a phase function to each of the degrees 0 to `degree`.
std::vector<DeltaM> Truncations(const PhaseFunction& function, int degree);
}
