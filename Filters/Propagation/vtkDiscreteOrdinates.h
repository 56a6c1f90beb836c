#ifndef vtkDiscreteOrdinates_h
#define vtkDiscreteOrdinates_h

#include "PropertyRange.h"
#include "vtkScatteringSolver.h"
#include "vtkTyndallModule.h" // for export macro

#include <memory>
#include <string>

namespace tyndall
{
class LastLight;
}

/**
 * @class vtkDiscreteOrdinates
 * @brief multiply and anisotropically scattered light, by discrete ordinates: radiance along the directions of a
 * quadrature in every voxel
 *
 * Solves for the radiance along DirectionsPerFace directions per face of a cube. Radiance in a
 * voxel is scattered by a separable phase function of Terms terms (vtkSeparablePhaseFunction), so that the cost per
 * direction is proportional to Terms, not to the number of directions. By default the scheme conserves energy and is
 * stable for voxels of any optical thickness; the published scheme takes explicit steps, and a warning reports where
 * they are unstable.
 *
 * Input 0, the medium: vtkImageData with cell arrays (point arrays: see SetPointData)
 *
 * | array      | components | unit             | meaning                                          |
 * |------------|------------|------------------|--------------------------------------------------|
 * | `sigma_a`  | 1 or 3     | 1/length         | absorption coefficient                           |
 * | `sigma_s`  | 1 or 3     | 1/length         | scattering coefficient                           |
 * | `emission` | 1 or 3     | W/(length^3 sr)  | emitted radiance per unit length; optional       |
 *
 * or the arrays chosen by SetInputArrayToProcess 0, 1 and 2, and field data `g` (default 0).
 * Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it.
 * Input 3, optional: uncollided light of another filter; replaces lights and environment (vtkScatteringSolver).
 *
 * Output 0: the medium's image with cell arrays of 1 component, or 3 where medium or light has colour
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions |
 * | `fluence_direct` | 1 or 3 | W/length^2 | uncollided part of `fluence`; in the published scheme of lamps only |
 * | `fluence_error` | 1 or 3 | W/length^2 | standard error of `fluence` (if EstimateError or TargetError) |
 * | `net_flux` | 3 or 9 | W/length^2 | radiance times direction, integrated (if NetFlux) |
 * | `scattered_radiance` | 1 or 3 | W/(length^2 sr) | scattered radiance, averaged over directions |
 *
 * and field data `energy_balance` (W: entered, emitted, absorbed, escaped, left over), `face_power_out` (W through -x,
 * +x, -y, +y, -z, +z), `half_range_flux`, `left_out` (computations that the scene did not need), `device`,
 * `stored_directions`.
 * Output 1: vtkTable, one row per scattering order (in the published scheme, per step): `iteration`, `seconds`,
 * `residual`, `change`, `absorbed`, `escaped`, `left_over`, and with WarmStart `sweeps_saved`: number of additional
 * rows after which the last cold solve (with zero initial guess) reached the same residual.
 *
 * Media that scatter light many times are solved by diffusion synthetic acceleration, DSA (Acceleration). The radiance
 * in all directions has to fit in device memory, unless an accelerated solve scatters isotropically: if it does not, an
 * error states the required memory. EstimateError and TargetError need the conservative scheme, TargetError also
 * SpiralDirections 0. In solves that are not accelerated, the error of replacing a mean cosine that varies by voxel by
 * its mean is not included.
 *
 * With Decomposition BLOCKS ranks exchange radiance at the boundaries of their pieces (numerics.md, section 10 b);
 * every scattering order is the same as in a serial solve. Quality limits the number of directions such that the
 * radiance of the whole domain would fit in half the memory of the rank with the least memory. Scheme PUBLISHED cannot
 * be used with BLOCKS.
 *
 * @sa vtkSeparablePhaseFunction vtkLightPropagationMaps vtkParticipatingMedium vtkLightRig
 * @par Thanks
 * Z. Gong, Z. Ren, Z. Wang, Q. Peng: Interactive Rendering of Multiple Scattering in Participating Media Using
 * Separable Phase Functions.
 */
class TYNDALL_EXPORT vtkDiscreteOrdinates : public vtkScatteringSolver
{
public:
  static vtkDiscreteOrdinates* New();
  vtkTypeMacro(vtkDiscreteOrdinates, vtkScatteringSolver);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Schemes
  {
    PUBLISHED = 0,   ///< explicit steps, as Gong et al. describe them
    CONSERVATIVE = 1 ///< attenuates exponentially in each voxel and conserves energy; light of lamps along exact rays
  };

  enum Scatterings
  {
    MATRIX = 0,             ///< phase function as full matrix of all pairs of directions
    SINGULAR_VALUES = 1,    ///< the largest Terms singular values of that matrix, as published
    SPHERICAL_HARMONICS = 2 ///< expansion in Terms spherical harmonics
  };

  enum Accelerations
  {
    NONE = 0,                  ///< plain source iteration
    AUTOMATIC_ACCELERATION = 1 ///< DSA: a diffusion solve between sweeps, if many orders would be needed
  };

  ///@{
  /// Numerical scheme: PUBLISHED, or CONSERVATIVE (default). With PUBLISHED a FaceAlbedo other than 0 is an error.
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  ///@{
  /// Representation of scattering between directions: MATRIX, SINGULAR_VALUES or SPHERICAL_HARMONICS (default).
  tyndallRangeMacro(Scattering, int, MATRIX, SPHERICAL_HARMONICS);
  ///@}

  ///@{
  /// Number of directions per face of a cube. Default 25, valid square numbers: 1, 4, 9, 16, 25, ... Slabs (two
  /// periodic axes of one voxel each) are solved with more.
  tyndallRangeMacro(DirectionsPerFace, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of directions of a spiral quadrature, at least 16, which replaces the cube's directions. Default 0: the
  /// cube's directions, which are symmetric under rotations by 90 degrees, so that the solution rotates with the scene.
  tyndallRangeMacro(SpiralDirections, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of terms of the separable phase function. Default 25, at most the number of directions; for spherical
  /// harmonics a square number: 1, 4, 9, 16, ...
  tyndallRangeMacro(Terms, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Limit on the number of scattering orders (in the published scheme, of steps). Default 0: as many as Tolerance
  /// requires.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Acceleration of source iteration (conservative scheme, if MaximumOrders is 0): NONE, or AUTOMATIC_ACCELERATION
  /// (default). There is no acceleration with directions of a spiral, for the light of input 3, or for anisotropic
  /// scattering by MATRIX or SINGULAR_VALUES.
  tyndallRangeMacro(Acceleration, int, NONE, AUTOMATIC_ACCELERATION);
  ///@}

  ///@{
  /// Whether the solution of the last update is the initial guess of the next one: it saves sweeps if medium or lights
  /// changed a little; the result is the same within Tolerance. The solution stays in memory until an update with
  /// WarmStart off: one float per voxel and channel. Used only if Scheme is CONSERVATIVE, and without acceleration only
  /// if scattering is isotropic.
  /// With Decomposition BLOCKS each rank keeps the solution of its piece; if the pieces have changed, the initial guess
  /// is zero on all ranks. Default off.
  tyndallFlagMacro(WarmStart);
  ///@}

  ///@{
  /// Whether to compute the array `net_flux`. Default off.
  tyndallFlagMacro(NetFlux);
  ///@}

  ///@{
  /// Results of the last update: number of scattering orders; number of additional orders that the last update with
  /// zero initial guess needed to reach the same residual (0 if this was such an update); half-range flux of the
  /// quadrature for isotropic radiance through a face, as a fraction of the exact value. Residual of
  /// vtkScatteringSolver is the error due to the omitted orders.
  vtkGetMacro(Orders, int);
  vtkGetMacro(SweepsSaved, int);
  vtkGetMacro(HalfRangeFlux, double);
  ///@}

protected:
  vtkDiscreteOrdinates();
  ~vtkDiscreteOrdinates() override;

  void Note(const tyndall::LightField& light) override;
  void ShareResults(tyndall::Communicator& ranks) override;
  std::string NotByBlocks(vtkInformationVector** inputs) const override;
  tyndall::LightField Solve(const tyndall::SolverScene& scene) override;

private:
  vtkDiscreteOrdinates(const vtkDiscreteOrdinates&) = delete;
  void operator=(const vtkDiscreteOrdinates&) = delete;

  int Scheme = CONSERVATIVE;
  int Scattering = SPHERICAL_HARMONICS;
  int DirectionsPerFace;
  int SpiralDirections;
  int Terms;
  int MaximumOrders;
  int Acceleration = AUTOMATIC_ACCELERATION;
  bool WarmStart = false;
  bool NetFlux;

  std::unique_ptr<tyndall::LastLight> Last;
  int Orders = 0;
  int SweepsSaved = 0;
  double HalfRangeFlux = 0.0;
};

#endif
