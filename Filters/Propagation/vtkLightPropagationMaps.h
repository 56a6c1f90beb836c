#ifndef vtkLightPropagationMaps_h
#define vtkLightPropagationMaps_h

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
 * @class vtkLightPropagationMaps
 * @brief multiply scattered light in a medium, by light propagation maps
 *
 * Rays sweep the grid along DirectionsPerFace directions per face of a cube, with MapResolution rays per voxel edge.
 * The power that rays lose to scattering in a voxel becomes the voxel's source for the next scattering order. Source
 * iteration ends when the estimated relative error of fluence is below Tolerance; it can be accelerated by diffusion
 * synthetic acceleration (DSA).
 *
 * Input 0, the medium: vtkImageData with cell arrays (point arrays: see SetPointData)
 *
 * | array      | components | unit             | meaning                                          |
 * |------------|------------|------------------|--------------------------------------------------|
 * | `sigma_a`  | 1 or 3     | 1/length         | absorption coefficient                           |
 * | `sigma_s`  | 1 or 3     | 1/length         | scattering coefficient                           |
 * | `emission` | 1 or 3     | W/(length^3 sr)  | emitted radiance per unit length; optional       |
 *
 * or the arrays chosen by SetInputArrayToProcess 0, 1 and 2, and field data `phase_function` and `g`, or cells `g`
 * (default: isotropic). The published scheme needs the same phase function in all voxels.
 * Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, vtkImageData in latitude-longitude layout, point array `radiance` (1 or 3
 * components, W/(length^2 sr)), as vtkEnvironmentReader makes it.
 * Input 3, optional: uncollided light of another filter; replaces lights and environment (vtkScatteringSolver).
 *
 * Output 0: the medium's image with cell arrays of 1 component, or 3 where medium or light has colour
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions |
 * | `fluence_direct` | 1 or 3 | W/length^2 | uncollided part of `fluence` |
 * | `fluence_error` | 1 or 3 | W/length^2 | standard error of `fluence` (if EstimateError or TargetError) |
 * | `net_flux` | 3 or 9 | W/length^2 | radiance times direction, integrated (if NetFlux) |
 * | `scattered_radiance` | StoredDirections x 1 or 3 | W/(length^2 sr) | scattered radiance per stored direction |
 *
 * and field data `energy_balance` (W: entered, emitted, absorbed, escaped, left over), `face_power_out` (W through -x,
 * +x, -y, +y, -z, +z), `half_range_flux` (see HalfRangeFlux), `left_out` (computations that the scene did not need),
 * `device`, `stored_directions`; if source iteration is accelerated and a voxel at a face of the box is thicker than
 * half a mean free path, `surface_radiance`, W/(length^2 sr): the outgoing radiance of each voxel face on the boundary,
 * tuples by face (-x to +z) and row of voxels, components for the cosines 0.05, 0.25, 0.6, 1 to the normal (times red,
 * green, blue).
 * Output 1: vtkTable, one row per scattering order: `iteration`, `seconds`, `residual`, `change`, `absorbed`,
 * `escaped`, `left_over`, and with WarmStart `sweeps_saved`: number of additional rows after which the last cold solve
 * (with zero initial guess) reached the same residual.
 *
 * Without lights, environment, SkyColor, FaceRadiance and emission the result is dark, with a warning.
 *
 * With Decomposition BLOCKS rays continue from rank to rank (numerics.md, section 4.9). Source iteration is accelerated
 * as in a serial solve, with two exceptions: thin voxels with isotropic scattering and periodic axes, and optically
 * thick voxels with UncollidedDirections. In these cases, and where a serial solve is not accelerated, scattering
 * orders are summed by plain source iteration, with the source by octant if the serial solve uses it. BLOCKS cannot be
 * used with Scheme PUBLISHED, nor with Source LINEAR and UncollidedDirections. Errors are estimated and targets met as
 * in a serial solve (numerics.md, section 9.2). AUTOMATIC_DECOMPOSITION chooses a serial solve also for these scenes:
 * the two exceptions above if they need many orders, which the serial solver accelerates; localised emission, whose
 * uncollided flux the serial solver computes along exact rays; finer UncollidedDirections together with accelerated
 * sweeps; and plane-parallel layers.
 *
 * @sa vtkParticipatingMedium vtkLightRig vtkEnvironmentReader vtkMediumRayCaster
 * @par Thanks
 * A. Gruson, A. Hakke Patil, R. Cozot, K. Bouatouch, S. Pattanaik: Light Propagation Maps on Parallel Graphics
 * Architectures, EGPGV 2012. R. Fattal: Participating Media Illumination Using Light Propagation Maps, ACM Trans.
 * Graph. 28 (2009).
 */
class TYNDALL_EXPORT vtkLightPropagationMaps : public vtkScatteringSolver
{
public:
  static vtkLightPropagationMaps* New();
  vtkTypeMacro(vtkLightPropagationMaps, vtkScatteringSolver);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Schemes
  {
    PUBLISHED = 0,   ///< scheme of Gruson et al. 2012
    CONSERVATIVE = 1 ///< energy-conserving deposit, directions weighted by solid angle, exact rays from lamps
  };

  enum Sources
  {
    CONSTANT = 0, ///< source constant in each voxel, as published
    LINEAR = 1,   ///< source linear between voxel centres: accurate for voxels of any optical thickness
    /// LINEAR if source iteration is accelerated, OCTANTS if many voxels are optically thick, else CONSTANT
    AUTOMATIC_SOURCE = 2,
    /// One source per octant of directions in optically thick voxels, accurate for strong absorption; LINEAR if source
    /// iteration is accelerated.
    OCTANTS = 3
  };

  enum Accelerations
  {
    NONE = 0,                  ///< plain source iteration, as published
    AUTOMATIC_ACCELERATION = 1 ///< DSA: a diffusion solve between sweeps, if many orders would be needed
  };

  enum Algorithms
  {
    SEQUENTIAL = 0, ///< Algorithm 1: rays in sequence, on one core of the host
    PARALLEL = 1    ///< Algorithm 2: propagation and collection on the device
  };

  ///@{
  /// Numerical scheme: PUBLISHED, or CONSERVATIVE (default). With PUBLISHED a FaceAlbedo other than 0 is an error, and
  /// the initial guess is zero, whatever WarmStart is.
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  ///@{
  /// Algorithm of the published scheme: SEQUENTIAL, or PARALLEL (default). The conservative scheme has only one.
  tyndallRangeMacro(Algorithm, int, SEQUENTIAL, PARALLEL);
  ///@}

  ///@{
  /// Spatial shape of the source within a voxel (conservative scheme): CONSTANT, LINEAR, AUTOMATIC_SOURCE (default), or
  /// OCTANTS.
  tyndallRangeMacro(Source, int, CONSTANT, OCTANTS);
  ///@}

  ///@{
  /// Acceleration of source iteration (conservative scheme, if MaximumOrders is 0): NONE, or AUTOMATIC_ACCELERATION
  /// (default). Source LINEAR needs acceleration.
  tyndallRangeMacro(Acceleration, int, NONE, AUTOMATIC_ACCELERATION);
  ///@}

  ///@{
  /// Number of directions per face of a cube. Default 25, valid square numbers: 1, 4, 9, 16, 25, ... Slabs (two
  /// periodic axes of one voxel each) are solved with more (GridAxes.h).
  tyndallRangeMacro(DirectionsPerFace, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of directions per face of a cube for the uncollided flux of boundary sources: faces, sky and environment
  /// (conservative scheme). Uncollided flux has sharp shadows but is swept only once, so that more directions than for
  /// scattered light are affordable. Default -1: a number that is predicted to add at most half to the run time, for
  /// boundary sources on faces only (LightSources.h); 0: as DirectionsPerFace; else square numbers up to 4096.
  tyndallRangeMacro(UncollidedDirections, int, -1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Relative error, in each voxel, of the uncollided flux of localised emission, which is computed along exact rays
  /// (conservative scheme, no periodic axis). Default 0.02, valid [0, infinity); 0.005 takes five to ten times as long,
  /// smaller values do not reduce the error. Localised emission is swept like other sources if EmissionError is 0, or
  /// if other light has more power.
  tyndallRangeMacro(EmissionError, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Degree of the angular moments (spherical harmonics) of the scattering source (conservative scheme): higher degrees
  /// resolve a forward peak better, and take longer. -1 (default): 3, in thin media 6, in slabs (two periodic axes of
  /// one voxel each) 9, or less if phase function and Tolerance do not require that degree or memory does not allow it;
  /// 0: scattering is isotropic with sigma_s (1 - g), the similarity relation. Valid [-1, 15]; a quadrature of n x n
  /// DirectionsPerFace resolves degrees up to 2 n - 1, higher ones are not used.
  tyndallRangeMacro(AngularDegree, int, -1, 15);
  ///@}

  ///@{
  /// Whether to write the angular moments of the scattering source (cells `scattered_moments`; cells `straight_on`, the
  /// fraction of scattering that is treated as unscattered; field data `lamps_apart`, the lamps whose first-collision
  /// source the moments exclude), if the solve uses moments: vtkMediumRayCaster renders from these moments. Memory: 4
  /// (degree + 1)^2 bytes per voxel and channel, a gigabyte at most. Default on.
  tyndallFlagMacro(StoreMoments);
  ///@}

  ///@{
  /// Whether the rays of each direction have a different offset within the voxels (conservative scheme); the uncollided
  /// flux along more than 100 UncollidedDirections always uses offsets if source iteration is not accelerated. With 144
  /// directions per face or more, offsets can halve the error; with fewer they can double it. Default off.
  tyndallFlagMacro(StaggeredRays);
  ///@}

  ///@{
  /// Number of rays of each direction per voxel edge. Default 1, valid [1, 16].
  tyndallRangeMacro(MapResolution, int, 1, 16);
  ///@}

  ///@{
  /// Limit on the number of scattering orders. Default 0: as many as Tolerance requires.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether the solution of the last update is the initial guess of the next one: it saves sweeps if medium or lights
  /// changed a little; the result is the same within Tolerance. The solution stays in memory until an update with
  /// WarmStart off: one float per voxel and channel, times (degree + 1)^2 with AngularDegree. Not used by the published
  /// scheme. With Decomposition BLOCKS each rank keeps the solution of its piece; if the pieces have changed, the
  /// initial guess is zero on all ranks. Default off.
  tyndallFlagMacro(WarmStart);
  ///@}

  ///@{
  /// Whether to compute the array `net_flux`, which costs time and memory. Default off.
  tyndallFlagMacro(NetFlux);
  ///@}

  ///@{
  /// Number of directions for which `scattered_radiance` is written. Default 1 (enough for isotropic scattering), valid
  /// from 1 on.
  tyndallRangeMacro(StoredDirections, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Results of the last update: number of scattering orders; number of additional orders that the last update with
  /// zero initial guess needed to reach the same residual (0 if this was such an update); half-range flux of the
  /// quadrature for isotropic radiance through a face, as a fraction of the exact value (0.99992 with 25 directions per
  /// face: the incident power from faces and sky has the same relative error). Residual of vtkScatteringSolver is the
  /// error due to the omitted orders.
  vtkGetMacro(Orders, int);
  vtkGetMacro(SweepsSaved, int);
  vtkGetMacro(HalfRangeFlux, double);
  ///@}

protected:
  vtkLightPropagationMaps();
  ~vtkLightPropagationMaps() override;

  void Note(const tyndall::LightField& light) override;
  void ShareResults(tyndall::Communicator& ranks) override;
  std::string NotByBlocks(vtkInformationVector** inputs) const override;
  std::string ReasonNotToDecompose(const tyndall::SolverScene& scene) override;
  tyndall::LightField Solve(const tyndall::SolverScene& scene) override;

private:
  vtkLightPropagationMaps(const vtkLightPropagationMaps&) = delete;
  void operator=(const vtkLightPropagationMaps&) = delete;

  int Scheme = CONSERVATIVE;
  int Algorithm = PARALLEL;
  int Source = AUTOMATIC_SOURCE;
  int Acceleration = AUTOMATIC_ACCELERATION;
  int DirectionsPerFace;
  int UncollidedDirections;
  int AngularDegree;
  bool StoreMoments;
  double EmissionError;
  bool StaggeredRays;
  int MapResolution;
  int MaximumOrders;
  bool WarmStart = false;
  bool NetFlux;
  int StoredDirections;

  std::unique_ptr<tyndall::LastLight> Last;
  int Orders = 0;
  int SweepsSaved = 0;
  double HalfRangeFlux = 0.0;
};

#endif
