#pragma once

#include "Common/PropertyRange.h"

#include "vtkIndent.h"

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

/// In PrintSelf: prints one line "Name: value" for each member that is passed.
#define tyndallPrintMacro(...) tyndall::PrintMembers(os, indent, #__VA_ARGS__, __VA_ARGS__)

namespace tyndall
{
/// In PrintSelf: prints the read-only properties Seconds (run time) and LeftOut (skipped computations), which every
/// filter has.
inline void PrintRun(std::ostream& os, vtkIndent indent, vtkAlgorithm* filter)
{
  os << indent << "Seconds: " << SecondsOfRun(filter) << "\n";
  os << indent << "LeftOut: " << LeftOutOfRun(filter) << "\n";
}

template <class Value>
void PrintValue(std::ostream& os, const Value& value)
{
  os << " " << value;
}

template <class Value, std::size_t Count>
void PrintValue(std::ostream& os, const Value (&values)[Count])
{
  std::for_each(values, values + Count, [&](const Value& value) { PrintValue(os, value); });
}

template <class Value>
void PrintValue(std::ostream& os, const std::vector<Value>& values)
{
  std::for_each(values.begin(), values.end(), [&](const Value& value) { PrintValue(os, value); });
}

/// Prints one line "name: value" for each value.
/// @param names  names of the values, separated by commas
template <class... Values>
void PrintMembers(std::ostream& os, vtkIndent indent, const std::string& names, const Values&... values)
{
  std::size_t begin = 0;
  const auto print = [&](const auto& value) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    os << indent << names.substr(begin, end - begin) << ":";
    PrintValue(os, value);
    os << "\n";
    begin = end + 2;
  };
  (print(values), ...);
}
}
