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
 * @brief light that is scattered many times in a medium, by light propagation maps
 *
 * Rays march through the grid in DirectionsPerFace directions of each face of a cube, one per MapResolution-th part of
 * a voxel's edge. What they lose to a voxel becomes its scattered light, which the next scattering order propagates,
 * until the light that is left does not matter any more.
 *
 * Input 0, the medium: vtkImageData with cell arrays (point arrays: see SetPointData)
 *
 * | array      | components | unit             | meaning                                          |
 * |------------|------------|------------------|--------------------------------------------------|
 * | `sigma_a`  | 1 or 3     | 1/length         | absorption coefficient                           |
 * | `sigma_s`  | 1 or 3     | 1/length         | scattering coefficient                           |
 * | `emission` | 1 or 3     | W/(length^3 sr)  | emitted radiance per unit length; optional       |
 *
 * or those chosen by SetInputArrayToProcess 0, 1 and 2, and field data `phase_function` and `g`, or
 * cells `g` (default: isotropic). As published there has to be one phase function for all.
 * Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, vtkImageData in latitude-longitude layout, point array `radiance` (1 or 3
 * components, W/(length^2 sr)), as vtkEnvironmentReader makes it.
 * Input 3, optional: uncollided light of another filter instead of all these (vtkScatteringSolver).
 *
 * Output 0: the medium's image with cell arrays of 1 component, or 3 where medium or light has colour
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions |
 * | `fluence_direct` | 1 or 3 | W/length^2 | its unscattered part |
 * | `fluence_error` | 1 or 3 | W/length^2 | its standard error (if EstimateError or TargetError) |
 * | `net_flux` | 3 or 9 | W/length^2 | radiance times direction, integrated (if NetFlux) |
 * | `scattered_radiance` | StoredDirections x 1 or 3 | W/(length^2 sr) | radiance scattered into each direction |
 *
 * and field data `energy_balance` (W: entered, emitted, absorbed, escaped, left over), `face_power_out` (W through -x,
 * +x, -y, +y, -z, +z), `half_range_flux` (see HalfRangeFlux), `left_out` (what the scene did not need), `device`,
 * `stored_directions`; where orders are accelerated and a voxel at a face of the box is thicker than half a mean free
 * path, `surface_radiance`, W/(length^2 sr): what leaves each voxel's face there, tuples face by face (-x to +z), row
 * by row, components at the cosines 0.05,
 * 0.25, 0.6, 1 to the normal (times red, green, blue).
 * Output 1: vtkTable, one row a scattering order: `iteration`, `seconds`, `residual`, `change`, `absorbed`, `escaped`,
 * `left_over`, and with WarmStart `sweeps_saved`: by how many rows a row comes to its residual earlier than the last
 * solve from darkness on did.
 *
 * Without lights, environment, SkyColor, FaceRadiance and emission the result is dark, with a warning.
 *
 * With Decomposition BLOCKS rays go from rank to rank (numerics.md, section 4.9). Orders are accelerated as in the
 * whole, but not in thin voxels of isotropic scattering round periodic axes and not in thick ones with
 * UncollidedDirections: there, and where the whole does so, they are added up one by one, by octant where the whole
 * would be. Blocks cannot do: Scheme PUBLISHED, and Source LINEAR with UncollidedDirections. Errors are estimated, and
 * targets met, as of the whole (numerics.md, section 9.2). AUTOMATIC_DECOMPOSITION leaves to the whole, beside that:
 * those many orders, which it accelerates; small bright emission, which it follows along exact rays; finer
 * UncollidedDirections beside accelerated sweeps; and layers.
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
    PUBLISHED = 0,   ///< as Gruson et al. describe it
    CONSERVATIVE = 1 ///< conservative deposit, directions by solid angle, lights followed exactly
  };

  enum Sources
  {
    CONSTANT = 0,         ///< in each voxel, as published
    LINEAR = 1,           ///< from voxel centre to voxel centre: right however thick voxels are
    AUTOMATIC_SOURCE = 2, ///< linear where orders are accelerated, by octant where many voxels are thick, else constant
    OCTANTS = 3           ///< of thick voxels by octant: right where they absorb much; linear where accelerated
  };

  enum Accelerations
  {
    NONE = 0,                  ///< scattering orders one after the other, as published
    AUTOMATIC_ACCELERATION = 1 ///< a diffusion system between sweeps where orders would be many
  };

  enum Algorithms
  {
    SEQUENTIAL = 0, ///< Algorithm 1: one ray after the other, on one core of the host
    PARALLEL = 1    ///< Algorithm 2: propagation and collection on the device
  };

  ///@{
  /// How to compute: PUBLISHED, or CONSERVATIVE (default). PUBLISHED refuses a FaceAlbedo other than 0, and begins in
  /// the dark whatever WarmStart is.
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  ///@{
  /// Which algorithm of the published scheme: SEQUENTIAL, or PARALLEL (default). The conservative scheme has one only.
  tyndallRangeMacro(Algorithm, int, SEQUENTIAL, PARALLEL);
  ///@}

  ///@{
  /// How the light that a voxel sends out is spread over it (conservative scheme): CONSTANT, LINEAR,
  /// AUTOMATIC_SOURCE (default), or OCTANTS.
  tyndallRangeMacro(Source, int, CONSTANT, OCTANTS);
  ///@}

  ///@{
  /// How scattering orders are added up (conservative scheme, where MaximumOrders is 0): NONE, or
  /// AUTOMATIC_ACCELERATION (default). LINEAR needs it.
  tyndallRangeMacro(Acceleration, int, NONE, AUTOMATIC_ACCELERATION);
  ///@}

  ///@{
  /// Directions per face of a cube. Default 25, valid square numbers: 1, 4, 9, 16, 25, ... Slabs are solved with more
  /// (UnvaryingAxes.h).
  tyndallRangeMacro(DirectionsPerFace, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Directions per face of a cube for unscattered light of shining faces, sky and environment (conservative scheme).
  /// It has shadows with edges and is swept once: it may have many while scattered light does with few. Default -1: as
  /// many as cost a quarter more time, for light of faces alone (UncollidedDirections.h); 0: as DirectionsPerFace;
  /// else square numbers up to 4096.
  tyndallRangeMacro(UncollidedDirections, int, -1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Relative error, voxel by voxel, of the unscattered light of small bright parts of the medium, which is followed
  /// along exact rays (conservative scheme, no periodic axis). Default 0.02; 0.005 costs five to ten times as much,
  /// less gains nothing; 0: they are swept like all else, as they are where other light has more power.
  tyndallRangeMacro(EmissionError, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Degree of the angular moments in which light is scattered (conservative scheme): higher ones show a forward peak
  /// in finer detail, and take longer. -1 (default): 3, in thin media 6, in slabs 9, or less, as the phase function,
  /// Tolerance and memory ask for; 0: scattering is taken as isotropic with sigma_s (1 - g), the similarity relation.
  /// Valid [-1, 15]; DirectionsPerFace of n x n tell 2 n - 1 degrees apart, no more are used.
  tyndallRangeMacro(AngularDegree, int, -1, 15);
  ///@}

  ///@{
  /// Whether to keep the angular moments of what is scattered (cells `scattered_moments`, `straight_on`, field data
  /// `lamps_apart`), where light is scattered in moments: vtkMediumRayCaster shows them. Four bytes times (degree +
  /// 1)^2 a voxel and channel, a gigabyte at most. Default on.
  tyndallFlagMacro(StoreMoments);
  ///@}

  ///@{
  /// Whether rays of each direction start in a place of their own within a voxel (conservative scheme), those of
  /// more than 100 UncollidedDirections always. From 144 directions per face on up to half the error, with fewer up to
  /// twice. Default off.
  tyndallFlagMacro(StaggeredRays);
  ///@}

  ///@{
  /// Rays of a direction per voxel edge. Default 1, valid [1, 16].
  tyndallRangeMacro(MapResolution, int, 1, 16);
  ///@}

  ///@{
  /// Scattering orders at most. Default 0: as many as Tolerance takes.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Relative error of fluence (root mean square over that of fluence) to solve to, by the solver's own estimate
  /// (conservative scheme): it chooses directions and tolerance where they have their default values, divides voxels
  /// where these are too coarse, and warns where the estimate stays above. Quality is not read then. Default 0: not
  /// asked for; valid [0, 0.5].
  tyndallRangeMacro(TargetError, double, 0.0, 0.5);
  ///@}

  ///@{
  /// Whether the light of the last update is the first guess of the next one: fewer sweeps where medium or lights
  /// changed a little, the same light within the tolerance. It is kept in memory until an update with WarmStart off: a
  /// float a voxel and channel, times (degree + 1)^2 with AngularDegree; not as published. By blocks each rank keeps
  /// that of its own, and all begin in the dark where blocks have changed. Default off.
  tyndallFlagMacro(WarmStart);
  ///@}

  ///@{
  /// Whether to compute `net_flux` too; it costs time and memory. Default off.
  tyndallFlagMacro(NetFlux);
  ///@}

  ///@{
  /// Whether to leave out what the scene does not need. Default on; off computes everything, for comparison: the same
  /// light, later.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// Directions for which `scattered_radiance` is kept. Default 1 (enough for isotropic scattering), valid from 1 on.
  tyndallRangeMacro(StoredDirections, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// What came of the last update: solves (more than one with TargetError), scattering orders done, how many more the
  /// last update from darkness on took to the same residual (0 where this was one), estimated relative error of
  /// fluence left by those that were not done, estimated relative error of fluence altogether (0 without
  /// EstimateError or TargetError; NaN, not known, after one order), relative error of the energy balance, what the
  /// directions carry of the power that even light brings through a face, over the exact value (0.99992 with 25
  /// directions per face: light that enters from faces and sky is off by as much), seconds, the device's name, and
  /// what the scene did not need, one per line.
  vtkGetMacro(Solves, int);
  vtkGetMacro(Orders, int);
  vtkGetMacro(SweepsSaved, int);
  vtkGetMacro(Residual, double);
  vtkGetMacro(EstimatedError, double);
  vtkGetMacro(BalanceError, double);
  vtkGetMacro(HalfRangeFlux, double);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

protected:
  vtkLightPropagationMaps();
  ~vtkLightPropagationMaps() override;

  void Note(const tyndall::LightField& light) override;
  bool ReadsQuality() const override { return this->TargetError == 0.0 && this->Superclass::ReadsQuality(); }
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
  bool LeaveOut;
  int StoredDirections;
  double TargetError = 0.0;

  std::unique_ptr<tyndall::LastLight> Last;
  int Solves = 0;
  int Orders = 0;
  int SweepsSaved = 0;
  double Residual = 0.0;
  double EstimatedError = 0.0;
  double BalanceError = 0.0;
  double HalfRangeFlux = 0.0;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
