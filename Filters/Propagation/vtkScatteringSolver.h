#ifndef vtkScatteringSolver_h
#define vtkScatteringSolver_h

#include "vtkPropagationAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <memory>
#include <string>

namespace tyndall
{
struct IlluminationInput;
class LastOutputs;
}

/**
 * @class vtkScatteringSolver
 * @brief superclass of the filters that solve for scattered light, from uncollided light of their own or of another
 *
 * Input 3, optional: uncollided light that another filter found, vtkImageData of the medium's voxels, as
 * vtkPhotonMarcher and vtkPhotonReconstruction make it: cell arrays `fluence_direct` (1 or 3 components, W/length^2)
 * and `mean_direction` (3 components, power-weighted mean direction; missing: light goes every way alike), field data
 * `face_power_out` (W that left unscattered through -x, +x, -y, +y, -z, +z; missing: 0). It is taken instead of the
 * uncollided light of lights, environment, SkyColor and FaceRadiance, which are then not read; what the medium emits is
 * added as always. What it lost and what left count as having come in, to 1e-5.
 *
 * Output 1 is the table of convergence, vtkTable.
 *
 * Asked again for the light of the same medium under the same light, even where filters before have made them anew,
 * it gives out the light that it has.
 *
 * Field data `settings_used` of output 0: "Name = value" of each property that Quality chooses, as it was used.
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
    DRAFT = 0, ///< to look at while settings are chosen
    USUAL = 1, ///< every property as it stands
    FINE = 2,
    REFERENCE = 3 ///< to compare others with
  };

  ///@{
  /// How exact the light is to be: chooses, from the scene, those of the properties below that have their default
  /// value, and leaves those that have another one. DRAFT, USUAL (default), FINE or REFERENCE; with USUAL all are taken
  /// as they stand.
  tyndallSetRangeMacro(Quality, int, DRAFT, REFERENCE);
  vtkGetMacro(Quality, int);
  ///@}

  ///@{
  /// Whether to find the light on half as many voxels along each axis (and half of those where many are left; LeftOut
  /// says how many), along few directions and to some percent, as a preview while lights are moved: `fluence` and
  /// `fluence_direct` alone, linear between the coarse voxels' middles. Quality, TargetError and WarmStart are not read
  /// then. Default off.
  vtkSetMacro(Preview, bool);
  vtkGetMacro(Preview, bool);
  vtkBooleanMacro(Preview, bool);
  ///@}

  /// "Name = value" of each property that Quality chooses, as the last update used it, one per line.
  vtkGetCharFromStdStringMacro(SettingsUsed);

  ///@{
  /// Uncollided light (vtkImageData) by connection or as data; null: the solver's own.
  void SetUncollidedLightConnection(vtkAlgorithmOutput* light);
  void SetUncollidedLightData(vtkDataObject* light);
  void RemoveUncollidedLight();
  ///@}

protected:
  vtkScatteringSolver();
  ~vtkScatteringSolver() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;

  /// All that shines: uncollided light, or else lights, environment, the sky and what comes in through the faces, or
  /// the default sky. Checked.
  /// @param emits  whether the medium does
  tyndall::IlluminationInput ReadShining(vtkInformationVector** inputs, bool emits);

  /// First and last in RequestData.
  std::unique_ptr<tyndall::LastOutputs> Solved;

  int Quality = USUAL;
  bool Preview = false;
  std::string SettingsUsed;

private:
  vtkScatteringSolver(const vtkScatteringSolver&) = delete;
  void operator=(const vtkScatteringSolver&) = delete;
};

#endif
