#ifndef ChangedProperty_h
#define ChangedProperty_h

#include <cstring>

/// Whether a property-modified event is about the property `name`.
/// @param data  call data of the vtkCommand::PropertyModifiedEvent: the changed property's name, or null if a
///   subproxy's property has changed
inline bool IsChangeOf(const void* data, const char* name)
{
  return data && std::strcmp(static_cast<const char*>(data), name) == 0;
}

#endif
