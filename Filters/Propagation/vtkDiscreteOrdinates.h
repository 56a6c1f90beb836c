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
 * @brief light that is scattered many times and unevenly, by its radiance along many directions in every voxel
 *
 * Solves for the radiance along DirectionsPerFace directions of each face of a cube, order by order of scattering. What
 * arrives in a voxel is scattered by a separable phase function of Terms terms (vtkSeparablePhaseFunction), so that a
 * direction costs Terms, not all other directions. By default the energy is kept, and voxels may be as thick as they
 * are; as published steps are explicit, and a warning says where they are not stable.
 *
 * Input 0, the medium: vtkImageData with cell arrays (point arrays: see SetPointData)
 *
 * | array      | components | unit             | meaning                                          |
 * |------------|------------|------------------|--------------------------------------------------|
 * | `sigma_a`  | 1 or 3     | 1/length         | absorption coefficient                           |
 * | `sigma_s`  | 1 or 3     | 1/length         | scattering coefficient                           |
 * | `emission` | 1 or 3     | W/(length^3 sr)  | emitted radiance per unit length; optional       |
 *
 * or those chosen by SetInputArrayToProcess 0, 1 and 2, and field data `g` (default 0).
 * Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it.
 * Input 3, optional: uncollided light of another filter instead of all these (vtkScatteringSolver).
 *
 * Output 0: the medium's image with cell arrays of 1 component, or 3 where medium or light has colour
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions |
 * | `fluence_direct` | 1 or 3 | W/length^2 | its unscattered part; as published that of lamps alone |
 * | `net_flux` | 3 or 9 | W/length^2 | radiance times direction, integrated (if NetFlux) |
 * | `scattered_radiance` | 1 or 3 | W/(length^2 sr) | radiance scattered, in the mean over directions |
 *
 * and field data `energy_balance` (W: entered, emitted, absorbed, escaped, left over), `face_power_out` (W through -x,
 * +x, -y, +y, -z, +z), `half_range_flux`, `left_out` (what the scene did not need), `device`, `stored_directions`.
 * Output 1: vtkTable, one row a scattering order (as published: a step): `iteration`, `seconds`, `residual`, `change`,
 * `absorbed`, `escaped`, `left_over`, and with WarmStart `sweeps_saved`: by how many rows a row comes to its residual
 * earlier than the last solve from darkness on did.
 *
 * Orders are not accelerated: for thick media that absorb little, vtkLightPropagationMaps is faster. The radiance of
 * all directions has to fit the device: what it takes is said before any is taken. EstimateError is not used.
 *
 * With Decomposition BLOCKS radiance goes from rank to rank (numerics.md, section 10 b): the same light, order by
 * order. A Quality has no more directions than half the smallest memory of all ranks would hold of the whole. Blocks
 * cannot do Scheme PUBLISHED.
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
    CONSERVATIVE = 1 ///< steps by exponentials that keep the energy, lights followed exactly
  };

  enum Scatterings
  {
    MATRIX = 0,             ///< every pair of directions
    SINGULAR_VALUES = 1,    ///< Terms singular values, as published
    SPHERICAL_HARMONICS = 2 ///< Terms spherical harmonics
  };

  ///@{
  /// How to compute: PUBLISHED, or CONSERVATIVE (default). PUBLISHED refuses a FaceAlbedo other than 0.
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  ///@{
  /// How what arrives along each direction is scattered into each: MATRIX, SINGULAR_VALUES or SPHERICAL_HARMONICS
  /// (default).
  tyndallRangeMacro(Scattering, int, MATRIX, SPHERICAL_HARMONICS);
  ///@}

  ///@{
  /// Directions per face of a cube. Default 25, valid square numbers: 1, 4, 9, 16, 25, ... Slabs are solved with more.
  tyndallRangeMacro(DirectionsPerFace, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Directions on a spiral instead, any number from 16 on. Default 0: those of the cube, whose light turns with its
  /// scene.
  tyndallRangeMacro(SpiralDirections, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Terms of the separable phase function. Default 25, at most as many as there are directions; of spherical
  /// harmonics square numbers: 1, 4, 9, 16, ...
  tyndallRangeMacro(Terms, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Scattering orders (as published: steps) at most. Default 0: as many as Tolerance takes.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether the light of the last update is the first guess of the next one: fewer sweeps where medium or lights
  /// changed a little, the same light within the tolerance. It is kept in memory until an update with WarmStart off: a
  /// float a voxel and channel. It is used where scattering is isotropic, and not as published. By blocks each rank
  /// keeps that of its own, and all begin in the dark where blocks have changed. Default off.
  tyndallFlagMacro(WarmStart);
  ///@}

  ///@{
  /// Whether to compute `net_flux` too. Default off.
  tyndallFlagMacro(NetFlux);
  ///@}

  ///@{
  /// Whether to leave out what the scene does not need. Default on.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// What came of the last update: scattering orders done, how many more the last update from darkness on took to the
  /// same residual (0 where this was one), estimated relative error of fluence left by those that were
  /// not done, relative error of the energy balance, what the directions carry of the power that even light brings
  /// through a face, over the exact value, seconds, the device's name, and what the scene did not need, one per line.
  vtkGetMacro(Orders, int);
  vtkGetMacro(SweepsSaved, int);
  vtkGetMacro(Residual, double);
  vtkGetMacro(BalanceError, double);
  vtkGetMacro(HalfRangeFlux, double);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

protected:
  vtkDiscreteOrdinates();
  ~vtkDiscreteOrdinates() override;

  void Note(const tyndall::LightField& light) override;
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
  bool WarmStart = false;
  bool NetFlux;
  bool LeaveOut;

  std::unique_ptr<tyndall::LastLight> Last;
  int Orders = 0;
  int SweepsSaved = 0;
  double Residual = 0.0;
  double BalanceError = 0.0;
  double HalfRangeFlux = 0.0;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
