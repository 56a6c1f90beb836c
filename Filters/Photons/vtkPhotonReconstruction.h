#ifndef vtkPhotonReconstruction_h
#define vtkPhotonReconstruction_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>

namespace tyndall
{
struct ReconstructedLight;
}

class vtkMultiProcessController;

/**
 * @class vtkPhotonReconstruction
 * @brief smooth light of the noisy light that photons left, voxel by voxel as coarse as the noise asks for
 *
 * Pyramids of the light, each level of half the resolution of the one below it. Every voxel takes its light from the
 * level that Scheme chooses; a level without photons is never chosen while a coarser one has some.
 *
 * Input: vtkImageData as vtkPhotonMarcher makes it, with cell arrays (point arrays: see SetPointData)
 *
 * | array | components | unit | meaning | needed by Scheme |
 * |---|---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | noisy light that was not scattered | all |
 * | `mean_direction` | 3 | 1 | power-weighted mean direction; optional |  |
 * | `photon_count` | 1 | 1 | photons in the voxel (PhotonCounts of the marcher) | 0, 3 |
 * | `photon_weight` | 1 | 1 | their mean weight (PhotonCounts) | 0 |
 * | `fluence_batches` | (1 or 3) x batches | W/length^2 | light by each batch alone (Batches: at least 2) | 1 |
 *
 * or those chosen by SetInputArrayToProcess 0 to 4.
 *
 * Output: the input with `fluence`, `fluence_direct` (the same) and `mean_direction` replaced by smooth ones, without
 * `fluence_batches`, and with
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `mip_level` | 1 | 1 | level that the light was taken from, 0 the voxels themselves; between two where blended |
 * | `fluence_error` | 1 or 3 | W/length^2 | standard error of fluence, of the conservative scheme |
 *
 * and field data `fluence_bias` (by which part the light of all voxels together was off before it was conserved);
 * `left_out` gains what was not needed here, `device` is the one that computed. In a parallel pipeline every rank
 * smooths its piece, and the light is that of the whole, to rounding.
 *
 * Cells that are hidden by `vtkGhostType` are empty.
 *
 * @sa vtkPhotonMarcher vtkPhotonEmitter vtkPhotonImportance vtkMediumRayCaster
 * @par Thanks
 * M. Pfeuti, Real-time Rendering of Refractive Objects in Participating Media, 2009, sections 3.2.4 and 4.2.
 */
class TYNDALL_EXPORT vtkPhotonReconstruction : public vtkImageAlgorithm
{
public:
  static vtkPhotonReconstruction* New();
  vtkTypeMacro(vtkPhotonReconstruction, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Schemes
  {
    PUBLISHED = 0,       ///< the lower of the levels by centre-surround differences and by photon weight
    CONSERVATIVE = 1,    ///< each level's detail is kept as far as independent batches agree on it; tells its error
    CONSTANT_RADIUS = 2, ///< Level everywhere
    NEAREST_PHOTONS = 3  ///< the lowest level that holds NearestPhotons
  };

  enum Conservation
  {
    NEVER = 0,
    ALWAYS = 1,
    BY_SCHEME = 2 ///< of the conservative scheme, not of the others: they are there to compare with what was published
  };

  ///@{
  /// How the level is chosen: PUBLISHED, CONSERVATIVE (default), CONSTANT_RADIUS or NEAREST_PHOTONS.
  tyndallRangeMacro(Scheme, int, PUBLISHED, NEAREST_PHOTONS);
  ///@}

  ///@{
  /// Levels of the pyramid above the voxels, at most; no more than the grid has are made. Default 5, valid [1, 8].
  tyndallRangeMacro(Levels, int, 1, 8);
  ///@}

  ///@{
  /// Published scheme: weight of photons from a level to the next. Default 0: the mean weight of lit voxels; valid
  /// [0, infinity).
  tyndallRangeMacro(WeightStep, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Constant radius: the level. Default 1, valid [0, 8].
  tyndallRangeMacro(Level, int, 0, 8);
  ///@}

  ///@{
  /// Nearest photons: how many. Default 20, valid [1, infinity).
  tyndallRangeMacro(NearestPhotons, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether the light is scaled such that that of all voxels together is what it was: NEVER, ALWAYS, or BY_SCHEME
  /// (default).
  tyndallRangeMacro(ConserveFluence, int, NEVER, BY_SCHEME);
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

  tyndallDeviceMacro();

  ///@{
  /// What came of the last update: `fluence_bias`; of the conservative scheme the root of the mean square of
  /// `fluence_error` over that of `fluence` (0 of the others); seconds, the device's name, and what was not needed
  /// here, one per line.
  vtkGetMacro(Bias, double);
  vtkGetMacro(MeanError, double);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

protected:
  vtkPhotonReconstruction();
  ~vtkPhotonReconstruction() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkPhotonReconstruction(const vtkPhotonReconstruction&) = delete;
  void operator=(const vtkPhotonReconstruction&) = delete;

  bool ReconstructPiece(vtkInformation* request, vtkMultiProcessController* ranks, vtkInformationVector** inputs,
    vtkInformationVector* outputs);
  void Note(const tyndall::ReconstructedLight& light, double squares, double ofErrors);

  int Scheme = CONSERVATIVE;
  int PointData = VOXELS_AROUND_POINTS;
  int Levels;
  double WeightStep;
  int Level;
  int NearestPhotons;
  int ConserveFluence = BY_SCHEME;
  std::string Device;

  double Bias = 0.0;
  double MeanError = 0.0;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
