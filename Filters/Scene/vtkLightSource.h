#ifndef vtkLightSource_h
#define vtkLightSource_h

#include "PropertyRange.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

namespace tyndall
{
struct DrawnLight;
}

/**
 * @class vtkLightSource
 * @brief superclass of filters that create a single light, which users place in a view
 *
 * Output 0: the light in the format of vtkLightRig's output, vtkPolyData of one vertex with the same point arrays.
 * Every solver accepts it as input of lights, and vtkLightRig combines any number of them.
 * Output 1: shape of the light for a view, vtkPolyData of lines and polygons with point array `color` (red, green, blue
 * as bytes: the light's colour at full brightness). The shape is not part of output 0, where every point is a light.
 *
 * A light without direction or size, or with a value that is not finite, is an error; the outputs are then empty.
 *
 * @sa vtkSun vtkPointLight vtkSpotLight vtkRectangleLight vtkLightRig
 */
class TYNDALL_EXPORT vtkLightSource : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkLightSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Power of the light, red, green, blue, W; for a sun the irradiance on a plane that faces it, W/length^2. Default
  /// (1, 1, 1), valid [0, infinity).
  tyndallSetRange3Macro(Power, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(Power, double);
  ///@}

  ///@{
  /// Position of the light. For a sun: start of its arrow, from which light travels in the direction of the focal
  /// point.
  tyndallSetRange3Macro(Position, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(Position, double);
  ///@}

protected:
  vtkLightSource(double x, double y, double z); ///< sets the default position
  ~vtkLightSource() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Returns type, direction, size and angle of the light, and the size of its shape; the caller sets power and
  /// position.
  virtual tyndall::DrawnLight MakeLight() const = 0;

  double Power[3] = { 1.0, 1.0, 1.0 };
  double Position[3];

private:
  vtkLightSource(const vtkLightSource&) = delete;
  void operator=(const vtkLightSource&) = delete;
};

#endif
