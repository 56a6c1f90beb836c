#ifndef vtkScatteringSolver_h
#define vtkScatteringSolver_h

#include "PropertyRange.h"
#include "vtkPropagationAlgorithm.h"
#include "vtkTimeStamp.h"
#include "vtkTyndallModule.h" // for export macro

#include <memory>
#include <string>
#include <vector>

class vtkImageData;

namespace tyndall
{
struct IlluminationInput;
struct LightField;
class Communicator;
class LastOutputs;
class PieceBlocks;
struct SolverScene;
}

/**
 * @class vtkScatteringSolver
 * @brief superclass of the filters that solve for multiply scattered light
 *
 * Input 3, optional: uncollided flux computed by another filter, vtkImageData of the medium's voxels, as
 * vtkPhotonMarcher and vtkPhotonReconstruction write it: cell arrays `fluence_direct` (1 or 3 components, W/length^2)
 * and `mean_direction` (3 components, power-weighted mean direction; missing: isotropic), field data `face_power_out`
 * (W that left unscattered through -x, +x, -y, +y, -z, +z; missing: 0). This input replaces the uncollided flux due to
 * lights, environment, SkyColor and FaceRadiance, which are then not read; the medium's emission is added in any case.
 * The incident power of the energy balance is then the power that the uncollided flux lost in the medium plus its
 * escaped power, to 1e-5.
 *
 * Output 1 is the convergence history, vtkTable.
 *
 * The last solution is cached. It is returned again for inputs with the same content, even if filters upstream have run
 * again, another piece is requested, or LitColor, Exposure or ToneCurve has changed. If the domain is decomposed, each
 * rank caches the solution of its piece, else the first rank caches the solution of the whole domain.
 *
 * In a parallel pipeline light crosses the boundaries between pieces: each rank solves on its piece, and ranks exchange
 * light; or, depending on Decomposition, the first rank solves on the whole domain and sends each rank the requested
 * piece.
 *
 * With LitColor output 0 also has the cell array `lit_color`, unsigned char, 4 components: the display colour of each
 * voxel, red, green, blue, not multiplied by alpha, and its opacity. A VTK volume mapper that uses these components
 * directly (vtkVolumeProperty with IndependentComponents off, an opacity function from 0 to 1 over 0 to 255, and
 * SetScalarOpacityUnitDistance(3, d)) shows the lit medium without OpenCL, approximately as vtkMediumRayCaster does
 * over black (numerics.md, section 14.8). d is field data `lit_color_distance`, a length; field data
 * `lit_color_exposure` is the factor by which radiance was multiplied.
 *
 * Field data `settings_used` of output 0 lists "Name = value" for each property that Quality chooses and, on several
 * ranks, for Decomposition; value is the value used. If Decomposition was automatic and the first rank solved the whole
 * domain, `left_out` reports the reason.
 *
 * @sa vtkLightPropagationMaps vtkDiscreteOrdinates vtkPhotonMarcher
 */
class TYNDALL_EXPORT vtkScatteringSolver : public vtkPropagationAlgorithm
{
public:
  vtkTypeMacro(vtkScatteringSolver, vtkPropagationAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Input port of the uncollided light; lower numbers are the ports of vtkLitMediumAlgorithm.
  static constexpr int UNCOLLIDED = 3;

  enum Qualities
  {
    DRAFT = 0, ///< fast and inaccurate, for adjusting a scene
    USUAL = 1, ///< uses all properties as they are set
    FINE = 2,
    REFERENCE = 3 ///< most accurate and slowest, for comparison with other settings
  };

  enum Decompositions
  {
    AUTOMATIC_DECOMPOSITION = 0, ///< BLOCKS or WHOLE, chosen for the scene (see SetDecomposition)
    WHOLE = 1,                   ///< the first rank solves the whole domain
    BLOCKS = 2                   ///< each rank solves its piece
  };

  ///@{
  /// Domain decomposition over MPI ranks. WHOLE: the first rank solves on the whole domain, for all ranks. BLOCKS: each
  /// rank solves on its piece; ranks exchange light, and hold a halo of one or two voxels. On one rank the solve is the
  /// serial one. Settings that cannot be used with BLOCKS (see the subclass) are an error. AUTOMATIC_DECOMPOSITION
  /// (default): BLOCKS if each of several ranks is asked for its own piece, the image has more than 64^3 voxels, the
  /// scene can be decomposed, and WHOLE would not be more accurate or much faster; else WHOLE.
  tyndallRangeMacro(Decomposition, int, AUTOMATIC_DECOMPOSITION, BLOCKS);
  ///@}

  ///@{
  /// Accuracy: DRAFT, USUAL (default), FINE or REFERENCE. Chooses values, depending on the scene, for properties below
  /// that have their default value; other properties keep their values. USUAL changes no property. FINE and REFERENCE
  /// also divide rectangle lights more finely.
  tyndallRangeMacro(Quality, int, DRAFT, REFERENCE);
  ///@}

  ///@{
  /// Target for the relative error of fluence (ratio of the root mean squares of error and fluence), as the solver
  /// estimates it. To meet the target, vtkLightPropagationMaps and vtkDiscreteOrdinates (conservative scheme) choose
  /// directions, terms and tolerance if they have their default values, divide voxels that are too coarse, and do not
  /// read Quality. The error of vtkLatticeBoltzmannLighting is that of diffusion, which no setting reduces. A warning
  /// says if the estimate stays above the target. Default 0: no target; valid [0, 0.5].
  tyndallRangeMacro(TargetError, double, 0.0, 0.5);
  ///@}

  ///@{
  /// Whether to solve for a preview, for example while lights are moved: on a grid with half as many voxels along each
  /// axis (halved again if that grid is large; LeftOut reports its size), with few directions and a tolerance of a few
  /// percent. The output has only `fluence` and `fluence_direct`, interpolated linearly between the centres of the
  /// coarse voxels. Quality, TargetError and WarmStart are not read for a preview. With Decomposition BLOCKS each rank
  /// averages its piece, and the first rank with voxels solves on the coarse grid for all ranks. Default off.
  tyndallFlagMacro(Preview);
  ///@}

  ///@{
  /// Device memory that a solve may use, MiB. Default 0: the device's memory. vtkLightPropagationMaps keeps voxel
  /// arrays that exceed this budget (with 0, nine tenths of the device's memory) in host memory and streams them
  /// through the device slice by slice: this takes longer, with bitwise the same result. vtkLatticeBoltzmannLighting
  /// keeps arrays that exceed the budget in host memory; in vtkDiscreteOrdinates they are an error. If the device is a
  /// CPU, which works on host memory in place, the budget bounds the memory used in addition to these arrays. With
  /// Decomposition BLOCKS the budget applies to each rank, and vtkLightPropagationMaps reads arrays that exceed it from
  /// host memory. DeviceName and field data `device` report how much memory was used on device and host. Valid [0,
  /// 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether to skip computations that the scene does not need; `left_out` and LeftOut list them. Default on; off
  /// computes everything, for comparison: the result is the same in more time.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// Whether to compute the cell array `lit_color`. Default off. The colour does not depend on the view direction:
  /// scattering towards the viewer is taken as isotropic for any phase function.
  void SetLitColor(bool make);
  vtkGetMacro(LitColor, bool);
  vtkBooleanMacro(LitColor, bool);
  ///@}

  ///@{
  /// Factor by which radiance is multiplied for `lit_color`. Default 0: chosen such that the mean over the lit pixels
  /// of views along the axes becomes a medium grey. Valid [0, 1e30].
  void SetExposure(double exposure);
  vtkGetMacro(Exposure, double);
  ///@}

  ///@{
  /// Tone curve from radiance to `lit_color`, one of the ToneCurves of vtkMediumRayCaster: 0 linear, 1 filmic
  /// (default).
  void SetToneCurve(int curve);
  vtkGetMacro(ToneCurve, int);
  ///@}

  /// Time of the latest modification, including LitColor, Exposure and ToneCurve.
  vtkMTimeType GetMTime() override;

  ///@{
  /// Results of the last update: estimated relative error of fluence due to the omitted orders; estimated total
  /// relative error of fluence (0 without EstimateError or TargetError; NaN, unknown, after one order); number of
  /// solves (more than one with TargetError); relative error of the energy balance; run time in seconds; the device's
  /// name; computations that the scene did not need, one per line; "Name = value" used for each property that Quality
  /// chooses, one per line.
  vtkGetMacro(Residual, double);
  vtkGetMacro(EstimatedError, double);
  vtkGetMacro(Solves, int);
  vtkGetMacro(BalanceError, double);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
  vtkGetCharFromStdStringMacro(SettingsUsed);
  ///@}

  ///@{
  /// Uncollided light (vtkImageData) by connection or as data; null: the solver computes the uncollided light.
  tyndallInputMacro(UncollidedLight, UNCOLLIDED);
  ///@}

protected:
  vtkScatteringSolver();
  ~vtkScatteringSolver() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Returns the cached solution if it is valid, else solves: on one subdomain per rank (Decomposition) or serially. An
  /// error is reported once (Pieces/GuardedWork.h).
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Solves on this rank's subdomain. Collective.
  /// @param scene  medium and light sources of the subdomain
  /// @return the light in the subdomain's voxels, with settingsUsed set
  virtual tyndall::LightField Solve(const tyndall::SolverScene& scene) = 0;

  /// Sets the read-only properties to those of the first rank, which has solved for all ranks. Collective.
  virtual void ShareResults(tyndall::Communicator& ranks);

  /// Sets the read-only properties that report on a solve. Called with an empty `light` before a solve, so that the
  /// properties stay empty if the solve fails.
  virtual void Note(const tyndall::LightField& light);

  /// Whether the solver uses the medium's cell array `ior` (refractive index). If not, which is the default, an `ior`
  /// other than 1 causes a warning.
  virtual bool KnowsIndex() const { return false; }

  /// Properties and inputs that rule out a decomposition, as text for an error message; empty if there are none.
  virtual std::string NotByBlocks(vtkInformationVector** inputs) const;
  /// Why the serial solver would be more accurate or much faster for a scene that can be decomposed; empty if it would
  /// not. The text continues the sentence "the first rank solved the whole, for". Not called for previews. Collective,
  /// the same on all ranks.
  virtual std::string ReasonNotToDecompose(const tyndall::SolverScene& scene);

  /// Input port of photons that are distributed over ranks (SolverScene::share); -1 if there is none.
  virtual int PortOfShares() const { return -1; }
  /// Reads and checks the light sources of a subdomain: by default UncollidedLight or, if it is not connected, lights,
  /// environment, sky and boundary radiance, or the default sky.
  virtual tyndall::IlluminationInput ReadShining(tyndall::SolverScene& scene, vtkInformationVector** inputs);

  /// Whether the solver reads the property Quality: not for previews, nor with a target error.
  virtual bool ReadsQuality() const { return !this->Preview && this->TargetError == 0.0; }

  int Decomposition = AUTOMATIC_DECOMPOSITION;
  int Quality = USUAL;
  bool Preview = false;
  double TargetError = 0.0;
  int MemoryBudget = 0;
  bool LeaveOut = true;
  double Residual = 0.0;
  double EstimatedError = 0.0;
  int Solves = 0;
  double BalanceError = 0.0;
  std::string DeviceName;
  std::string SettingsUsed;
  bool LitColor = false;
  double Exposure = 0.0;
  int ToneCurve = 1;

private:
  vtkScatteringSolver(const vtkScatteringSolver&) = delete;
  void operator=(const vtkScatteringSolver&) = delete;

  void ColorsModified();
  bool IgnoresIndexOf(vtkImageData* medium);
  bool WantsPieces(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const;
  std::string ReasonNotToAgree(vtkInformationVector** inputs) const;
  std::string ReadShiningOrRefuse(tyndall::SolverScene& scene, vtkInformationVector** inputs);
  bool ReadOrRefuse(tyndall::SolverScene& scene, vtkInformationVector** inputs);
  bool UpdateCachedOrSolve(
    const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkInformationVector* outputs);
  void Write(const tyndall::PieceBlocks& pieces, tyndall::LightField&& light, vtkInformationVector** inputs,
    vtkInformationVector* outputs);
  void Color(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkInformationVector* outputs);
  void RestoreLightBefore(vtkInformationVector* outputs);

  std::unique_ptr<tyndall::LastOutputs> Solved;
  bool SolvedInPieces = false; ///< whether the cached outputs (Solved) are only this rank's piece
  bool HasSolved = false;      ///< whether this rank solved in the last update, or had a valid cached solution
  // State of the current update:
  bool OverRanks = false;           ///< whether several ranks take part in the update
  bool IsFirstRank = true;          ///< whether this is the first rank, which issues the warnings
  std::vector<std::string> Ignored; ///< arrays of the medium that the solver does not use
  std::string WholeFor;             ///< why the first rank solves the whole domain with automatic Decomposition
  vtkTimeStamp ColorsTime;          ///< last change of LitColor, Exposure or ToneCurve, which need no new solve
};

#endif
