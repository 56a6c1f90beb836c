#ifndef vtkSeparablePhaseFunction_h
#define vtkSeparablePhaseFunction_h

#include "PropertyRange.h"
#include "vtkTableAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkSeparablePhaseFunction
 * @brief factorises a phase function on a quadrature into a sum of separable terms, and tabulates the error of the sum
 *
 * The matrix of the phase function between all pairs of directions becomes p(i, j) = sum_k lambda_k u_k(i) u_k(j), by
 * singular value decomposition or by spherical harmonics. vtkDiscreteOrdinates scatters by such terms; this filter
 * tabulates them.
 *
 * Output 0: vtkTable, one row per direction
 *
 * | column | type | unit | meaning |
 * |---|---|---|---|
 * | `direction` | double x 3 | 1 | unit vector |
 * | `weight` | double | sr | solid angle of the quadrature point |
 * | `u_1`, `u_2`, ... | double | 1/sqrt(sr) | factors, orthonormal by the weights |
 *
 * Output 1: vtkTable, one row for each number N of terms
 *
 * | column | type | unit | meaning |
 * |---|---|---|---|
 * | `terms` | int | 1 | number of terms, N |
 * | `eigenvalue` | double | 1 | lambda_N, factor of the Nth term |
 * | `singular_value` | double | 1 | Nth largest singular value of the matrix |
 * | `error` | double | 1 | relative error of the sum of N terms: root of the sum of squares, weighted by solid angle |
 * | `error_singular_values`, `error_spherical_harmonics` | double | 1 | `error` of N terms of either Factorisation |
 * | `error_theory` | double | 1 | `error` predicted from the phase function's Legendre moments |
 * | `error_max` | double | 1 | largest error of an entry of the matrix, divided by the largest entry |
 * | `row_sum_error` | double | 1 | largest difference from 1 of the total scattered power |
 * | `mean_cosine_error` | double | 1 | largest error of the mean cosine over all directions |
 * | `least_value` | double | 1 | smallest entry of the sum divided by the largest; negative if terms are too few |
 *
 * A value is NaN if fewer than N terms are nonzero.
 *
 * @sa vtkDiscreteOrdinates
 * @par Thanks
 * Z. Gong, Z. Ren, Z. Wang, Q. Peng: Interactive Rendering of Multiple Scattering in Participating Media Using
 * Separable Phase Functions.
 */
class TYNDALL_EXPORT vtkSeparablePhaseFunction : public vtkTableAlgorithm
{
public:
  static vtkSeparablePhaseFunction* New();
  vtkTypeMacro(vtkSeparablePhaseFunction, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum PhaseFunctions
  {
    HENYEY_GREENSTEIN = 0,
    DOUBLE_HENYEY_GREENSTEIN = 1,
    SCHLICK = 2,
    RAYLEIGH = 3
  };

  enum DirectionSets
  {
    CUBE = 0,   ///< DirectionsPerFace directions per face of a cube, weighted by the solid angle of their cells
    SPIRAL = 1, ///< SpiralDirections directions on a spiral, with weights for which angular moments are exact
    PUBLISHED_SPIRAL = 2 ///< SpiralDirections directions on the same spiral, all with the same weight
  };

  enum Factorisations
  {
    SINGULAR_VALUES = 0,
    SPHERICAL_HARMONICS = 1
  };

  enum Samplings
  {
    POINT_VALUES = 0, ///< phase function at pairs of quadrature directions, as published
    CELL_MEANS = 1    ///< means of the phase function over the solid-angle cells of both directions
  };

  ///@{
  /// Phase function that is factorised: HENYEY_GREENSTEIN (default), DOUBLE_HENYEY_GREENSTEIN, SCHLICK or RAYLEIGH.
  tyndallRangeMacro(PhaseFunction, int, HENYEY_GREENSTEIN, RAYLEIGH);
  ///@}

  ///@{
  /// Mean cosine of the phase function; for DOUBLE_HENYEY_GREENSTEIN, of its first lobe. Default 0.5, as for the clouds
  /// of Gong et al.; valid [-0.999, 0.999].
  tyndallRangeMacro(G, double, -0.999, 0.999);
  ///@}

  ///@{
  /// Mean cosine of the second lobe of DOUBLE_HENYEY_GREENSTEIN. Default -0.3, valid [-0.999, 0.999].
  tyndallRangeMacro(SecondG, double, -0.999, 0.999);
  ///@}

  ///@{
  /// Weight of the first lobe of DOUBLE_HENYEY_GREENSTEIN. Default 0.9, valid [0, 1].
  tyndallRangeMacro(FirstPart, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Quadrature of directions: CUBE, SPIRAL (default) or PUBLISHED_SPIRAL.
  tyndallRangeMacro(DirectionSet, int, CUBE, PUBLISHED_SPIRAL);
  ///@}

  ///@{
  /// Number of directions per face of the cube (CUBE). Default 25, valid square numbers up to 144.
  tyndallRangeMacro(DirectionsPerFace, int, 1, 144);
  ///@}

  ///@{
  /// Number of directions on the spiral (SPIRAL, PUBLISHED_SPIRAL). Default 128, valid [16, 1024].
  tyndallRangeMacro(SpiralDirections, int, 16, 1024);
  ///@}

  ///@{
  /// Number of terms of the sum. Default 24, as published; valid from 1 to the number of directions.
  tyndallRangeMacro(Terms, int, 1, 1024);
  ///@}

  ///@{
  /// Factorisation of the matrix into terms: SINGULAR_VALUES (default) or SPHERICAL_HARMONICS.
  tyndallRangeMacro(Factorisation, int, SINGULAR_VALUES, SPHERICAL_HARMONICS);
  ///@}

  ///@{
  /// Matrix entries: POINT_VALUES (default) or CELL_MEANS of the phase function.
  tyndallRangeMacro(Sampling, int, POINT_VALUES, CELL_MEANS);
  ///@}

  ///@{
  /// Whether the terms are corrected such that the sum conserves power and has the exact mean cosine. Default on; off:
  /// as published.
  tyndallFlagMacro(Repaired);
  ///@}

  ///@{
  /// Results of the last update: run time in seconds, and the terms whose eigenvalues are 0 (also field data `left_out`
  /// of both outputs).
  tyndallSecondsMacro();
  tyndallLeftOutMacro();
  ///@}

protected:
  vtkSeparablePhaseFunction();
  ~vtkSeparablePhaseFunction() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSeparablePhaseFunction(const vtkSeparablePhaseFunction&) = delete;
  void operator=(const vtkSeparablePhaseFunction&) = delete;

  int PhaseFunction = HENYEY_GREENSTEIN;
  double G = 0.5;
  double SecondG = -0.3;
  double FirstPart = 0.9;
  int DirectionSet = SPIRAL;
  int DirectionsPerFace = 25;
  int SpiralDirections = 128;
  int Terms = 24;
  int Factorisation = SINGULAR_VALUES;
  int Sampling = POINT_VALUES;
  bool Repaired = true;
};

#endif
