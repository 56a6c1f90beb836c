#ifndef vtkAimedLight_h
#define vtkAimedLight_h

#include "vtkLightSource.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkAimedLight
 * @brief superclass of lights that emit from their position towards a focal point
 *
 * @sa vtkSun vtkSpotLight
 */
class TYNDALL_EXPORT vtkAimedLight : public vtkLightSource
{
public:
  vtkTypeMacro(vtkAimedLight, vtkLightSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Point at which the light is aimed; must differ from its position. Default (0, 0, 0).
  tyndallSetRange3Macro(FocalPoint, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(FocalPoint, double);
  ///@}

protected:
  using vtkLightSource::vtkLightSource;
  ~vtkAimedLight() override;

  /// Sets the direction from the position to the focal point, and the distance between them as length; leaves the type.
  /// @throws InvalidInput if both are the same point
  tyndall::DrawnLight MakeLight() const override;

  double FocalPoint[3] = { 0.0, 0.0, 0.0 };

private:
  vtkAimedLight(const vtkAimedLight&) = delete;
  void operator=(const vtkAimedLight&) = delete;
};

#endif
