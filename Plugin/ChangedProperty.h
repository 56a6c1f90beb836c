#ifndef ChangedProperty_h
#define ChangedProperty_h

#include <cstring>

/// Whether the property `name` is the one that has changed.
/// @param data  call data of a vtkCommand::PropertyModifiedEvent: the property's name, or null if it is a subproxy's
inline bool IsChangeOf(const void* data, const char* name)
{
  return data && std::strcmp(static_cast<const char*>(data), name) == 0;
}

#endif
