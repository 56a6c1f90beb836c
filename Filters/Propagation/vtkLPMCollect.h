#ifndef vtkLPMCollect_h
#define vtkLPMCollect_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>

/**
 * @class vtkLPMCollect
 * @brief collects the rays' deposits in the voxels: the second half of one scattering order of the published light
 * propagation maps
 *
 * Each voxel reads the temporary buffers T of all directions and updates its fluence and the source of the next order
 * (Gruson et al. 2012, Algorithm 2, Eq. 4).
 *
 * Input: the output of vtkLPMPropagate: the medium's image with cell arrays `T_xmin`, `T_xmax`, ..., `T_zmax` and field
 * data `map_resolution`, `stored_directions_count`, `scattering_order`. If the input also has `fluence`,
 * `fluence_direct` and `scattered_radiance` of the previous orders, this order is added to them.
 *
 * Output: the input without the arrays T, with the cell arrays
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `unscattered` | 6, or stored directions, x 1 or 3 | W/(length^3 sr) | U: source of the next order |
 * | `scattered_radiance` | stored directions x 1 or 3 | W/(length^2 sr) | I / sigma_s, sum of all orders so far |
 * | `fluence` | 1 or 3 | W/length^2 | fluence, sum of all orders so far |
 * | `fluence_direct` | 1 or 3 | W/length^2 | fluence of order 0 |
 *
 * with channels varying fastest, then directions; and field data `left_over` (W per channel: the power in U). The
 * output is vtkLPMPropagate's input for the next order.
 *
 * Cells that `vtkGhostType` marks as hidden are empty.
 *
 * @sa vtkLPMPropagate vtkLightPropagationMaps
 * @par Thanks
 * A. Gruson, A. Hakke Patil, R. Cozot, K. Bouatouch, S. Pattanaik: Light Propagation Maps on Parallel Graphics
 * Architectures, EGPGV 2012.
 */
class TYNDALL_EXPORT vtkLPMCollect : public vtkImageAlgorithm
{
public:
  static vtkLPMCollect* New();
  vtkTypeMacro(vtkLPMCollect, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  tyndallDeviceMacro();

  ///@{
  /// Results of the last update: run time in seconds, and the computations that the scene did not need, one per line
  /// (also field data `left_out`).
  tyndallSecondsMacro();
  tyndallLeftOutMacro();
  ///@}

protected:
  vtkLPMCollect();
  ~vtkLPMCollect() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkLPMCollect(const vtkLPMCollect&) = delete;
  void operator=(const vtkLPMCollect&) = delete;

  std::string Device;
};

#endif
