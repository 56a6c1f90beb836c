#ifndef vtkLitMediumAlgorithm_h
#define vtkLitMediumAlgorithm_h

#include "PropertyRange.h"
#include "vtkDataObjectAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

class vtkImageData;

namespace tyndall
{
struct Illumination;
}

/**
 * @class vtkLitMediumAlgorithm
 * @brief superclass of filters whose inputs are a medium and its illumination
 *
 * Defines the input ports and the orientation of the environment. Outputs are vtkImageData unless a subclass overrides
 * FillOutputPortInformation.
 *
 * Input 0, the medium: vtkImageData; see the subclass for its arrays.
 * Input 1, optional: lights as vtkLightRig makes them, vtkPolyData.
 * Input 2, optional: the environment, vtkImageData in latitude-longitude layout, point array `radiance` (1 or 3
 * components, W/(length^2 sr)), as vtkEnvironmentReader makes it.
 *
 * Cells of the medium that `vtkGhostType` marks as hidden are empty; hidden pixels of the environment are black.
 *
 * Light crosses the boundaries between pieces. In a parallel pipeline every rank therefore requests the complete
 * inputs, and RequestData of a subclass returns the requested piece. Exceptions are subclasses whose ranks exchange
 * light (vtkScatteringSolver, vtkMediumRayCaster, vtkPhotonImportance), or that need only the medium's box
 * (vtkPhotonEmitter): their ranks request one piece of the medium each.
 *
 * A subclass implements RequestData, which reads the lights and the environment by ReadIllumination.
 *
 * @sa vtkPropagationAlgorithm vtkPhotonEmitter vtkMediumRayCaster
 */
class TYNDALL_EXPORT vtkLitMediumAlgorithm : public vtkDataObjectAlgorithm
{
public:
  vtkTypeMacro(vtkLitMediumAlgorithm, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  vtkImageData* GetOutput();

  /// Numbers of the input ports.
  enum InputPorts
  {
    MEDIUM = 0,
    LIGHTS = 1,
    ENVIRONMENT = 2
  };

  ///@{
  /// Lights (vtkPolyData) and environment (vtkImageData) by connection or as data; null: none.
  tyndallInputMacro(Lights, LIGHTS);
  tyndallInputMacro(Environment, ENVIRONMENT);
  ///@}

  ///@{
  /// How point arrays are read. 0 (default): each point is the centre of a voxel with its value: n points make n
  /// voxels, the output has cell arrays, and its bounds are half a spacing wider than the input's. 1: points are
  /// averaged to the voxels between them: n points make n - 1 voxels. If a cell array is read as well, the cells are
  /// the voxels and points are averaged; field data `settings_used` then report it.
  tyndallPointDataMacro();
  ///@}

  ///@{
  /// Axis of the scene along which the environment's up direction points: 0, 1, 2 for x, y, z. Default 2.
  tyndallRangeMacro(EnvironmentUp, int, 0, 2);
  ///@}

  ///@{
  /// Rotation of the environment about its up direction, degrees. Default 0.
  tyndallRangeMacro(EnvironmentAzimuth, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

protected:
  vtkLitMediumAlgorithm();
  ~vtkLitMediumAlgorithm() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override = 0;

  /// Reads and checks the lights and the environment, which is oriented by EnvironmentUp and EnvironmentAzimuth.
  /// @throws InvalidInput if either is invalid
  tyndall::Illumination ReadIllumination(vtkInformationVector** inputs);

  int EnvironmentUp = 2;
  double EnvironmentAzimuth = 0.0;
  int PointData = VOXELS_AROUND_POINTS;

private:
  vtkLitMediumAlgorithm(const vtkLitMediumAlgorithm&) = delete;
  void operator=(const vtkLitMediumAlgorithm&) = delete;
};

#endif
