#pragma once

#include <vector>

class vtkAlgorithm;
class vtkImageData;
class vtkInformationVector;
class vtkPolyData;

/// What `vtkGhostType` of an input image means here.
///
/// Hidden cells (HIDDENCELL, and as everywhere in VTK cells with a hidden point, HIDDENPOINT) are empty: whatever array
/// is read of them is 0, their refractive index 1. That is done where arrays are read (ReadCells, ReadChosenCells), so
/// that all filters agree. Their values may be anything, also NaN, which is what ResampleToImage leaves outside of its
/// input.
///
/// Duplicates (DUPLICATECELL) are cells that another rank has, too. In an image that one process has as a whole each of
/// them is there once, is a part of the medium like others, and its power is counted once. Over ranks that run a filter
/// together each is taken from the rank that has it as its own (WholeInputs.h). Where the output is divided otherwise,
/// as one process streams it, each piece would be solved with cells of its neighbours, and the sum over pieces would
/// have their power twice: that is refused.
///
/// Of lights and photons, hidden points and duplicates are left out: every rank asks for all of them, so that the one
/// that a duplicate repeats is there.
namespace tyndall
{
/// A number for each cell, not 0 where it is hidden; empty: none is.
std::vector<unsigned char> HiddenCells(vtkImageData* image);

/// Numbers of the points that count, in their order.
std::vector<long long> PointsThatCount(vtkPolyData* data);

/// @throws InvalidInput where an input image has duplicate cells and more than one piece of the output is asked for,
///   unless the filter works cell by cell
void CheckDuplicates(vtkAlgorithm* filter, vtkInformationVector* outputs);
}
