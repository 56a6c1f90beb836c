#ifndef vtkPhotonImportance_h
#define vtkPhotonImportance_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <memory>
#include <optional>
#include <string>

namespace tyndall
{
class Device;
class KeptMarcher;
struct Illumination;
struct Importance;
}

class vtkMultiProcessController;

/**
 * @class vtkPhotonImportance
 * @brief where photons are needed: an importance map, found by few pilot photons
 *
 * Pilot photons on a jittered grid of each light's photon plane are marched through the medium and gathered in coarse
 * cells. Cells where the light changes steeply from one to the next, and dark ones, are chosen; each is splatted into
 * the map as a circle about the mean origin of its photons, as wide as they deviate from it; a 5x5 Gauss filter smooths
 * the map, and a background is added. vtkPhotonEmitter makes photons as dense as it says.
 *
 * Where the light is even nothing is gained: `even` is 1, and vtkPhotonEmitter spreads its photons evenly.
 *
 * Input 0, the medium: vtkImageData with cell arrays `sigma_a`, `sigma_s` (1 or 3 components, 1/length) and optionally
 * `ior` (1 component; missing: constant), or those chosen by SetInputArrayToProcess 0, 1 and 3, and optionally
 * `octree_level`, as vtkPhotonMarcher reads them. Input 1, optional: lights as vtkLightRig makes them. Input 2,
 * optional: the environment, as vtkEnvironmentReader makes it. Give vtkPhotonEmitter the same.
 *
 * Output 0, the map: vtkImageData of n x n x lights cells over the unit square, n the root of PilotCount, cell array
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `importance` | 1 | 1 | probability density of the photons' starting places on the photon plane, mean 1 per light |
 *
 * and field data `light` (number of the light of each layer; -1: the environment or SkyColor) and `even`.
 * Output 1, the pilot light: vtkImageData of the coarse cells over the medium's box, cell arrays
 *
 * | array              | components | unit       | meaning                                                      |
 * |--------------------|------------|------------|--------------------------------------------------------------|
 * | `fluence`          | 1 or 3     | W/length^2 | mean over the cell                                           |
 * | `photon_count`     | 1          | 1          | pilot photons that crossed the cell                          |
 * | `origin_mean`      | 2          | map cells  | mean column and row that they set out from                   |
 * | `origin_deviation` | 2          | map cells  | standard deviation of those                                  |
 * | `gradient`         | 1          | W/length^2 | steepness of the light, from a cell to the next              |
 * | `chosen`           | 1          | 1          | 1 where photons are to be dense                              |
 *
 * Both have field data `left_out` (what the scene did not need) and `device`. Without lights, environment and SkyColor
 * both are empty, with a warning. In a parallel pipeline pilot photons go from rank to rank, each of
 * which has its piece of the medium, finds the whole map and hands on its piece of that.
 *
 * @sa vtkPhotonEmitter vtkPhotonMarcher vtkPhotonReconstruction
 * @par Thanks
 * M. Pfeuti, Real-time Rendering of Refractive Objects in Participating Media, 2009, sections 3.2.1 and 3.2.2.
 */
class TYNDALL_EXPORT vtkPhotonImportance : public vtkLitMediumAlgorithm
{
public:
  static vtkPhotonImportance* New();
  vtkTypeMacro(vtkPhotonImportance, vtkLitMediumAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  tyndallDeviceMacro();

  enum ThresholdKinds
  {
    OWN = 0,      ///< GradientThreshold and LuminanceThreshold, as published
    AUTOMATIC = 1 ///< from the pilot photons' own statistics, in proportion to the light
  };

  ///@{
  /// Pilot photons of each light; the largest square number that is not above it is made. Default 1024, valid [1,
  /// 2^20]; below it is an error.
  tyndallRangeMacro(PilotCount, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Coarse cells along each axis. Default 16 each, valid from 1 on; more than the medium has voxels are cut to those.
  tyndallSetRange3Macro(PilotDimensions, int, 1, VTK_INT_MAX);
  vtkGetVector3Macro(PilotDimensions, int);
  ///@}

  ///@{
  /// Where the thresholds come from: OWN or AUTOMATIC (default).
  tyndallRangeMacro(Thresholds, int, OWN, AUTOMATIC);
  ///@}

  ///@{
  /// With own thresholds: cells whose light changes by this or more to the next are chosen, and lit cells of this light
  /// or less. W/length^2, default 0, valid [0, infinity).
  tyndallRangeMacro(GradientThreshold, double, 0.0, tyndall::AnyHigh);
  tyndallRangeMacro(LuminanceThreshold, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Part of the photons that are spread evenly all the same. Default 0.3, valid (0, 1].
  tyndallRangeMacro(Background, double, tyndall::AboveZero, 1.0);
  ///@}

  ///@{
  /// Another seed gives other pilot photons, the same seed the same ones. Default 0.
  tyndallRangeMacro(Seed, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Radiance from every direction alike, red, green, blue, added to the environment, W/(length^2 sr). Default 0, valid
  /// [0, infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// MiB of the device's memory that the filter may take, with what it keeps from update to update; what is needed
  /// beyond is one error that says how much. Default 0: what the device has. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// What came of the last update: whether the light is even, the thresholds that were used (W/length^2), seconds, the
  /// device's name, and what the scene did not need, one per line.
  vtkGetMacro(Even, bool);
  vtkGetMacro(UsedGradientThreshold, double);
  vtkGetMacro(UsedLuminanceThreshold, double);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

  using Superclass::SetInputConnection;
  /// Another medium: what was kept of the one before is given back.
  void SetInputConnection(int port, vtkAlgorithmOutput* input) override;

protected:
  vtkPhotonImportance();
  ~vtkPhotonImportance() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkPhotonImportance(const vtkPhotonImportance&) = delete;
  void operator=(const vtkPhotonImportance&) = delete;

  /// Reads the inputs and does the work.
  /// @return device and result; nothing where nothing shines
  tyndall::Importance Find(vtkInformationVector** inputs);
  std::optional<tyndall::Importance> FindInPieces(vtkMultiProcessController* ranks, vtkInformationVector** inputs);
  std::optional<tyndall::Illumination> ReadLight(vtkInformationVector** inputs);
  void Write(vtkInformation* request, vtkInformationVector* outputs, tyndall::Importance&& importance);
  void Note(const tyndall::Importance& importance);

  std::string Device;
  int PilotCount;
  int PilotDimensions[3];
  int Thresholds = AUTOMATIC;
  double GradientThreshold;
  double LuminanceThreshold;
  double Background;
  int Seed = 0;
  double SkyColor[3] = { 0.0, 0.0, 0.0 };

  int MemoryBudget = 0;

  std::shared_ptr<tyndall::Device> Within; ///< MemoryBudget, where there is one; stays longer than what is kept on it
  std::unique_ptr<tyndall::KeptMarcher> Kept;

  bool Even = false;
  double UsedGradientThreshold = 0.0;
  double UsedLuminanceThreshold = 0.0;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
