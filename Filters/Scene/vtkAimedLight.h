#ifndef vtkAimedLight_h
#define vtkAimedLight_h

#include "vtkLightSource.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkAimedLight
 * @brief superclass of the lights that shine from their position towards a focal point
 *
 * @sa vtkSun vtkSpotLight
 */
class TYNDALL_EXPORT vtkAimedLight : public vtkLightSource
{
public:
  vtkTypeMacro(vtkAimedLight, vtkLightSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// What the light shines at: another place than its position. Default (0, 0, 0).
  tyndallSetRange3Macro(FocalPoint, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(FocalPoint, double);
  ///@}

protected:
  using vtkLightSource::vtkLightSource;
  ~vtkAimedLight() override;

  /// Direction from the position to the focal point, and how far it is; its type is left.
  /// @throws InvalidInput where both are one place
  tyndall::DrawnLight MakeLight() const override;

  double FocalPoint[3] = { 0.0, 0.0, 0.0 };

private:
  vtkAimedLight(const vtkAimedLight&) = delete;
  void operator=(const vtkAimedLight&) = delete;
};

#endif
