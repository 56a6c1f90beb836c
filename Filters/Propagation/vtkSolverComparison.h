#ifndef vtkSolverComparison_h
#define vtkSolverComparison_h

#include "PropertyRange.h"
#include "vtkPropagationAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>
#include <vector>

class vtkImageData;
class vtkTable;

namespace tyndall
{
struct Comparison;
struct ComparisonSettings;
}

/**
 * @class vtkSolverComparison
 * @brief error against run time: which solver at which setting is best for a scene
 *
 * Runs the chosen methods at several settings each on one scene, and compares their light with a reference: that of
 * input 3, or that of photons or a converged run of the best method (MonteCarloReference).
 *
 * Input 0, the medium: vtkImageData as vtkLightPropagationMaps and vtkPhotonMarcher read it: cell arrays `sigma_a`,
 * `sigma_s` (1 or 3 components, 1/length), optionally `emission` (W/(length^3 sr)), `ior` and `octree_level` (photons
 * only), or those chosen by SetInputArrayToProcess 0, 1, 2 and 3, and field data
 * `phase_function` and `g`, or cells `g`.
 * Input 1, optional: lights as vtkLightRig makes them. Input 2, optional: the environment, as vtkEnvironmentReader
 * makes it.
 * Input 3, optional: the reference, vtkImageData of the same box, its voxels as large as the medium's or a whole number
 * of times smaller or larger, with cell array `fluence`, or `fluence_direct` for photons, or both (W/length^2; as many
 * components as the light has). Where it is NaN nothing is compared. Light and reference are compared on the coarser
 * grid of both, by voxel means; light of a coarsened medium is taken to be constant in its voxels.
 *
 * Output 0: vtkTable `error_against_time`, a row a method and setting:
 *
 * | column | unit | meaning |
 * |---|---|---|
 * | `method` |  | its name |
 * | `setting` |  | in words |
 * | `quantity` |  | what is compared: `fluence`, or `fluence_direct` for photons, which do not follow scattered light |
 * | `grid` |  | voxels, as 64x64x64 |
 * | `seconds` | s | median of Repeats, from arrays to arrays, kernels compiled |
 * | `peak_bytes` | byte | most memory that was taken on the device at one time; NaN of a method on the host |
 * | `error_l2` | 1 | root of the sum of squared differences over voxels and channels, over that of the reference |
 * | `error_max` | 1 | largest difference in a voxel, over the largest fluence of the reference |
 * | `error_relative` | 1 | root of the mean square of voxels' own relative errors, where the reference is above 0 |
 * | `balance` | 1 | relative error of the energy balance |
 * | `iterations` | 1 | scattering orders or sweeps; 1 for photons |
 * | `estimated_error` | 1 | of `error_l2`, by the solver itself (if EstimateError); NaN where it is not known |
 * | `face_power_out` | W | 6 components: through -x, +x, -y, +y, -z, +z, channels summed |
 * | `power_in` | W | entered and emitted, channels summed |
 * | `pareto` | 1 | 1 where no other row of the same quantity is both faster and better |
 * | `error of METHOD` | 1 | `error_l2` of one method, NaN in rows of others: for charts |
 *
 * and field data `reference` (what it is), `left_out` (what was not compared, and why) and `device`.
 *
 * Output 1: the reference, vtkImageData with cell arrays `fluence` and `fluence_direct`, those that are known: to look
 * at, or to connect as input 3 of the next comparison of the same scene.
 *
 * The settings that are tried: of propagation, all Directions on all Coarsenings of the grid (those that do not divide
 * it are left out); MapResolutions above 1 where directions are 25 or more; limited Orders with the number of
 * Directions nearest to 25. Of photons, all PhotonCounts by Hammersley's sampler, and with AllSamplers the largest but
 * one by the others. Both lattices on all Coarsenings.
 *
 * With EstimateError (default on here) solvers estimate their own errors, by a run more whose time does not count.
 * Photons do not go round periodic axes; they are left out then.
 *
 * In a parallel pipeline every rank asks for all; the outputs are on the first.
 *
 * @sa vtkLightPropagationMaps vtkPhotonMarcher vtkPhotonReconstruction
 */
class TYNDALL_EXPORT vtkSolverComparison : public vtkPropagationAlgorithm
{
public:
  static vtkSolverComparison* New();
  vtkTypeMacro(vtkSolverComparison, vtkPropagationAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Number of the input port after those of vtkPropagationAlgorithm.
  static constexpr int REFERENCE = 3;
  /// Number of the output port of the reference.
  static constexpr int REFERENCE_OUTPUT = 1;

  vtkTable* GetOutput();

  ///@{
  /// The reference (vtkImageData) by connection or as data; null: a converged run.
  tyndallInputMacro(Reference, REFERENCE);
  ///@}

  ///@{
  /// Methods: light propagation maps as they are by default (default on); with a constant source and no acceleration
  /// (on); as published, on the device (on), and one ray after the other (off: slow); photons with reconstruction (on),
  /// with an importance map (off), and as published (off).
  tyndallFlagMacro(LightPropagationMaps);
  tyndallFlagMacro(ConstantSource);
  tyndallFlagMacro(AsPublished);
  tyndallFlagMacro(AsPublishedSequential);
  tyndallFlagMacro(DiscreteOrdinates);
  tyndallFlagMacro(Photons);
  tyndallFlagMacro(AdaptivePhotons);
  tyndallFlagMacro(PublishedPhotons);
  ///@}

  ///@{
  /// Whether photons that are scattered until they end are compared, by all light and without a filter: Monte Carlo,
  /// without bias, by the medium's own phase function and along bent rays. Default off. Where light is bent and there
  /// is no input 3, such photons make the reference then. Left out where the medium emits, axes are periodic or faces
  /// give back light.
  tyndallFlagMacro(MonteCarlo);
  ///@}

  ///@{
  /// Whether lattices of 18 and of 6 directions are compared, as vtkLatticeBoltzmannLighting solves them by default:
  /// diffusion. Default off. Left out where voxels are not cubes. Where light is bent the lattice is given the
  /// uncollided light of photons, of each of the numbers that are tried, and left out where Monte Carlo is.
  tyndallFlagMacro(LatticeBoltzmann);
  ///@}

  ///@{
  /// Whether, without input 3, photons that are scattered until they end make the reference also where light goes
  /// straight: sixteen sets of them or more. It shares no solver with the methods then, but has noise, of which field
  /// data `reference` gives the standard error. 0: never, but light propagation maps; 1: always, and an error where the
  /// medium emits, axes are periodic or faces give back light; 2, the default: where they can beat the methods
  /// compared, that is where within half of TimeBudget their standard error is forecast to be at most a third of what
  /// the finest maps that are tried are off by, or where maps take too long or do not fit; never where photons alone
  /// are compared. `reference` says what was chosen, and why.
  enum MonteCarloReferences
  {
    NEVER = 0,
    ALWAYS = 1,
    WHERE_IT_CAN_BEAT = 2
  };
  vtkSetMacro(MonteCarloReference, int);
  vtkGetMacro(MonteCarloReference, int);
  vtkBooleanMacro(MonteCarloReference, int);
  ///@}

  ///@{
  /// Directions per face that are tried. Default 4, 9, 25, 64, 100; valid square numbers.
  void AddDirections(int perFace);
  void RemoveAllDirections();
  ///@}
  ///@{
  /// Map resolutions that are tried. Default 1, 2; valid [1, 16].
  void AddMapResolution(int raysPerEdge);
  void RemoveAllMapResolutions();
  ///@}
  ///@{
  /// Edges of the voxels that are tried, in the medium's. Default 1, 2, 4; valid from 1 on.
  void AddCoarsening(int factor);
  void RemoveAllCoarsenings();
  ///@}
  ///@{
  /// Largest scattering orders that are tried besides all. Default 1, 3, 10; valid from 1 on.
  void AddOrders(int orders);
  void RemoveAllOrders();
  ///@}
  ///@{
  /// Numbers of photons that are tried. Default 10000, 100000, 1000000; valid from 1 on.
  void AddPhotonCount(int photons);
  void RemoveAllPhotonCounts();
  ///@}

  ///@{
  /// Whether photons are tried by all samplers. Default off.
  tyndallFlagMacro(AllSamplers);
  ///@}

  ///@{
  /// Runs whose median is the time, after one that does not count; fewer where TimeBudget does not allow them. Default
  /// 3, valid [1, 100].
  tyndallRangeMacro(Repeats, int, 1, 100);
  ///@}

  ///@{
  /// Seconds that all may take, without those in which kernels are compiled: half of it for a converged run, the rest
  /// shared by the methods. Runs that do not fit are not begun, or stopped; field data `left_out` names them. Default
  /// 300, valid above 0.
  tyndallRangeMacro(TimeBudget, double, tyndall::AboveZero, tyndall::AnyHigh);
  ///@}

  ///@{
  /// What came of the last update: what the reference is, seconds, the device's name, and what was not compared, one a
  /// line.
  vtkGetCharFromStdStringMacro(ReferenceText);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

protected:
  vtkSolverComparison();
  ~vtkSolverComparison() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSolverComparison(const vtkSolverComparison&) = delete;
  void operator=(const vtkSolverComparison&) = delete;

  tyndall::ComparisonSettings Settings() const;
  void TellOfIgnored(const tyndall::Comparison& comparison, vtkImageData* medium);
  void Note(const tyndall::Comparison& comparison, double seconds);

  bool LightPropagationMaps = true;
  bool ConstantSource = true;
  bool AsPublished = true;
  bool AsPublishedSequential = false;
  bool DiscreteOrdinates = false;
  bool LatticeBoltzmann = false;
  bool Photons = true;
  bool AdaptivePhotons = false;
  bool PublishedPhotons = false;
  bool MonteCarlo = false;
  std::vector<int> Directions;
  std::vector<int> MapResolutions;
  std::vector<int> Coarsenings;
  std::vector<int> Orders;
  std::vector<int> PhotonCounts;
  bool AllSamplers = false;
  int MonteCarloReference = WHERE_IT_CAN_BEAT;
  int Repeats;
  double TimeBudget;

  std::string ReferenceText;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
