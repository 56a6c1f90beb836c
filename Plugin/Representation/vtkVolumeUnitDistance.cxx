#include "vtkVolumeUnitDistance.h"

#include "vtkCompositeRepresentation.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkVolumeRepresentation.h"

namespace
{
constexpr int Alpha = 3; ///< index of the component that is alpha
}

vtkStandardNewMacro(vtkVolumeUnitDistance);

vtkVolumeUnitDistance::vtkVolumeUnitDistance() = default;

vtkVolumeUnitDistance::~vtkVolumeUnitDistance() = default;

void vtkVolumeUnitDistance::SetRepresentation(vtkObject* representation)
{
  this->Representation = representation;
}

void vtkVolumeUnitDistance::SetDistance(double distance)
{
  auto* const composite = vtkCompositeRepresentation::SafeDownCast(this->Representation);
  auto* const volume =
    vtkVolumeRepresentation::SafeDownCast(composite ? composite->GetActiveRepresentation() : nullptr);
  if (volume && distance > 0.0)
  {
    volume->GetActor()->GetProperty()->SetScalarOpacityUnitDistance(Alpha, distance);
  }
}

void vtkVolumeUnitDistance::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Representation: " << this->Representation << "\n";
}
