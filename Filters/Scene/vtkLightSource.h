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
 * @brief superclass of the sources that are one light each, to be placed by hand
 *
 * Output 0: the light as a row of vtkLightRig's output, vtkPolyData of one vertex with the same point arrays: every
 * solver takes it as its lights, and vtkLightRig groups any number of them.
 * Output 1: what it looks like in a view, vtkPolyData of lines and polygons with point array `color` (bytes of red,
 * green, blue: the light's power at full brightness). A port of its own, because every point of output 0 is a light.
 *
 * A light without direction or size, or with a number that is not finite, is an error; the outputs are empty then.
 *
 * @sa vtkSun vtkPointLight vtkSpotLight vtkRectangleLight vtkLightRig
 */
class TYNDALL_EXPORT vtkLightSource : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkLightSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Red, green, blue of the light's power, W; of a sun its irradiance on a plane that faces it, W/length^2. Default
  /// (1, 1, 1), valid [0, infinity).
  tyndallSetRange3Macro(Power, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(Power, double);
  ///@}

  ///@{
  /// Where the light is. Of a sun: where it is drawn, and from where it shines towards the focal point.
  tyndallSetRange3Macro(Position, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(Position, double);
  ///@}

protected:
  vtkLightSource(double x, double y, double z); ///< where it is untouched
  ~vtkLightSource() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// The light without its power and its position, and how large it is drawn.
  virtual tyndall::DrawnLight MakeLight() const = 0;

  double Power[3] = { 1.0, 1.0, 1.0 };
  double Position[3];

private:
  vtkLightSource(const vtkLightSource&) = delete;
  void operator=(const vtkLightSource&) = delete;
};

#endif
