#ifndef vtkScatteringSolver_h
#define vtkScatteringSolver_h

#include "vtkPropagationAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

namespace tyndall
{
struct IlluminationInput;
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
 * @sa vtkLightPropagationMaps vtkDiscreteOrdinates vtkPhotonMarcher
 */
class TYNDALL_EXPORT vtkScatteringSolver : public vtkPropagationAlgorithm
{
public:
  vtkTypeMacro(vtkScatteringSolver, vtkPropagationAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Number of the input port, behind those of vtkLitMediumAlgorithm.
  static constexpr int UNCOLLIDED = 3;

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

  /// All that shines: uncollided light, or else lights, environment, the sky and what comes in through the faces.
  /// Checked.
  tyndall::IlluminationInput ReadShining(vtkInformationVector** inputs);

private:
  vtkScatteringSolver(const vtkScatteringSolver&) = delete;
  void operator=(const vtkScatteringSolver&) = delete;
};

#endif
