#include "TransferFunctions.h"

#include "ChangedProperty.h"
#include "RegisteredProxies.h"

#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"

namespace
{
bool IsOn(vtkSMProxy* filter, vtkPVXMLElement* hint)
{
  return vtkSMPropertyHelper(filter, hint->GetAttributeOrEmpty("flag"), true).GetAsInt() == 1;
}

/// A representation of the filter's input that maps an array to colours and opacities; null if there is none.
vtkSMProxy* ColoredInput(vtkSMProxy* filter)
{
  const vtkSMPropertyHelper input(filter, "Input", true);
  vtkNew<vtkCollection> representations;
  filter->GetSessionProxyManager()->GetProxies("representations", representations);
  for (int i = 0; i < representations->GetNumberOfItems(); ++i)
  {
    auto* const representation = vtkSMProxy::SafeDownCast(representations->GetItemAsObject(i));
    if (!representation || !representation->GetProperty("ScalarOpacityFunction"))
    {
      continue;
    }
    const vtkSMPropertyHelper shown(representation, "Input", true);
    if (input.GetAsProxy() && shown.GetAsProxy() == input.GetAsProxy() &&
      shown.GetOutputPort() == input.GetOutputPort() &&
      vtkSMPropertyHelper(representation, "LookupTable", true).GetAsProxy() &&
      vtkSMPropertyHelper(representation, "ScalarOpacityFunction").GetAsProxy())
    {
      return representation;
    }
  }
  return nullptr;
}

void Take(vtkSMProxy* filter, vtkPVXMLElement* hint)
{
  if (!IsOn(filter, hint) || vtkSMPropertyHelper(filter, "LookupTable").GetAsProxy())
  {
    return;
  }
  vtkSMProxy* const representation = ColoredInput(filter);
  if (!representation)
  {
    return;
  }
  for (const char* const name : { "LookupTable", "ScalarOpacityFunction" })
  {
    vtkSMPropertyHelper(filter, name).Set(vtkSMPropertyHelper(representation, name).GetAsProxy());
  }
  if (representation->GetProperty("ScalarOpacityUnitDistance"))
  {
    vtkSMPropertyHelper(filter, "ScalarOpacityUnitDistance")
      .Set(vtkSMPropertyHelper(representation, "ScalarOpacityUnitDistance").GetAsDouble());
  }
  if (representation->GetProperty("MapScalars"))
  {
    vtkSMPropertyHelper(filter, "MapScalars").Set(vtkSMPropertyHelper(representation, "MapScalars").GetAsInt());
  }
  const vtkSMPropertyHelper array(representation, "ColorArrayName");
  vtkSMPropertyHelper(filter, hint->GetAttributeOrEmpty("array"))
    .SetInputArrayToProcess(array.GetInputArrayAssociation(), array.GetInputArrayNameToProcess());
}

void FollowFlag(vtkObject* caller, unsigned long, void*, void* property)
{
  auto* const filter = vtkSMProxy::SafeDownCast(caller);
  vtkPVXMLElement* const hint = HintOf(filter, "TransferFunctions");
  if (IsChangeOf(property, hint->GetAttributeOrEmpty("flag")))
  {
    Take(filter, hint);
  }
}

/// Observes a new filter. A script may have set the flag before the filter is registered.
void Notice(vtkObject*, unsigned long, void*, void* data)
{
  static vtkCallbackCommand* const follow = CommandOf(FollowFlag);
  vtkSMProxy* const filter = RegisteredProxy(data);
  vtkPVXMLElement* const hint = filter ? HintOf(filter, "TransferFunctions") : nullptr;
  if (hint)
  {
    Observe(filter, vtkCommand::PropertyModifiedEvent, follow);
    Take(filter, hint);
    filter->UpdateVTKObjects();
  }
}
}

void FollowTransferFunctions()
{
  static bool listening = false;
  FollowRegisteredProxies(listening, Notice);
}
