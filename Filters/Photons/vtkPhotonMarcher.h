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
struct MarchSettings;
struct Photon;
struct PhotonLight;
struct RefractiveInput;
}

class vtkImageData;
class vtkMultiProcessController;

/**
 * @class vtkPhotonMarcher
 * @brief photons along bent rays through a medium: its light before it is scattered
 *
 * Paths follow d/ds(n dx/ds) = grad n, so that refraction and total reflection need no surfaces. Power falls along a
 * path by extinction, exactly; every voxel that a path crosses gains its power times its length in it, so that
 * `fluence` is an unbiased estimate in W/length^2 whatever the number of photons is. By default scattered light is not
 * followed: a viewer gathers single scattering from `fluence` and `mean_direction`, and vtkLightPropagationMaps takes
 * the light as UncollidedLight. With MaximumOrders photons go on through scattering after scattering.
 *
 * Input 0, the medium: vtkImageData with cell arrays `sigma_a`, `sigma_s` (1 or 3 components, 1/length) and optionally
 * `ior` (1 component; missing: constant) or those chosen by SetInputArrayToProcess 0, 1 and 3.
 * Input 1: photons as vtkPhotonEmitter makes them. Input 2, optional: an image of the same voxels with cell array
 * `octree_level`, as vtkRefractionOctree makes it; without it that array of the medium, if there is one.
 *
 * Output 0: the medium's image with cell arrays
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions, of light of up to MaximumOrders |
 * | `fluence_direct` | 1 or 3 | W/length^2 | its unscattered part |
 * | `fluence_error` | 1 or 3 | W/length^2 | standard error of `fluence`; of other orders than 1, with ErrorBatches |
 * | `mean_direction` | 3 | 1 | power-weighted mean direction; its length is the anisotropy |
 * | `photon_count` | 1 | 1 | photons that crossed the voxel, each once; with PhotonCounts |
 * | `photon_weight` | 1 | 1 | their mean `weight`, 0 where there is none; with PhotonCounts |
 * | `fluence_batches` | (1 or 3) x batches | W/length^2 | of each of several batches, as if it was all the light |
 *
 * the last three of the conservative scheme only, as vtkPhotonReconstruction wants them, and field data
 * `energy_balance` (W: entered, emitted, absorbed, escaped, left over; absorbed includes what is scattered),
 * `scattered` (W, for the first time), `face_power_out`, `left_out`, `device`; of other orders than 1 `scatterings` and
 * `exchanged` (W that Russian roulette gave less what it took; `absorbed` is then what the medium absorbed); of the
 * published scheme also `packing_loss` (see PackingLoss).
 * Output 1: vtkPolyData, the paths of PathCount photons as polylines, point data `power_left` (part of its power), cell
 * data `photon` (its number).
 *
 * The medium stays prepared on the device, so that new light or other photons only cost their march: until the medium
 * or the octree changes, another one is connected, a setting needs it, the device is another one, or the filter goes.
 * With BLOCKS it is prepared anew with every march.
 *
 * In a parallel pipeline every rank marches photons through its piece, and photons go from rank to rank; or, with
 * Decomposition, each marches all photons and hands on its piece. The paths are on the first rank, each in one piece.
 *
 * Cells that are hidden by `vtkGhostType` are empty.
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
    /// Explicit Euler, power per rasterised voxel, 64 bits per voxel by compare-and-swap, smoothed at the end.
    PUBLISHED = 0,
    /// Symplectic integrator, power times path, fixed point sums that lose nothing and repeat bit for bit.
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
  /// How to compute: PUBLISHED, or CONSERVATIVE (default).
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  enum Decompositions
  {
    AUTOMATIC_DECOMPOSITION = 0, ///< into blocks, of more than 64^3 voxels, where ranks can
    WHOLE = 1,                   ///< none: each rank marches all photons through the whole
    BLOCKS = 2                   ///< each rank has its piece of the medium
  };

  ///@{
  /// What each of several ranks of MPI holds. With WHOLE all of the medium and all photons. With BLOCKS its piece, and
  /// of the index some voxels round it, and its share of the photons: a photon that leaves the piece is handed on as it
  /// stands (numerics.md, section 12.6), scattered ones too, and light is that of one rank bit for bit, that of the
  /// published scheme but for what its packing loses, which is not the same twice on one rank either. Where ranks are
  /// given the same photons each takes a part of them, else all are those of rank 0, then of rank 1, and so on. An
  /// error names what blocks cannot do: an octree that lies on ranks in other pieces than the medium. What EmptySpace
  /// keeps by bricks they keep voxel by voxel.
  /// AUTOMATIC_DECOMPOSITION (default): BLOCKS where each of several ranks asks for its piece and the scene can be
  /// marched through so; else WHOLE, and also where EmptySpace asks for bricks, unless the whole, once for each rank of
  /// a machine, is more than the memory that it has available.
  tyndallRangeMacro(Decomposition, int, AUTOMATIC_DECOMPOSITION, BLOCKS);
  ///@}

  ///@{
  /// What arrays of points are: 0 (default): each is in the middle of a voxel of its value, so that n points are n
  /// voxels, the output has arrays of cells, and its bounds are half a spacing wider than the input's; 1: their mean is
  /// that of the voxel between them, and n points are n - 1 voxels. Where an array of cells is read as well, voxels are
  /// the cells and points are averaged; field data `settings_used` then say so.
  enum PointDataKinds
  {
    VOXELS_AROUND_POINTS = 0,
    AVERAGE_TO_CELLS = 1
  };
  tyndallPointDataMacro();
  ///@}

  ///@{
  /// Order of the conservative scheme's integrator: 1 (explicit Euler, to compare), 2 (leapfrog; default) or 4
  /// (Yoshida; where the index is smooth over several voxels; crosses 16 voxels of an octree's node in a step at most).
  tyndallRangeMacro(IntegratorOrder, int, 1, 4);
  ///@}

  ///@{
  /// Length of a step where the index varies and the octree has single voxels, in voxels. Default 1, valid [0.05, 1e4].
  tyndallRangeMacro(StepSize, double, 0.05, 1e4);
  ///@}

  ///@{
  /// Whether to count photons: `photon_count` and `photon_weight`, one more number per voxel in the same pass. Default
  /// off. The published scheme cannot: an error.
  tyndallFlagMacro(PhotonCounts);
  ///@}

  ///@{
  /// Orders of scattering that photons are followed through: 1 (default), to where they are first scattered, without
  /// randomness; m, through m - 1 scatterings; 0, until they are absorbed or have left. Valid [0, infinity). Scattered
  /// photons are an unbiased reference for every other solver: Monte Carlo along bent rays, by the medium's phase
  /// function. The published scheme has order 1 only: an error.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Of the random numbers by which photons are scattered: the same seed gives the same light, bit for bit. Default 1,
  /// valid [0, infinity).
  tyndallRangeMacro(Seed, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Batches of scattered photons whose differences make `fluence_error`: 2 to 64, default 16; 0: it is not wanted. Of
  /// other orders than 1, without PhotonCounts.
  tyndallRangeMacro(ErrorBatches, int, 0, 64);
  ///@}

  ///@{
  /// Whether to leave out what the scene does not need. Default on; off computes everything, for comparison: the same
  /// light, later. Of the conservative scheme.
  tyndallFlagMacro(LeaveOut);
  ///@}

  /// Where light in empty space is kept by bricks of 8^3 voxels.
  enum EmptySpaces
  {
    BY_VOXEL = 0, ///< nowhere
    AS_READ = 1,  ///< where the medium's field data `active_part` (vtkVDBReader) is at most 0.25
    BY_BRICK = 2  ///< wherever a medium is mostly empty
  };

  ///@{
  /// How light is kept in bricks of 8^3 voxels that hold no medium: voxel by voxel, or as the mean over the brick,
  /// which photons then cross in one stretch. By bricks takes a small part of the time and of the memory where a medium
  /// is mostly empty; in bricks that hold anything `fluence` is the same, to rounding. Applies where the index is
  /// constant and three quarters of the bricks are empty at least, of order 1 and the conservative scheme, without
  /// PhotonCounts and photons of several batches. Default AS_READ.
  tyndallRangeMacro(EmptySpace, int, BY_VOXEL, BY_BRICK);
  ///@}

  ///@{
  /// Number of photons, spread evenly over all, whose paths go to the second output. Default 0, valid [0, infinity).
  tyndallRangeMacro(PathCount, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether the published scheme ends with its 3x3x3 Gauss filter. Default on.
  tyndallFlagMacro(Smoothing);
  ///@}

  ///@{
  /// MiB of the device's memory that the filter may take, with what it keeps from update to update; what is needed
  /// beyond is one error that says how much. Default 0: what the device has. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  tyndallDeviceMacro();

  ///@{
  /// What came of the last update: stretches of path deposited to voxels, steps of the integrator, photons that miss
  /// the volume, relative error of the energy balance, whether the medium was still prepared, seconds, the device's
  /// name, and what the scene did not need, one per line.
  ///
  /// The conservative scheme's balance closes to rounding. That of the published scheme does not, even where packing
  /// loses nothing: it deposits a photon's power to a voxel however long the path in it is, so the extinction of its
  /// light is not what the photons lost. PackingLoss is apart from that: the part of the power deposited to voxels that
  /// their 64 bits did not keep (rounding, saturation, tries of compare-and-swap that ran out), before smoothing; 0 of
  /// the conservative scheme.
  vtkGetMacro(Deposits, vtkIdType);
  vtkGetMacro(Steps, vtkIdType);
  vtkGetMacro(Missed, vtkIdType);
  vtkGetMacro(Scatterings, vtkIdType); ///< that photons went through, of other orders than 1
  vtkGetMacro(BalanceError, double);
  vtkGetMacro(PackingLoss, double);
  vtkGetMacro(MediumKept, bool);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

  using Superclass::SetInputConnection;
  /// Another medium or octree: what was kept of the one before is given back.
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
  Marched March(vtkInformationVector** inputs, const std::vector<tyndall::Photon>& photons);
  void MarchAsPublished(tyndall::Device& device, const tyndall::Domain& domain, const tyndall::RefractiveInput& read,
    const std::vector<tyndall::Photon>& photons, Marched& marched);
  void MarchThrough(tyndall::PhotonMarcher& marcher, tyndall::Communicator& communicator,
    const std::vector<tyndall::Photon>& photons, Marched& marched);
  struct PieceOfMarch;
  bool WantsBlocks(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const;
  bool ReadPiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs,
    bool needsPieces, PieceOfMarch& piece);
  bool MarchPiece(vtkInformation* request, vtkMultiProcessController* ranks, vtkInformationVector** inputs,
    vtkInformationVector* outputs);
  void WarnOfBox(vtkInformationVector** inputs, const tyndall::Grid& medium);
  void Write(Marched&& marched, vtkImageData* medium, vtkImageData* output);
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

  std::shared_ptr<tyndall::Device> Within; ///< MemoryBudget, where there is one
  std::unique_ptr<tyndall::KeptMarcher> Kept;

  vtkIdType Deposits = 0;
  vtkIdType Steps = 0;
  vtkIdType Missed = 0;
  vtkIdType Scatterings = 0;
  double BalanceError = 0.0;
  double PackingLoss = 0.0;
  bool MediumKept = false;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
  std::vector<std::string> Ignored; ///< of the medium, in the last update
  bool IsFirstRank = true;          ///< the same: the rank that warns for all that march together
};

#endif
