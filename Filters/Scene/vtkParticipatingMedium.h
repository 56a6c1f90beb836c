#ifndef vtkParticipatingMedium_h
#define vtkParticipatingMedium_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>
#include <vector>

namespace tyndall
{
class Domain;
struct Grid;
struct OpticalSize;
class PieceBlocks;
struct VoxelBox;
}

/**
 * @class vtkParticipatingMedium
 * @brief turns a density into a medium that absorbs, scatters and emits light
 *
 * Input: vtkImageData with an array of one component, of cells or of points (SetPointData): the active scalars, or
 * the array chosen by SetInputArrayToProcess(0, ...). An array `g` (1 or 3 components) of it is the mean cosine by
 * voxel, of a mixture for example; it is passed on and counts before MeanCosine.
 *
 * Input 1, optional: vtkTable with the columns `cosine` and `value`, the phase function of TABULATED.
 *
 * Output: the input with the cell arrays
 *
 * | array      | components           | unit              |
 * |------------|----------------------|-------------------|
 * | `sigma_a`  | 1, or 3 where it has colour | 1/length   |
 * | `sigma_s`  | 1, or 3 where it has colour | 1/length   |
 * | `emission` | 1 or 3; only where EmissionScale is not 0 | W/(length^3 sr) |
 *
 * and as field data the phase function: `phase_function` (its name), `g` (mean cosine; 3 numbers where channels
 * differ), and where they are needed `phase_second_g`, `phase_first_part`, `phase_cosine`, `phase_value`. Lengths are
 * in the dataset's own unit.
 *
 * With the relative density rho = (density - MinimumDensity) / (MaximumDensity - MinimumDensity), at least 0:
 *
 *     sigma_t  = rho ExtinctionScale
 *     sigma_s  = Albedo sigma_t,   sigma_a = (1 - Albedo) sigma_t
 *     emission = rho EmissionScale EmissionColor
 *
 * With LevelSet the array is the distance from a surface, negative inside: rho is 1 inside, less in proportion within a
 * voxel of the surface, and 0 outside. A level set that is taken for a density has its fog outside of the surface, and
 * a warning says so: field data of vtkVDBReader call it one, or it is negative inside of the image and positive on its
 * border.
 *
 * A preset gives sigma_s, sigma_a (1/mm at rho = 1) and g of a real medium instead of Albedo and MeanCosine;
 * ExtinctionScale then multiplies them, 1 being the medium as it was measured, and LengthUnit or MillimetresPerUnit
 * says how long a unit of the dataset is.
 *
 * Where the optical thickness is not 0, but below 0.01 or above 1e6, a warning says so: seldom is that what was meant.
 *
 * Cells that are hidden by `vtkGhostType` are empty.
 *
 * @sa vtkLightPropagationMaps
 */
class TYNDALL_EXPORT vtkParticipatingMedium : public vtkImageAlgorithm
{
public:
  static vtkParticipatingMedium* New();
  vtkTypeMacro(vtkParticipatingMedium, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Media for SetPreset. Sources: GetPresetSource.
  enum Presets
  {
    CUSTOM = 0,
    CLOUD,     ///< rho 1: 1 g of liquid water per cubic metre, droplets of 10 um
    FOG,       ///< rho 1: 1 droplet per cubic centimetre
    SMOKE,     ///< rho 1: 1 g of soot per cubic metre
    SKIM_MILK, ///< this and the following: rho 1 is the medium as it was measured
    WHOLE_MILK,
    CREAM,
    ESPRESSO,
    KETCHUP,
    MARBLE,
    SKIN_1,
    SKIN_2
  };

  ///@{
  /// The medium, one of Presets. Default CUSTOM: Albedo and MeanCosine. PhaseFunction counts with presets, too: theirs
  /// is HENYEY_GREENSTEIN, which with g 0 is isotropic.
  tyndallRangeMacro(Preset, int, CUSTOM, SKIN_2);
  ///@}

  ///@{
  /// Name, meaning of density 1, and source of a preset; empty for CUSTOM.
  static const char* GetPresetName(int preset);
  static const char* GetPresetDensity(int preset);
  static const char* GetPresetSource(int preset);
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
  /// Density that is vacuum, as is what lies below it. Default 0.
  tyndallRangeMacro(MinimumDensity, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Density with relative density 1; what lies above it is denser in proportion. Default 1, valid from MinimumDensity
  /// on; if equal to it, everything above it has relative density 1.
  tyndallRangeMacro(MaximumDensity, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Whether the array is a level set, the distance from a surface in the dataset's unit, negative inside. Default off.
  /// On: fog fills the inside, with a ramp of a voxel (the shortest edge) at the surface; MinimumDensity and
  /// MaximumDensity are not read.
  tyndallFlagMacro(LevelSet);
  ///@}

  ///@{
  /// Extinction coefficient sigma_t at relative density 1, 1/length; with a preset the multiple of its coefficients.
  /// Default 1, valid [0, infinity).
  tyndallRangeMacro(ExtinctionScale, double, 0.0, tyndall::LargestFloat);
  ///@}

  ///@{
  /// Part of the extinguished light that is scattered, not absorbed; red, green, blue. Default (0.9, 0.9, 0.9), valid
  /// [0, 1]. Not used with a preset.
  tyndallSetRange3Macro(Albedo, double, 0.0, 1.0);
  vtkGetVector3Macro(Albedo, double);
  ///@}

  /// Phase functions for SetPhaseFunction.
  enum PhaseFunctions
  {
    ISOTROPIC = 0,
    HENYEY_GREENSTEIN,
    DOUBLE_HENYEY_GREENSTEIN, ///< FirstPart of the light with MeanCosine, the rest with SecondMeanCosine
    SCHLICK,
    RAYLEIGH, ///< of particles much smaller than the wavelength
    TABULATED ///< PhaseTable
  };

  ///@{
  /// How light is scattered by angle, one of PhaseFunctions. Default HENYEY_GREENSTEIN.
  tyndallRangeMacro(PhaseFunction, int, ISOTROPIC, TABULATED);
  ///@}

  ///@{
  /// Mean cosine g of the angle by which light is scattered (Henyey-Greenstein, Schlick; of
  /// DOUBLE_HENYEY_GREENSTEIN that of its first lobe): 0 isotropic, near 1 forward. Default 0, valid (-1, 1). Not used
  /// with a preset, which has its own.
  tyndallRangeMacro(MeanCosine, double, -1.0, 1.0);
  ///@}

  ///@{
  /// Mean cosines of red, green and blue instead of MeanCosine, one call each. None (default) or three, valid (-1, 1).
  void SetChannelMeanCosines(double red, double green, double blue);
  void AddChannelMeanCosine(double g);
  void RemoveAllChannelMeanCosines();
  int GetNumberOfChannelMeanCosines() const;
  ///@}

  ///@{
  /// Mean cosine of the second lobe of DOUBLE_HENYEY_GREENSTEIN. Default 0, valid (-1, 1).
  tyndallRangeMacro(SecondMeanCosine, double, -1.0, 1.0);
  ///@}

  ///@{
  /// Part of the scattered light that the first lobe of DOUBLE_HENYEY_GREENSTEIN has. Default 1, valid [0, 1].
  tyndallRangeMacro(FirstPart, double, 0.0, 1.0);
  ///@}

  ///@{
  /// The phase function of TABULATED: a table with the columns `cosine` (of the scattering angle, from -1 to 1, rising
  /// or falling) and `value` (not negative, in any unit). Linear between its rows.
  tyndallInputMacro(PhaseTable, PHASE_TABLE);
  ///@}

  ///@{
  /// Radiance emitted per unit length at relative density 1, W/(length^3 sr), times EmissionColor. Default 0, valid
  /// [0, infinity).
  tyndallRangeMacro(EmissionScale, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Red, green and blue part of EmissionScale. Default (1, 1, 1), valid [0, infinity).
  tyndallSetRange3Macro(EmissionColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(EmissionColor, double);
  ///@}

  /// Units for SetLengthUnit.
  enum LengthUnits
  {
    AS_GIVEN = 0, ///< MillimetresPerUnit
    MICROMETRES,
    MILLIMETRES,
    CENTIMETRES,
    METRES,
    KILOMETRES
  };

  ///@{
  /// The dataset's unit of length, for presets, one of LengthUnits. Default AS_GIVEN.
  tyndallRangeMacro(LengthUnit, int, AS_GIVEN, KILOMETRES);
  ///@}

  ///@{
  /// Length of the dataset's unit in millimetres where LengthUnit is AS_GIVEN: 1 for a scan in mm, 1000 for metres.
  /// Default 1, valid (0, infinity).
  tyndallRangeMacro(MillimetresPerUnit, double, tyndall::AboveZero, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Of the last update, and of the whole dataset on every rank: how large it is by its unit of length, as
  /// "480 x 480 x 240 m"; the largest optical thickness of a row of voxels along x, y or z, no unit; and the mean free
  /// path, 1 over the mean extinction of the voxels that are not empty, in the dataset's unit (0 where all are). Of the
  /// colour that is extinguished most. 0 and empty before, and after an error.
  vtkGetCharFromStdStringMacro(PhysicalExtent);
  vtkGetMacro(OpticalThickness, double);
  vtkGetMacro(MeanFreePath, double);
  ///@}

protected:
  enum Inputs
  {
    DENSITY = 0,
    PHASE_TABLE = 1
  };

  vtkParticipatingMedium();
  ~vtkParticipatingMedium() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkParticipatingMedium(const vtkParticipatingMedium&) = delete;
  void operator=(const vtkParticipatingMedium&) = delete;

  /// Sets the properties that report the optical size; warns if the medium is too thin or too thick to be meant.
  void NoteSize(const tyndall::Grid& grid, const tyndall::OpticalSize& size);
  void DoubtLevelSet(const tyndall::Domain& domain, vtkImageData* image, const tyndall::VoxelBox& box);
  void MakeMedium(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkImageData* output);

  int Preset = CUSTOM;
  int PointData = VOXELS_AROUND_POINTS;
  double MinimumDensity = 0.0;
  double MaximumDensity = 1.0;
  bool LevelSet = false;
  double ExtinctionScale = 1.0;
  double Albedo[3] = { 0.9, 0.9, 0.9 };
  int PhaseFunction = HENYEY_GREENSTEIN;
  double MeanCosine = 0.0;
  std::vector<double> ChannelMeanCosines;
  double SecondMeanCosine = 0.0;
  double FirstPart = 1.0;
  double EmissionScale = 0.0;
  double EmissionColor[3] = { 1.0, 1.0, 1.0 };
  int LengthUnit = AS_GIVEN;
  double MillimetresPerUnit = 1.0;
  std::string PhysicalExtent;
  double OpticalThickness = 0.0;
  double MeanFreePath = 0.0;
};

#endif
