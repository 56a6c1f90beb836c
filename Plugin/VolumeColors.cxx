#include "VolumeColors.h"

#include "ChangedProperty.h"
#include "ShownOutput.h"

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
// This file calls only inline and virtual functions of vtkSMPVRepresentationProxy, so that the library RemotingViews,
// which needs GLEW, is not linked.
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMSessionProxyManager.h"

#include <cstring>
#include <iterator>

namespace
{
/// Control points of the opacity function, four numbers each: value, opacity, midpoint, sharpness.
constexpr double Opacity[] = { 0.0, 0.0, 0.5, 0.0, 255.0, 1.0, 0.5, 0.0 };
constexpr int NeverRescaled = -1;

vtkPVXMLElement* HintOf(vtkSMProxy* representation)
{
  return HintFor(ShownBy(representation), "VolumeColors");
}

bool IsVolume(vtkSMProxy* representation)
{
  const char* const type = vtkSMPropertyHelper(representation, "Representation", true).GetAsString();
  return type && std::strcmp(type, "Volume") == 0;
}

bool HasColors(vtkSMProxy* representation)
{
  return HintedArray(ShownBy(representation), HintOf(representation)) != nullptr;
}

bool IsColoredByThem(vtkSMProxy* representation)
{
  const vtkSMPropertyHelper chosen(representation, "ColorArrayName", true);
  const char* const name = chosen.GetInputArrayNameToProcess();
  return name && std::strcmp(name, HintOf(representation)->GetAttributeOrEmpty("array")) == 0;
}

/// Length over which alpha is the opacity of the shown volume (its unit distance), from the field data that the hint
/// names.
/// @return 0 if the field data are missing
double DistanceOf(vtkSMProxy* representation)
{
  const Shown shown = ShownBy(representation);
  const char* const name = HintOf(representation)->GetAttributeOrEmpty("distance");
  vtkPVArrayInformation* const fact =
    shown.source->GetDataInformation(shown.port)->GetArrayInformation(name, vtkDataObject::FIELD);
  return fact ? fact->GetComponentRange(0)[0] : 0.0;
}

/// Sets the unit distance of a volume's alpha by vtkVolumeUnitDistance, because ParaView has no property for it.
void GiveDistance(vtkSMProxy* representation)
{
  const double distance = DistanceOf(representation);
  vtkSmartPointer<vtkSMProxy> giver;
  giver.TakeReference(
    representation->GetSessionProxyManager()->NewProxy("internal_representations", "VolumeUnitDistance"));
  if (giver && distance > 0.0)
  {
    vtkSMPropertyHelper(giver, "Representation").Set(representation);
    giver->UpdateVTKObjects();
    vtkSMPropertyHelper(giver, "Distance").Set(distance);
    giver->UpdateVTKObjects();
  }
}

/// Resets an opacity function to opacity 0 to 1 over the range 0 to 255 if it has another range; otherwise keeps the
/// control points that the user has set.
void GiveRange(vtkSMProxy* function)
{
  vtkSMPropertyHelper points(function, "Points");
  const unsigned int count = points.GetNumberOfElements();
  const bool isRescaled =
    count < std::size(Opacity) || points.GetAsDouble(0) != Opacity[0] || points.GetAsDouble(count - 4) != Opacity[4];
  if (isRescaled)
  {
    points.Set(Opacity, static_cast<unsigned int>(std::size(Opacity)));
    function->UpdateVTKObjects();
  }
}

/// Restores the opacity function's range after ParaView has rescaled it to the range of the colours' norm.
void GiveRangeAtChange(vtkObject* caller, unsigned long, void*, void* property)
{
  if (IsChangeOf(property, "Points"))
  {
    GiveRange(vtkSMProxy::SafeDownCast(caller));
  }
}

void FitOpacity(vtkSMProxy* representation)
{
  static vtkNew<vtkCallbackCommand> change;
  change->SetCallback(GiveRangeAtChange);
  if (vtkSMProxy* const function = vtkSMPropertyHelper(representation, "ScalarOpacityFunction", true).GetAsProxy())
  {
    GiveRange(function);
    if (!function->HasObserver(vtkCommand::PropertyModifiedEvent, change))
    {
      function->AddObserver(vtkCommand::PropertyModifiedEvent, change);
    }
  }
  if (vtkSMProxy* const colors = vtkSMPropertyHelper(representation, "LookupTable", true).GetAsProxy())
  {
    vtkSMPropertyHelper(colors, "AutomaticRescaleRangeMode", true).Set(NeverRescaled);
    vtkSMPropertyHelper(colors, "ScalarRangeInitialized", true).Set(1);
    colors->UpdateVTKObjects();
  }
}

/// Sets Map Scalars, opacity and unit distance for the array that the representation is coloured by.
void Fit(vtkSMProxy* representation)
{
  const bool own = IsColoredByThem(representation);
  vtkSMPropertyHelper(representation, "MapScalars").Set(own ? 0 : 1);
  if (own)
  {
    FitOpacity(representation);
    const double distance = DistanceOf(representation);
    if (distance > 0.0)
    {
      vtkSMPropertyHelper(representation, "ScalarOpacityUnitDistance", true).Set(distance);
    }
  }
  representation->UpdateVTKObjects();
}

void ShowColors(vtkSMProxy* representation)
{
  const char* const name = HintOf(representation)->GetAttributeOrEmpty("array");
  if (auto* const colored = vtkSMPVRepresentationProxy::SafeDownCast(representation))
  {
    colored->SetScalarColoring(name, vtkDataObject::CELL);
  }
  Fit(representation);
  GiveDistance(representation);
}

void FollowProperty(vtkObject* caller, unsigned long, void*, void* data)
{
  auto* const representation = vtkSMProxy::SafeDownCast(caller);
  if (!HintOf(representation))
  {
    return;
  }
  if (IsChangeOf(data, "Representation") && IsVolume(representation) && HasColors(representation))
  {
    // Makes the representation show the volume, before ShowColors sets the volume's unit distance.
    representation->UpdateVTKObjects();
    ShowColors(representation);
  }
  else if (IsChangeOf(data, "ColorArrayName") || IsChangeOf(data, "ScalarOpacityFunction"))
  {
    Fit(representation);
  }
}

/// Sets the unit distance again after an update: it may change with time, or a state may have been loaded.
void FollowData(vtkObject* caller, unsigned long, void*, void*)
{
  auto* const representation = vtkSMProxy::SafeDownCast(caller);
  if (HintOf(representation) && IsVolume(representation) && IsColoredByThem(representation))
  {
    GiveDistance(representation);
  }
}

void Follow(vtkSMProxy* representation)
{
  vtkNew<vtkCallbackCommand> property, data;
  property->SetCallback(FollowProperty);
  data->SetCallback(FollowData);
  representation->AddObserver(vtkCommand::PropertyModifiedEvent, property);
  representation->AddObserver(vtkCommand::UpdateDataEvent, data);
}
}

void FollowVolumeColors(vtkSMProxy* representation)
{
  if (!representation->GetProperty("MapScalars") || !representation->GetProperty("ScalarOpacityFunction") ||
    !HintOf(representation))
  {
    return;
  }
  Follow(representation);
  if (HasColors(representation))
  {
    // This change calls the observer FollowProperty, which sets the colours.
    vtkSMPropertyHelper(representation, "Representation").Set("Volume");
    representation->UpdateVTKObjects();
  }
}
