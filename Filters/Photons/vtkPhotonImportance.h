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
class PieceBlocks;
struct Illumination;
struct Importance;
}

/**
 * @class vtkPhotonImportance
 * @brief importance map for photon emission, computed with a few pilot photons
 *
 * Pilot photons on a jittered grid of each light's photon plane are marched through the medium and accumulated in
 * coarse cells. Dark cells, and cells with a steep gradient of fluence, are chosen. Each chosen cell is splatted into
 * the map as a circle about the mean origin of its photons, with the origins' standard deviation as radius; a 5x5 Gauss
 * filter smooths the map, and a constant background is added. vtkPhotonEmitter emits photons with this density.
 *
 * If the light is even, a map does not reduce the noise: `even` is then 1, and vtkPhotonEmitter distributes its photons
 * evenly.
 *
 * Input 0, the medium: vtkImageData with cell arrays `sigma_a`, `sigma_s` (1 or 3 components, 1/length) and optionally
 * `ior` (1 component; missing: constant), or the arrays chosen by SetInputArrayToProcess 0, 1 and 3, and optionally
 * `octree_level`, as vtkPhotonMarcher reads them. Input 1, optional: lights as vtkLightRig makes them. Input 2,
 * optional: the environment, as vtkEnvironmentReader makes it. vtkPhotonEmitter needs the same inputs.
 *
 * Output 0, the map: vtkImageData of n x n x lights cells over the unit square, n the root of PilotCount, cell array
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `importance` | 1 | 1 | probability density of the photons' start points on the photon plane, mean 1 per light |
 *
 * and field data `light` (number of the light of each layer; -1: the environment or SkyColor) and `even` (1: photons
 * should be evenly distributed).
 * Output 1, the pilot light: vtkImageData of the coarse cells over the medium's box, cell arrays
 *
 * | array              | components | unit       | meaning                                                      |
 * |--------------------|------------|------------|--------------------------------------------------------------|
 * | `fluence`          | 1 or 3     | W/length^2 | mean fluence of the pilot photons in the cell                |
 * | `photon_count`     | 1          | 1          | pilot photons that crossed the cell                          |
 * | `origin_mean` | 2 | map cells | mean column and row of the origins of the cell's photons |
 * | `origin_deviation` | 2 | map cells | standard deviation of the origins of the cell's photons |
 * | `gradient`         | 1          | W/length^2 | gradient of `fluence`, per cell                              |
 * | `chosen` | 1 | 1 | 1 if the map is to send more photons to the cell, else 0 |
 *
 * Both outputs have field data `left_out` (computations that the scene did not need) and `device`. Without lights,
 * environment and SkyColor both outputs are empty, with a warning. In a parallel pipeline each rank has its piece of
 * the medium, and pilot photons continue from rank to rank; each rank computes the complete map and returns the
 * requested piece.
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
    OWN = 0,      ///< cells are chosen by GradientThreshold and LuminanceThreshold, as published
    AUTOMATIC = 1 ///< both thresholds follow from statistics of the pilot light and scale with it
  };

  ///@{
  /// Number of pilot photons per light, rounded down to a square number. Default 1024, valid [1, 2^20]; a smaller value
  /// is an error, a larger one counts as 2^20.
  tyndallRangeMacro(PilotCount, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of coarse cells along x, y and z. Default (16, 16, 16), valid from 1 on; at most the medium's numbers of
  /// voxels are used.
  tyndallSetRange3Macro(PilotDimensions, int, 1, VTK_INT_MAX);
  vtkGetVector3Macro(PilotDimensions, int);
  ///@}

  ///@{
  /// Thresholds by which the filter chooses coarse cells that receive more photons: OWN or AUTOMATIC (default).
  tyndallRangeMacro(Thresholds, int, OWN, AUTOMATIC);
  ///@}

  ///@{
  /// Thresholds that apply if Thresholds is OWN, W/length^2: a coarse cell receives more photons if its `gradient` is
  /// at least GradientThreshold, or if it is lit and its `fluence` is at most LuminanceThreshold. Default of both 0,
  /// valid [0, infinity).
  tyndallRangeMacro(GradientThreshold, double, 0.0, tyndall::AnyHigh);
  tyndallRangeMacro(LuminanceThreshold, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Fraction of the photons that is evenly distributed, independent of the chosen cells. Default 0.3, valid (0, 1].
  tyndallRangeMacro(Background, double, tyndall::AboveZero, 1.0);
  ///@}

  ///@{
  /// Seed of the random numbers: the same seed reproduces the same pilot photons. Default 0, valid [0, infinity).
  tyndallRangeMacro(Seed, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Isotropic incident radiance, red, green, blue, added to the environment, W/(length^2 sr). Default 0, valid [0,
  /// infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// Whether pilot photons skip what the medium does not need; LeftOut lists it. Default on; off: for comparison, with
  /// the same map in more time.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// Device memory that the filter may use, MiB, including memory that it keeps between updates; a scene that needs
  /// more is an error, which states the required memory. Default 0: all memory of the device. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Results of the last update: whether the light varies so little that a map would not reduce the noise; the
  /// thresholds used (W/length^2), run time in seconds, the device's name, and the computations that the scene did not
  /// need, one per line.
  vtkGetMacro(Even, bool);
  vtkGetMacro(UsedGradientThreshold, double);
  vtkGetMacro(UsedLuminanceThreshold, double);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
  ///@}

  using Superclass::SetInputConnection;
  /// Connects an input. A new medium also frees the cached marcher of the previous medium.
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

  tyndall::Importance Find(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs);
  std::optional<tyndall::Illumination> ReadLight(vtkInformationVector** inputs);
  void Write(vtkInformationVector* outputs, tyndall::Importance&& importance);
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

  bool LeaveOut = true;
  int MemoryBudget = 0;

  /// Device limited by MemoryBudget; null if that is 0; outlives Kept, the cached medium.
  std::shared_ptr<tyndall::Device> Within;
  std::unique_ptr<tyndall::KeptMarcher> Kept;

  bool Even = false;
  double UsedGradientThreshold = 0.0;
  double UsedLuminanceThreshold = 0.0;
  std::string DeviceName;
};

#endif
