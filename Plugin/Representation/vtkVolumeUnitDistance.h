#ifndef vtkVolumeUnitDistance_h
#define vtkVolumeUnitDistance_h

#include "vtkObject.h"
#include "vtkSmartPointer.h"
#include "vtkTyndallRepresentationModule.h" // for export macro

/**
 * @class vtkVolumeUnitDistance
 * @brief across which distance the alpha of a volume shown in its own colours is its opacity
 *
 * ParaView's property Scalar Opacity Unit Distance is that of a volume's first component. Where a volume has its own
 * red, green, blue and alpha, VTK takes the fourth's (vtkVolumeProperty::SetScalarOpacityUnitDistance(3, d)), which
 * nothing in ParaView sets. This does, for the volume that a composite representation shows at the moment.
 */
class TYNDALLREPRESENTATION_EXPORT vtkVolumeUnitDistance : public vtkObject
{
public:
  static vtkVolumeUnitDistance* New();
  vtkTypeMacro(vtkVolumeUnitDistance, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The representation, a vtkCompositeRepresentation. To come before SetDistance.
  void SetRepresentation(vtkObject* representation);

  /// Length, above 0. Nothing happens where it is not, or something else than a volume is shown.
  void SetDistance(double distance);

protected:
  vtkVolumeUnitDistance();
  ~vtkVolumeUnitDistance() override;

private:
  vtkVolumeUnitDistance(const vtkVolumeUnitDistance&) = delete;
  void operator=(const vtkVolumeUnitDistance&) = delete;

  vtkSmartPointer<vtkObject> Representation;
};

#endif
