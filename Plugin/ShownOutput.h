#ifndef ShownOutput_h
#define ShownOutput_h

#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"

/// An output port of a source, which a representation shows.
struct Shown
{
  vtkSMSourceProxy* source;
  int port;
};

inline Shown ShownBy(vtkSMProxy* representation)
{
  const vtkSMPropertyHelper input(representation, "Input", true);
  return { vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()), static_cast<int>(input.GetOutputPort()) };
}

/// Returns the hint `name` of the source that applies to the shown output; null if there is none.
inline vtkPVXMLElement* HintFor(const Shown& shown, const char* name)
{
  vtkPVXMLElement* const hints = shown.source ? shown.source->GetHints() : nullptr;
  vtkPVXMLElement* const hint = hints ? hints->FindNestedElementByName(name) : nullptr;
  int port = 0;
  const bool isOfOther = hint && hint->GetScalarAttribute("port", &port) && port != shown.port;
  return isOfOther ? nullptr : hint;
}

/// Returns information about the cell array that a hint names; null if the output does not have this array.
inline vtkPVArrayInformation* HintedArray(const Shown& shown, vtkPVXMLElement* hint)
{
  const char* const name = hint->GetAttributeOrEmpty("array");
  return shown.source->GetDataInformation(shown.port)->GetArrayInformation(name, vtkDataObject::CELL);
}

#endif
