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
class LastOutputs;
class PieceBlocks;
struct SolverScene;
}

/**
 * @class vtkScatteringSolver
 * @brief superclass of the filters that solve for scattered light, from their own uncollided light or another filter's
 *
 * Input 3, optional: uncollided light of another filter, vtkImageData of the medium's voxels, as vtkPhotonMarcher and
 * vtkPhotonReconstruction make it: cell arrays `fluence_direct` (1 or 3 components, W/length^2) and `mean_direction` (3
 * components, power-weighted mean direction; missing: isotropic), field data `face_power_out` (W that left unscattered
 * through -x, +x, -y, +y, -z, +z; missing: 0). It replaces the uncollided light of lights, environment, SkyColor and
 * FaceRadiance, which are then not read; emission of the medium is added as always. What it lost and what left count as
 * incident power, to 1e-5.
 *
 * Output 1 is the table of convergence, vtkTable.
 *
 * The last light is returned again for the same inputs, even if filters upstream have made them anew, for another
 * piece, and if only LitColor, Exposure or ToneCurve has changed. Each rank keeps the light of the whole image for
 * that, or of its piece.
 *
 * In a parallel pipeline light crosses the boundaries between pieces: each rank solves its piece, and ranks exchange
 * light; or, by Decomposition or if that is better, every rank solves the whole domain and returns the piece that it
 * was asked for.
 *
 * With LitColor output 0 has the cell array `lit_color` too, unsigned char, 4 components: the colour that each voxel
 * shows on a screen, red, green, blue, not multiplied by alpha, and an opacity. A volume mapper that uses them directly
 * (vtkVolumeProperty with IndependentComponents off, an opacity function from 0 to 1 over 0 to 255, and
 * SetScalarOpacityUnitDistance(3, d)) shows the lit medium without OpenCL, about as vtkMediumRayCaster does over black
 * (numerics.md, section 14.8). d is field data `lit_color_distance`, length; field data `lit_color_exposure` is the
 * factor of radiance.
 *
 * Field data `settings_used` of output 0: "Name = value" of each property that Quality chooses, as it was used, and on
 * several ranks of Decomposition. If that was automatic and each rank solved the whole domain, `left_out` says why.
 *
 * @sa vtkLightPropagationMaps vtkDiscreteOrdinates vtkPhotonMarcher
 */
class TYNDALL_EXPORT vtkScatteringSolver : public vtkPropagationAlgorithm
{
public:
  vtkTypeMacro(vtkScatteringSolver, vtkPropagationAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Number of the input port, behind those of vtkLitMediumAlgorithm.
  static constexpr int UNCOLLIDED = 3;

  enum Qualities
  {
    DRAFT = 0, ///< while settings are chosen
    USUAL = 1, ///< every property as it is
    FINE = 2,
    REFERENCE = 3 ///< for comparisons
  };

  enum Decompositions
  {
    AUTOMATIC_DECOMPOSITION = 0, ///< BLOCKS unless WHOLE is better
    WHOLE = 1,                   ///< each rank solves the whole domain
    BLOCKS = 2                   ///< each rank solves its piece
  };

  ///@{
  /// What each of several MPI ranks solves. WHOLE: the whole domain, which each then holds. BLOCKS: its piece; ranks
  /// exchange light, and hold a halo of one or two voxels. One rank alone solves the same way then, so that light does
  /// not depend on their number, but for rounding. An error names what blocks cannot do; see the subclass.
  /// AUTOMATIC_DECOMPOSITION (default): BLOCKS if each of several ranks is asked for its piece of more than 64^3
  /// voxels, the scene can be decomposed, and WHOLE would not be more accurate or much faster; else WHOLE.
  tyndallRangeMacro(Decomposition, int, AUTOMATIC_DECOMPOSITION, BLOCKS);
  ///@}

  ///@{
  /// Accuracy: chooses, from the scene, those of the properties below that have their default value, and leaves the
  /// other ones. DRAFT, USUAL (default), FINE or REFERENCE; USUAL changes none. FINE and REFERENCE also divide
  /// rectangle lights more finely.
  tyndallRangeMacro(Quality, int, DRAFT, REFERENCE);
  ///@}

  ///@{
  /// Whether to find the light on half as many voxels along each axis (and half of those where many are left; LeftOut
  /// says how many), along few directions and to some percent, as a preview while lights are moved: `fluence` and
  /// `fluence_direct` alone, linear between the coarse voxels' middles. Quality, TargetError and WarmStart are not read
  /// then. By blocks (Decomposition) each rank averages its piece, and the first that has voxels solves the coarse grid
  /// for all. Default off.
  tyndallFlagMacro(Preview);
  ///@}

  ///@{
  /// MiB of the device's memory that a solve may take. Default 0: what the device has. vtkLightPropagationMaps keeps
  /// arrays over all voxels that do not fit in host memory then, and streams them through the device slice by slice:
  /// the same light, bit for bit, later; with 0 beyond nine tenths of the device. vtkLatticeBoltzmannLighting leaves
  /// what does not fit in host memory, and of vtkDiscreteOrdinates it is an error. Where the device is a processor,
  /// which works on host memory in place, it bounds what a solve takes beside these arrays. By blocks (Decomposition)
  /// it is of each rank, and vtkLightPropagationMaps reads what does not fit from host memory. DeviceName and field
  /// data `device` say how much lay where. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether to make `lit_color`. Default off. What is on is seen from every side alike: light is scattered evenly in
  /// it, whatever the phase function.
  void SetLitColor(bool make);
  vtkGetMacro(LitColor, bool);
  vtkBooleanMacro(LitColor, bool);
  ///@}

  ///@{
  /// What radiance is multiplied by for `lit_color`. Default 0: so that the mean of the lit part, seen along the axes,
  /// becomes a medium grey. Valid [0, 1e30].
  void SetExposure(double exposure);
  vtkGetMacro(Exposure, double);
  ///@}

  ///@{
  /// How `lit_color` follows radiance, as vtkMediumRayCaster::ToneCurve: 0 linear, 1 filmic (default).
  void SetToneCurve(int curve);
  vtkGetMacro(ToneCurve, int);
  ///@}

  /// Includes the properties of `lit_color`.
  vtkMTimeType GetMTime() override;

  /// "Name = value" of each property that Quality chooses, as the last update used it, one per line.
  vtkGetCharFromStdStringMacro(SettingsUsed);

  ///@{
  /// Uncollided light (vtkImageData) by connection or as data; null: the solver's own.
  tyndallInputMacro(UncollidedLight, UNCOLLIDED);
  ///@}

protected:
  vtkScatteringSolver();
  ~vtkScatteringSolver() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Returns the light of the last solve if that is asked for again, or solves on subdomains of ranks (Decomposition)
  /// or serially. An error is reported once (Pieces/GuardedWork.h).
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Solves on this rank's subdomain. Collective.
  /// @return the light of its voxels; settingsUsed is set
  virtual tyndall::LightField Solve(const tyndall::SolverScene& scene) = 0;

  /// Sets the properties that report a solve; with an empty one before solving, and if it failed.
  virtual void Note(const tyndall::LightField& light) = 0;

  /// Whether the light depends on the medium's cells `ior`. Default: no, and a warning if they are not 1.
  virtual bool KnowsIndex() const { return false; }

  /// Which properties and inputs rule out a decomposition, in words for an error; empty: none.
  virtual std::string NotByBlocks(vtkInformationVector** inputs) const;
  /// The same for the scene of a rank.
  virtual std::string NotInBlocks(const tyndall::SolverScene& scene);
  /// Why the serial solver would be more accurate or much faster for a scene that can be decomposed, in words that
  /// follow "better for"; empty if it would not. Not for previews. Collective, the same on all ranks.
  virtual std::string ReasonNotToDecompose(const tyndall::SolverScene& scene);

  /// An input of points (photons) that are distributed among ranks: SolverScene::share; -1: there is none.
  virtual int PortOfShares() const { return -1; }
  /// What lights a subdomain: by default UncollidedLight, or else lights, environment, sky and faces, or the default
  /// sky. Checked.
  virtual tyndall::IlluminationInput ReadShining(tyndall::SolverScene& scene, vtkInformationVector** inputs);

  /// Whether Quality chooses anything.
  virtual bool ReadsQuality() const { return !this->Preview; }

  int Decomposition = AUTOMATIC_DECOMPOSITION;
  int Quality = USUAL;
  bool Preview = false;
  int MemoryBudget = 0;
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
  bool SolvedInPieces = false; ///< that is of this rank's piece
  // Of the current update:
  bool OverRanks = false;           ///< several ranks run it together
  bool IsFirstRank = true;          ///< the rank that warns for all of them
  std::vector<std::string> Ignored; ///< arrays of the medium that the light does not depend on
  std::string WholeFor;             ///< why each rank solves serially although Decomposition was automatic
  vtkTimeStamp ColorsTime;          ///< of LitColor, Exposure, ToneCurve, which do not change the light
};

#endif
