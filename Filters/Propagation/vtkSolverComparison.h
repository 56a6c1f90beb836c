#ifndef vtkSolverComparison_h
#define vtkSolverComparison_h

#include "PropertyRange.h"
#include "vtkPropagationAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <memory>
#include <string>

class vtkImageData;
class vtkTable;

namespace tyndall
{
struct ComparedScene;
struct ComparedSettings;
struct Comparison;
struct ComparisonSettings;
}

/**
 * @class vtkSolverComparison
 * @brief compares error and run time of solvers and their settings for a scene
 *
 * Runs the chosen methods, each with several settings, on one scene, and compares their light with a reference: input
 * 3, or a Monte Carlo run, or a converged run of the best method (MonteCarloReference).
 *
 * Input 0, the medium: vtkImageData as vtkLightPropagationMaps and vtkPhotonMarcher read it: cell arrays `sigma_a`,
 * `sigma_s` (1 or 3 components, 1/length), optionally `emission` (W/(length^3 sr)), `ior` and `octree_level` (photons
 * only), or the arrays chosen by SetInputArrayToProcess 0, 1, 2 and 3, and field data `phase_function` and `g`, or
 * cells `g`.
 * Input 1, optional: lights as vtkLightRig makes them. Input 2, optional: the environment, as vtkEnvironmentReader
 * makes it.
 * Input 3, optional: the reference, vtkImageData of the same box, its voxels as large as the medium's or a whole number
 * of times smaller or larger, with cell array `fluence`, or `fluence_direct` for photons, or both (W/length^2; as many
 * components as the light has). Voxels where it is NaN are not compared. Light and reference are compared on the
 * coarser of their two grids, by voxel means; light of a coarsened medium is taken as constant in each voxel.
 * Input 4, optional: the closed mesh (vtkPolyData) from which vtkMeshVoxelizer made the medium, which then needs its
 * cell array `occupancy`: the mesh is voxelised with all SupersamplingFactors and FilterSizes, and photons march
 * through each. Without input 3 the reference is then of photons in the mesh, voxelised with a quarter (above 2^18
 * voxels: half) of the voxel edge and supersampling 16.
 *
 * Output 0: vtkTable `error_against_time`, one row per method and setting:
 *
 * | column | unit | meaning |
 * |---|---|---|
 * | `method` |  | name of the method |
 * | `setting` |  | settings of the method, as text |
 * | `quantity` |  | `fluence`; `fluence_direct`: photons without scattered light; `radiance`: pictures |
 * | `grid` | | size in voxels, for example 64x64x64; of pictures in pixels |
 * | `seconds` | s | least of Repeats runs, from input arrays to output arrays, without compilation of kernels |
 * | `core_seconds` | s | least processor time of the process in these runs, all threads summed; NaN on a GPU |
 * | `peak_bytes` | byte | peak device memory; NaN for a method on the host |
 * | `error_l2` | 1 | 2-norm of the difference over voxels and channels, divided by the 2-norm of the reference |
 * | `error_max` | 1 | largest difference in a voxel, divided by the largest fluence of the reference |
 * | `error_relative` | 1 | root mean square of the voxels' relative errors, where the reference is above 0 |
 * | `balance` | 1 | relative error of the energy balance |
 * | `iterations` | 1 | scattering orders or sweeps; 1 for photons |
 * | `estimated_error` | 1 | estimate of `error_l2` by the solver (if EstimateError); NaN if unknown |
 * | `face_power_out` | W | escaped power, 6 components: through -x, +x, -y, +y, -z, +z, channels summed |
 * | `power_in` | W | incident and emitted power, channels summed |
 * | `pareto` | 1 | 1 if no other row of the same quantity is both faster and more accurate, else 0 |
 * | `recommended` | 1 | 1 for the recommended row of each quantity, of those with `filters`, see AcceptedError |
 * | `filters` |  | filters that repeat the row, "Filter Property=Value ... \| Filter ..."; empty if none can |
 * | `error of METHOD` | 1 | `error_l2` of METHOD, NaN in other methods' rows: for charts |
 *
 * and field data `reference` (a description), `recommended` (the recommended row in words), `left_out` (methods and
 * settings that were not compared, with reasons) and `device`. "#1" in `filters` is the output of the first filter,
 * "@Mesh" what is connected to the input Mesh, and all inputs and properties that are not listed are those of the
 * comparison. No filters repeat rows of coarser voxels, nor rows of photons lit by FaceRadiance or the default sky.
 *
 * Output 1: the reference, vtkImageData with the cell arrays `fluence` and `fluence_direct`, as far as they are known,
 * for viewing or as input 3 of another comparison of the same scene.
 *
 * The settings that are tried are, for propagation: all Directions on all Coarsenings of the grid (those that do not
 * divide its size are skipped); MapResolutions above 1 with 25 or more directions; limited Orders with the number of
 * Directions nearest to 25. For photons: all PhotonCounts with the Hammersley sampler, and with AllSamplers the second
 * largest count with the other samplers. The lattices of 18 and of 6 directions are tried on all Coarsenings. Terms are
 * tried for discrete ordinates with the number of Directions nearest to 25. Where light is refracted, the second
 * largest PhotonCount is tried with all IntegratorOrders and StepSizes, and with octrees of all OctreeTolerances, whose
 * construction is part of the time.
 *
 * With EstimateError (default on here) solvers, photons of MonteCarlo and pictures estimate their errors, by an
 * additional run that is not timed. Photons do not support periodic axes and are skipped if there are any.
 *
 * In a parallel pipeline the first rank runs the comparison and returns output 0; each rank returns its piece of output
 * 1.
 *
 * @sa vtkLightPropagationMaps vtkPhotonMarcher vtkPhotonReconstruction
 */
class TYNDALL_EXPORT vtkSolverComparison : public vtkPropagationAlgorithm
{
public:
  static vtkSolverComparison* New();
  vtkTypeMacro(vtkSolverComparison, vtkPropagationAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Input port of the reference; lower numbers are the ports of vtkLitMediumAlgorithm.
  static constexpr int REFERENCE = 3;
  static constexpr int MESH = 4; ///< input port of the mesh
  /// Output port of the reference, a vtkImageData.
  static constexpr int REFERENCE_OUTPUT = 1;

  vtkTable* GetOutput();

  ///@{
  /// Reference (vtkImageData) by connection or as data; null: the filter computes the reference, by a converged solve
  /// or by Monte Carlo (MonteCarloReference).
  tyndallInputMacro(Reference, REFERENCE);
  ///@}

  ///@{
  /// Mesh (vtkPolyData) by connection or as data; null: no voxelisations are compared.
  tyndallInputMacro(Mesh, MESH);
  ///@}

  ///@{
  /// Methods that are compared, each with its default in parentheses. Light propagation maps: with default settings
  /// (on), with a constant source and no acceleration (on), as published on the device (on), as published sequentially
  /// on the host (off: slow). Discrete ordinates (off). Photons: with reconstruction (on), with an importance map
  /// (off), as published (off).
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
  /// Whether Monte Carlo is compared: photons that are scattered until they are absorbed or leave, by the medium's
  /// phase function and along bent rays, an unbiased and unfiltered estimate of fluence. Default off. If light is
  /// refracted and there is no input 3, the reference is then also computed by Monte Carlo. Skipped if the medium
  /// emits, axes are periodic or faces reflect light.
  tyndallFlagMacro(MonteCarlo);
  ///@}

  ///@{
  /// Whether diffusion on lattices of 18 and of 6 directions is compared, solved by vtkLatticeBoltzmannLighting with
  /// its default settings. Default off. Skipped if voxels are not cubes. If light is refracted, photons compute the
  /// uncollided light of the lattice, for each PhotonCount, and the lattice is skipped in the same cases as
  /// MonteCarlo.
  tyndallFlagMacro(LatticeBoltzmann);
  ///@}

  ///@{
  /// Whether a chain of two methods is compared: photons along bent rays compute the uncollided light, for each
  /// PhotonCount, and light propagation maps scatter it, along straight rays. Default off. Skipped in the same cases
  /// as MonteCarlo.
  tyndallFlagMacro(PhotonsThenMaps);
  ///@}

  ///@{
  /// Whether the preview of light propagation maps is compared (vtkLightPropagationMaps, Preview). Default off.
  tyndallFlagMacro(Previews);
  ///@}

  ///@{
  /// Whether pictures of the reference light at each Quality of vtkMediumRayCaster are compared with a picture at half
  /// the step size of Quality REFERENCE. Default off. They need the camera (tyndallCameraMacro), whose position must
  /// differ from its focal point. Defaults: position and focal point (0, 0, 0), CameraViewUp (0, 0, 1), CameraViewAngle
  /// 30, ImageSize 320 x 240.
  tyndallFlagMacro(Pictures);
  tyndallCameraMacro();
  ///@}

  ///@{
  /// Whether, without input 3, the reference is a Monte Carlo run (sixteen or more sets of photons) also if light
  /// travels in straight lines. Such a reference shares no solver with the compared methods, but has noise; field data
  /// `reference` reports its standard error. 0: never, the reference is light propagation maps. 1: always; it is an
  /// error if the medium emits, axes are periodic or faces reflect light. 2 (default): if the predicted standard error
  /// of Monte Carlo after half of TimeBudget is at most a third of the error of the finest light propagation maps that
  /// are tried, or if those take too long or do not fit in memory; never if only photons are compared. Field data
  /// `reference` reports the choice and its reason.
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
  /// Adds to the list of numbers of directions per face that are tried. Default 4, 9, 25, 64, 100; valid square
  /// numbers.
  void AddDirections(int perFace);
  void RemoveAllDirections();
  ///@}
  ///@{
  /// Adds to the list of map resolutions that are tried: rays of each direction per voxel edge. Default 1, 2; valid [1,
  /// 16].
  void AddMapResolution(int raysPerEdge);
  void RemoveAllMapResolutions();
  ///@}
  ///@{
  /// Adds to the list of voxel edges that are tried, as multiples of the edges of the medium's voxels. Default 1, 2, 4;
  /// valid from 1 on.
  void AddCoarsening(int factor);
  void RemoveAllCoarsenings();
  ///@}
  ///@{
  /// Adds to the list of limits on the number of scattering orders that are tried, in addition to no limit. Default 1,
  /// 3, 10; valid from 1 on.
  void AddOrders(int orders);
  void RemoveAllOrders();
  ///@}
  ///@{
  /// Adds to the list of numbers of photons that are tried. Default 10000, 100000, 1000000; valid from 1 on.
  void AddPhotonCount(int photons);
  void RemoveAllPhotonCounts();
  ///@}

  ///@{
  /// Adds to the list of numbers of terms of the phase function that discrete ordinates try. Default none; valid 1 to
  /// the number of directions.
  void AddTerms(int terms);
  void RemoveAllTerms();
  ///@}
  ///@{
  /// Adds to the lists of orders (1, 2 or 4) and step sizes (0.05 to 1e4 voxels) of photons' integrators that are
  /// tried, each order with each step size, and of the tolerances of octrees (0 to 1). Default none.
  void AddIntegratorOrder(int order);
  void RemoveAllIntegratorOrders();
  void AddStepSize(double voxels);
  void RemoveAllStepSizes();
  void AddOctreeTolerance(double tolerance);
  void RemoveAllOctreeTolerances();
  ///@}
  ///@{
  /// Adds to the lists of supersampling factors (1 to 16) and filter sizes (odd, 1 to 65) with which Mesh is voxelised,
  /// each factor with each size. Default 2, 4, 8 and 5, 9, 13.
  void AddSupersamplingFactor(int factor);
  void RemoveAllSupersamplingFactors();
  void AddFilterSize(int voxels);
  void RemoveAllFilterSizes();
  ///@}

  ///@{
  /// Whether photons are tried with all samplers. Default off.
  tyndallFlagMacro(AllSamplers);
  ///@}

  ///@{
  /// Number of timed runs, whose least time is reported, after one run that is not timed; 5 to 25 more, in turns, of
  /// settings that take less than 50 ms; fewer if TimeBudget does not allow them. Default 3, valid [1, 100].
  tyndallRangeMacro(Repeats, int, 1, 100);
  ///@}

  ///@{
  /// Time limit of an update in seconds, without compilation of kernels: half of it for the reference, the rest for the
  /// methods. Runs that do not fit are not started, or are stopped; field data `left_out` names them. Default 300,
  /// valid above 0.
  tyndallRangeMacro(TimeBudget, double, tyndall::AboveZero, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Largest accepted error `error_l2`: the fastest row with at most this error is recommended or, if there is none,
  /// the most accurate row. Default 0.01, valid above 0.
  tyndallRangeMacro(AcceptedError, double, tyndall::AboveZero, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Results of the last update: descriptions of the reference and of the recommended row, the filters of this row, run
  /// time in seconds, the device's name, and the methods and settings that were not compared, one per line.
  vtkGetCharFromStdStringMacro(ReferenceText);
  vtkGetCharFromStdStringMacro(Recommended);
  vtkGetCharFromStdStringMacro(RecommendedFilters);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
  ///@}

protected:
  vtkSolverComparison();
  ~vtkSolverComparison() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSolverComparison(const vtkSolverComparison&) = delete;
  void operator=(const vtkSolverComparison&) = delete;

  tyndall::ComparisonSettings Settings(const tyndall::ComparedScene& scene) const;
  void TakeCamera(tyndall::ComparedScene& scene);
  void Compare(vtkInformationVector** inputs, vtkInformationVector* outputs);
  void TellOfIgnored(const tyndall::Comparison& comparison, vtkImageData* medium);
  void Note(const tyndall::Comparison& comparison);

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
  bool PhotonsThenMaps = false;
  bool Previews = false;
  bool Pictures = false;
  double CameraPosition[3] = { 0.0, 0.0, 0.0 };
  double CameraFocalPoint[3] = { 0.0, 0.0, 0.0 };
  double CameraViewUp[3] = { 0.0, 0.0, 1.0 };
  double CameraViewAngle = 30.0;
  int ImageSize[2] = { 320, 240 };
  const std::unique_ptr<tyndall::ComparedSettings> Tried; ///< the lists of settings
  bool AllSamplers = false;
  int MonteCarloReference = WHERE_IT_CAN_BEAT;
  int Repeats;
  double TimeBudget;
  double AcceptedError;

  std::string ReferenceText;
  std::string Recommended;
  std::string RecommendedFilters;
  std::string DeviceName;
};

#endif
