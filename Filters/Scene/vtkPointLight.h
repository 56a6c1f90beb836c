#ifndef vtkPointLight_h
#define vtkPointLight_h

#include "vtkLightSource.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkPointLight
 * @brief an isotropic point source
 *
 * The shape of the light in a view is a ball.
 *
 * @sa vtkLightSource vtkLightRig
 */
class TYNDALL_EXPORT vtkPointLight : public vtkLightSource
{
public:
  static vtkPointLight* New();
  vtkTypeMacro(vtkPointLight, vtkLightSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Radius of the drawn ball, in units of length. The emitted light does not depend on ShapeSize. Default 0.02, valid
  /// above 0.
  tyndallRangeMacro(ShapeSize, double, tyndall::AboveZero, tyndall::AnyHigh);
  ///@}

protected:
  vtkPointLight();
  ~vtkPointLight() override;

  tyndall::DrawnLight MakeLight() const override;

  double ShapeSize = 0.02;

private:
  vtkPointLight(const vtkPointLight&) = delete;
  void operator=(const vtkPointLight&) = delete;
};

#endif
