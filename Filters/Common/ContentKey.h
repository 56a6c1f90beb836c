#pragma once

#include <cstdint>

class vtkDataObject;

namespace tyndall
{
/// A number that two datasets have in common only if all that they hold is the same, byte by byte: place, grid, points,
/// arrays with their names. Unlike times it does not change where a filter before ran again and made the same, as
/// ParaView's readers do, which read a file twice for two ways to ask for one time step.
/// @param data  null: that there is none
std::uint64_t ContentKey(vtkDataObject* data);

/// The same without the arrays of the field data: ranks that hold the same photons know other facts of the medium where
/// one has no piece of it.
std::uint64_t ContentKeyButFacts(vtkDataObject* data);
}
