#ifndef vtkPhotonMarcher_h
#define vtkPhotonMarcher_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace tyndall
{
class Communicator;
class Device;
class Domain;
class KeptMarcher;
class PhotonMarcher;
class PieceBlocks;
struct Grid;
struct Photon;
struct PhotonLight;
struct RefractiveInput;
}

/**
 * @class vtkPhotonMarcher
 * @brief marches photons along bent rays through a medium: uncollided flux, or Monte Carlo of multiple scattering
 *
 * Paths follow d/ds(n dx/ds) = grad n, so that refraction and total reflection need no surfaces. A photon's power
 * decreases along its path as exp(-optical thickness); every voxel that a path crosses gains the integral of the
 * photon's power over the path length in the voxel, so that `fluence` is an unbiased estimate in W/length^2 for any
 * number of photons. By default scattered light is not followed: vtkMediumRayCaster computes single scattering from
 * `fluence` and `mean_direction`, and vtkLightPropagationMaps accepts the light as UncollidedLight. With MaximumOrders
 * photons are followed through several scatterings.
 *
 * Input 0, the medium: vtkImageData with cell arrays `sigma_a`, `sigma_s` (1 or 3 components, 1/length) and optionally
 * `ior` (1 component; missing: constant) or the arrays chosen by SetInputArrayToProcess 0, 1 and 3.
 * Input 1: photons as vtkPhotonEmitter makes them. Input 2, optional: an image of the same voxels with cell array
 * `octree_level`, as vtkRefractionOctree makes it; without this input, `octree_level` of the medium is used, if there
 * is such an array.
 *
 * Output 0: the medium's image with cell arrays
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions, scattering orders up to MaximumOrders |
 * | `fluence_direct` | 1 or 3 | W/length^2 | uncollided part of `fluence` |
 * | `fluence_error` | 1 or 3 | W/length^2 | standard error of `fluence`; if MaximumOrders is not 1, with ErrorBatches |
 * | `mean_direction` | 3 | 1 | power-weighted mean direction; its length is the anisotropy |
 * | `photon_count` | 1 | 1 | photons that crossed the voxel, each once; with PhotonCounts |
 * | `photon_weight` | 1 | 1 | mean `weight` of these photons, 0 if there are none; with PhotonCounts |
 * | `fluence_batches` | (1 or 3) x batches | W/length^2 | `fluence` estimated from each of several batches |
 *
 * (the last three by the conservative scheme only, for vtkPhotonReconstruction), and field data `energy_balance` (W:
 * entered, emitted, absorbed, escaped, left over; absorbed includes the scattered power), `scattered` (W, scattered for
 * the first time), `face_power_out`, `left_out`, `device`; if MaximumOrders is not 1, `scatterings` and `exchanged` (W
 * added by Russian roulette minus W removed by it; `absorbed` is then the power that the medium absorbed); by the
 * published scheme also `packing_loss` (see PackingLoss).
 * Output 1: vtkPolyData, the paths of PathCount photons as polylines, point data `power_left` (fraction of the photon's
 * initial power), cell data `photon` (number of the photon).
 *
 * The prepared medium stays on the device, so that new photons cost only their march. It is freed when the medium or
 * the octree changes, another medium or octree is connected, a changed setting requires it, another device is chosen,
 * or the filter is deleted. With BLOCKS the medium is prepared again for every march.
 *
 * In a parallel pipeline every rank marches photons through its piece of the medium, and photons continue from rank to
 * rank; or, depending on Decomposition, the first rank marches all photons through the whole medium and sends each rank
 * the requested piece. Output 1 of the first rank has the paths, each as one polyline.
 *
 * Cells that `vtkGhostType` marks as hidden are empty.
 *
 * @sa vtkPhotonEmitter vtkRefractionOctree vtkPhotonReconstruction vtkMediumRayCaster
 * @par Thanks
 * M. Pfeuti, Real-time Rendering of Refractive Objects in Participating Media, 2009, section 3.1.5. X. Sun, K. Zhou, E.
 * Stollnitz, J. Shi, B. Guo: Interactive Relighting of Dynamic Refractive Objects, ACM Trans. Graph. 27 (2008).
 */
class TYNDALL_EXPORT vtkPhotonMarcher : public vtkImageAlgorithm
{
public:
  static vtkPhotonMarcher* New();
  vtkTypeMacro(vtkPhotonMarcher, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  enum Schemes
  {
    /// Explicit Euler steps; deposits power in rasterised voxels, packed into 64 bits per voxel by compare-and-swap;
    /// smooths the result (Smoothing).
    PUBLISHED = 0,
    /// Symplectic integrator; deposits power times path length, in fixed-point sums that are exact and bitwise
    /// reproducible.
    CONSERVATIVE = 1
  };

  ///@{
  /// Photons (vtkPolyData) and octree (vtkImageData) by connection or as data; null: none.
  void SetPhotonsConnection(vtkAlgorithmOutput* photons);
  void SetPhotonsData(vtkDataObject* photons);
  void SetOctreeConnection(vtkAlgorithmOutput* octree);
  void SetOctreeData(vtkDataObject* octree);
  void RemoveOctree();
  ///@}

  ///@{
  /// Numerical scheme of the march: PUBLISHED, or CONSERVATIVE (default).
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  enum Decompositions
  {
    AUTOMATIC_DECOMPOSITION = 0, ///< BLOCKS for more than 64^3 voxels, if possible
    WHOLE = 1,                   ///< the first rank marches all photons through the whole medium
    BLOCKS = 2                   ///< each rank marches photons through its piece of the medium
  };

  ///@{
  /// Domain decomposition over MPI ranks. WHOLE: the first rank holds the whole medium and all photons. BLOCKS: each
  /// rank holds its piece, a halo of the refractive index, and its share of the photons. A photon that leaves the
  /// piece, scattered or not, continues on the neighbouring rank with its full state (numerics.md, section 12.6). The
  /// light is bitwise that of one rank; in the published scheme it differs by the packing loss, which is not
  /// reproducible even on one rank. If all ranks have the same photons, they are divided among the ranks; else the
  /// photons are those of rank 0, then rank 1, and so on. An octree whose pieces differ from the medium's is an error
  /// with BLOCKS. Light that EmptySpace would store by bricks is stored by voxels. AUTOMATIC_DECOMPOSITION (default):
  /// BLOCKS if each of several ranks is asked for its own piece and the scene allows it; else WHOLE. WHOLE is also
  /// chosen if EmptySpace asks for bricks, unless the whole medium exceeds the machine's available memory.
  tyndallRangeMacro(Decomposition, int, AUTOMATIC_DECOMPOSITION, BLOCKS);
  ///@}

  ///@{
  /// How point arrays are read. 0 (default): each point is the centre of a voxel with its value: n points make n
  /// voxels, the output has cell arrays, and its bounds are half a spacing wider than the input's. 1: points are
  /// averaged to the voxels between them: n points make n - 1 voxels. If a cell array is read as well, the cells are
  /// the voxels and points are averaged; field data `settings_used` then report it.
  tyndallPointDataMacro();
  ///@}

  ///@{
  /// Order of the conservative scheme's integrator: 1 (explicit Euler, for comparison), 2 (leapfrog; default) or 4
  /// (Yoshida; for an index that is smooth over several voxels; a step within an octree node is at most 16 voxels
  /// long).
  tyndallRangeMacro(IntegratorOrder, int, 1, 4);
  ///@}

  ///@{
  /// Step length of the integrator, in voxels, where the refractive index varies and the octree has single voxels.
  /// Default 1, valid [0.05, 1e4].
  tyndallRangeMacro(StepSize, double, 0.05, 1e4);
  ///@}

  ///@{
  /// Whether to write `photon_count` and `photon_weight`, at the cost of one more sum per voxel in the same pass.
  /// Default off. An error with the published scheme.
  tyndallFlagMacro(PhotonCounts);
  ///@}

  ///@{
  /// Scattering orders through which photons are followed. 1 (default): to the first scattering, which is
  /// deterministic; m: through m - 1 scatterings; 0: until they are absorbed or leave the volume. Valid [0, infinity).
  /// Scattered photons are an unbiased reference for every other solver: Monte Carlo along bent rays, with the medium's
  /// phase function. Values other than 1 are an error with the published scheme.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Seed of the random numbers for scattering: the same seed gives bitwise the same light. Default 1, valid [0,
  /// infinity).
  tyndallRangeMacro(Seed, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of batches of scattered photons, from whose differences `fluence_error` is computed: 2 to 64, default 16;
  /// 0: no `fluence_error`. Used if MaximumOrders is not 1, without PhotonCounts.
  tyndallRangeMacro(ErrorBatches, int, 0, 64);
  ///@}

  ///@{
  /// Whether to skip computations that the scene does not need. Default on; off computes everything, for comparison:
  /// the result is the same in more time. Conservative scheme only.
  tyndallFlagMacro(LeaveOut);
  ///@}

  /// Conditions under which light in empty space is stored by bricks of 8^3 voxels, for EmptySpace.
  enum EmptySpaces
  {
    BY_VOXEL = 0, ///< never: all light is stored voxel by voxel
    AS_READ = 1,  ///< by bricks if the medium's field data `active_part` (vtkVDBReader) is at most 0.25
    BY_BRICK = 2  ///< by bricks whenever the medium is mostly empty
  };

  ///@{
  /// Storage of light in empty bricks (8^3 voxels without medium): voxel by voxel (BY_VOXEL), or as the mean over the
  /// brick (BY_BRICK), which photons then cross in one segment; AS_READ chooses by the fraction of active voxels in the
  /// medium's file. Storage by bricks needs a fraction of the time and memory if the medium is mostly empty; `fluence`
  /// in bricks with medium is the same, to rounding. Bricks are used if the index is constant, at least three quarters
  /// of the bricks are empty, MaximumOrders is 1 and the scheme conservative, without PhotonCounts and several batches.
  /// Default AS_READ.
  tyndallRangeMacro(EmptySpace, int, BY_VOXEL, BY_BRICK);
  ///@}

  ///@{
  /// Number of photons, evenly chosen from all photons, whose paths are written to output 1. Default 0, valid [0,
  /// infinity).
  tyndallRangeMacro(PathCount, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether the published scheme smooths the result by a 3x3x3 Gauss filter. Default on.
  tyndallFlagMacro(Smoothing);
  ///@}

  ///@{
  /// Device memory that the filter may use, MiB, including memory that it keeps between updates; a scene that needs
  /// more is an error, which states the required memory. Default 0: all memory of the device. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  tyndallDeviceMacro();

  ///@{
  /// Results of the last update: path segments deposited in voxels, steps of the integrator, photons that miss the
  /// volume, scatterings, relative error of the energy balance, packing loss, whether the prepared medium was reused,
  /// run time in seconds, the device's name, and the computations that the scene did not need, one per line.
  ///
  /// The energy balance of the conservative scheme closes to rounding. That of the published scheme does not, even
  /// without packing loss: it deposits a photon's power in a voxel regardless of the path length, so that extinction
  /// times fluence differs from the power that photons lost. PackingLoss is a separate error: the fraction of the
  /// deposited power that the voxels' 64 bits did not keep (rounding, saturation, failed compare-and-swap), before
  /// smoothing; 0 for the conservative scheme.
  vtkGetMacro(Deposits, vtkIdType);
  vtkGetMacro(Steps, vtkIdType);
  vtkGetMacro(Missed, vtkIdType);
  vtkGetMacro(Scatterings, vtkIdType); ///< number of scatterings of all photons; 0 if MaximumOrders is 1
  vtkGetMacro(BalanceError, double);
  vtkGetMacro(PackingLoss, double);
  vtkGetMacro(MediumKept, bool);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
  ///@}

  using Superclass::SetInputConnection;
  /// Connects an input. A new medium or octree also frees the cached marcher of the previous one.
  void SetInputConnection(int port, vtkAlgorithmOutput* input) override;

protected:
  vtkPhotonMarcher();
  ~vtkPhotonMarcher() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkPhotonMarcher(const vtkPhotonMarcher&) = delete;
  void operator=(const vtkPhotonMarcher&) = delete;

  struct Marched;
  struct MarchInput;
  bool WantsBlocks(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const;
  bool FindInput(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, MarchInput& input);
  bool March(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkInformationVector* outputs);
  void MarchAsPublished(tyndall::Device& device, const tyndall::Domain& domain, const tyndall::RefractiveInput& read,
    const std::vector<tyndall::Photon>& photons, Marched& marched);
  void MarchThrough(tyndall::PhotonMarcher& marcher, tyndall::Communicator& communicator,
    const std::vector<tyndall::Photon>& photons, Marched& marched);
  void WarnOfBox(vtkInformationVector** inputs, const tyndall::Grid& medium);
  void Write(const tyndall::PieceBlocks& pieces, const MarchInput& input, Marched&& marched,
    vtkInformationVector** inputs, vtkInformationVector* outputs);
  void Note(const Marched& marched);
  void Warn(const tyndall::PhotonLight& light, std::size_t photons);

  int Scheme = CONSERVATIVE;
  int PointData = VOXELS_AROUND_POINTS;
  int IntegratorOrder;
  double StepSize;
  bool PhotonCounts;
  bool LeaveOut;
  int EmptySpace = AS_READ;
  int Decomposition = AUTOMATIC_DECOMPOSITION;
  int MaximumOrders;
  int Seed = 1;
  int ErrorBatches = 16;
  int PathCount = 0;
  bool Smoothing = true;
  int MemoryBudget = 0;
  std::string Device;

  /// Device limited by MemoryBudget; null if that is 0; outlives Kept, the cached medium.
  std::shared_ptr<tyndall::Device> Within;
  std::unique_ptr<tyndall::KeptMarcher> Kept;

  vtkIdType Deposits = 0;
  vtkIdType Steps = 0;
  vtkIdType Missed = 0;
  vtkIdType Scatterings = 0;
  double BalanceError = 0.0;
  double PackingLoss = 0.0;
  bool MediumKept = false;
  std::string DeviceName;
  std::vector<std::string> Ignored; ///< arrays of the medium that the last update ignored
};

#endif
