#pragma once

#include <memory>
#include <vector>

namespace tyndall
{
/// What part of scattered light goes which way, by the cosine of the angle between its direction before and after: 1
/// straight on, -1 straight back. The same both ways (reciprocity). One description for all solvers, the photons and
/// the ray caster; numerics.md, section 2.1.
///
/// A value: copies are cheap, a table is shared.
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
  /// @param g  mean cosine, in (-1, 1), else InvalidInput; 0: isotropic
  static PhaseFunction HenyeyGreenstein(double g);
  /// `part` of the light by one, the rest by another (Kattawar 1975): a forward and a backward lobe.
  /// @param part  of the first, in [0, 1]
  static PhaseFunction DoubleHenyeyGreenstein(double g, double secondG, double part);
  /// (1 - k^2) / (4 pi (1 - k cosine)^2), Blasi et al. 1993, with the k whose mean cosine is g exactly.
  static PhaseFunction Schlick(double g);
  /// 3 / (16 pi) (1 + cosine^2)
  static PhaseFunction Rayleigh();
  /// Linear between the rows of a table, as Mie codes print them; scaled such that its integral is 1.
  /// @param cosines  from -1 to 1 (to 1e-3), rising or falling
  /// @param values   in any unit, not negative
  /// @throws InvalidInput naming the first row that is not a number, negative or out of order; where there are fewer
  /// than two, or their integral is zero
  static PhaseFunction Tabulated(std::vector<double> cosines, std::vector<double> values);

  Kind TheKind() const { return this->Which; }
  bool IsIsotropic() const; ///< whatever kind it was made as

  /// 1/sr; its integral over all directions is 1.
  /// @param cosine  in [-1, 1]
  double Value(double cosine) const;
  double MeanCosine() const; ///< in (-1, 1)
  /// Legendre moments 2 pi integral p(c) P_l(c) dc for l = 0 to `degree`: 1, the mean cosine, ...
  std::vector<double> Moments(int degree) const;
  /// The cosine below which a part u of the light is scattered, 0 <= u <= 1: the inverse of the distribution.
  double CosineAt(double u) const;

  /// Part of the light that is scattered below a cosine, in [-1, 1]: what CosineAt inverts.
  double Below(double cosine) const;

  /// Of the two kinds that have one parameter: the function of the same kind with another mean cosine. Of an isotropic
  /// one Henyey and Greenstein's.
  /// @throws InvalidInput for the other kinds, or g outside (-1, 1)
  PhaseFunction WithMeanCosine(double g) const;

  /// g, second g and part of Henyey and Greenstein's, k of Schlick's; for kernels.
  struct Parameters
  {
    double first = 0.0, second = 0.0, part = 1.0;
  };
  const Parameters& Shape() const { return this->The; }
  struct Table
  {
    std::vector<double> cosines, values, below; ///< rising; 1/sr; part of the light that goes below each cosine
  };
  const Table* TheTable() const { return this->Rows.get(); } ///< null but for Tabulated

  /// Whether both scatter alike as they are; isotropic ones do, of whatever kind.
  bool operator==(const PhaseFunction& other) const;
  bool operator!=(const PhaseFunction& other) const { return !(*this == other); }

private:
  Kind Which = Kind::Isotropic;
  Parameters The;
  std::shared_ptr<const Table> Rows;
};
}
