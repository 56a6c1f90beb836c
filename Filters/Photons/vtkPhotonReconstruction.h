#ifndef vtkPhotonReconstruction_h
#define vtkPhotonReconstruction_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>

namespace tyndall
{
class PieceBlocks;
struct ReconstructedLight;
}

class vtkImageData;

/**
 * @class vtkPhotonReconstruction
 * @brief smooths the noisy fluence of marched photons, with a resolution adapted to the noise in each voxel
 *
 * Builds a resolution pyramid of the fluence: each level has half the resolution of the level below. The fluence of
 * every voxel is interpolated from the level that Scheme chooses; a level without photons is never chosen if a coarser
 * level has photons.
 *
 * Input: vtkImageData as vtkPhotonMarcher makes it, with cell arrays (point arrays: see SetPointData)
 *
 * | array | components | unit | meaning | needed by Scheme |
 * |---|---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | noisy fluence | all |
 * | `mean_direction` | 3 | 1 | power-weighted mean direction; optional |  |
 * | `photon_count` | 1 | 1 | photons in the voxel (PhotonCounts of the marcher) | 0, 3 |
 * | `photon_weight` | 1 | 1 | mean weight of these photons (PhotonCounts) | 0 |
 * | `fluence_batches` | (1 or 3) x batches | W/length^2 | fluence of each of 2 or more Batches (vtkPhotonEmitter) | 1 |
 *
 * or the arrays chosen by SetInputArrayToProcess 0 to 4.
 *
 * Output: the input without `fluence_batches`, with `fluence` and `mean_direction` replaced by smooth arrays, and
 * `fluence_direct` by the smooth `fluence` unless photons were scattered; and with the cell arrays
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `mip_level` | 1 | 1 | pyramid level used, 0 for single voxels; fractional if two levels are blended |
 * | `fluence_error` | 1 or 3 | W/length^2 | standard error of fluence, by the conservative scheme |
 *
 * and field data `fluence_bias` (relative change of the sum of fluence over all voxels by smoothing, before
 * ConserveFluence restores the sum); the filter appends to `left_out` the computations that it skipped, and replaces
 * `device` by the device that it ran on. In a parallel pipeline every rank smooths its piece, and the result is that of
 * a serial run, to rounding.
 *
 * Cells that `vtkGhostType` marks as hidden are empty.
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
    PUBLISHED = 0, ///< the lower of two pyramid levels: one by centre-surround differences, one by photon weight
    /// Weights the detail of each pyramid level by how well the photon batches agree on it; estimates the error.
    CONSERVATIVE = 1,
    CONSTANT_RADIUS = 2, ///< pyramid level Level in all voxels
    NEAREST_PHOTONS = 3  ///< the lowest pyramid level whose cell contains at least NearestPhotons photons
  };

  enum Conservation
  {
    NEVER = 0,
    ALWAYS = 1,
    BY_SCHEME = 2 ///< fluence is scaled with Scheme CONSERVATIVE; other schemes are for comparison with publications
  };

  ///@{
  /// Method of choosing the pyramid level in each voxel: PUBLISHED, CONSERVATIVE (default), CONSTANT_RADIUS or
  /// NEAREST_PHOTONS.
  tyndallRangeMacro(Scheme, int, PUBLISHED, NEAREST_PHOTONS);
  ///@}

  ///@{
  /// Largest number of pyramid levels above the voxels; the size of the grid may allow fewer. Default 5, valid [1, 8].
  tyndallRangeMacro(Levels, int, 1, 8);
  ///@}

  ///@{
  /// With Scheme PUBLISHED: photon weight per pyramid level, dimensionless. The level of a voxel is at most its mean
  /// photon weight divided by WeightStep. Default 0: 0.999 times the mean weight of lit voxels; valid [0, infinity).
  tyndallRangeMacro(WeightStep, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// With Scheme CONSTANT_RADIUS: the pyramid level of all voxels. Default 1, valid [0, 8].
  tyndallRangeMacro(Level, int, 0, 8);
  ///@}

  ///@{
  /// With Scheme NEAREST_PHOTONS: number of photons that the cell of the chosen level must contain. Default 20, valid
  /// [1, infinity).
  tyndallRangeMacro(NearestPhotons, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether fluence is scaled such that its sum over all voxels is conserved: NEVER, ALWAYS, or BY_SCHEME (default).
  tyndallRangeMacro(ConserveFluence, int, NEVER, BY_SCHEME);
  ///@}

  ///@{
  /// With Scheme CONSERVATIVE: whether light that has the same colour everywhere is smoothed once for its three
  /// channels. Default on; off: for comparison, with the same light in more time.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// How point arrays are read. 0 (default): each point is the centre of a voxel with its value: n points make n
  /// voxels, the output has cell arrays, and its bounds are half a spacing wider than the input's. 1: points are
  /// averaged to the voxels between them: n points make n - 1 voxels. If a cell array is read as well, the cells are
  /// the voxels and points are averaged; field data `settings_used` then report it.
  tyndallPointDataMacro();
  ///@}

  tyndallDeviceMacro();

  ///@{
  /// Results of the last update: `fluence_bias`; for the conservative scheme the ratio of the root mean squares of
  /// `fluence_error` and `fluence` (0 for other schemes); run time in seconds, the device's name, and the computations
  /// that were not needed, one per line.
  vtkGetMacro(Bias, double);
  vtkGetMacro(MeanError, double);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
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

  void Reconstruct(const tyndall::PieceBlocks& pieces, vtkImageData* image, vtkImageData* output);
  void Note(const tyndall::ReconstructedLight& light, double squares, double ofErrors);

  int Scheme = CONSERVATIVE;
  int PointData = VOXELS_AROUND_POINTS;
  int Levels;
  double WeightStep;
  int Level;
  int NearestPhotons;
  bool LeaveOut;
  int ConserveFluence = BY_SCHEME;
  std::string Device;

  double Bias = 0.0;
  double MeanError = 0.0;
  std::string DeviceName;
};

#endif
