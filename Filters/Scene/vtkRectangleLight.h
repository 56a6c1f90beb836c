#ifndef vtkRectangleLight_h
#define vtkRectangleLight_h

#include "vtkAimedLight.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkRectangleLight
 * @brief a rectangle that shines to the side of its focal point, as a Lambertian emitter
 *
 * Its position is its centre. Its first edge is horizontal (across z and the direction; along x where the light shines
 * straight up or down), its second one is across the first and the direction. In a view it is itself, with an arrow to
 * the side that it shines to.
 *
 * @sa vtkLightSource vtkLightRig
 */
class TYNDALL_EXPORT vtkRectangleLight : public vtkAimedLight
{
public:
  static vtkRectangleLight* New();
  vtkTypeMacro(vtkRectangleLight, vtkAimedLight);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Lengths of the first and the second edge. Default (0.25, 0.25), valid above 0.
  tyndallSetRange2Macro(Size, double, tyndall::AboveZero, tyndall::AnyHigh);
  vtkGetVector2Macro(Size, double);
  ///@}

protected:
  vtkRectangleLight();
  ~vtkRectangleLight() override;

  tyndall::DrawnLight MakeLight() const override;

  double Size[2] = { 0.25, 0.25 };

private:
  vtkRectangleLight(const vtkRectangleLight&) = delete;
  void operator=(const vtkRectangleLight&) = delete;
};

#endif
