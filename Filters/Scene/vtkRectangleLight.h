#ifndef vtkRectangleLight_h
#define vtkRectangleLight_h

#include "vtkLightSource.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkRectangleLight
 * @brief a rectangle that shines to one side, as a Lambertian emitter
 *
 * Its position is its centre. It is placed like a plane, by its normal and not by a focal point. Its first edge is
 * horizontal (across z and the direction; along x where the light shines straight up or down), its second one is across
 * the first and the direction. In a view it is itself, with an arrow to the side that it shines to.
 *
 * @sa vtkLightSource vtkLightRig
 */
class TYNDALL_EXPORT vtkRectangleLight : public vtkLightSource
{
public:
  static vtkRectangleLight* New();
  vtkTypeMacro(vtkRectangleLight, vtkLightSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Normal of the rectangle, to the side that it shines to; its length does not count, but must not be 0. Default
  /// (1, 0, -1).
  tyndallSetRange3Macro(Direction, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(Direction, double);
  ///@}

  ///@{
  /// Lengths of the first and the second edge. Default (0.25, 0.25), valid above 0.
  tyndallSetRange2Macro(Size, double, tyndall::AboveZero, tyndall::AnyHigh);
  vtkGetVector2Macro(Size, double);
  ///@}

protected:
  vtkRectangleLight();
  ~vtkRectangleLight() override;

  tyndall::DrawnLight MakeLight() const override;

  double Direction[3] = { 1.0, 0.0, -1.0 };
  double Size[2] = { 0.25, 0.25 };

private:
  vtkRectangleLight(const vtkRectangleLight&) = delete;
  void operator=(const vtkRectangleLight&) = delete;
};

#endif
