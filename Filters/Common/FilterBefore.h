#pragma once

class vtkDataObject;

/// What the outputs of a filter that was aborted, or failed, tell the filters after it. They are empty.
namespace tyndall
{
/// Field data of such outputs.
constexpr const char* AbortedFact = "aborted";
constexpr const char* FailedFact = "failed";
/// Of an output that is empty because the file it was read from is, which is no error.
constexpr const char* EmptyFact = "nothing_in_file";
/// Beside FailedFact: because a rank did not come, so that it is not waited for again.
constexpr const char* MissingFact = "rank_missing";

/// To be asked where an input is empty: ends the work of Guarded (Work/GuardedWork.h) without an error where the filter
/// before failed or was aborted, or read an empty file.
void StopWithFilterBefore(vtkDataObject* input);
}
