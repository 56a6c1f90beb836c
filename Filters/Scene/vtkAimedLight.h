#ifndef vtkAimedLight_h
#define vtkAimedLight_h

#include "vtkLightSource.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkAimedLight
 * @brief superclass of lights that emit from their position in the direction of a focal point
 *
 * @sa vtkSun vtkSpotLight
 */
class TYNDALL_EXPORT vtkAimedLight : public vtkLightSource
{
public:
  vtkTypeMacro(vtkAimedLight, vtkLightSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Point at which the light is aimed; must differ from the light's position. Default (0, 0, 0).
  tyndallSetRange3Macro(FocalPoint, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(FocalPoint, double);
  ///@}

protected:
  using vtkLightSource::vtkLightSource;
  ~vtkAimedLight() override;

  /// Returns a light whose direction is from the position to the focal point, drawn with their distance as length;
  /// subclasses set its type.
  /// @throws InvalidInput if position and focal point coincide
  tyndall::DrawnLight MakeLight() const override;

  double FocalPoint[3] = { 0.0, 0.0, 0.0 };

private:
  vtkAimedLight(const vtkAimedLight&) = delete;
  void operator=(const vtkAimedLight&) = delete;
};

#endif
