#ifndef ChangedProperty_h
#define ChangedProperty_h

#include <cstring>

/// Is it the property of that name that has changed?
/// @param data  of a vtkCommand::PropertyModifiedEvent: a name, or null where the property is a subproxy's
inline bool IsChangeOf(const void* data, const char* name)
{
  return data && std::strcmp(static_cast<const char*>(data), name) == 0;
}

#endif
